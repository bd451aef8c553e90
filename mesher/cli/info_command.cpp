#include "info_command.h"

#include <fmt/format.h>

#include <chrono>

#include "collarmesh/error.h"
#include "collarmesh/predict.h"
#include "complex_input.h"
#include "console.h"
#include "input_files.h"
#include "interrupt.h"
#include "machine.h"
#include "mesh_groups.h"
#include "out_of_memory.h"
#include "report.h"

namespace collarmesh::cli {

namespace {

void print_mesh(const TetMesh& mesh, bool as_json) {
  stop_if_interrupted();
  const MeshMeasures measures = measure_mesh(mesh);
  const double median = median_edge(mesh);
  if (!as_json) {
    print_result(
        fmt::format("{}  median edge {:.6g}\n{}", mesh_text(mesh, measures), median, groups_text(mesh)));
    return;
  }
  nlohmann::ordered_json json{{"mesh", measures_json(mesh, measures)}};
  json["mesh"]["median_edge"] = median;
  json["mesh"]["patch_list"] = groups_json(patches_of(mesh), "triangles", "area");
  json["mesh"]["curve_list"] = groups_json(curves_of(mesh), "edges", "length");
  print_result(json_text(json, 1) + "\n");
}

/// The complex that would be meshed; what bounds no region, and cannot be repaired so that it does, is one
/// here, too.
Plc build_any(ComplexInput& input, const RunOptions& options) {
  try {
    return input.build(options.complex, options.repair);
  } catch (const PlcError&) {
    PlcOptions any = options.complex;
    any.require_solid = false;
    return input.build(any, options.repair);
  }
}

/// `read`: seconds that reading and building the complex took, as they will again.
std::vector<Prediction> predictions(const InfoArguments& arguments, const Plc& plc, double read) {
  if (arguments.predicted_sizes.empty()) return {};
  PipelineOptions options = arguments;
  if (!arguments.size_field_file.empty())
    options.mesh.size_field = read_size_field(arguments.size_field_file, plc);
  stop_if_interrupted();
  std::vector<Prediction> result = predict(plc, options, arguments.predicted_sizes);
  for (Prediction& prediction : result) prediction.seconds += read;
  return result;
}

void print_complex(const InfoArguments& arguments) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  ComplexInput input(arguments.inputs, interruptible({.format = {},
                                                      .overlap = arguments.overlap,
                                                      .threads = arguments.mesh.threads,
                                                      .names = arguments.names,
                                                      .given_names = arguments.given_names}));
  const Plc plc = build_any(input, arguments);
  stop_if_interrupted();
  const double read = std::chrono::duration<double>(Clock::now() - begin).count();
  const std::vector<Prediction> predicted = predictions(arguments, plc, read);
  const PlcSummary summary = summarize(plc, arguments.mesh.bounds.crease_angle);
  const GroupNames names = input.has_cad() ? GroupNames::cad : GroupNames::complex;
  if (arguments.json) {
    nlohmann::ordered_json json{{"complex", complex_json(plc, summary, names, input.colours())},
                                {"repair", repair_json(input.repaired())}};
    if (!predicted.empty()) json["predictions"] = predictions_json(predicted);
    print_result(json_text(json, 1) + "\n");
  } else {
    print_result(repair_text(input.repaired()) + complex_text(plc, summary, names) +
                 predictions_text(predicted) + warnings_text(plc));
  }
}

}  // namespace

ExitCode info_command(const InfoArguments& arguments) {
  set_time_limit(arguments.mesh.time_limit);
  limit_memory(memory_of_the_machine() / 2);
  const std::string& first = arguments.inputs.front();
  const std::optional<TetMesh> mesh = read_mesh_if_there(first);
  if (!mesh)
    print_complex(arguments);
  else if (!arguments.predicted_sizes.empty())
    throw OptionError(
        fmt::format("--predict: {} is a mesh already; name the surface or CAD file to be meshed", first));
  else if (arguments.inputs.size() == 1)
    print_mesh(*mesh, arguments.json);
  else
    throw OptionError(
        fmt::format("{} is a mesh, of which info tells about one at a time; name it alone", first));
  return ExitCode::success;
}

}  // namespace collarmesh::cli
