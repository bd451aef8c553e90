// Solves a problem on a part, all in memory: mpirun -n 2 poisson part.off [SIZE [LEVELS]]
//
// The equation -div grad u = f is solved with linear elements on the coarse mesh and after each level of
// refinement. The exact solution is known and gives u on all patches. Each level divides the error by about
// four.
#include <collarmesh/distributed.h>
#include <collarmesh/io/soup_io.h>
#include <collarmesh/mesher.h>
#include <collarmesh/pipeline.h>
#include <fmt/format.h>
#include <petscksp.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

namespace {

using collarmesh::Point;
using collarmesh::Vector;

double exact(const Point& p, double scale) {
  return std::sin(p.x / scale) * std::cos(p.y / scale) * std::exp(p.z / scale);
}
double source(const Point& p, double scale) { return exact(p, scale) / (scale * scale); }

struct Tet {
  std::array<PetscInt, 4> vertices;
  std::array<Point, 4> corners;
};

/// A discretization with one unknown at each vertex.
class Poisson {
 public:
  Poisson(DM mesh, double scale) : scale_(scale) {
    PetscCallAbort(PETSC_COMM_WORLD, DMClone(mesh, &dm_));
    PetscSection section = nullptr;
    const PetscInt unknowns[] = {1, 0, 0, 0}, components[] = {1};  // by dimension of the points
    PetscCallAbort(PETSC_COMM_WORLD, DMSetNumFields(dm_, 1));
    PetscCallAbort(PETSC_COMM_WORLD, DMPlexCreateSection(dm_, nullptr, components, unknowns, 0, nullptr,
                                                         nullptr, nullptr, nullptr, &section));
    PetscCallAbort(PETSC_COMM_WORLD, DMSetLocalSection(dm_, section));
    PetscCallAbort(PETSC_COMM_WORLD, PetscSectionDestroy(&section));
    PetscCallAbort(PETSC_COMM_WORLD, DMPlexGetDepthStratum(dm_, 0, &first_vertex_, nullptr));
    PetscCallAbort(PETSC_COMM_WORLD, DMPlexGetHeightStratum(dm_, 0, &first_tet_, &end_tet_));
  }
  ~Poisson() { PetscCallAbort(PETSC_COMM_WORLD, DMDestroy(&dm_)); }
  Poisson(const Poisson&) = delete;
  Poisson& operator=(const Poisson&) = delete;

  /// Returns the error of the solution in the L2 norm, and the norm of the solution.
  std::array<double, 2> solve() {
    Mat matrix = nullptr;
    Vec load = nullptr, solution = nullptr;
    KSP solver = nullptr;
    PetscCallAbort(PETSC_COMM_WORLD, DMCreateMatrix(dm_, &matrix));
    PetscCallAbort(PETSC_COMM_WORLD, DMCreateGlobalVector(dm_, &load));
    PetscCallAbort(PETSC_COMM_WORLD, VecDuplicate(load, &solution));
    assemble(matrix, load);
    constrain(matrix, load, solution);
    PetscCallAbort(PETSC_COMM_WORLD, KSPCreate(PETSC_COMM_WORLD, &solver));
    PetscCallAbort(PETSC_COMM_WORLD, KSPSetOperators(solver, matrix, matrix));
    PetscCallAbort(PETSC_COMM_WORLD, KSPSetType(solver, KSPCG));
    PetscCallAbort(PETSC_COMM_WORLD, KSPSetTolerances(solver, 1e-12, PETSC_DEFAULT, PETSC_DEFAULT, 10000));
    PetscCallAbort(PETSC_COMM_WORLD, KSPSetFromOptions(solver));
    PetscCallAbort(PETSC_COMM_WORLD, KSPSolve(solver, load, solution));
    const std::array<double, 2> result = norms(solution);
    PetscCallAbort(PETSC_COMM_WORLD, KSPDestroy(&solver));
    PetscCallAbort(PETSC_COMM_WORLD, VecDestroy(&solution));
    PetscCallAbort(PETSC_COMM_WORLD, VecDestroy(&load));
    PetscCallAbort(PETSC_COMM_WORLD, MatDestroy(&matrix));
    return result;
  }

 private:
  Point point(const PetscScalar* coordinates, PetscInt vertex) const {
    const PetscScalar* at = coordinates + 3 * (vertex - first_vertex_);
    return {at[0], at[1], at[2]};
  }

