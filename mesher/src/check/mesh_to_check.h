#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "check/findings.h"
#include "check/guarantees.h"
#include "check/region_locator.h"
#include "collarmesh/check.h"
#include "common/shared_bounds.h"
#include "common/sorted.h"
#include "tolerance/forced_edges.h"
#include "tolerance/narrow_places.h"

/// The certificate. Each group of guarantees has a file of its own with functions that add findings. No part
/// of it knows how the mesh was made.
namespace collarmesh::checks {

/// The features of the complex that the entities of the mesh belong to.
struct FeatureMatch {
  std::vector<Index> face_patch;    ///< by face of the mesh, none if it has no patch
  std::vector<Index> edge_curve;    ///< by edge of the mesh, none if it has no curve
  std::vector<Index> vertex_point;  ///< by vertex of the complex: its mesh point, or none
};

/// A mesh with its complex and the bounds that it is judged by.
struct MeshToCheck {
  const TetMesh& mesh;
  const Plc& plc;
  CheckOptions options;
  SurfaceTolerance tolerance;
  double rounding = 0;  ///< distance by which rounding may move a point off a straight line or a plane,
                        ///< absolute
  /// Allowed distance of the mesh from each curve and patch, absolute. For bent curves and smooth patches,
  /// the largest one on them, because `tolerance` depends on the place.
  std::vector<double> curve_allowance, patch_allowance;
  std::shared_ptr<const RegionLocator> regions;
  FeatureMatch match;
  std::vector<std::uint8_t> collar;  ///< by tet: a value as in TetMesh::tet_collar, but found from the tet's
                                     ///< corners on creases of the complex (find_collar_cells)
  bool coarsened = false;            ///< if true, tets in collars must also keep the bounds of tets outside
                                     ///< collars
  /// Tets from this index on are parts of prisms and pyramids, which are judged elsewhere, as whole cells.
  Index first_part = none;

  /// Returns whether `match` is filled in.
  bool is_matched() const {
    return match.face_patch.size() == mesh.faces.size() && match.edge_curve.size() == mesh.edges.size() &&
           match.vertex_point.size() == plc.vertices.size();
  }
  /// Returns whether the mesh has layers; the angles of its tets are then judged elsewhere.
  bool has_layers() const { return !mesh.layers.tet_layer.empty(); }

  const Point& point(Index i) const { return mesh.points[i]; }
  Point centroid(const std::array<Index, 3>& f) const {
    return (point(f[0]) + point(f[1]) + point(f[2])) / 3;
  }
  Point midpoint(const std::array<Index, 2>& e) const { return 0.5 * (point(e[0]) + point(e[1])); }
  const Point& plc_corner(const Plc::Triangle& t, unsigned i) const { return plc.points[t.points[i]]; }
};

/// The tets that may exceed the radius-edge bound if their angles are bounded: dihedral angles from below,
/// and dihedral and face angles by 150 degrees. Only marked tets and cells of collars in a coarsened mesh may
/// exceed it; in a mesh from a file without marks, any tet may. The bound from below is smaller in two cases.
/// Where features meet at less than twice the bound, half the angle between them is enough. For a tet with an
/// edge that the input forces to be short, ForcedEdges::smallest_angle is enough. Both of these bounds are
/// halved if each tet needs an interior node.
class ThinCells {
 public:
  static constexpr double largest_angle = largest_angle_of_thin_tets;

  /// Precondition: to_check.match is filled in.
  explicit ThinCells(const MeshToCheck& to_check);

  bool claimed(Index tet) const;
  /// Returns whether a tet is at a place where tets may be thin.
  bool has_place(Index tet) const;
  /// Returns the lower bound on a tet's dihedral angles, degrees.
  double smallest_angle(Index tet) const;
  /// Returns whether a tet's angles are within their bounds; `face_angle` is the largest angle of its faces,
  /// degrees.
  bool are_bounded(const TetQuality& quality, double face_angle, Index tet) const;
  /// Returns whether a tet has an angle below the bound that would hold without forced edges. Precondition:
  /// its angles are bounded.
  bool is_forced(const TetQuality& quality, Index tet) const;

