#include "options.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <initializer_list>
#include <stdexcept>
#include <utility>

#include "arrays.h"
#include "collarmesh/error.h"
#include "machine.h"
#include "option_values.h"

namespace py = pybind11;

namespace collarmesh::python {

namespace {

class Reader {
 public:
  explicit Reader(const py::dict& given) : given_(given) {}

  template <class T>
  void take(const char* name, T& value, const char* what) const {
    if (!given_.contains(name)) return;
    try {
      value = py::handle(given_[name]).cast<T>();
    } catch (const py::cast_error&) {
      throw OptionError(
          fmt::format("{} must be {}, not {}", name, what, std::string(py::repr(given_[name]))));
    }
  }
  void number(const char* name, double& value) const { take(name, value, "a number"); }
  template <class T>
  void count(const char* name, T& value) const {
    take(name, value, "a whole number that is not negative");
  }
  void number_in(const char* name, double& value, double low, double high) const {
    number(name, value);
    if (given_.contains(name) && !(value >= low && value <= high))
      throw OptionError(fmt::format("{} is {}; it must be from {} to {}", name, value, low, high));
  }
  template <class T>
  void word(const char* name, T& value, std::initializer_list<std::pair<const char*, T>> words) const {
    std::string given;
    take(name, given, "a word");
    if (!given_.contains(name)) return;
    std::string known;
    for (const auto& [text, meaning] : words) {
      if (given == text) {
        value = meaning;
        return;
      }
      known += fmt::format("{}\"{}\"", known.empty() ? "" : ", ", text);
    }
    throw OptionError(fmt::format("{} must be one of {}, not \"{}\"", name, known, given));
  }
  bool has(const char* name) const { return given_.contains(name); }
  py::object operator[](const char* name) const { return given_[name]; }

 private:
  const py::dict& given_;
};

void take_complex(const Reader& from, Options& options) {
  PipelineOptions& p = options.pipeline;
  from.number_in("feature_angle", p.complex.feature_angle, 0, 180);
  from.number_in("planar_tolerance", p.complex.planar_tolerance, 0, 0.01);
  from.number_in("weld", p.complex.weld, 0, 0.1);
  from.word<RepairMode>(
      "repair", p.repair.mode,
      {{"auto", RepairMode::automatic}, {"none", RepairMode::off}, {"wrap", RepairMode::wrap}});
  from.number_in("repair_tolerance", p.repair.tolerance, 0, 0.01);
  from.number_in("wrap_offset", p.repair.wrap_offset, 1e-4, 0.1);
  from.number_in("crease_angle", p.mesh.crease_angle, 0, 90);
  from.word<cli::SolidOverlap>("overlap", options.overlap,
                               {{"first", cli::SolidOverlap::first}, {"region", cli::SolidOverlap::region}});
}

void take_sizes(const Reader& from, MeshOptions& m) {
  constexpr const char* sizes = "a dict of tags and lengths, {3: 0.1}";
  from.number("size", m.size);
  from.number("size_min", m.size_min);
  from.take("region_size", m.region_size, sizes);
  from.take("patch_size", m.patch_size, sizes);
  from.take("curve_size", m.curve_size, sizes);
  from.number("gradation", m.gradation);
  from.number("elements_per_circle", m.elements_per_circle);
  from.number("elements_across_gap", m.elements_across_gap);
}

void take_budgets(const Reader& from, MeshOptions& m) {
  from.count("max_vertices", m.max_vertices);
  from.number("time_limit", m.time_limit);
  m.max_memory = cli::memory_of_the_machine() / 2;
  if (!from.has("max_memory")) return;
  if (!py::isinstance<py::str>(from["max_memory"])) {
    from.count("max_memory", m.max_memory);
    return;
  }
  try {
    m.max_memory = cli::parse_memory(from["max_memory"].cast<std::string>());
  } catch (const std::invalid_argument& error) {
    throw OptionError(fmt::format("max_memory: {}", error.what()));
  }
}

void take_quality(const Reader& from, PipelineOptions& p) {
  MeshOptions& m = p.mesh;
  from.number("radius_edge", m.radius_edge);
  from.number("vertex_ratio", m.vertex_ratio);
  from.number("theta", m.theta);
  from.number_in("collar_angle", m.collar_angle, 100, 175);
  from.word<CollarCreation>("collar_creation", m.collar_creation,
                            {{"up-front", CollarCreation::up_front}, {"in-pass", CollarCreation::in_pass}});
  from.number("distance", m.distance);
  from.count("seed", m.seed);
  from.take("coarsen", p.coarsen, "True or False");
  from.number_in("thin_angle", p.thin_angle, 0.1, 30);
  from.count("improve", p.improve);
  from.number_in("min_dihedral", p.min_dihedral, 0, 60);
  from.count("order", p.order);
  from.count("partitions", p.partitions);
  from.count("threads", p.threads);
  if (p.improve > 3) throw OptionError(fmt::format("improve is {}; it must be from 0 to 3", p.improve));
  if (from.has("partitions") && p.partitions == 0)
    throw OptionError("partitions is 0; it must be at least 1, or None for a mesh that is not divided");
  if (p.order != 1 && p.order != 2) throw OptionError(fmt::format("order is {}; it must be 1 or 2", p.order));
}

/// A callable of a place, called with the lock of the interpreter held.
SizeField field_of(const py::object& callable) {
  const auto locked = [](py::object* object) {
    const py::gil_scoped_acquire acquire;
    delete object;
  };
  const std::shared_ptr<py::object> kept(new py::object(callable), locked);
  return [kept](const Point& p) {
    const py::gil_scoped_acquire acquire;
    return (*kept)(p.x, p.y, p.z).cast<double>();
  };
}

void take_size_field(const Reader& from, Options& options) {
  if (!from.has("size_field")) return;
  const py::object field = from["size_field"];
  if (py::isinstance<py::dict>(field) && py::dict(field).contains("tets")) {
    const py::dict arrays(field);
    options.pipeline.mesh.size_field =
        size_field_on_mesh(tet_mesh_of(arrays), arrays["values"].cast<std::vector<double>>());
  } else if (py::isinstance<py::dict>(field)) {
    options.size_field_json = py::module_::import("json").attr("dumps")(field).cast<std::string>();
  } else if (py::isinstance<py::str>(field)) {
    options.size_field_file = field.cast<std::string>();
  } else {
    options.pipeline.mesh.size_field = field_of(field);
  }
}

void take_check(const Reader& from, Options& options) {
  CheckOptions& c = options.check;
  const PipelineOptions& p = options.pipeline;
  from.count("findings", c.findings_per_guarantee);
  c.thin_angle = CheckOptions().thin_angle;
  from.number_in("thin_angle", c.thin_angle, 0, 30);
  c.radius_edge = p.mesh.radius_edge;
  c.distance = p.mesh.distance;
  c.collar_angle = p.mesh.collar_angle;
  c.crease_angle = p.mesh.crease_angle;
  c.threads = p.threads;
}

}  // namespace

Options options_of(const py::dict& given) {
  const Reader from(given);
  Options options;
  take_complex(from, options);
  take_sizes(from, options.pipeline.mesh);
  take_budgets(from, options.pipeline.mesh);
  take_quality(from, options.pipeline);
  take_size_field(from, options);
  take_check(from, options);
  if (from.has("names"))
    options.names = py::isinstance<py::str>(from["names"])
                        ? from["names"].cast<std::string>()
                        : py::module_::import("json").attr("dumps")(from["names"]).cast<std::string>();
  from.take("format", options.output_format, "an extension");
  from.take("input_format", options.input_format, "an extension");
  return options;
}

}  // namespace collarmesh::python
