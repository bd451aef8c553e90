#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "collarmesh/geometry.h"
#include "collarmesh/layer_cells.h"
#include "collarmesh/tag_names.h"

namespace collarmesh {

/// The style of group names in formats that have them.
enum class GroupNames {
  complex,  ///< region_1, patch_7, curve_3: kind and tag
  cad       ///< Solid1, Face7, Edge3: the sub-shapes of a CAD shape
};

/// The element type for triangles of a mesh without tets, in solver formats that have several kinds of plane
/// elements.
enum class TriangleElements {
  shell,         ///< S3, S6
  plane_stress,  ///< CPS3, CPS6: in the plane z = 0
  plane_strain   ///< CPE3, CPE6: in the plane z = 0
};

/// A conforming tetrahedral mesh, or one of triangles or of curve edges alone (`mesh_shells`), with all that
/// a solver's set-up needs to refer to the input: regions, tagged boundary and interface triangles, tagged
/// curve edges. Every array of a group (tets, faces, edges, points) has the same length.
struct TetMesh {
  /// The feature of the complex that a mesh vertex lies on: the one of lowest dimension.
  struct VertexFeature {
    std::uint8_t dimension = 3;  ///< 0 vertex, 1 curve, 2 patch, 3 none (inside a region)
    Index feature = none;        ///< its index in the complex; none when unknown (read from a file)
  };

  std::vector<Point> points;
  std::vector<VertexFeature> features;  ///< one per point, or empty (read from a file)

  /// Corners a, b, c, d with six_volume(a, b, c, d) > 0.
  std::vector<std::array<Index, 4>> tets;
  std::vector<Index> tet_region;         ///< index of the region in the complex, from 1
  std::vector<Tag> tet_tag;              ///< tag of that region
  std::vector<std::uint8_t> tet_collar;  ///< 0 outside collars, 1 star, 2 book
  /// 1: a thin tet, which may exceed the radius-edge bound (see `coarsen`), else 0; empty: not known.
  std::vector<std::uint8_t> tet_thin;
  std::vector<Tag> tet_crease;  ///< tag of the collar's crease, a curve or vertex; 0 outside collars
  /// Rank of the partition of each tet, from 0 (see `partition`); empty: not partitioned.
  std::vector<Index> tet_partition;

  /// Boundary, interface and internal-facet triangles; the normal (b-a) x (c-a) points from
  /// face_regions[0] to face_regions[1]. A boundary triangle has its solid in [0] and 0 in [1].
  std::vector<std::array<Index, 3>> faces;
  std::vector<std::array<Index, 2>> face_regions;
  std::vector<Index> face_patch;  ///< index of the patch in the complex, none when unknown
  std::vector<Tag> face_tag;      ///< tag of that patch

  /// Edges on curves.
  std::vector<std::array<Index, 2>> edges;
  std::vector<Index> edge_curve;  ///< index of the curve in the complex, none when unknown
  std::vector<Tag> edge_tag;

  /// Mid-edge nodes of cells of second order, which are points like the corners: for a tet abcd the nodes of
  /// ab, bc, ca, ad, bd, cd; for a face abc the nodes of ab, bc, ca; for an edge its one node. Empty: first
  /// order.
  std::vector<std::array<Index, 6>> tet_mid_nodes;
  std::vector<std::array<Index, 3>> face_mid_nodes;
  std::vector<Index> edge_mid_nodes;

  LayerCells layers;  ///< cells of boundary layers other than tets

  GroupNames group_names = GroupNames::complex;
  TagNames names;  ///< names to write for the tags
  TriangleElements triangle_elements = TriangleElements::shell;

  /// A rigid motion: p goes to (dot(rows[0], p), dot(rows[1], p), dot(rows[2], p)) + shift.
  struct Motion {
    std::array<Vector, 3> rows{Vector{1, 0, 0}, Vector{0, 1, 0}, Vector{0, 0, 1}};
    Vector shift{0, 0, 0};

    Point operator()(const Point& p) const {
      return Point{dot(rows[0], p), dot(rows[1], p), dot(rows[2], p)} + shift;
    }
  };
  /// Two groups of patches. The motion takes the nodes, edges and triangles of the first group to those of
  /// the second.
  struct PeriodicFaces {
    std::vector<Tag> first, second;  ///< tags of patches, sorted
    Motion motion;                   ///< takes the first to the second
    /// Pairs of a node of the first group and its image, mid-edge nodes included; sorted by the first. A node
    /// on an axis of rotation is its own image.
    std::vector<std::array<Index, 2>> nodes;
  };
  std::vector<PeriodicFaces> periodic;  ///< pairs of groups of periodic patches; empty: none

  int order() const {
    const bool second = tets.empty() ? !tet_mid_nodes.empty() || !face_mid_nodes.empty() ||
                                           (faces.empty() && !edge_mid_nodes.empty())
                                     : !tet_mid_nodes.empty();
    return second ? 2 : 1;
  }
  /// Returns whether the mesh has triangles but no tets.
  bool is_surface() const { return tets.empty() && !faces.empty(); }
  /// Returns whether the mesh has curve edges alone.
  bool is_curves() const { return tets.empty() && faces.empty() && !edges.empty(); }

  /// A ball around a point of a crease. Stars and books fill the union of these balls.
  struct CollarBall {
    Index point = none;  ///< its centre, on a crease
    double radius = 0;   ///< its radius, absolute
    /// Position of that point when the ball was placed; projection may have moved the point since.
    Point centre;
  };
  std::vector<CollarBall> collar_balls;  ///< empty when unknown (read from a file)
};

/// Shape measures of one tetrahedron.
struct TetQuality {
  double volume;        ///< signed volume
  double radius_edge;   ///< circumradius / shortest edge; infinite for a flat tet
  double min_dihedral;  ///< degrees
  double max_dihedral;  ///< degrees
};
/// Measures a tet of any scale, even if squares and products of its lengths exceed a double's range.
TetQuality measure(const Point& a, const Point& b, const Point& c, const Point& d);
/// Returns the largest angle of a tetrahedron's faces in degrees, for a tet of any scale.
double largest_face_angle(const Point& a, const Point& b, const Point& c, const Point& d);

/// Returns the median length of the edges of the tets, each edge counted once; 0 without tets. Cost: linear;
/// temporarily about 45 bytes per tet.
double median_edge(const TetMesh& mesh);

}  // namespace collarmesh
