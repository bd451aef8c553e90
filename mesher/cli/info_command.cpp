#include "commands.h"

#include <fmt/format.h>

#include "collarmesh/error.h"
#include "collarmesh/io/size_field_io.h"
#include "collarmesh/predict.h"
#include "command/interruptible.h"
#include "common/stopwatch.h"
#include "files/complex_input.h"
#include "files/input_files.h"
#include "report/json_text.h"
#include "report/mesh_groups.h"
#include "report/report.h"

namespace collarmesh::cli {

namespace {

void print_mesh(process::Process& process, const TetMesh& mesh, bool as_json) {
  process.interrupts.stop_if_asked();
  const MeshMeasures measures = measure_mesh(mesh);
  const double median = median_edge(mesh);
  if (!as_json) {
    process.console.print_result(fmt::format("{}  median edge {:.6g}\n{}", report::mesh_text(mesh, measures),
                                             median, report::groups_text(mesh)));
    return;
  }
  nlohmann::ordered_json json{{"mesh", report::measures_json(mesh, measures)}};
  json["mesh"]["median_edge"] = median;
  json["mesh"]["patch_list"] = report::groups_json(report::patches_of(mesh), "triangles", "area");
  json["mesh"]["curve_list"] = report::groups_json(report::curves_of(mesh), "edges", "length");
  process.console.print_result(report::json_text(json, 1) + "\n");
}

/// Builds the complex that would be meshed. Also accepts facets that bound no region and that repair cannot
/// close.
Plc build_any(files::ComplexInput& input, const RunOptions& options) {
  try {
    return input.build(options.complex, options.repair);
  } catch (const PlcError&) {
    PlcOptions any = options.complex;
    any.require_solid = false;
    return input.build(any, options.repair);
  }
}

/// Predicts meshes. `read` is the time in seconds that reading and building the complex took. It is added to
/// each prediction, because a run has to do this again.
std::vector<Prediction> predictions(process::Process& process, const InfoArguments& arguments, const Plc& plc,
                                    double read) {
  if (arguments.predicted_sizes.empty()) return {};
  PipelineOptions options = arguments;
  if (!arguments.size_field_file.empty())
    options.mesh.size_field = io::read_size_field(arguments.size_field_file, plc);
  process.interrupts.stop_if_asked();
  const auto told = [&](Prediction prediction) {
    prediction.seconds += read;
    const nlohmann::ordered_json line{{"prediction", report::prediction_json(prediction)}};
    if (arguments.progress == ProgressStyle::json) process.console.tell("{}\n", report::json_text(line));
  };
  std::vector<Prediction> result = predict(plc, options, arguments.predicted_sizes, told);
  for (Prediction& prediction : result) prediction.seconds += read;
  return result;
}

void print_complex(process::Process& process, const InfoArguments& arguments) {
  const Stopwatch stopwatch;
  files::ComplexInput input(arguments.inputs, interruptible(process, files::reading_of(arguments)));
  const Plc plc = build_any(input, arguments);
  process.interrupts.stop_if_asked();
  const double read = stopwatch.seconds();
  const std::vector<Prediction> predicted = predictions(process, arguments, plc, read);
  const PlcSummary summary = summarize(plc, arguments.mesh.bounds.crease_angle);
  const GroupNames names = input.has_cad() ? GroupNames::cad : GroupNames::complex;
  if (arguments.json) {
    nlohmann::ordered_json json{{"complex", report::complex_json(plc, summary, names, input.colours())},
                                {"repair", report::repair_json(input.repaired())}};
    if (!predicted.empty()) json["predictions"] = report::predictions_json(predicted);
    process.console.print_result(report::json_text(json, 1) + "\n");
  } else {
    process.console.print_result(report::repair_text(input.repaired()) +
                                 report::complex_text(plc, summary, names) +
                                 report::predictions_text(predicted) + report::warnings_text(plc));
  }
}

}  // namespace

ExitCode info_command(process::Process& process, const InfoArguments& arguments) {
  const std::string& first = arguments.inputs.front();
  const std::optional<TetMesh> mesh = files::read_mesh_if_there(first);
  if (!mesh)
    print_complex(process, arguments);
  else if (!arguments.predicted_sizes.empty())
    throw OptionError(
        fmt::format("--predict: {} is a mesh already; name the surface or CAD file to be meshed", first));
  else if (arguments.inputs.size() == 1)
    print_mesh(process, *mesh, arguments.json);
  else
    throw OptionError(fmt::format("{} is a mesh; info takes a mesh as its only input", first));
  return ExitCode::success;
}

}  // namespace collarmesh::cli