 private:
  double smallest_angle_at(const std::array<Index, 4>& corners) const;
  double forced_angle(Index tet) const;

  const TetMesh& mesh_;
  const MeshToCheck& to_check_;
  double smallest_;
  const std::vector<std::uint8_t>& marks_;
  bool all_;
  std::vector<double> at_point_;        // by point: lower bound on angles, smaller at sharp creases; empty if
                                        // no crease is sharp
  std::optional<ForcedEdges> forced_;   // none if no tet may be thin
  std::optional<NarrowPlaces> narrow_;  // none if thin tets may be anywhere
};

/// Returns for each point the feature of lowest dimension that contains it, found from the mesh's faces and
/// edges. Precondition: to_check.match is filled in.
std::vector<TetMesh::VertexFeature> features_of(const MeshToCheck& to_check);

/// Items grouped by their keys, which are below `groups`. Items whose key is none are left out.
class Grouping {
 public:
  Grouping(const std::vector<Index>& keys, std::size_t groups) : first_(groups + 1, 0) {
    for (const Index key : keys)
      if (key != none) ++first_[key + 1];
    for (std::size_t g = 0; g < groups; ++g) first_[g + 1] += first_[g];
    items_.resize(first_[groups]);
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (Index i = 0; i < keys.size(); ++i)
      if (keys[i] != none) items_[next[keys[i]]++] = i;
  }
  const Index* begin(std::size_t group) const { return items_.data() + first_[group]; }
  const Index* end(std::size_t group) const { return items_.data() + first_[group + 1]; }
  std::size_t size(std::size_t group) const { return first_[group + 1] - first_[group]; }

