#include "program.h"

#include <tbb/global_control.h>

#include <algorithm>
#include <variant>

#include "arguments.h"
#include "batch_command.h"
#include "command/guarded.h"
#include "commands.h"
#include "failure_report.h"
#include "files/cad_files.h"
#include "process/machine.h"

namespace collarmesh::cli {

namespace {

struct Execute {
  process::Process& process;
  ExitCode operator()(const MeshArguments& arguments) const { return mesh_command(process, arguments); }
  ExitCode operator()(const CheckArguments& arguments) const { return check_command(process, arguments); }
  ExitCode operator()(const InfoArguments& arguments) const { return info_command(process, arguments); }
  ExitCode operator()(const ConvertArguments& arguments) const { return convert_command(process, arguments); }
  ExitCode operator()(const RepairArguments& arguments) const { return repair_command(process, arguments); }
  ExitCode operator()(const RemeshArguments& arguments) const { return remesh_command(process, arguments); }
};

const RunOptions& options_of(const Arguments& arguments) {
  return std::visit([](const RunOptions& options) -> const RunOptions& { return options; }, arguments);
}

bool reads_cad(const Arguments& arguments) {
  return std::visit(
      [](const auto& a) {
        const auto any = [](const auto& inputs, const std::string& format) {
          return std::any_of(inputs.begin(), inputs.end(),
                             [&](const std::string& path) { return files::CadFiles::knows(path, format); });
        };
        if constexpr (requires { a.input_format; })
          return any(a.inputs, a.input_format);
        else
          return any(a.inputs, {});
      },
      arguments);
}

// Limits the number of threads of everything that uses TBB, including OpenCASCADE and code outside the
// stages' arenas. The limit is never lifted: TBB would then create all threads that were requested before.
void limit_threads(const Arguments& arguments) {
  const unsigned threads = options_of(arguments).mesh.threads;
  if (threads == 0) return;
  static const auto* const limit =
      new tbb::global_control(tbb::global_control::max_allowed_parallelism, threads);
  static_cast<void>(limit);
}

/// Runs a command. If it reads CAD files, runs it in a separate process, because OpenCASCADE may crash.
ExitCode execute(process::Process& process, const Arguments& arguments) {
  report_failures_of(process, arguments);
  const auto command = [&] {
    limit_threads(arguments);
    process.catch_signals();
    return process.run_interruptible([&] {
      return guarded(process, [&] {
        process.interrupts.set_time_limit(options_of(arguments).mesh.time_limit);
        process::limit_memory(options_of(arguments).mesh.max_memory);
        return std::visit(Execute{process}, arguments);
      });
    });
  };
  return reads_cad(arguments) ? process.supervisor.run(command) : command();
}

}  // namespace

int run(process::Process& process, int argc, const char* const* argv) {
  return static_cast<int>(guarded(process, [&] {
    const std::variant<Arguments, ExitCode> parsed = parse(process.console, argc, argv);
    if (const ExitCode* code = std::get_if<ExitCode>(&parsed)) return *code;
    const Arguments& arguments = std::get<Arguments>(parsed);
    const auto* mesh = std::get_if<MeshArguments>(&arguments);
    if (mesh == nullptr || mesh->batch.empty()) return execute(process, arguments);
    return batch_command(process, *mesh,
                         [&](const MeshArguments& part) { return execute(process, Arguments(part)); });
  }));
}

}  // namespace collarmesh::cli
