#pragma once

#include <mpi.h>
#include <petscdmplex.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "collarmesh/exact_geometry.h"
#include "collarmesh/plc.h"
#include "collarmesh/tet_mesh.h"

/// Meshes on many ranks of MPI, held by PETSc's DMPlex. Everything here is collective: all ranks of the
/// communicator call it. What one rank throws all ranks throw, with the message of the first of them. The
/// caller has initialized PETSc. Meshes do not depend on the number of ranks, but for the order of their
/// cells and points.
namespace collarmesh::distributed {

/// What the mesh approximates. Every rank has it; the references are kept.
struct Shape {
  const Plc& plc;
  ExactGeometry exact;  ///< where it is empty or gives nothing: the polylines and triangles of the complex
  double distance = 0;  ///< surface distance tolerance, absolute, input units
};

/// Bounds of dihedral angles, degrees: outside collars [0] and in collars [1].
struct AngleBounds {
  std::array<double, 2> least{180, 180}, most{0, 0};
};

/// What one level of refinement did, over all ranks.
struct LevelReport {
  std::int64_t tets = 0;         ///< after it
  std::int64_t on_features = 0;  ///< vertices with a place on a smooth or exact feature
  std::int64_t spoilt = 0;       ///< tets that this spoilt
  std::int64_t made_room = 0;    ///< moves of vertices inside regions, in planes and along straight curves
  std::int64_t drawn_back = 0;   ///< vertices that did not go all the way
  double farthest_off = 0;       ///< of those from their places, absolute
  double seconds = 0;            ///< of the slowest rank
};

/// What `raise_order` did, over all ranks.
struct OrderReport {
  std::int64_t nodes = 0, curved = 0, straightened = 0;  ///< mid-side nodes
  double farthest_off = 0;                               ///< of straightened ones from their places, absolute
};

/// A guarantee that does not hold.
struct Finding {
  std::string guarantee;  ///< short stable name, as those of `check`
  std::string message;    ///< full sentence
};

/// The certificate, the same on all ranks.
struct Certificate {
  static constexpr std::size_t listed = 20;  ///< findings of each guarantee and rank at most
  std::vector<Finding> findings;
  std::int64_t findings_total = 0;                            ///< with those not listed
  std::int64_t tets = 0, vertices = 0, faces = 0, edges = 0;  ///< faces on patches, edges on curves
  AngleBounds angles;
  double largest_distance = 0;  ///< of vertices from their smooth patches and curves
  std::map<Tag, double> region_volumes, patch_areas, curve_lengths;
  std::vector<std::int64_t> tets_of_ranks;  ///< by rank
  /// Of all cells with their labels and exact coordinates, whatever their order: equal for equal meshes.
  std::array<std::uint64_t, 2> fingerprint{};

  bool passed() const { return findings_total == 0; }
};

/// A mesh of tetrahedra on the ranks of a communicator.
///
/// The DMPlex has vertices, edges, faces and tets, without overlap, and the labels `region` (tets, the tag),
/// `collar` (tets in collars: 1 star, 2 book), `patch` (faces, the tag) and `curve` (edges, the tag). The
/// label `feature` is for this library: four times the index of the vertex, curve or patch of the complex
/// plus its dimension, on vertices, edges and faces.
class ParallelMesh {
 public:
  /// Distribute a mesh that rank 0 has; others pass an empty one. Tags must fit PETSc's integers. PTScotch
  /// partitions where PETSc has it. `collar_angle` is the bound that angles in collars have kept, degrees.
  ParallelMesh(MPI_Comm communicator, const TetMesh& mesh, const Plc& plc, double collar_angle = 150);
  ~ParallelMesh();
  ParallelMesh(const ParallelMesh&) = delete;
  ParallelMesh& operator=(const ParallelMesh&) = delete;

  /// Cut every tet into eight, by Bey's rule, first at the diagonal that makes the best angles, and put the
  /// vertices on features onto the shape. Where that spoils tets, vertices inside regions and on what is flat
  /// make room; where that does not help, those on smooth or exact features are drawn back. Precondition:
  /// first order.
  LevelReport refine(const Shape& shape);

  /// Put a node amid every edge, on the shape where the edge is on a feature, so that every tet stays valid
  /// (`jacobian_exceeds` by 0.1). The coordinates of the DMPlex become those of Lagrange elements of order 2.
  OrderReport raise_order(const Shape& shape);

  /// Recompute every guarantee. Angles may exceed those of the coarse mesh by `slack` degrees.
  Certificate certify(const Shape& shape, double slack = 10) const;

  /// Multiply all coordinates.
  void scale(double factor);

  /// Write NAME.h5 for PETSc (`DMPlexTopologyLoad` and so on, format PETSC_VIEWER_HDF5_PETSC, name `mesh`),
  /// which also has the arrays of NAME.xdmf (tets). That, NAME_faces.xdmf and NAME_edges.xdmf, with an .h5 of
  /// their own each, are written beside it.
  void write_h5(const std::string& path) const;
  /// Write NAME.pvtu and a piece NAME_RANK.vtu by each rank.
  void write_pvtu(const std::string& path) const;

  DM dm() const { return dm_; }
  MPI_Comm communicator() const { return communicator_; }
  int order() const { return order_; }
  /// Of the mesh that was distributed, in collars up to the bound that was given.
  const AngleBounds& coarse_angles() const { return coarse_angles_; }
  /// PETSc's name of it.
  const std::string& partitioner() const { return partitioner_; }

 private:
  MPI_Comm communicator_;
  DM dm_ = nullptr;
  int order_ = 1;
  unsigned levels_ = 0;
  AngleBounds coarse_angles_;
  std::string partitioner_;
  std::map<Tag, Index> regions_;  // the first region of each tag
};

}  // namespace collarmesh::distributed
