// The mesher for Python: the functions that collarmesh/__init__.py calls.
#include <fmt/format.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "arrays.h"
#include "collarmesh/error.h"
#include "collarmesh/io/tet_mesh_io.h"
#include "collarmesh/locate.h"
#include "collarmesh/mesh_measures.h"
#include "collarmesh/partition.h"
#include "collarmesh/pipeline.h"
#include "collarmesh/predict.h"
#include "collarmesh/remesh.h"
#include "files/check_against.h"
#include "files/complex_input.h"
#include "files/input_files.h"
#include "files/surface_files.h"
#include "io/complete_mesh.h"
#include "options.h"
#include "report/layers_report.h"
#include "report/report.h"
#include "report/soup_output.h"
#include "report/split_report.h"
#include "watched.h"

namespace py = pybind11;

namespace collarmesh::python {

namespace {

/// The input to be meshed: paths and surfaces given as arrays, in their order.
struct Inputs {
  std::vector<std::string> paths;
  std::vector<PolygonSoup> soups;
};

Inputs inputs_of(const py::list& given) {
  Inputs inputs;
  for (const py::handle& each : given) {
    if (py::isinstance<py::str>(each))
      inputs.paths.push_back(each.cast<std::string>());
    else
      inputs.soups.push_back(soup_of(py::reinterpret_borrow<py::dict>(each)));
  }
  return inputs;
}

/// A complex and the input that it came from, which must stay alive because other data refer to it.
struct Complex {
  std::optional<files::ComplexInput> input;
  Plc plc;
};

files::ComplexInput read(const Inputs& inputs, const Options& options, Watch& watch) {
  watch.begin_stage("read");
  files::InputReading reading;
  reading.format = options.input_format;
  reading.distance = [&options](double diagonal) { return distance_of(options, diagonal); };
  reading.tolerance = [&options](const Plc& plc) {
    return tolerance_of(plc, options.mesh.bounds, options.mesh.size, static_cast<int>(options.order));
  };
  reading.overlap = options.overlap;
  reading.threads = options.mesh.threads;
  reading.names = options.names;
  reading.cancel = &watch.flag();
  reading.stop = [&watch] { watch.stop_if_asked(); };
  files::ComplexInput input(inputs.paths, reading);
  for (const PolygonSoup& soup : inputs.soups) input.add(soup);
  return input;
}

void build(const Inputs& inputs, const Options& options, Watch& watch, Complex& complex) {
  complex.input.emplace(read(inputs, options, watch));
  watch.begin_stage("complex");
  complex.plc = complex.input->build(options.complex, options.repair);
  watch.stop_if_asked();
}

py::object parsed(const nlohmann::ordered_json& json) {
  return py::module_::import("json").attr("loads")(json.dump());
}

/// The data that a call owns while its work runs, and its results.
struct MeshCall {
  Inputs inputs;
  Options options;
  std::optional<files::ComplexInput> input;
  SoupPipelineResult run;
};

/// Builds the complexes of a call's inputs.
class InputSource : public ComplexSource {
 public:
  /// Keeps all by reference.
  InputSource(const Options& options, files::ComplexInput& input) : options_(options), input_(input) {}

  RepairedPlc build(const RepairOptions& repair, const Execution&) override {
    return {input_.build(options_.complex, repair), input_.repaired(), {}};
  }

  void adapt(const Plc& plc, PipelineOptions& options) override {
    if (SizeField field = size_field_for(plc, options_)) options.mesh.size_field = std::move(field);
    if (input_.has_cad()) {
      options.exact = input_.exact_geometry(plc);
      options.exact_measures = input_.exact_measures(plc);
    }
  }

