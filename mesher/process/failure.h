#pragma once

#include <atomic>
#include <functional>
#include <string_view>
#include <utility>

#include "collarmesh/error.h"
#include "process/exit_code.h"

namespace collarmesh::process {

/// The reports that a failing command writes.
class FailureReports {
 public:
  /// A function that writes the reports. `faults` is null unless the input is no valid complex.
  using Write = std::function<void(ExitCode code, std::string_view message, const PlcError* faults)>;

  /// Makes a later failure call this function; an empty one does nothing. Precondition: there is only one
  /// thread.
  void on_failure(Write write) {
    write_ = std::move(write);
    written_ = false;
  }

  /// Writes the reports at the first call; does nothing at later calls. Ignores errors, because the caller
  /// prints the message and returns the exit code in any case. Any thread may call it, possibly when memory
  /// is used up.
  void failed(ExitCode code, std::string_view message, const PlcError* faults = nullptr) noexcept {
    if (!write_ || written_.exchange(true)) return;
    try {
      write_(code, message, faults);
    } catch (...) {
    }
  }

 private:
  Write write_;
  std::atomic<bool> written_{false};
};

}  // namespace collarmesh::process
