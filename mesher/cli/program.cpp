#include "program.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>
#include <variant>

#include "arguments.h"
#include "check_command.h"
#include "collarmesh/error.h"
#include "convert_command.h"
#include "info_command.h"
#include "interrupt.h"
#include "mesh_command.h"
#include "repair_command.h"

namespace collarmesh::cli {

namespace {

struct Execute {
  ExitCode operator()(const MeshArguments& arguments) const { return mesh_command(arguments); }
  ExitCode operator()(const CheckArguments& arguments) const { return check_command(arguments); }
  ExitCode operator()(const InfoArguments& arguments) const { return info_command(arguments); }
  ExitCode operator()(const ConvertArguments& arguments) const { return convert_command(arguments); }
  ExitCode operator()(const RepairArguments& arguments) const { return repair_command(arguments); }
};

ExitCode fail(ExitCode code, const std::string& message) {
  fmt::print(stderr, "collarmesh: {}\n", message);
  return code;
}

ExitCode fail(const PlcError& error) {
  constexpr std::size_t listed = 10;
  fail(ExitCode::invalid_complex, error.what());
  const std::string_view said = error.what();
  for (std::size_t k = 0; k < std::min(error.faults.size(), listed); ++k)
    if (said.find(error.faults[k].message) == std::string_view::npos)
      fmt::print(stderr, "  {}\n", error.faults[k].message);
  if (error.faults.size() > listed) fmt::print(stderr, "  ... and {} more\n", error.faults.size() - listed);
  return ExitCode::invalid_complex;
}

}  // namespace

ExitCode guarded(const std::function<ExitCode()>& command) {
  try {
    return command();
  } catch (const OptionError& error) {
    return fail(ExitCode::usage, error.what());
  } catch (const ReadError& error) {
    return fail(ExitCode::unreadable, error.what());
  } catch (const PlcError& error) {
    return fail(error);
  } catch (const WriteError& error) {
    return fail(ExitCode::cannot_write, error.what());
  } catch (const Stopped& stopped) {
    return fail(stopped.code, stopped.what());
  } catch (const std::bad_alloc&) {
    return fail(
        ExitCode::budget_hit,
        "the memory is used up; raise --size for a coarser mesh, or set --max-memory to stop earlier");
  } catch (const std::exception& error) {
    return fail(
        ExitCode::internal_error,
        fmt::format("internal error: {}; please report it with the input and the options", error.what()));
  }
}

int run(int argc, const char* const* argv) {
  const std::variant<Arguments, ExitCode> parsed = parse(argc, argv);
  if (const ExitCode* code = std::get_if<ExitCode>(&parsed)) return static_cast<int>(*code);
  install_interrupt_handlers();
  return static_cast<int>(run_interruptible(
      [&] { return guarded([&] { return std::visit(Execute(), std::get<Arguments>(parsed)); }); }));
}

}  // namespace collarmesh::cli
