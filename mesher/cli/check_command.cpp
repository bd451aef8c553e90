#include "check_command.h"

#include <fmt/format.h>

#include "complex_input.h"
#include "console.h"
#include "input_files.h"
#include "interrupt.h"
#include "machine.h"
#include "out_of_memory.h"
#include "report.h"

namespace collarmesh::cli {

ExitCode check_command(const CheckArguments& arguments) {
  set_time_limit(arguments.time_limit);
  limit_memory(memory_of_the_machine() / 2);
  const TetMesh mesh = read_mesh(arguments.mesh);
  const auto distance = [&](double diagonal) {
    return arguments.check.distance > 0 ? arguments.check.distance : default_distance(0, diagonal);
  };
  ComplexInput input(arguments.inputs, interruptible({{}, distance, arguments.complex.overlap}));
  const Plc plc = input.build(arguments.complex);
  stop_if_interrupted();
  CheckOptions options = arguments.check;
  options.crease_angle = arguments.complex.crease_angle;
  CheckReport report = check(mesh, plc, options);
  if (input.repaired().repaired)
    report.notes.emplace_back(
        "the mesh was judged against the repaired complex, and that against the input:");
  for (const std::string& repair : describe(input.repaired()))
    report.notes.push_back("the input was repaired: " + repair);
  if (arguments.json)
    print_result(json_text(check_json(report), 1) + "\n");
  else
    print_result(check_text(report));
  return report.passed() ? ExitCode::success : ExitCode::guarantee_missed;
}

}  // namespace collarmesh::cli
