// One level of refinement: divides every tet into eight.
#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

#include "angles.h"
#include "calls.h"
#include "collarmesh/distributed.h"
#include "common/stopwatch.h"
#include "labels.h"
#include "local_mesh.h"
#include "placement.h"

namespace collarmesh::distributed {

namespace {

/// Rotations of a tet's corners. PETSc cuts the octahedron in the middle of a tet between the middles of the
/// edges 01 and 23. A rotation of the first three corners by one of these amounts chooses the pair of
/// edges. PETSc numbers the corners of the eight children so that later levels cut them along the diagonals
/// of Bey's rule (Tetrahedral grid refinement, 1995): the four tets in the octahedron are cut next between
/// the middles of this diagonal and of the opposite edge, the other four like the tet that they are similar
/// to. By that rule all descendants of a tet have at most three shapes, which appear at the first level. So
/// the diagonal is chosen only once, there. Choosing the best diagonal at each level would make ever new and
/// worse shapes.
constexpr std::array<PetscInt, 3> arrangements{0, 1, 2};

/// Returns the quality of the four tets around the diagonal between the middles of the edges ij and kl: their
/// least dihedral angle or, if that is smaller, 180 degrees minus their greatest one.
double goodness(const Corners& p, std::size_t i, std::size_t j, std::size_t k, std::size_t l) {
  const auto middle = [&](std::size_t a, std::size_t b) { return 0.5 * (p[a] + p[b]); };
  const Point from = middle(i, j), to = middle(k, l);
  const std::array<Point, 4> around{middle(i, k), middle(k, j), middle(j, l), middle(l, i)};
  double worst = 180;
  for (std::size_t n = 0; n < 4; ++n) {
    const ExtremeAngles angles = extreme_angles({from, to, around[n], around[(n + 1) % 4]});
    worst = std::min({worst, angles.least, 180 - angles.most});
  }
  return worst;
}

void choose_diagonals(DM dm) {
  PetscInt first = 0, end = 0;
  call(DMPlexGetHeightStratum(dm, 0, &first, &end));
  std::vector<PetscInt> turned;
  {
    const LocalMesh mesh(dm, 1);
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
      const auto [a, c, b, d] = mesh.corners(t);
      const Corners p{a, b, c, d};  // in PETSc's order
      const std::array<double, 3> found{goodness(p, 0, 1, 2, 3), goodness(p, 1, 2, 0, 3),
                                        goodness(p, 2, 0, 1, 3)};
      turned.push_back(arrangements[static_cast<std::size_t>(std::max_element(found.begin(), found.end()) -
                                                             found.begin())]);
    }
  }
  for (std::size_t t = 0; t < turned.size(); ++t)
    if (turned[t] != 0) call(DMPlexOrientPoint(dm, first + static_cast<PetscInt>(t), turned[t]));
}

}  // namespace

LevelReport ParallelMesh::refine(const Shape& shape) {
  const PetscMessages messages;
  const Stopwatch stopwatch;
  PetscInt first = 0, end = 0;
  call(DMPlexGetHeightStratum(dm_, 0, &first, &end));
  // Estimates the number of points of the refined DMPlex on all ranks, 4.5 for each tet: the tet, two faces,
  // slightly more than one edge, and a fifth of a vertex or slightly more. PETSc's integers must suffice.
  const std::int64_t points = 8 * 9 * all_reduce(communicator_, std::int64_t{end - first}, MPI_SUM) / 2;
  agree(communicator_, [&] {
    if (order_ != 1) throw OptionError("meshes of second order are not refined; raise the order afterwards");
    if (points > std::numeric_limits<PetscInt>::max())
      throw OptionError(
          "the refined mesh has more points than PETSc's integers can count; use fewer levels, or a "
          "PETSc with integers of 64 bits");
    if (levels_++ == 0) choose_diagonals(dm_);
    for (const char* name : {"patch", "curve"}) call(DMRemoveLabel(dm_, name, nullptr));
  });
  DM refined = nullptr;
  call(DMPlexSetRefinementUniform(dm_, PETSC_TRUE));
  call(DMRefine(dm_, communicator_, &refined));
  call(DMDestroy(&dm_));
  dm_ = refined;
  call(PetscObjectSetName(reinterpret_cast<PetscObject>(dm_), "mesh"));
  agree(communicator_, [&] {
    keep_depth(dm_, "region", 3);
    keep_depth(dm_, "collar", 3);
    label_patches_and_curves(dm_, shape.plc);
  });
  LevelReport report = place(dm_, shape, coarse_angles_);
  report.seconds = all_reduce(communicator_, stopwatch.seconds(), MPI_MAX);
  return report;
}

}  // namespace collarmesh::distributed
