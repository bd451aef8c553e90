#include "check_command.h"

#include <fmt/format.h>

#include "check_against.h"
#include "console.h"
#include "input_files.h"
#include "interrupt.h"
#include "machine.h"
#include "out_of_memory.h"
#include "report.h"

namespace collarmesh::cli {

ExitCode check_command(const CheckArguments& arguments) {
  set_time_limit(arguments.mesh.time_limit);
  limit_memory(memory_of_the_machine() / 2);
  TetMesh mesh = read_mesh(arguments.mesh_path);
  for (Point& p : mesh.points) p = p / arguments.scale;
  const auto distance = [&](double diagonal) {
    return arguments.mesh.bounds.distance > 0 ? arguments.mesh.bounds.distance
                                              : default_distance(0, diagonal, mesh.order());
  };
  const auto tolerance = [&](const Plc& plc) {
    return tolerance_of(plc, arguments.mesh.bounds, 0, mesh.order());
  };
  ComplexInput input(arguments.inputs, interruptible({{},
                                                      distance,
                                                      tolerance,
                                                      arguments.overlap,
                                                      arguments.mesh.threads,
                                                      arguments.names,
                                                      arguments.given_names}));
  Execution execution;
  execution.cancel = &interrupt_flag();
  const CheckReport report = check_against(mesh, input, arguments, execution);
  stop_if_interrupted();
  if (arguments.json)
    print_result(json_text(check_json(report), 1) + "\n");
  else
    print_result(check_text(report));
  return report.passed() ? ExitCode::success : ExitCode::guarantee_missed;
}

}  // namespace collarmesh::cli
