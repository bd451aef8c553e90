#include "check_command.h"

#include <fmt/format.h>

#include "complex_input.h"
#include "input_files.h"
#include "interrupt.h"
#include "report.h"

namespace collarmesh::cli {

ExitCode check_command(const CheckArguments& arguments) {
  const TetMesh mesh = read_mesh(arguments.mesh);
  ComplexInput input(arguments.inputs, {}, [&](double diagonal) {
    return arguments.check.distance > 0 ? arguments.check.distance : default_distance(0, diagonal);
  });
  const Plc plc = input.build(arguments.complex);
  stop_if_interrupted();
  CheckOptions options = arguments.check;
  options.crease_angle = arguments.complex.crease_angle;
  CheckReport report = check(mesh, plc, options);
  for (const std::string& repair : describe(input.repaired()))
    report.notes.push_back("the input was repaired: " + repair);
  if (arguments.json)
    fmt::print("{}\n", check_json(report).dump(1));
  else
    fmt::print("{}", check_text(report));
  return report.passed() ? ExitCode::success : ExitCode::guarantee_missed;
}

}  // namespace collarmesh::cli
