#pragma once

/// The names of the guarantees, as in Finding::guarantee. They are stable: scripts select by them.
namespace collarmesh::guarantee {

// The arrays
inline constexpr char valid_arrays[] = "valid_arrays";            ///< equal lengths, indices in range
inline constexpr char finite_points[] = "finite_points";          ///< no NaN, no infinity
inline constexpr char distinct_points[] = "distinct_points";      ///< no two at one place
inline constexpr char referenced_points[] = "referenced_points";  ///< every point is a corner of a tet
inline constexpr char region_tag[] = "region_tag";                ///< a tet's tag is its region's
inline constexpr char vertex_feature[] = "vertex_feature";  ///< what a vertex says it lies on, it lies on

// The tets
inline constexpr char positive_volume[] = "positive_volume";  ///< by exact arithmetic
inline constexpr char distinct_tets[] = "distinct_tets";
inline constexpr char conforming[] = "conforming";    ///< a face has at most two tets, on its two sides
inline constexpr char radius_edge[] = "radius_edge";  ///< outside collars, but for thin tets
inline constexpr char thin_angles[] = "thin_angles";  ///< of tets that exceed the radius-edge bound
inline constexpr char collar_dihedral[] = "collar_dihedral";  ///< in collars
inline constexpr char interior_node[] = "interior_node";  ///< a corner on no face, if each tet is to have one

// The balls of the collars, where the mesh tells them
inline constexpr char collar_centre[] = "collar_centre";  ///< the balls are where their points are
inline constexpr char collar_gap[] = "collar_gap";        ///< radius at most a third of the gap size
inline constexpr char collar_disjoint[] =
    "collar_disjoint";  ///< different creases' are apart, consecutive ones meet in a circle of their own
inline constexpr char collar_cells[] = "collar_cells";  ///< stars and books have their balls' centres

// The regions
inline constexpr char listed_faces[] =
    "listed_faces";  ///< faces hold the boundary and the interfaces, once each
inline constexpr char face_regions[] = "face_regions";    ///< a face's regions are those of its tets
inline constexpr char watertight[] = "watertight";        ///< the faces around a region form a closed surface
inline constexpr char region_volume[] = "region_volume";  ///< is the complex's own
inline constexpr char volume_kept[] = "volume_kept";      ///< and so much of it that results can be trusted
inline constexpr char thickness_kept[] = "thickness_kept";  ///< thin places of large regions are there

// The complex's vertices and curves
inline constexpr char vertex_present[] = "vertex_present";  ///< each is a mesh vertex
inline constexpr char listed_edges[] = "listed_edges";      ///< edges are edges of tets, listed once
inline constexpr char curve_tag[] = "curve_tag";            ///< an edge's tag is its curve's
inline constexpr char curve_cover[] = "curve_cover";        ///< its edges are one chain from end to end
inline constexpr char curve_distance[] = "curve_distance";  ///< the chain and the curve are close

// Its patches
inline constexpr char patch_tag[] = "patch_tag";            ///< a face's tag is its patch's
inline constexpr char patch_regions[] = "patch_regions";    ///< a face's regions are its patch's
inline constexpr char patch_manifold[] = "patch_manifold";  ///< its faces form a surface, without pinches
inline constexpr char patch_orientation[] = "patch_orientation";  ///< its faces are oriented alike
inline constexpr char patch_border[] = "patch_border";      ///< its faces end at its curves and nowhere else
inline constexpr char patch_plane[] = "patch_plane";        ///< planar: its faces lie in the plane
inline constexpr char patch_area[] = "patch_area";          ///< planar: its faces have its area
inline constexpr char patch_distance[] = "patch_distance";  ///< smooth: two-sided

// Cells of second order
inline constexpr char mid_nodes[] = "mid_nodes";  ///< one to an edge, in all cells at it, and to no other
inline constexpr char positive_jacobian[] = "positive_jacobian";  ///< everywhere in a tet, by bounds
inline constexpr char mid_node_distance[] = "mid_node_distance";  ///< from the node's curve or patch

// Meshes of triangles alone
inline constexpr char triangle_angles[] =
    "triangle_angles";  ///< of triangles, away from sharp corners of the input
inline constexpr char patch_present[] = "patch_present";          ///< each has faces
inline constexpr char curve_present[] = "curve_present";          ///< each has edges
inline constexpr char shell_orientation[] = "shell_orientation";  ///< faces of solids look outwards

}  // namespace collarmesh::guarantee
