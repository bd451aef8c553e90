#include "check_command.h"

#include <fmt/format.h>

#include "complex_input.h"
#include "input_files.h"
#include "interrupt.h"
#include "report.h"

namespace collarmesh::cli {

ExitCode check_command(const CheckArguments& arguments) {
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
    fmt::print("{}\n", check_json(report).dump(1));
  else
    fmt::print("{}", check_text(report));
  return report.passed() ? ExitCode::success : ExitCode::guarantee_missed;
}

}  // namespace collarmesh::cli