  /// Calls `visit` for each tet of this rank.
  template <class Visit>
  void for_each_tet(const Visit& visit) const {
    Vec coordinates = nullptr;
    const PetscScalar* values = nullptr;
    PetscCallAbort(PETSC_COMM_WORLD, DMGetCoordinatesLocal(dm_, &coordinates));
    PetscCallAbort(PETSC_COMM_WORLD, VecGetArrayRead(coordinates, &values));
    for (PetscInt t = first_tet_; t < end_tet_; ++t) {
      Tet tet;
      PetscInt count = 0, *closure = nullptr;
      PetscCallAbort(PETSC_COMM_WORLD, DMPlexGetTransitiveClosure(dm_, t, PETSC_TRUE, &count, &closure));
      for (std::size_t k = 0; k < 4; ++k) {  // the vertices are the last points
        tet.vertices[k] = closure[2 * (static_cast<std::size_t>(count) - 4 + k)];
        tet.corners[k] = point(values, tet.vertices[k]);
      }
      PetscCallAbort(PETSC_COMM_WORLD, DMPlexRestoreTransitiveClosure(dm_, t, PETSC_TRUE, &count, &closure));
      visit(t, tet);
    }
    PetscCallAbort(PETSC_COMM_WORLD, VecRestoreArrayRead(coordinates, &values));
  }

  static double volume(const Tet& tet) {
    const auto& [a, b, c, d] = tet.corners;
    return std::fabs(collarmesh::six_volume(a, b, c, d)) / 6;
  }

  /// Visits the four points of a quadrature rule that is exact for quadratic polynomials, each with the
  /// values of the linear shape functions there and the weight.
  template <class Visit>
  static void quadrature(const Tet& tet, const Visit& visit) {
    constexpr double near = 0.5854101966249685, far = 0.1381966011250105;
    for (std::size_t q = 0; q < 4; ++q) {
      std::array<double, 4> shape{far, far, far, far};
      shape[q] = near;
      Point p;
      for (std::size_t k = 0; k < 4; ++k) p = p + shape[k] * tet.corners[k];
      visit(p, shape, volume(tet) / 4);
    }
  }

  void assemble(Mat matrix, Vec load) const {
    Vec local = nullptr;
    PetscCallAbort(PETSC_COMM_WORLD, DMGetLocalVector(dm_, &local));
    PetscCallAbort(PETSC_COMM_WORLD, VecSet(local, 0));
    for_each_tet([&](PetscInt t, const Tet& tet) {
      const auto& p = tet.corners;
      std::array<Vector, 4> gradients;
      for (std::size_t k = 0; k < 4; ++k) {
        const Point &a = p[(k + 1) % 4], &b = p[(k + 2) % 4], &c = p[(k + 3) % 4];
        const Vector normal = collarmesh::cross(b - a, c - a);
        gradients[k] = normal / collarmesh::dot(normal, p[k] - a);
      }
      std::array<PetscScalar, 16> stiffness;
      for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j)
          stiffness[4 * i + j] = volume(tet) * collarmesh::dot(gradients[i], gradients[j]);
      std::array<PetscScalar, 4> force{};
      quadrature(tet, [&](const Point& at, const std::array<double, 4>& shape, double weight) {
        for (std::size_t k = 0; k < 4; ++k) force[k] += weight * shape[k] * source(at, scale_);
      });
      PetscCallAbort(PETSC_COMM_WORLD,
                     DMPlexMatSetClosure(dm_, nullptr, nullptr, matrix, t, stiffness.data(), ADD_VALUES));
      PetscCallAbort(PETSC_COMM_WORLD, DMPlexVecSetClosure(dm_, nullptr, local, t, force.data(), ADD_VALUES));
    });
    PetscCallAbort(PETSC_COMM_WORLD, MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY));
    PetscCallAbort(PETSC_COMM_WORLD, MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY));
    PetscCallAbort(PETSC_COMM_WORLD, DMLocalToGlobal(dm_, local, ADD_VALUES, load));
    PetscCallAbort(PETSC_COMM_WORLD, DMRestoreLocalVector(dm_, &local));
  }

  /// Sets the unknowns on patches (label `patch`) to the exact solution.
  void constrain(Mat matrix, Vec load, Vec solution) const {
    PetscSection global = nullptr;
    PetscCallAbort(PETSC_COMM_WORLD, DMGetGlobalSection(dm_, &global));
    DMLabel patches = nullptr;
    IS tags = nullptr;
    PetscCallAbort(PETSC_COMM_WORLD, DMGetLabel(dm_, "patch", &patches));
    PetscCallAbort(PETSC_COMM_WORLD, DMLabelGetValueIS(patches, &tags));
    Vec coordinates = nullptr;
    const PetscScalar* values = nullptr;
    PetscCallAbort(PETSC_COMM_WORLD, DMGetCoordinatesLocal(dm_, &coordinates));
    PetscCallAbort(PETSC_COMM_WORLD, VecGetArrayRead(coordinates, &values));
    std::vector<PetscInt> rows;
    for_each_index(tags, [&](PetscInt tag) {
      IS faces = nullptr;
      PetscCallAbort(PETSC_COMM_WORLD, DMLabelGetStratumIS(patches, tag, &faces));
      for_each_index(faces, [&](PetscInt face) {
        PetscInt count = 0, *closure = nullptr;
        PetscCallAbort(PETSC_COMM_WORLD, DMPlexGetTransitiveClosure(dm_, face, PETSC_TRUE, &count, &closure));
        for (PetscInt k = count - 3; k < count; ++k) {
          PetscInt row = 0;
          PetscCallAbort(PETSC_COMM_WORLD, PetscSectionGetOffset(global, closure[2 * k], &row));
          if (row < 0) row = -row - 1;  // another rank owns it
          rows.push_back(row);
          PetscCallAbort(
              PETSC_COMM_WORLD,
              VecSetValue(solution, row, exact(point(values, closure[2 * k]), scale_), INSERT_VALUES));
        }
        PetscCallAbort(PETSC_COMM_WORLD,
                       DMPlexRestoreTransitiveClosure(dm_, face, PETSC_TRUE, &count, &closure));
      });
      PetscCallAbort(PETSC_COMM_WORLD, ISDestroy(&faces));
    });
    PetscCallAbort(PETSC_COMM_WORLD, VecRestoreArrayRead(coordinates, &values));
    PetscCallAbort(PETSC_COMM_WORLD, ISDestroy(&tags));
    PetscCallAbort(PETSC_COMM_WORLD, VecAssemblyBegin(solution));
    PetscCallAbort(PETSC_COMM_WORLD, VecAssemblyEnd(solution));
    PetscCallAbort(PETSC_COMM_WORLD, MatZeroRowsColumns(matrix, static_cast<PetscInt>(rows.size()),
                                                        rows.data(), 1, solution, load));
  }

  template <class Visit>
  static void for_each_index(IS set, const Visit& visit) {
    if (set == nullptr) return;
    PetscInt count = 0;
    const PetscInt* indices = nullptr;
    PetscCallAbort(PETSC_COMM_WORLD, ISGetLocalSize(set, &count));
    PetscCallAbort(PETSC_COMM_WORLD, ISGetIndices(set, &indices));
    for (PetscInt i = 0; i < count; ++i) visit(indices[i]);
    PetscCallAbort(PETSC_COMM_WORLD, ISRestoreIndices(set, &indices));
  }

  std::array<double, 2> norms(Vec solution) const {
    Vec local = nullptr;
    PetscCallAbort(PETSC_COMM_WORLD, DMGetLocalVector(dm_, &local));
    PetscCallAbort(PETSC_COMM_WORLD, DMGlobalToLocal(dm_, solution, INSERT_VALUES, local));
    const PetscScalar* values = nullptr;
    PetscCallAbort(PETSC_COMM_WORLD, VecGetArrayRead(local, &values));
    std::array<double, 2> squares{0, 0};
    for_each_tet([&](PetscInt, const Tet& tet) {
      quadrature(tet, [&](const Point& at, const std::array<double, 4>& shape, double weight) {
        double u = 0;
        for (std::size_t k = 0; k < 4; ++k) u += shape[k] * values[tet.vertices[k] - first_vertex_];
        squares[0] += weight * (u - exact(at, scale_)) * (u - exact(at, scale_));
        squares[1] += weight * u * u;
      });
    });
    PetscCallAbort(PETSC_COMM_WORLD, VecRestoreArrayRead(local, &values));
    PetscCallAbort(PETSC_COMM_WORLD, DMRestoreLocalVector(dm_, &local));
    MPI_Allreduce(MPI_IN_PLACE, squares.data(), 2, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
    return {std::sqrt(squares[0]), std::sqrt(squares[1])};
  }

  double scale_;
  DM dm_ = nullptr;
  PetscInt first_vertex_ = 0, first_tet_ = 0, end_tet_ = 0;
};

