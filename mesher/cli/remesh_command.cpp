#include "commands.h"

#include <optional>
#include <utility>

#include "collarmesh/error.h"
#include "collarmesh/io/size_field_io.h"
#include "collarmesh/remesh.h"
#include "command/interruptible.h"
#include "files/complex_input.h"
#include "files/input_files.h"

namespace collarmesh::cli {

namespace {

void adapt(const RemeshArguments& arguments, const files::ComplexInput* input, const Plc& plc,
           PipelineOptions& options) {
  if (!arguments.size_field_file.empty())
    options.mesh.size_field = io::read_size_field(arguments.size_field_file, plc);
  if (input == nullptr || !input->has_cad()) return;
  options.exact = input->exact_geometry(plc);
  options.exact_measures = input->exact_measures(plc);
}

files::ComplexInput read_complex(process::Process& process, const RemeshArguments& arguments) {
  files::InputReading reading;
  reading.distance = [&](double diagonal) { return distance_of(arguments, diagonal); };
  reading.tolerance = [&](const Plc& plc) {
    return tolerance_of(plc, arguments.mesh.bounds, arguments.mesh.size, static_cast<int>(arguments.order));
  };
  reading.order = static_cast<int>(arguments.order);
  reading.threads = arguments.mesh.threads;
  return files::ComplexInput(arguments.against, interruptible(process, std::move(reading)));
}

void remesh_file(process::Process& process, const RemeshArguments& arguments, Stages& stages,
                 report::MeshRun& run) {
  const TetMesh mesh = files::read_mesh(arguments.inputs.front(), arguments.input_format);
  PipelineOptions options = arguments;
  options.mesh.time_limit = 0;  // the interrupt flag limits the whole run, from reading to writing
  Execution execution;
  execution.cancel = &process.interrupts.flag();
  execution.progress = [&](const ProgressReport& report) {
    stages.update(report);
    return true;
  };
  std::optional<files::ComplexInput> input;
  if (!arguments.against.empty()) input.emplace(read_complex(process, arguments));
  const auto adapted = [&](const Plc& plc, PipelineOptions& o) {
    adapt(arguments, input ? &*input : nullptr, plc, o);
  };
  RemeshResult made =
      input ? remesh(mesh, input->build(arguments.complex, arguments.repair), options, adapted, execution)
            : remesh(mesh, options, adapted, execution);
  run.remeshing = made.remeshing;
  static_cast<SoupPipelineResult&>(run) = std::move(made);
  if (run.result.status == MeshStatus::cancelled) process.interrupts.stop_if_asked();
  if (run.result.status == MeshStatus::budget_hit)
    throw process::Stopped(process::ExitCode::budget_hit, run.result.message + "; nothing was written");
  run.summary = summarize(run.plc, arguments.mesh.bounds.crease_angle);
}

}  // namespace

ExitCode remesh_command(process::Process& process, const RemeshArguments& arguments) {
  return make_and_write(process, arguments, [&](Stages& stages, report::MeshRun& run) {
    remesh_file(process, arguments, stages, run);
  });
}

}  // namespace collarmesh::cli
