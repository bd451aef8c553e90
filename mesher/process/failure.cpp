#include "process/failure.h"

#include <atomic>

namespace collarmesh::process {

namespace {
std::atomic<FailureHandler> handler{nullptr};
}

void on_failure(FailureHandler wanted) { handler.store(wanted); }

void failed(ExitCode code, std::string_view message) {
  if (const FailureHandler handle = handler.load(); handle != nullptr) handle(code, message);
}

}  // namespace collarmesh::process
