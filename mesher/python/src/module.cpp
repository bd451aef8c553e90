// The mesher for Python: the functions that the package collarmesh calls.
#include <fmt/format.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
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
#include "common/deadline.h"
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

/// The input to be meshed: paths, and surfaces given as arrays.
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

files::ComplexInput read(const Inputs& inputs, const Options& options, Watch& watch) {
  watch.begin_stage("read");
  files::InputReading reading = files::reading_of(options, options.input_format);
  reading.distance = [&options](double diagonal) { return distance_of(options, diagonal); };
  reading.tolerance = [&options](const Plc& plc) {
    return tolerance_of(plc, options.mesh.bounds, options.mesh.size, static_cast<int>(options.order));
  };
  reading.order = static_cast<int>(options.order);
  reading.cancel = &watch.flag();
  reading.stop = [&watch] { watch.stop_if_asked(); };
  files::ComplexInput input(inputs.paths, reading);
  for (const PolygonSoup& soup : inputs.soups) input.add(soup);
  return input;
}

/// The data that a call owns while its work runs. Classes derived from it add the results.
struct Call {
  Inputs inputs;
  Options options;
  std::optional<files::ComplexInput> input = {};
  Plc plc = {};  // refers to the input
  Deadline deadline = {};
};

template <class Kind>
std::shared_ptr<Kind> new_call(const py::list& inputs, const py::dict& options) {
  const auto call = std::make_shared<Kind>();
  call->inputs = inputs_of(inputs);
  call->options = options_of(options);
  call->deadline = Deadline::in(call->options.mesh.time_limit);
  return call;
}

template <class Kind>
void run(const std::shared_ptr<Kind>& call, const std::function<void(Kind&, Watch&)>& work,
         const py::object& progress = py::none()) {
  run_watched([call, work](Watch& watch) { work(*call, watch); }, progress, call->options.mesh.time_limit);
}

void read(Call& call, Watch& watch) { call.input.emplace(read(call.inputs, call.options, watch)); }

void build(Call& call, Watch& watch) {
  read(call, watch);
  watch.begin_stage("complex");
  call.plc = call.input->build(call.options.complex, call.options.repair);
  watch.stop_if_asked();
}

/// Sets options that depend on the complex.
void adapt(const Plc& plc, const Options& given, const files::ComplexInput* input, PipelineOptions& options) {
  if (SizeField field = size_field_for(plc, given)) options.mesh.size_field = std::move(field);
  if (input == nullptr || !input->has_cad()) return;
  options.exact = input->exact_geometry(plc);
  options.exact_measures = input->exact_measures(plc);
}

/// Throws if a run ended early.
void require_complete(const MeshResult& result) {
  if (result.status == MeshStatus::budget_hit) throw BudgetSpent(result.message);
  if (result.status == MeshStatus::cancelled) throw Cancelled(result.message);
}

py::object parsed(const nlohmann::ordered_json& json) {
  return py::module_::import("json").attr("loads")(json.dump());
}

struct MeshCall : Call {
  SoupPipelineResult run;
};

/// A builder of complexes from a call's inputs.
class InputSource : public ComplexSource {
 public:
  /// Keeps references to both arguments.
  InputSource(const Options& options, files::ComplexInput& input) : options_(options), input_(input) {}

  RepairedPlc build(const RepairOptions& repair, const Execution&) override {
    return {input_.build(options_.complex, repair), input_.repaired(), {}};
  }

  void adapt(const Plc& plc, PipelineOptions& options) override {
    python::adapt(plc, options_, &input_, options);
  }

 private:
  const Options& options_;
  files::ComplexInput& input_;
};

void mesh(MeshCall& call, Watch& watch) {
  read(call, watch);
  PipelineOptions options = call.options;
  options.mesh.time_limit = call.deadline.as_option();  // run_watched limits the time of the whole call
  InputSource source(call.options, *call.input);
  call.run = run_pipeline(source, options, watch.execution());
  require_complete(call.run.result);
  if (call.input->has_cad()) call.run.result.mesh.group_names = GroupNames::cad;
}

std::vector<std::string> warnings_of(const Plc& plc) {
  std::vector<std::string> warnings;
  for (const Plc::Warning& warning : plc.warnings) warnings.push_back(warning.message);
  return warnings;
}

