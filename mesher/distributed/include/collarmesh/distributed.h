#pragma once

#include <mpi.h>
#include <petscdmplex.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "collarmesh/bounds.h"
#include "collarmesh/exact_geometry.h"
#include "collarmesh/plc.h"
#include "collarmesh/tet_mesh.h"

/// Meshes on many MPI ranks, stored in PETSc's DMPlex. Everything here is collective: all ranks of the
/// communicator must call it. If some ranks throw, all ranks throw, with the message of the first of these.
/// The caller must have initialized PETSc. Meshes do not depend on the number of ranks, except for the order
/// of their cells and points.
namespace collarmesh::distributed {

/// The shape that the mesh approximates. Every rank must have it. Keeps a reference to the complex.
struct Shape {
  const Plc& plc;
  ExactGeometry exact;  ///< if this is empty or returns no point, the polylines and triangles of the complex
                        ///< take its place
  double distance = 0;  ///< surface distance tolerance, absolute, input units
};

/// Bounds on dihedral angles, degrees: [0] outside collars, [1] in collars.
struct AngleBounds {
  std::array<double, 2> least{180, 180}, most{0, 0};

  /// Widens the bounds so that they include the angles of a tet.
  void add(const TetQuality& tet, bool in_collar) {
    least[in_collar] = std::min(least[in_collar], tet.min_dihedral);
    most[in_collar] = std::max(most[in_collar], tet.max_dihedral);
  }
};

/// The result of one level of refinement, summed over all ranks.
struct LevelReport {
  std::int64_t tets = 0;         ///< tets after the refinement
  std::int64_t on_features = 0;  ///< vertices with a place on a smooth or exact feature
  std::int64_t spoilt = 0;       ///< tets that were invalid or poor after these vertices were placed
  std::int64_t made_room = 0;    ///< number of moves, inside regions or along features, that made room
  std::int64_t drawn_back = 0;   ///< vertices that did not reach their place
  double farthest_off = 0;       ///< largest distance of these vertices from their places, absolute
  double seconds = 0;            ///< time of the slowest rank
};

/// The result of `raise_order`, summed over all ranks.
struct OrderReport {
  std::int64_t nodes = 0, curved = 0, straightened = 0;  ///< mid-edge nodes: all, those off the middles of
                                                         ///< their edges, those drawn back from the shape
  double farthest_off = 0;                               ///< largest distance of straightened nodes from
                                                         ///< their places, absolute
};

/// A guarantee that does not hold.
struct Finding {
  std::string guarantee;  ///< short stable name, as in `check`
  std::string message;    ///< full sentence
};

/// The certificate, the same on all ranks.
struct Certificate {
  static constexpr std::size_t listed = 20;  ///< maximum number of findings per guarantee and rank
  std::vector<Finding> findings;
  std::int64_t findings_total = 0;                            ///< number of findings, listed or not
  std::int64_t tets = 0, vertices = 0, faces = 0, edges = 0;  ///< faces on patches, edges on curves
  AngleBounds angles;
  double largest_distance = 0;  ///< largest distance of nodes from their smooth patches and curves
  std::map<Tag, double> region_volumes, patch_areas, curve_lengths;
  std::vector<std::int64_t> tets_of_ranks;  ///< by rank
  /// A hash of all cells with their labels and exact coordinates, independent of their order: equal for equal
  /// meshes.
  std::array<std::uint64_t, 2> fingerprint{};

  bool passed() const { return findings_total == 0; }
};

/// A mesh of tetrahedra on the ranks of a communicator.
///
/// The DMPlex has vertices, edges, faces and tets, without overlap, and the labels `region` (tets, the tag),
/// `collar` (tets in collars: 1 star, 2 book), `patch` (faces, the tag) and `curve` (edges, the tag). The
/// label `feature`, on vertices, edges and faces, is for this library: its value is 4 i + d for the curve (d
/// = 1) or patch (d = 2) of index i in the complex; 0 for all vertices of the complex.
class ParallelMesh {
 public:
  /// Distributes a mesh that rank 0 has; others pass an empty one. Tags must fit PETSc's integers. PTScotch
  /// partitions if PETSc has it. `collar_angle` is the upper bound that dihedral angles in collars of this
  /// mesh keep, degrees.
  ParallelMesh(MPI_Comm communicator, const TetMesh& mesh, const Plc& plc,
               double collar_angle = Bounds().collar_angle);
  ~ParallelMesh();
  ParallelMesh(const ParallelMesh&) = delete;
  ParallelMesh& operator=(const ParallelMesh&) = delete;

  /// Cuts every tet into eight by Bey's rule; the first refinement chooses the inner diagonal with the best
  /// angles. Moves the vertices on features onto the shape. If that spoils tets, vertices move to make room,
  /// inside regions or along their features; if that does not help, vertices on smooth or exact features move
  /// back. Precondition: first order.
  LevelReport refine(const Shape& shape);

  /// Adds a mid-edge node to every edge, on the shape if the edge is on a feature, so that every tet is valid
  /// (`jacobian_exceeds` with `least` 0.1). The coordinates of the DMPlex become those of Lagrange elements
  /// of order 2.
  OrderReport raise_order(const Shape& shape);

  /// Checks every guarantee anew. Angles may exceed the extreme ones of the coarse mesh by `slack` degrees.
  Certificate certify(const Shape& shape, double slack = 10) const;

  /// Multiplies all coordinates by a factor.
  void scale(double factor);

  /// Writes NAME.h5 for PETSc (`DMPlexTopologyLoad` and so on, format PETSC_VIEWER_HDF5_PETSC, name `mesh`),
  /// which also has the arrays of NAME.xdmf (tets). Also writes NAME.xdmf, NAME_faces.xdmf and
  /// NAME_edges.xdmf beside it; the last two have their own .h5 files.
  void write_h5(const std::string& path) const;
  /// Writes NAME.pvtu and a piece NAME_RANK.vtu from each rank.
  void write_pvtu(const std::string& path) const;

  DM dm() const { return dm_; }
  MPI_Comm communicator() const { return communicator_; }
  int order() const { return order_; }
  /// Returns the extreme dihedral angles that the coarse mesh had when it was distributed; the largest in
  /// collars is `collar_angle` if that is larger.
  const AngleBounds& coarse_angles() const { return coarse_angles_; }
  /// Returns PETSc's name of the partitioner.
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