 private:
  const Options& options_;
  files::ComplexInput& input_;
};

void mesh(MeshCall& call, Watch& watch) {
  call.input.emplace(read(call.inputs, call.options, watch));
  PipelineOptions options = call.options;
  options.mesh.time_limit = 0;  // run_watched limits the time of the whole call
  InputSource source(call.options, *call.input);
  call.run = run_pipeline(source, options, watch.execution());
  MeshResult& result = call.run.result;
  if (result.status == MeshStatus::budget_hit) throw BudgetSpent(result.message);
  if (result.status == MeshStatus::cancelled) throw Cancelled(result.message);
  if (call.input->has_cad()) result.mesh.group_names = GroupNames::cad;
}

std::vector<std::string> warnings_of(const Plc& plc) {
  std::vector<std::string> warnings;
  for (const Plc::Warning& warning : plc.warnings) warnings.push_back(warning.message);
  return warnings;
}

py::dict mesh_of(const py::list& inputs, const py::dict& options, const py::object& progress) {
  const auto call = std::make_shared<MeshCall>();
  call->inputs = inputs_of(inputs);
  call->options = options_of(options);
  const double time_limit = call->options.mesh.time_limit;
  run_watched([call](Watch& watch) { mesh(*call, watch); }, progress, time_limit);
  py::dict arrays = arrays_of(std::move(call->run.result.mesh));
  arrays["status_message"] = call->run.result.message;
  arrays["check"] = parsed(report::check_json(call->run.check));
  arrays["repairs"] = describe(call->run.repair);
  if (call->run.layers) arrays["boundary_layers"] = parsed(report::layers_json(*call->run.layers));
  if (call->run.split) arrays["split"] = parsed(report::split_json(*call->run.split));
  arrays["notes"] = call->input->notes(call->options.dimension);
  arrays["colours"] = colours_of(call->input->colours());
  arrays["warnings"] = warnings_of(call->run.plc);
  return arrays;
}

struct RemeshCall {
  TetMesh mesh;
  Inputs against;
  Options options;
  std::optional<files::ComplexInput> input;
  RemeshResult run;
};

void remesh(RemeshCall& call, Watch& watch) {
  watch.begin_stage("complex");
  PipelineOptions options = call.options;
  options.mesh.time_limit = 0;  // run_watched limits the time of the whole call
  const auto adapt = [&](const Plc& plc, PipelineOptions& adapted) {
    if (SizeField field = size_field_for(plc, call.options)) adapted.mesh.size_field = std::move(field);
    if (!call.input || !call.input->has_cad()) return;
    adapted.exact = call.input->exact_geometry(plc);
    adapted.exact_measures = call.input->exact_measures(plc);
  };
  if (call.against.paths.empty() && call.against.soups.empty()) {
    call.run = collarmesh::remesh(call.mesh, options, adapt, watch.execution());
  } else {
    call.input.emplace(read(call.against, call.options, watch));
    watch.begin_stage("complex");
    const Plc plc = call.input->build(call.options.complex, call.options.repair);
    call.run = collarmesh::remesh(call.mesh, plc, options, adapt, watch.execution());
  }
  const MeshResult& result = call.run.result;
  if (result.status == MeshStatus::budget_hit) throw BudgetSpent(result.message);
  if (result.status == MeshStatus::cancelled) throw Cancelled(result.message);
}

py::dict remesh_mesh(const py::dict& mesh, const py::list& against, const py::dict& options,
                     const py::object& progress) {
  const auto call = std::make_shared<RemeshCall>();
  call->mesh = tet_mesh_of(mesh);
  call->against = inputs_of(against);
  call->options = options_of(options);
  const double time_limit = call->options.mesh.time_limit;
  run_watched([call](Watch& watch) { remesh(*call, watch); }, progress, time_limit);
  py::dict arrays = arrays_of(std::move(call->run.result.mesh));
  arrays["status_message"] = call->run.result.message;
  arrays["check"] = parsed(report::check_json(call->run.check));
  if (call->input) {
    arrays["repairs"] = describe(call->input->repaired());
    arrays["notes"] = call->input->notes();
    arrays["warnings"] = warnings_of(call->run.plc);
  }
  return arrays;
}

struct CheckCall {
  TetMesh mesh;
  Inputs inputs;
  Options options;
  std::optional<files::ComplexInput> input;
  CheckReport report;
};

py::object check_mesh(const py::dict& mesh, const py::list& against, const py::dict& options) {
  const auto call = std::make_shared<CheckCall>();
  call->mesh = tet_mesh_of(mesh);
  call->inputs = inputs_of(against);
  call->options = options_of(options);
  const auto work = [call](Watch& watch) {
    call->input.emplace(read(call->inputs, call->options, watch));
    watch.begin_stage("check");
    call->report = files::check_against(call->mesh, *call->input, call->options, watch.execution());
    watch.stop_if_asked();
  };
  run_watched(work, py::none(), call->options.mesh.time_limit);
  return parsed(report::check_json(call->report));
}

struct ComplexCall {
  Inputs inputs;
  Options options;
  Complex complex;
  PlcSummary summary;
};

py::object info(const py::list& inputs, const py::dict& options) {
  const auto call = std::make_shared<ComplexCall>();
  call->inputs = inputs_of(inputs);
  call->options = options_of(options);
  const auto work = [call](Watch& watch) {
    try {
      build(call->inputs, call->options, watch, call->complex);
    } catch (const PlcError&) {
      call->options.complex.require_solid = false;
      build(call->inputs, call->options, watch, call->complex);
    }
    call->summary = summarize(call->complex.plc, call->options.mesh.bounds.crease_angle);
  };
  run_watched(work, py::none(), call->options.mesh.time_limit);
  nlohmann::ordered_json json{{"complex", report::complex_json(call->complex.plc, call->summary)},
                              {"repair", report::repair_json(call->complex.input->repaired())}};
  return parsed(json);
}

struct PredictCall {
  Inputs inputs;
  Options options;
  std::vector<double> sizes;
  Complex complex;
  std::vector<Prediction> predictions;
};

py::object predicted(const py::list& inputs, const std::vector<double>& sizes, const py::dict& options) {
  const auto call = std::make_shared<PredictCall>();
  call->inputs = inputs_of(inputs);
  call->options = options_of(options);
  call->sizes = sizes;
  const auto work = [call](Watch& watch) {
    build(call->inputs, call->options, watch, call->complex);
    const Plc& plc = call->complex.plc;
    InputSource(call->options, *call->complex.input).adapt(plc, call->options);
    call->predictions = predict(plc, call->options, call->sizes);
  };
  run_watched(work, py::none(), call->options.mesh.time_limit);
  return parsed(report::predictions_json(call->predictions));
}

py::object measures(const py::dict& arrays) {
  const TetMesh mesh = tet_mesh_of(arrays);
  nlohmann::ordered_json json = report::measures_json(mesh, measure_mesh(mesh));
  json["median_edge"] = median_edge(mesh);
  return parsed({{"mesh", json}});
}

py::list repaired(const py::list& inputs, const py::dict& options, py::list& messages) {
  const auto call = std::make_shared<ComplexCall>();
  call->inputs = inputs_of(inputs);
  call->options = options_of(options);
  run_watched([call](Watch& watch) { build(call->inputs, call->options, watch, call->complex); }, py::none(),
              call->options.mesh.time_limit);
  py::list soups;
  for (const PolygonSoup& soup : call->complex.input->soups()) soups.append(arrays_of(soup));
  for (const std::string& line : describe(call->complex.input->repaired())) messages.append(line);
  return soups;
}

struct ConvertCall {
  Inputs inputs;
  Options options;
  std::string output;
  std::vector<PolygonSoup> soups;
  std::string told;
};

/// Joins surfaces into one file without repairing them. Returns a text on what was welded, merged and
/// dropped.
std::string convert_surfaces(const py::list& inputs, const std::string& output, const py::dict& options) {
  const auto call = std::make_shared<ConvertCall>();
  call->inputs = inputs_of(inputs);
  call->options = options_of(options);
  call->output = output;
  const auto work = [call](Watch& watch) {
    const files::ComplexInput input = read(call->inputs, call->options, watch);
    const report::MergedSoup merged = report::merge_for_output(
        input.soups(), call->output, call->options.output_format, call->options.complex);
    files::write_surface(call->output, merged.soup, call->options.output_format);
    call->told = merged.told;
  };
  run_watched(work, py::none(), call->options.mesh.time_limit);
  return call->told;
}

py::dict read_mesh(const std::string& path, const std::string& format) {
  const auto mesh = std::make_shared<TetMesh>();
  run_watched([mesh, path, format](Watch&) { *mesh = files::read_mesh(path, format); }, py::none(), 0);
  return arrays_of(std::move(*mesh));
}

/// Returns the mesh, or None for a surface.
py::object read_mesh_if_there(const std::string& path, const std::string& format) {
  const auto mesh = std::make_shared<std::optional<TetMesh>>();
  run_watched([mesh, path, format](Watch&) { *mesh = files::read_mesh_if_there(path, format); }, py::none(),
              0);
  if (!*mesh) return py::none();
  return arrays_of(std::move(**mesh));
}

void write_mesh(const py::dict& arrays, const std::string& path, const std::string& format,
                bool ghost_cells) {
  const auto mesh = std::make_shared<TetMesh>(tet_mesh_of(arrays));
  if (ghost_cells && mesh->tet_partition.empty())
    throw OptionError("ghost_cells: the mesh is not partitioned; see Mesh.partitioned");
  const auto ghosts = ghost_cells ? io::GhostCells::one_layer : io::GhostCells::none;
  run_watched([mesh, path, format, ghosts](Watch&) { io::write_tet_mesh(path, *mesh, format, ghosts); },
              py::none(), 0);
}

/// Returns the partition of each tet.
py::array partition_mesh(const py::dict& arrays, unsigned partitions) {
  const auto mesh = std::make_shared<TetMesh>(tet_mesh_of(arrays));
  run_watched([mesh, partitions](Watch&) { partition(*mesh, partitions); }, py::none(), 0);
  return partition_array(*mesh);
}

/// Fills in data that meshes of other programs lack.
py::dict complete(const py::dict& arrays) {
  TetMesh mesh = tet_mesh_of(arrays);
  io::complete_mesh("the mesh", mesh);
  return arrays_of(std::move(mesh));
}

/// Returns (tet or -1, barycentric coordinates, nearest point or -1) for each point.
py::tuple locate_points(const py::dict& arrays, const py::dict& places) {
  const auto mesh = std::make_shared<TetMesh>(tet_mesh_of(arrays));
  const auto points = std::make_shared<std::vector<Point>>(soup_of(places).points);
  const auto found = std::make_shared<std::vector<MeshPlace>>();
  run_watched([mesh, points, found](Watch&) { *found = locate(*mesh, *points); }, py::none(), 0);
  return arrays_of(*found);
}

}  // namespace

PYBIND11_MODULE(_core, module) {
  module.attr("__version__") = COLLARMESH_VERSION;
  const auto error = py::register_exception<Error>(module, "Error", PyExc_RuntimeError);
  // pybind11 tries translators in reverse order, so register base classes before subclasses.
  py::register_exception<OptionError>(module, "OptionError", error.ptr());
  py::register_exception<ReadError>(module, "ReadError", error.ptr());
  py::register_exception<WriteError>(module, "WriteError", error.ptr());
  py::register_exception<PlcError>(module, "ComplexError", error.ptr());
  py::register_exception<BudgetSpent>(module, "BudgetError", error.ptr());
  py::register_exception<Cancelled>(module, "CancelledError", error.ptr());
  module.def("mesh", &mesh_of);
  module.def("remesh", &remesh_mesh);
  module.def("check", &check_mesh);
  module.def("info", &info);
  module.def("predict", &predicted);
  module.def("measures", &measures);
  module.def("locate", &locate_points);
  module.def("complete", &complete);
  module.def("repaired", &repaired);
  module.def("convert_surfaces", &convert_surfaces);
  module.def("read_mesh", &read_mesh);
  module.def("read_mesh_if_there", &read_mesh_if_there);
  module.def("write_mesh", &write_mesh);
  module.def("partition", &partition_mesh);
  module.def("formats_with_partitions", &io::formats_with_partitions);
  module.def("formats_with_ghost_cells", &io::formats_with_ghost_cells);
  module.def("is_surface_format", [](const std::string& path, const std::string& format) {
    return files::is_surface_format(path, format);
  });
  py::module_::import("atexit").attr("register")(py::cpp_function(&wait_for_abandoned));
}

}  // namespace collarmesh::python
