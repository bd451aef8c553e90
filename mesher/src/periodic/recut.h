#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <unordered_map>
#include <utility>
#include <vector>

#include "collarmesh/mesher.h"
#include "collarmesh/plc.h"
#include "collarmesh/tet_mesh.h"
#include "periodic/feature_images.h"
#include "periodic/tiled_complex.h"
#include "remesh/tet_complex.h"

namespace collarmesh::periodicity {

/// A periodic mesh joined at its pairs and cut open elsewhere. The tets beside one group of each pair are
/// moved behind the other group, so that both groups become one patch inside the mesh, with tets on both
/// sides. A change there fits both sides. The vertices at the new cuts do not move.
class Recut {
 public:
  /// The tets that are moved: those much nearer to the first (or second) group than to the other one, or all
  /// that are nearer to the first. The choice determines where the cuts lie. Cuts of two pairs may meet the
  /// faces of a third pair at the same places for two of these choices, but not for all three.
  enum class Moved { beside_first, beside_second, first_half };

  /// Keeps the mesh and the complex by reference. Preconditions: the mesh is of first order, and
  /// `mesh.periodic` has the pairs of its vertices.
  Recut(const TetMesh& mesh, const Plc& plc, const SurfaceTolerance& tolerance,
        const std::vector<PatchPair>& pairs, const std::vector<FeatureImages>& images, Moved moved);

  /// Returns the recut mesh; its patches, curves and vertices are those of the tiled complex.
  TetMesh& mesh() { return made_; }
  const TiledComplex& complex() const { return *complex_; }
  /// Returns the vertices at the new cuts, which must stay.
  const std::vector<Index>& fixed() const { return fixed_; }
  /// Returns for each vertex whether its distance from the groups' patches exceeds this number of edges.
  std::vector<bool> farther_than(unsigned edges) const;

  /// Returns sizes for the recut mesh from sizes for the original mesh.
  SizeField sizes(const SizeField& of_mesh) const;

  /// Removes the entries of vertices that the complex has lost. Call it before the complex is stored.
  void note_vertices(const remeshing::TetComplex& complex);
  /// Returns the mesh cut at the faces of the pairs again, without a map of their nodes. Precondition: the
  /// complex is stored.
  TetMesh back() const;

 private:
  using Shift = std::uint32_t;  // one bit for each pair: 1 if moved
  struct Seam {
    Motion motion;                                          // motion of the moved part
    std::unordered_map<Index, Index> image_of;              // by vertex of the group whose tets move: its
                                                            // image on the other group
    std::unordered_map<Index, Index> on_other;              // inverse of `image_of`
    std::array<std::map<Index, Index>, 3> image, original;  // maps of features, by dimension
  };
  struct Place {
    Index vertex;
    Shift shift;
    friend bool operator==(const Place&, const Place&) = default;
  };
  void find_seams(const std::vector<PatchPair>& pairs, const std::vector<FeatureImages>& images, Moved moved);
  void find_shifts(Moved moved);
  std::vector<double> distances(std::size_t seam, const std::vector<Index>& from) const;
  void find_neighbours() const;
  void number_copies();
  Motion motion_of(Shift shift) const;
  Place on_seam(Place place) const;
  Index vertex_at(Place place);
  void add_vertices();
  void add_faces();
  void add_edges();
  void fix_cuts();
  std::size_t count(unsigned dimension) const;
  Index feature_back(unsigned dimension, Index feature, Shift shift) const;
  Index vertex_back(Place place, Shift shift) const;

  const TetMesh& mesh_;
  const Plc& plc_;
  mutable std::vector<std::vector<Index>> neighbours_;  // by vertex; empty until first used
  std::vector<Seam> seams_;
  std::vector<Shift> shifts_;       // by tet
  std::vector<Shift> copies_;       // shift of each copy
  std::vector<Motion> motions_;     // by copy
  std::map<Shift, Index> copy_of_;  // by shift
  std::unique_ptr<const TiledComplex> complex_;
  TetMesh made_;
  std::vector<Place> places_;                           // by vertex of the recut mesh
  std::vector<Point> points_;                           // points of these vertices before any change
  std::unordered_map<std::uint64_t, Index> vertex_at_;  // by vertex of the mesh and shift
  std::vector<Index> fixed_;
};

}  // namespace collarmesh::periodicity
