#include "commands.h"

#include <fmt/format.h>

#include <utility>

#include "command/interruptible.h"
#include "files/check_against.h"
#include "files/input_files.h"
#include "report/json_text.h"
#include "report/report.h"

namespace collarmesh::cli {

ExitCode check_command(process::Process& process, const CheckArguments& arguments) {
  TetMesh mesh = files::read_mesh_or_triangles(arguments.mesh_path);
  for (Point& p : mesh.points) p = p / arguments.scale;
  for (TetMesh::PeriodicFaces& faces : mesh.periodic)
    faces.motion.shift = faces.motion.shift / arguments.scale;
  files::InputReading reading = files::reading_of(arguments);
  reading.distance = [&](double diagonal) {
    return arguments.mesh.bounds.distance > 0 ? arguments.mesh.bounds.distance
                                              : default_distance(0, diagonal, mesh.order());
  };
  if (!mesh.tets.empty())
    reading.tolerance = [&](const Plc& plc) {
      return tolerance_of(plc, arguments.mesh.bounds, 0, mesh.order());
    };
  reading.order = static_cast<int>(mesh.order());
  files::ComplexInput input(arguments.inputs, interruptible(process, std::move(reading)));
  Execution execution;
  execution.cancel = &process.interrupts.flag();
  const CheckReport report = files::check_against(mesh, input, arguments, execution);
  process.interrupts.stop_if_asked();
  if (arguments.json)
    process.console.print_result(report::json_text(report::check_json(report), 1) + "\n");
  else
    process.console.print_result(report::check_text(report));
  return report.passed() ? ExitCode::success : ExitCode::guarantee_missed;
}

}  // namespace collarmesh::cli
