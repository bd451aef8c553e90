// A Poisson problem with a known solution on the tets of a mesh file, scaled to a diagonal of 1: errors and
// condition number. poisson MESH
#include <fmt/format.h>

#include <cstdio>

#include "collarmesh/io/tet_mesh_io.h"
#include "support/poisson.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    fmt::print(stderr, "usage: poisson MESH\n");
    return 2;
  }
  using namespace collarmesh;
  TetMesh mesh = io::read_tet_mesh(argv[1]);
  Box box;
  for (const auto& tet : mesh.tets)
    for (const Index v : tet) box.add(mesh.points[v]);
  for (Point& p : mesh.points) p = (p - box.centre()) / box.diagonal();
  const testing::PoissonErrors e = testing::solve_poisson(mesh, testing::smooth_solution(), true);
  fmt::print("L2 {:.6g} H1 {:.6g} condition {:.6g} unknowns {} tets {}\n", e.l2, e.h1, e.condition_number,
             e.unknowns, mesh.tets.size());
}