py::dict mesh_of(const py::list& inputs, const py::dict& options, const py::object& progress) {
  const auto call = new_call<MeshCall>(inputs, options);
  run<MeshCall>(call, mesh, progress);
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

struct RemeshCall : Call {
  TetMesh mesh;
  RemeshResult run;
};

void remesh(RemeshCall& call, Watch& watch) {
  watch.begin_stage("complex");
  PipelineOptions options = call.options;
  options.mesh.time_limit = 0;  // run_watched limits the time of the whole call
  const auto adapt_to = [&](const Plc& plc, PipelineOptions& adapted) {
    adapt(plc, call.options, call.input ? &*call.input : nullptr, adapted);
  };
  if (call.inputs.paths.empty() && call.inputs.soups.empty()) {
    call.run = collarmesh::remesh(call.mesh, options, adapt_to, watch.execution());
  } else {
    build(call, watch);
    call.run = collarmesh::remesh(call.mesh, call.plc, options, adapt_to, watch.execution());
  }
  require_complete(call.run.result);
}

py::dict remesh_mesh(const py::dict& mesh, const py::list& against, const py::dict& options,
                     const py::object& progress) {
  const auto call = new_call<RemeshCall>(against, options);
  call->mesh = tet_mesh_of(mesh);
  run<RemeshCall>(call, remesh, progress);
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

struct CheckCall : Call {
  TetMesh mesh;
  CheckReport report;
};

py::object check_mesh(const py::dict& mesh, const py::list& against, const py::dict& options) {
  const auto call = new_call<CheckCall>(against, options);
  call->mesh = tet_mesh_of(mesh);
  run<CheckCall>(call, [](CheckCall& own, Watch& watch) {
    read(own, watch);
    watch.begin_stage("check");
    own.report = files::check_against(own.mesh, *own.input, own.options, watch.execution());
    watch.stop_if_asked();
  });
  return parsed(report::check_json(call->report));
}

struct ComplexCall : Call {
  PlcSummary summary;
};

py::object info(const py::list& inputs, const py::dict& options) {
  const auto call = new_call<ComplexCall>(inputs, options);
  run<ComplexCall>(call, [](ComplexCall& own, Watch& watch) {
    try {
      build(own, watch);
    } catch (const PlcError&) {
      own.options.complex.require_solid = false;
      build(own, watch);
    }
    own.summary = summarize(own.plc, own.options.mesh.bounds.crease_angle);
  });
  nlohmann::ordered_json json{{"complex", report::complex_json(call->plc, call->summary)},
                              {"repair", report::repair_json(call->input->repaired())}};
  return parsed(json);
}

struct PredictCall : Call {
  std::vector<double> sizes;
  std::vector<Prediction> predictions;
};

py::object predicted(const py::list& inputs, const std::vector<double>& sizes, const py::dict& options) {
  const auto call = new_call<PredictCall>(inputs, options);
  call->sizes = sizes;
  run<PredictCall>(call, [](PredictCall& own, Watch& watch) {
    build(own, watch);
    adapt(own.plc, own.options, &*own.input, own.options);
    own.predictions = predict(own.plc, own.options, own.sizes);
  });
  return parsed(report::predictions_json(call->predictions));
}

py::object measures(const py::dict& arrays) {
  const TetMesh mesh = tet_mesh_of(arrays);
  nlohmann::ordered_json json = report::measures_json(mesh, measure_mesh(mesh));
  json["median_edge"] = median_edge(mesh);
  return parsed({{"mesh", json}});
}

py::list repaired(const py::list& inputs, const py::dict& options, py::list& messages) {
  const auto call = new_call<Call>(inputs, options);
  run<Call>(call, build);
  py::list soups;
  for (const PolygonSoup& soup : call->input->soups()) soups.append(arrays_of(soup));
  for (const std::string& line : describe(call->input->repaired())) messages.append(line);
  return soups;
}

struct ConvertCall : Call {
  std::string output;
  std::string told;
};

/// Joins surfaces into one file without repairing them. Returns a text on what was welded, merged and
/// dropped.
std::string convert_surfaces(const py::list& inputs, const std::string& output, const py::dict& options) {
  const auto call = new_call<ConvertCall>(inputs, options);
  call->output = output;
  run<ConvertCall>(call, [](ConvertCall& own, Watch& watch) {
    read(own, watch);
    const report::MergedSoup merged = report::merge_for_output(
        own.input->soups(), own.output, own.options.output_format, own.options.complex);
    files::write_surface(own.output, merged.soup, own.options.output_format);
    own.told = merged.told;
  });
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
  const auto ghosts = ghost_cells ? GhostCells::one_layer : GhostCells::off;
  run_watched([mesh, path, format, ghosts](Watch&) { io::write_tet_mesh(path, *mesh, format, ghosts); },
              py::none(), 0);
}

/// Returns the partition of each tet.
py::array partition_mesh(const py::dict& arrays, unsigned partitions) {
  const auto mesh = std::make_shared<TetMesh>(tet_mesh_of(arrays));
  run_watched([mesh, partitions](Watch&) { partition(*mesh, partitions); }, py::none(), 0);
  return partition_array(*mesh);
}

/// Adds the data that a mesh of another program lacks.
py::dict complete(const py::dict& arrays) {
  TetMesh mesh = tet_mesh_of(arrays);
  io::complete_mesh("the mesh", mesh);
  return arrays_of(std::move(mesh));
}

/// Returns (tet or -1, barycentric coordinates, nearest point or -1) for each place.
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
