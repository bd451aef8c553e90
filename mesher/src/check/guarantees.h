#pragma once

#include <array>
#include <string_view>

/// The names of the guarantees, as in Finding::guarantee. They are stable, because scripts look for them.
///
/// To add a guarantee:
/// 1. Give it a name here, or in the header of its part: layer_cells.h, layer_walls.h, periodic.h. If a mesh
///    that misses it may still get labels (labelled.h), list it in `of_shapes`.
/// 2. If it concerns single tets or nodes, write a predicate into predicates.h and call it from tets.cpp or
///    second_order.cpp. Otherwise declare a check in mesh_to_check.h and call it from `judge` in check.cpp;
///    for meshes of triangles alone, from `judge_shells` in shells.cpp; for meshes of curve edges alone, from
///    `judge_lines` in lines.cpp.
/// 3. Under MPI none of this runs by itself: call the predicate from `Certification` in
///    distributed/src/certify.cpp, for tets in `check_tets`, for nodes in `check_points`. `gather` collects
///    the findings of all ranks. A measure of the whole mesh is summed in `sum_up` and judged in
///    `compare_with_complex`. Guarantees that only a mesh on several ranks needs, such as "shared_places",
///    have their names in certify.cpp.
/// 4. Break the guarantee on purpose in tests/fast/check_wrong_meshes_test.cpp. If no solver can use a mesh
///    that misses it, list it in command/usable.cpp.
/// 5. Add the name to `guarantees` in report/html_report/facts.js and to
///    freecad_workbench/freecad/collarmesh_workbench/guarantees.py; else the reports show the guarantee only
///    when it is missed.
namespace collarmesh::guarantee {

// Guarantees of arrays and labels.
inline constexpr char valid_arrays[] = "valid_arrays";            ///< equal lengths, indices in range
inline constexpr char finite_points[] = "finite_points";          ///< no NaN, no infinity
inline constexpr char distinct_points[] = "distinct_points";      ///< no two points are at one place
inline constexpr char referenced_points[] = "referenced_points";  ///< every point is a node of an element
inline constexpr char region_tag[] = "region_tag";                ///< a tet's tag is its region's
inline constexpr char vertex_feature[] = "vertex_feature";  ///< a vertex lies on the feature that the mesh
                                                            ///< gives for it

// Guarantees of the tets.
inline constexpr char positive_volume[] = "positive_volume";  ///< positive by exact arithmetic
inline constexpr char distinct_tets[] = "distinct_tets";
inline constexpr char conforming[] = "conforming";    ///< a face has at most two tets, on its two sides
inline constexpr char radius_edge[] = "radius_edge";  ///< bound for tets that are neither thin nor in collars
inline constexpr char thin_angles[] = "thin_angles";  ///< angle bounds of tets beyond the radius-edge bound
inline constexpr char collar_dihedral[] = "collar_dihedral";  ///< dihedral angles in collars
/// If the bounds ask for interior nodes, each tet has a corner on no listed face.
inline constexpr char interior_node[] = "interior_node";

// Guarantees of the balls of the collars, if the mesh has them.
inline constexpr char collar_centre[] = "collar_centre";  ///< a ball's centre is where its mesh point is
inline constexpr char collar_gap[] = "collar_gap";        ///< radius at most a third of the gap size there
inline constexpr char collar_disjoint[] =
    "collar_disjoint";  ///< balls of different creases are apart; consecutive balls meet in a circle that no
                        ///< third ball reaches
inline constexpr char collar_cells[] = "collar_cells";  ///< tets in stars have the centre of one ball as a
                                                        ///< corner, tets in books the centres of two

// Guarantees of the regions.
inline constexpr char listed_faces[] =
    "listed_faces";  ///< boundary and interface triangles are listed as faces, once each
inline constexpr char face_regions[] = "face_regions";  ///< a face's regions are those of the tets beside it
inline constexpr char watertight[] = "watertight";      ///< the faces around a region form a closed surface
inline constexpr char region_volume[] = "region_volume";    ///< the mesh's volume is that of the complex
inline constexpr char volume_kept[] = "volume_kept";        ///< the volume is close enough to the input's for
                                                            ///< results to be trusted
inline constexpr char thickness_kept[] = "thickness_kept";  ///< thin places of large regions are still there

// Guarantees of the complex's vertices and curves.
inline constexpr char vertex_present[] = "vertex_present";  ///< each vertex of the complex is a mesh vertex
inline constexpr char listed_edges[] = "listed_edges";      ///< listed edges are edges of tets, each listed
                                                            ///< once
inline constexpr char curve_tag[] = "curve_tag";            ///< an edge's tag is its curve's
inline constexpr char curve_cover[] = "curve_cover";        ///< a curve's edges are one chain from end to end
inline constexpr char curve_distance[] = "curve_distance";  ///< the chain and the curve are close

// Guarantees of the complex's patches.
inline constexpr char patch_tag[] = "patch_tag";                  ///< a face's tag is its patch's
inline constexpr char patch_regions[] = "patch_regions";          ///< a face's regions are its patch's
inline constexpr char patch_manifold[] = "patch_manifold";        ///< a patch's faces form a surface without
                                                                  ///< pinches
inline constexpr char patch_orientation[] = "patch_orientation";  ///< a patch's faces are oriented alike
inline constexpr char patch_border[] = "patch_border";      ///< a patch's faces end at its curves and nowhere
                                                            ///< else
inline constexpr char patch_plane[] = "patch_plane";        ///< the faces of a planar patch lie in its plane
inline constexpr char patch_area[] = "patch_area";          ///< the faces of a planar patch have its area
inline constexpr char patch_distance[] = "patch_distance";  ///< the faces and a smooth patch are close, in
                                                            ///< both directions

// Guarantees of cells of second order.
inline constexpr char mid_nodes[] = "mid_nodes";  ///< each edge has one mid-edge node, which all cells at it
                                                  ///< share and no other edge has
inline constexpr char positive_jacobian[] = "positive_jacobian";  ///< positive everywhere in a tet, proved by
                                                                  ///< bounds
inline constexpr char mid_node_distance[] = "mid_node_distance";  ///< distance of a mid-edge node from its
                                                                  ///< curve or patch

// Guarantees of meshes without tets.
inline constexpr char triangle_angles[] =
    "triangle_angles";  ///< angles of triangles, away from sharp corners of the input
inline constexpr char patch_present[] = "patch_present";          ///< each patch has faces
inline constexpr char curve_present[] = "curve_present";          ///< each curve has edges
inline constexpr char shell_orientation[] = "shell_orientation";  ///< faces of solids point outwards, those
                                                                  ///< of other surfaces are oriented alike

/// Guarantees of the shapes of cells, of collars, and of distances, areas, volumes and thicknesses. A mesh
/// that misses them may still get labels (labelled.h).
inline constexpr std::array<std::string_view, 14> of_shapes{
    radius_edge,    thin_angles,     collar_dihedral, interior_node, collar_centre,
    collar_gap,     collar_disjoint, collar_cells,    region_volume, volume_kept,
    thickness_kept, curve_distance,  patch_distance,  patch_area};

}  // namespace collarmesh::guarantee

namespace collarmesh {

/// The largest relative deviation of a region's volume from the input's without a warning.
inline constexpr double volume_warned_of = 0.02;

}  // namespace collarmesh