 private:
  std::vector<std::size_t> first_;
  std::vector<Index> items_;
};

inline double area(const Point& a, const Point& b, const Point& c) { return 0.5 * norm(cross(b - a, c - a)); }

/// Makes the mesh to check, but leaves `match`, `collar` and `coarsened` to `judge`. Keeps references to the
/// mesh and the complex.
MeshToCheck make_mesh_to_check(const TetMesh& mesh, const Plc& plc, const CheckOptions& options);

/// Checks that arrays that belong together have equal lengths, and that the nodes of each element are in
/// range and different. If it returns false, no other check can run.
bool check_arrays(const TetMesh& mesh, Findings& findings);

/// Checks that points are finite, distinct and nodes of elements. Returns false if a point is not finite.
bool check_points(const MeshToCheck& to_check, Findings& findings);

/// Finds missing labels by position, for meshes from files. If a tet's region and tag are not the complex's,
/// finds the region of each connected part (bounded by listed faces, planar patches, and changes of region or
/// tag) from its largest tet. If most tags of faces or edges are missing or unknown to the complex, makes new
/// faces and edges from the tets and the complex. Otherwise leaves out listed edges that lie on no curve. The
/// result has the complex's labels; notes say what was found or left out. Returns nothing if nothing changes.
/// Adds a finding for each part outside all regions. Precondition: check_arrays and check_points hold. Cost:
/// O(n log n).
std::optional<TetMesh> place_by_position(const MeshToCheck& to_check, CheckReport& report,
                                         Findings& findings);

/// Checks that the labels are indices of the complex. If it returns false, no other check can run.
bool check_labels(const TetMesh& mesh, const Plc& plc, Findings& findings);

/// Checks volumes, shapes and tags of all tets, and fills in report.region_volumes. Precondition:
/// to_check.collar is filled in.
void check_tets(const MeshToCheck& to_check, CheckReport& report, Findings& findings);

/// Counts the tets whose corners are all corners of listed faces. They are findings if the bounds ask for an
/// interior node in each tet.
void check_interior_nodes(const MeshToCheck& to_check, CheckReport& report, Findings& findings);

/// Checks tets against each other and against the listed faces. Visits each edge once, so it also finds the
/// median length of the edges.
void check_conformity(const MeshToCheck& to_check, CheckReport& report, Findings& findings);

void check_watertight(const MeshToCheck& to_check, Findings& findings);

/// The volumes that the complex encloses, by region, and by how much the mesh's may differ from them: to
/// first order, the allowed distance of the surface times its area.
struct RegionVolumes {
  std::vector<double> enclosed, allowed;
};
RegionVolumes expected_volumes(const MeshToCheck& to_check);

/// Checks region volumes. Precondition: report.region_volumes is filled in.
void check_region_volumes(const MeshToCheck& to_check, const CheckReport& report, Findings& findings);

/// Writes volumes, areas and lengths of the mesh and of the input to the report, and compares the volumes.
/// They may differ by 5%, with curved elements by 1%, unless the bounds ask for a distance. Preconditions:
/// to_check.match and report.region_volumes are filled in.
void check_shape_kept(const MeshToCheck& to_check, CheckReport& report, Findings& findings);

/// Compares the thickness of walls and the width of gaps at smooth patches with those of the complex, along
/// rays. Averaged over a patch, they may differ by half of the complex's, unless the bounds ask for a
/// distance. Precondition: to_check.match is filled in. Cost: near linear, at most 4000 rays per patch.
void check_thickness_kept(const MeshToCheck& to_check, CheckReport& report, Findings& findings);

/// Compute the allowed distances. For straight curves and planar patches: four times their own deviation from
/// straight or planar, because the mesh's vertices may be extrapolated from the complex's, but at most the
/// complex's planar tolerance. For other features: the distance tolerance. Rounding is added to all.
std::vector<double> curve_allowances(const MeshToCheck& to_check);
std::vector<double> patch_allowances(const MeshToCheck& to_check);

/// Finds the features of the mesh's entities: by the indices in the mesh; where an index is none, by tag and
/// position.
FeatureMatch match_features(const TetMesh& mesh, const Plc& plc, double rounding);

/// Finds the vertices of the complex in the mesh, by index or position.
std::vector<Index> match_vertices(const TetMesh& mesh, const Plc& plc, double rounding);

/// Finds patches for faces without one: by position and, if the tags are the complex's, by tag.
std::vector<Index> match_faces(const TetMesh& mesh, const Plc& plc, bool by_tag);

/// Precondition of these functions: to_check.match is filled in; check_vertices_present needs only its
/// vertices.
void check_vertices_present(const MeshToCheck& to_check, Findings& findings);
void check_vertices(const MeshToCheck& to_check, Findings& findings);
void check_listed_edges(const MeshToCheck& to_check, Findings& findings);
void check_curves(const MeshToCheck& to_check, CheckReport& report, Findings& findings);
void check_patches(const MeshToCheck& to_check, CheckReport& report, Findings& findings);

/// Finds the tets in collars: those in stars have one corner on a crease of the complex; those in books have
/// two, joined by an edge on it. If the mesh marks tets, only marked ones count; a mark on another tet is a
/// finding. A mesh that lists no balls was coarsened if it has thin tets, or if its marks fit only this: then
/// all tets that touch a crease are its collar. Precondition: to_check.match is filled in.
void find_collar_cells(MeshToCheck& to_check, Findings& findings);

/// Checks the balls of the collars against the features of the mesh and against each other (paper,
/// Definitions 6 and 7). Does nothing if the mesh lists no balls.
void check_collars(const MeshToCheck& to_check, Findings& findings);

/// Gives the faces and edges of a mesh of second order the mid-edge nodes of the tets there.
void take_mid_nodes_of_tets(TetMesh& mesh);

/// Checks mid-edge nodes and the sign of the Jacobian. Does nothing for a mesh of first order.
void check_second_order(const MeshToCheck& to_check, CheckReport& report, Findings& findings);

/// Return whether a feature lies outside all regions and therefore is not in the mesh.
bool curve_is_outside(const MeshToCheck& to_check, Index curve);
bool vertex_is_outside(const MeshToCheck& to_check, Index vertex);
bool patch_is_outside(const MeshToCheck& to_check, Index patch);

/// Warns of curves on no patch and vertices on no patch or curve that lie outside all regions. (The builder
/// of the complex warns of patches outside all regions.)
void warn_of_features_outside(const MeshToCheck& to_check, CheckReport& report);

}  // namespace collarmesh::checks
