// Distributes the mesh of one rank to a DMPlex on all ranks.
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "calls.h"
#include "collarmesh/distributed.h"
#include "collarmesh/mesh_measures.h"
#include "labels.h"
#include "local_mesh.h"

namespace collarmesh::distributed {

namespace {

#if defined(PETSC_HAVE_PTSCOTCH)
constexpr const char* partitioner_type = PETSCPARTITIONERPTSCOTCH;
#elif defined(PETSC_HAVE_PARMETIS)
constexpr const char* partitioner_type = PETSCPARTITIONERPARMETIS;
#else
constexpr const char* partitioner_type = PETSCPARTITIONERSIMPLE;
#endif

void require_labels(const TetMesh& mesh, const Plc& plc) {
  constexpr Tag most = std::numeric_limits<PetscInt>::max();
  const auto require = [&](const char* what, Tag tag) {
    if (tag < 0 || tag > most)
      throw OptionError(fmt::format(
          "the tag {} of a {} is out of range for PETSc's labels, 0 to {}; renumber it", tag, what, most));
  };
  for (const Plc::Region& region : plc.regions) require("region", region.tag);
  for (const Plc::Patch& patch : plc.patches) require("patch", patch.tag);
  for (const Plc::Curve& curve : plc.curves) require("curve", curve.tag);
  const std::size_t features = std::max(plc.patches.size(), plc.curves.size());
  if (features >= static_cast<std::size_t>(most / 4) || mesh.points.size() >= static_cast<std::size_t>(most))
    throw OptionError(
        "the mesh has more points or features than PETSc's integers can count; choose a larger size, or use "
        "a PETSc with integers of 64 bits");
}

AngleBounds angles_of(const TetMesh& mesh) {
  AngleBounds bounds;
  for (Index t = 0; t < mesh.tets.size(); ++t) bounds.add(measure_tet(mesh, t), mesh.tet_collar[t] != 0);
  return bounds;
}

/// Makes the DMPlex of the whole mesh on rank 0, and an empty one elsewhere.
DM create(MPI_Comm communicator, const TetMesh& mesh) {
  std::vector<PetscInt> cells;
  cells.reserve(4 * mesh.tets.size());
  for (const auto& [a, b, c, d] : mesh.tets)  // PETSc's tets are mirror images of ours
    for (const Index v : {a, c, b, d}) cells.push_back(static_cast<PetscInt>(v));
  std::vector<PetscReal> coordinates;
  coordinates.reserve(3 * mesh.points.size());
  for (const Point& p : mesh.points) coordinates.insert(coordinates.end(), {p.x, p.y, p.z});
  DM dm = nullptr;
  call(DMPlexCreateFromCellListPetsc(communicator, 3, static_cast<PetscInt>(mesh.tets.size()),
                                     static_cast<PetscInt>(mesh.points.size()), 4, PETSC_TRUE, cells.data(),
                                     3, coordinates.data(), &dm));
  return dm;
}

template <std::size_t n>
PetscInt point_of(DM dm, const std::array<Index, n>& corners, PetscInt first_vertex) {
  std::array<PetscInt, n> vertices;
  for (std::size_t k = 0; k < n; ++k) vertices[k] = first_vertex + static_cast<PetscInt>(corners[k]);
  PetscInt count = 0;
  const PetscInt* found = nullptr;
  call(DMPlexGetFullJoin(dm, static_cast<PetscInt>(n), vertices.data(), &count, &found));
  const PetscInt point = count == 1 ? found[0] : -1;
  call(DMPlexRestoreJoin(dm, static_cast<PetscInt>(n), vertices.data(), &count, &found));
  if (point < 0) throw std::logic_error("a face or edge of the mesh belongs to none of its tets");
  return point;
}

void label_features(DM dm, const TetMesh& mesh) {
  PetscInt first_vertex = 0, end = 0, all = 0;
  call(DMPlexGetDepthStratum(dm, 0, &first_vertex, &end));
  call(DMPlexGetChart(dm, nullptr, &all));
  std::vector<PetscInt> codes(static_cast<std::size_t>(all), -1);
  for (std::size_t v = 0; v < mesh.points.size(); ++v)
    if (mesh.features[v].dimension < 3)
      codes[static_cast<std::size_t>(first_vertex) + v] = encoded(mesh.features[v]);
  for (std::size_t e = 0; e < mesh.edges.size(); ++e)
    codes[static_cast<std::size_t>(point_of(dm, mesh.edges[e], first_vertex))] =
        encoded({1, mesh.edge_curve[e]});
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const PetscInt face = point_of(dm, mesh.faces[f], first_vertex);
    const PetscInt code = encoded({2, mesh.face_patch[f]});
    codes[static_cast<std::size_t>(face)] = code;
    const PetscInt* edges = nullptr;
    call(DMPlexGetCone(dm, face, &edges));
    for (std::size_t k = 0; k < 3; ++k)  // label its edges that are on no curve
      if (PetscInt& of_edge = codes[static_cast<std::size_t>(edges[k])]; of_edge < 0) of_edge = code;
  }
  std::vector<std::pair<PetscInt, PetscInt>> labels;
  for (std::size_t point = 0; point < codes.size(); ++point)
    if (codes[point] >= 0) labels.emplace_back(codes[point], static_cast<PetscInt>(point));
  set_label(dm, feature_label, std::move(labels));
}

void label_tets(DM dm, const TetMesh& mesh) {
  PetscInt first = 0;
  call(DMPlexGetHeightStratum(dm, 0, &first, nullptr));
  std::vector<std::pair<PetscInt, PetscInt>> regions, collars;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const PetscInt tet = first + static_cast<PetscInt>(t);
    regions.emplace_back(static_cast<PetscInt>(mesh.tet_tag[t]), tet);
    if (mesh.tet_collar[t] != 0) collars.emplace_back(mesh.tet_collar[t], tet);
  }
  set_label(dm, "region", std::move(regions));
  set_label(dm, "collar", std::move(collars));
}

}  // namespace

