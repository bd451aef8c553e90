// The mesher for Python: numpy arrays in and out.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <memory>
#include <string>
#include <vector>

#include "collarmesh/check.h"
#include "collarmesh/coarsen.h"
#include "collarmesh/error.h"
#include "collarmesh/improve.h"
#include "collarmesh/io/tet_mesh_io.h"
#include "collarmesh/mesher.h"
#include "collarmesh/plc_builder.h"
#include "collarmesh/repair.h"
#include "collarmesh/second_order.h"

namespace py = pybind11;
using namespace py::literals;

namespace collarmesh::python {

namespace {

template <class T>
using Array = py::array_t<T, py::array::c_style | py::array::forcecast>;

[[noreturn]] void refuse(const std::string& message) { throw OptionError(message); }

template <class T>
void require_rows(const Array<T>& array, py::ssize_t columns, const std::string& what) {
  if (array.ndim() == 2 && array.shape(1) == columns) return;
  refuse(what + " must be an array of shape (n, " + std::to_string(columns) + ")");
}

/// A surface: (points, triangles) or (points, triangles, tags).
PolygonSoup soup_of(const py::tuple& surface, std::size_t number) {
  const std::string name = "surface " + std::to_string(number);
  if (surface.size() != 2 && surface.size() != 3)
    refuse(name + " must be a tuple (points, triangles) or (points, triangles, tags)");
  const auto points = surface[0].cast<Array<double>>();
  const auto triangles = surface[1].cast<Array<std::int64_t>>();
  require_rows(points, 3, "the points of " + name);
  require_rows(triangles, 3, "the triangles of " + name);
  Array<std::int64_t> tags;
  if (surface.size() == 3) {
    tags = surface[2].cast<Array<std::int64_t>>();
    if (tags.ndim() != 1 || tags.shape(0) != triangles.shape(0))
      refuse("the tags of " + name + " must be an array of shape (n,), one for each triangle");
  }
  PolygonSoup soup;
  soup.name = name;
  const auto p = points.unchecked<2>();
  for (py::ssize_t i = 0; i < points.shape(0); ++i) soup.points.push_back({p(i, 0), p(i, 1), p(i, 2)});
  const auto t = triangles.unchecked<2>();
  for (py::ssize_t i = 0; i < triangles.shape(0); ++i) {
    std::array<Index, 3> corners{};
    for (py::ssize_t k = 0; k < 3; ++k) {
      if (t(i, k) < 0 || t(i, k) >= points.shape(0))
        refuse("triangle " + std::to_string(i) + " of " + name + " has the corner " +
               std::to_string(t(i, k)) + "; its points are 0 to " + std::to_string(points.shape(0) - 1));
      corners[static_cast<std::size_t>(k)] = static_cast<Index>(t(i, k));
    }
    soup.add_facet(corners, surface.size() == 3 ? static_cast<Tag>(tags.at(i)) : 0);
  }
  return soup;
}

struct Mesh {
  TetMesh mesh;
  CheckReport report;
  std::vector<std::string> repairs;
};

/// A view of a vector, kept alive by the mesh; not to be written to.
template <class T, py::ssize_t columns, class Item>
py::array view(const py::object& owner, const std::vector<Item>& items) {
  static_assert(sizeof(Item) == columns * sizeof(T));
  const auto rows = static_cast<py::ssize_t>(items.size());
  const auto* data = reinterpret_cast<const T*>(items.data());
  py::array array = columns == 1 ? py::array(py::dtype::of<T>(), {rows}, {}, data, owner)
                                 : py::array(py::dtype::of<T>(), {rows, columns}, {}, data, owner);
  array.attr("setflags")("write"_a = false);
  return array;
}

template <class T, py::ssize_t columns, class Item>
auto property(std::vector<Item> TetMesh::*member) {
  return [member](const py::object& self) {
    return view<T, columns>(self, self.cast<const Mesh&>().mesh.*member);
  };
}

struct Wanted {
  MeshOptions mesh;
  PlcOptions plc;
  RepairOptions repair;
  bool coarsen = true;
  CoarsenOptions thin;
  unsigned improve = 2;
  int order = 1;
};

void require_complete(const MeshResult& result) {
  if (result.status == MeshStatus::budget_hit || result.status == MeshStatus::cancelled)
    throw Error(result.message.empty() ? "cancelled" : result.message);
}

RepairMode repair_mode(const std::string& word) {
  if (word == "auto") return RepairMode::automatic;
  if (word == "none") return RepairMode::off;
  if (word == "wrap") return RepairMode::wrap;
  refuse("repair must be \"auto\", \"none\" or \"wrap\"");
}

std::unique_ptr<Mesh> generate_mesh(const std::vector<PolygonSoup>& soups, const Wanted& wanted,
                                    const Execution& execution) {
  const auto [plc, repaired, repaired_soups] =
      build_repaired_plc(soups, wanted.plc, wanted.repair, execution);
  if (repaired.cancelled) throw Error("cancelled");
  MeshOptions options = wanted.mesh;
  if (!(options.distance > 0))
    options.distance = default_distance(options.size, plc.bounds.diagonal(), wanted.order);
  MeshResult result = generate(plc, options, execution);
  require_complete(result);
  auto made = std::make_unique<Mesh>();
  made->mesh = std::move(result.mesh);
  made->repairs = describe(repaired);
  const bool coarse = wanted.coarsen && result.status == MeshStatus::complete;
  if (coarse) {
    Execution later = execution;  // than what the fractions count
    if (execution.progress)
      later.progress = [&](ProgressReport report) {
        report.fraction = 1;
        return execution.progress(report);
      };
    if (coarsen(made->mesh, plc, options, wanted.thin, later).cancelled) throw Error("cancelled");
  }
  if (wanted.improve > 0) {
    ImproveOptions improvement = improve_options(wanted.improve);
    improvement.radius_edge = options.radius_edge;
    improvement.distance = options.distance;
    improvement.thin_angle = coarse ? wanted.thin.thin_angle : 0;
    improvement.keep_vertices = coarse;
    collarmesh::improve(made->mesh, plc, improvement);
  }
  if (wanted.order == 2) make_second_order(made->mesh, plc);
  CheckOptions bounds;
  bounds.radius_edge = wanted.mesh.radius_edge;
  bounds.thin_angle = wanted.thin.thin_angle;
  bounds.distance = options.distance;
  bounds.collar_angle = wanted.mesh.collar_angle;
  bounds.crease_angle = wanted.mesh.crease_angle;
  made->report = check(made->mesh, plc, bounds);
  return made;
}

std::unique_ptr<Mesh> mesh(const py::args& surfaces, double size, double size_min,
                           const std::map<Tag, double>& region_size, const std::map<Tag, double>& patch_size,
                           double gradation, double elements_per_circle, double elements_across_gap,
                           double radius_edge, double feature_angle, double crease_angle, double collar_angle,
                           double distance, bool coarsen, double thin_angle, unsigned improve, int order,
                           std::uint64_t seed, double time_limit, const std::string& repair,
                           double repair_tolerance, const py::object& progress) {
  if (order != 1 && order != 2) refuse("order must be 1 or 2");
  if (surfaces.empty()) refuse("there is no surface to mesh: give tuples (points, triangles)");
  std::vector<PolygonSoup> soups;
  for (const py::handle& surface : surfaces)
    soups.push_back(soup_of(surface.cast<py::tuple>(), soups.size() + 1));
  Wanted wanted;
  wanted.coarsen = coarsen;
  wanted.thin.thin_angle = thin_angle;
  wanted.improve = improve;
  wanted.order = order;
  wanted.mesh.size = size;
  wanted.mesh.size_min = size_min;
  wanted.mesh.region_size = region_size;
  wanted.mesh.patch_size = patch_size;
  wanted.mesh.gradation = gradation;
  wanted.mesh.elements_per_circle = elements_per_circle;
  wanted.mesh.elements_across_gap = elements_across_gap;
  wanted.mesh.radius_edge = radius_edge;
  wanted.mesh.crease_angle = crease_angle;
  wanted.mesh.collar_angle = collar_angle;
  wanted.mesh.distance = distance;
  wanted.mesh.seed = seed;
  wanted.mesh.time_limit = time_limit;
  wanted.plc.feature_angle = feature_angle;
  wanted.repair.mode = repair_mode(repair);
  wanted.repair.tolerance = repair_tolerance;
  Execution execution;
  if (!progress.is_none())
    execution.progress = [&progress](const ProgressReport& report) {
      const py::gil_scoped_acquire acquire;
      return progress(std::string(report.phase), report.fraction).cast<bool>();
    };
  const py::gil_scoped_release release;
  return generate_mesh(soups, wanted, execution);
}

std::vector<std::string> findings(const Mesh& mesh) {
  std::vector<std::string> messages;
  for (const Finding& finding : mesh.report.findings)
    messages.push_back(finding.guarantee + ": " + finding.message);
  return messages;
}

constexpr const char* mesh_doc =
    R"(Mesh what closed surfaces bound, and certify the result.

Each surface is a tuple (points, triangles) or (points, triangles, tags): points of shape (n, 3), in any unit
of length; triangles of shape (m, 3), rows of points, oriented outwards; tags of shape (m,), integers, by which
the faces of the mesh are found again. Several surfaces are several regions, numbered from 1; one that is
inside another and oriented inwards is a cavity. Lengths are absolute: size is a target edge length (0: 1/20
of the diagonal), distance how far smooth surfaces may be off (0: 1/20 of the size, at most 1/400 of the diagonal).
Angles are degrees.
There are about as many tetrahedra as size asks for; in thin places they are thin, with dihedral angles of at least
thin_angle. coarsen=False makes them so small there that circumradius / shortest edge is at most radius_edge.
progress(phase, fraction) may return False to cancel.
Surfaces that are no valid complex are repaired, which `repairs` of the result tells: repair="none" makes them an
error, repair="wrap" puts a closed surface around what cannot be repaired. repair_tolerance, relative to the
diagonal of the bounding box, is the size below which features are noise to the repair.

Returns a Mesh; its `passed` tells whether every guarantee holds. Raises Error for surfaces that are no valid
complex and cannot be repaired, with names and places, for contradicting options, and when it is cancelled or the time (seconds) is up.)";

}  // namespace

