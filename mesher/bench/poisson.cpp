// Solves a Poisson problem with a known solution on the tets of a mesh file, and prints the errors and the
// condition number: poisson MESH [plate|shell|wedge]
//
// Without a second argument the mesh is scaled to a diagonal of 1 and the solution's values are given on the
// whole boundary. The domains that the second argument names are thin, and their meshes have hardly any inner
// nodes. There the values are given only at the ends of the domain. The solution is constant across the
// thickness, so its normal derivative is zero on the rest of the boundary.
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <string>

#include "collarmesh/io/tet_mesh_io.h"
#include "support/poisson.h"

namespace collarmesh::bench {
namespace {

using testing::Solution;

bool is_near(double x, double y) { return std::fabs(x - y) < 1e-6; }

// u = sin(a x + 0.3) cos(b y) on a plate of 10 by 10; values are given at the four sides.
Solution on_plate() {
  constexpr double a = 0.6, b = 0.5;
  const auto value = [](const Point& p) { return std::sin(a * p.x + 0.3) * std::cos(b * p.y); };
  return {value,
          [](const Point& p) {
            return Vector{a * std::cos(a * p.x + 0.3) * std::cos(b * p.y),
                          -b * std::sin(a * p.x + 0.3) * std::sin(b * p.y), 0};
          },
          [value](const Point& p) { return (a * a + b * b) * value(p); },
          [](const Point& p) {
            return is_near(p.x, 0) || is_near(p.x, 10) || is_near(p.y, 0) || is_near(p.y, 10);
          }};
}

// u = cos(2 phi) sin(b z + 0.2), phi the angle around the z axis; values are given at the ends z = 0, z = 10.
Solution on_shell() {
  constexpr double b = 0.4;
  const auto value = [](const Point& p) {
    return std::cos(2 * std::atan2(p.y, p.x)) * std::sin(b * p.z + 0.2);
  };
  return {value,
          [](const Point& p) {
            const double phi = std::atan2(p.y, p.x), r = std::hypot(p.x, p.y);
            const double around = -2 * std::sin(2 * phi) * std::sin(b * p.z + 0.2) / r;
            return Vector{-std::sin(phi) * around, std::cos(phi) * around,
                          b * std::cos(2 * phi) * std::cos(b * p.z + 0.2)};
          },
          [value](const Point& p) { return (4 / (p.x * p.x + p.y * p.y) + b * b) * value(p); },
          [](const Point& p) { return is_near(p.z, 0) || is_near(p.z, 10); }};
}

// u = exp(-a r^2) cos(b z), where r is the distance from the z axis, the wedge's sharp edge. Values are given
// at the back x = 10 and at the ends z = 0 and z = 4.
Solution on_wedge() {
  constexpr double a = 0.05, b = 0.4;
  const auto squared_radius = [](const Point& p) { return p.x * p.x + p.y * p.y; };
  const auto value = [=](const Point& p) { return std::exp(-a * squared_radius(p)) * std::cos(b * p.z); };
  return {value,
          [=](const Point& p) {
            const double u = value(p);
            return Vector{-2 * a * p.x * u, -2 * a * p.y * u,
                          -b * std::exp(-a * squared_radius(p)) * std::sin(b * p.z)};
          },
          [=](const Point& p) { return (4 * a - 4 * a * a * squared_radius(p) + b * b) * value(p); },
          [](const Point& p) { return is_near(p.x, 10) || is_near(p.z, 0) || is_near(p.z, 4); }};
}

void scale_to_unit_diagonal(TetMesh& mesh) {
  Box box;
  for (const auto& tet : mesh.tets)
    for (const Index v : tet) box.add(mesh.points[v]);
  for (Point& p : mesh.points) p = (p - box.centre()) / box.diagonal();
}

int run(const std::string& file, const std::string& domain) {
  const std::map<std::string, std::function<Solution()>> solutions{
      {"", testing::smooth_solution}, {"plate", on_plate}, {"shell", on_shell}, {"wedge", on_wedge}};
  const auto solution = solutions.find(domain);
  if (solution == solutions.end()) {
    fmt::print(stderr, "poisson: no domain {}\n", domain);
    return 2;
  }
  TetMesh mesh = io::read_tet_mesh(file);
  if (domain.empty()) scale_to_unit_diagonal(mesh);
  const testing::PoissonErrors e = testing::solve_poisson(mesh, solution->second(), true);
  fmt::print("L2 {:.6g} H1 {:.6g} condition {:.6g} unknowns {} tets {}\n", e.l2, e.h1, e.condition_number,
             e.unknowns, mesh.tets.size());
  return 0;
}

}  // namespace
}  // namespace collarmesh::bench

int main(int argc, char** argv) {
  if (argc == 2 || argc == 3) return collarmesh::bench::run(argv[1], argc == 3 ? argv[2] : "");
  fmt::print(stderr, "usage: poisson MESH [plate|shell|wedge]\n");
  return 2;
}