void run(const std::string& path, double size, int levels) {
  int rank = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  // Every rank knows the complex; rank 0 meshes it.
  const collarmesh::PolygonSoup soups[] = {collarmesh::io::read_soup(path)};
  const collarmesh::Plc plc = collarmesh::build_plc(soups);
  collarmesh::PipelineOptions options;
  options.mesh.size = size;
  collarmesh::TetMesh coarse;
  if (rank == 0) coarse = collarmesh::run_pipeline(plc, options).result.mesh;
  const double scale = 0.5 * plc.bounds.diagonal();
  const collarmesh::distributed::Shape shape{
      plc, {}, collarmesh::distance_of(options, plc.bounds.diagonal())};
  collarmesh::distributed::ParallelMesh mesh(PETSC_COMM_WORLD, coarse, plc);
  for (int level = 0; level <= levels; ++level) {
    if (level > 0) mesh.refine(shape);
    const auto certificate = mesh.certify(shape);
    const auto [error, norm] = Poisson(mesh.dm(), scale).solve();
    if (rank == 0)
      fmt::print("level {}: {} tets, {}, error {:.6e}, norm {:.10e}\n", level, certificate.tets,
                 certificate.passed() ? "certified" : "NOT certified", error, norm);
  }
}

}  // namespace

int main(int argc, char** argv) {
  PetscInitializeNoArguments();
  try {
    run(argc > 1 ? argv[1] : "box.off", argc > 2 ? std::atof(argv[2]) : 0, argc > 3 ? std::atoi(argv[3]) : 2);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    MPI_Abort(PETSC_COMM_WORLD, 1);
  }
  PetscFinalize();
}
