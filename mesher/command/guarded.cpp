#include "command/guarded.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <new>
#include <string>
#include <string_view>
#include <system_error>

#include "collarmesh/error.h"

namespace collarmesh::command {

using process::ExitCode;

namespace {

ExitCode fail(process::Process& process, ExitCode code, const std::string& message,
              const PlcError* faults = nullptr) {
  process.console.tell("collarmesh: {}\n", message);
  process.reports.failed(code, message, faults);
  return code;
}

ExitCode fail(process::Process& process, const PlcError& error) {
  constexpr std::size_t listed = 10;
  fail(process, ExitCode::invalid_complex, error.what(), &error);
  const std::string_view said = error.what();
  for (std::size_t k = 0; k < std::min(error.faults.size(), listed); ++k)
    if (said.find(error.faults[k].message) == std::string_view::npos)
      process.console.tell("  {}\n", error.faults[k].message);
  if (error.faults.size() > listed) process.console.tell("  ... and {} more\n", error.faults.size() - listed);
  return ExitCode::invalid_complex;
}

ExitCode fail_without_threads(process::Process& process) {
  return fail(process, ExitCode::budget_hit,
              "no thread can be made; nothing was written; raise the limit on threads or memory");
}

// Returns whether TBB failed to create a thread; only the exception's message tells this.
bool is_of_threads(const std::exception& error) {
  return std::string_view(error.what()).find("pthread_create") != std::string_view::npos;
}

}  // namespace

ExitCode guarded(process::Process& process, const std::function<ExitCode()>& command) {
  try {
    return command();
  } catch (const OptionError& error) {
    return fail(process, ExitCode::usage, error.what());
  } catch (const ReadError& error) {
    return fail(process, ExitCode::unreadable, error.what());
  } catch (const PlcError& error) {
    return fail(process, error);
  } catch (const WriteError& error) {
    return fail(process, ExitCode::cannot_write, error.what());
  } catch (const process::Stopped& stopped) {
    return fail(process, stopped.code, stopped.what());
  } catch (const std::bad_alloc&) {
    return fail(
        process, ExitCode::budget_hit,
        "the memory is used up; nothing was written; raise --max-memory, or --size for a coarser mesh");
  } catch (const std::system_error& error) {
    return error.code() == std::errc::resource_unavailable_try_again
               ? fail_without_threads(process)
               : fail(process, ExitCode::cannot_write, error.what());
  } catch (const std::exception& error) {
    if (is_of_threads(error)) return fail_without_threads(process);
    return fail(
        process, ExitCode::internal_error,
        fmt::format("internal error: {}; please report it with the input and the options", error.what()));
  }
}

}  // namespace collarmesh::command