PYBIND11_MODULE(collarmesh, module) {
  module.doc() =
      "Tetrahedral meshes of surfaces by Sparse Voronoi Refinement with collars; numpy arrays in and out.";
  py::register_exception<Error>(module, "Error", PyExc_RuntimeError);
  py::class_<Mesh>(module, "Mesh", "A tetrahedral mesh. Its arrays are views, not to be written to.")
      .def_property_readonly("points", property<double, 3>(&TetMesh::points), "(n, 3), float64")
      .def_property_readonly("tets", property<Index, 4>(&TetMesh::tets),
                             "(m, 4), rows of points, positive volume")
      .def_property_readonly("tet_region", property<Index, 1>(&TetMesh::tet_region),
                             "(m,), numbers of regions, from 1")
      .def_property_readonly("tet_collar", property<std::uint8_t, 1>(&TetMesh::tet_collar),
                             "(m,), 0 outside of collars, 1 star, 2 book")
      .def_property_readonly("tet_thin", property<std::uint8_t, 1>(&TetMesh::tet_thin),
                             "(m,), 1 for thin tetrahedra, which exceed radius_edge; (0,) when there is none")
      .def_property_readonly("tet_mid_nodes", property<Index, 6>(&TetMesh::tet_mid_nodes),
                             "(m, 6), nodes amid the edges ab, bc, ca, ad, bd, cd; (0, 6) for first order")
      .def_property_readonly("faces", property<Index, 3>(&TetMesh::faces),
                             "(k, 3), triangles on boundaries and interfaces")
      .def_property_readonly("face_regions", property<Index, 2>(&TetMesh::face_regions),
                             "(k, 2), regions behind and before the triangle; 0: none")
      .def_property_readonly("face_tag", property<Tag, 1>(&TetMesh::face_tag),
                             "(k,), tags of the surfaces' triangles")
      .def_property_readonly("edges", property<Index, 2>(&TetMesh::edges), "(j, 2), edges on feature curves")
      .def_property_readonly("edge_tag", property<Tag, 1>(&TetMesh::edge_tag), "(j,), tags of the curves")
      .def_property_readonly(
          "order", [](const Mesh& self) { return self.mesh.order(); }, "1 or 2")
      .def_property_readonly(
          "passed", [](const Mesh& self) { return self.report.passed(); }, "does every guarantee hold?")
      .def_property_readonly("findings", &findings, "what does not hold: sentences with places")
      .def_property_readonly(
          "repairs", [](const Mesh& self) { return self.repairs; },
          "what was done to surfaces that were no valid complex: sentences with places")
      .def_property_readonly(
          "min_dihedral", [](const Mesh& self) { return self.report.min_dihedral; },
          "smallest dihedral angle outside of collars, degrees")
      .def_property_readonly(
          "max_dihedral", [](const Mesh& self) { return self.report.max_dihedral; },
          "largest dihedral angle outside of collars, degrees")
      .def(
          "write", [](const Mesh& self, const std::string& path) { io::write_tet_mesh(path, self.mesh); },
          "path"_a, py::call_guard<py::gil_scoped_release>(),
          "Write a file; its extension tells the format (.vtu, .msh, .inp ...)")
      .def("__repr__", [](const Mesh& self) {
        return "<collarmesh.Mesh: " + std::to_string(self.mesh.tets.size()) + " tets, " +
               std::to_string(self.mesh.points.size()) + " points>";
      });
  module.def("mesh", &mesh, mesh_doc, py::kw_only(), "size"_a = 0., "size_min"_a = 0.,
             "region_size"_a = std::map<Tag, double>(), "patch_size"_a = std::map<Tag, double>(),
             "gradation"_a = 0., "elements_per_circle"_a = 0., "elements_across_gap"_a = 0.,
             "radius_edge"_a = 2., "feature_angle"_a = 30., "crease_angle"_a = 60., "collar_angle"_a = 150.,
             "distance"_a = 0., "coarsen"_a = true, "thin_angle"_a = CoarsenOptions().thin_angle,
             "improve"_a = 2U, "order"_a = 1, "seed"_a = 0U, "time_limit"_a = 0., "repair"_a = "auto",
             "repair_tolerance"_a = RepairOptions().tolerance, "progress"_a = py::none());
}

}  // namespace collarmesh::python