ParallelMesh::ParallelMesh(MPI_Comm communicator, const TetMesh& mesh, const Plc& plc, double collar_angle)
    : communicator_(communicator) {
  const PetscMessages messages;
  const Ranks ranks(communicator);
  for (Index region = 1; region < plc.regions.size(); ++region)
    regions_.try_emplace(plc.regions[region].tag, region);
  agree(communicator, [&] {
    if (ranks.rank == 0) {
      require_labels(mesh, plc);
      coarse_angles_ = angles_of(mesh);
      if (double& most = coarse_angles_.most[1]; most > 0) most = std::max(most, collar_angle);
    }
  });
  MPI_Bcast(coarse_angles_.least.data(), 2, MPI_DOUBLE, 0, communicator);
  MPI_Bcast(coarse_angles_.most.data(), 2, MPI_DOUBLE, 0, communicator);
  dm_ = create(communicator, mesh);
  agree(communicator, [&] {
    label_tets(dm_, mesh);
    label_features(dm_, mesh);
  });
  PetscPartitioner partitioner = nullptr;
  call(DMPlexGetPartitioner(dm_, &partitioner));
  call(PetscPartitionerSetType(partitioner, partitioner_type));
  partitioner_ = partitioner_type;
  DM distributed = nullptr;
  call(DMPlexDistribute(dm_, 0, nullptr, &distributed));
  if (distributed != nullptr) {
    call(DMDestroy(&dm_));
    dm_ = distributed;
  }
  call(PetscObjectSetName(reinterpret_cast<PetscObject>(dm_), "mesh"));
  agree(communicator, [&] { label_patches_and_curves(dm_, plc); });
}

ParallelMesh::~ParallelMesh() { DMDestroy(&dm_); }

void ParallelMesh::scale(double factor) {
  if (factor == 1) return;
  Vec coordinates = nullptr;
  call(DMGetCoordinatesLocal(dm_, &coordinates));
  call(VecScale(coordinates, factor));
  call(DMSetCoordinatesLocal(dm_, coordinates));
}

}  // namespace collarmesh::distributed
