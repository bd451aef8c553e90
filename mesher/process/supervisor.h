#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "common/deadline.h"
#include "process/exit_code.h"

namespace collarmesh::process {

/// Runs a command in a child process, which this process only watches. CAD files can make OpenCASCADE crash
/// or run forever. In that case the child dies; this process then reports the file and the operation, removes
/// unfinished files and returns the exit code of the failure. Passes signals that ask to stop on to the
/// child; the child dies with this process. Runs the command here if no child can be created. Precondition:
/// there is only one thread. Cost: about a millisecond.
ExitCode run_supervised(const std::function<ExitCode()>& command);

/// A report of work of OpenCASCADE on a file, such as "cutting faces into triangles", during its lifetime.
/// The inner one of two nested objects counts; all must be made by one thread.
class CadWork {
 public:
  /// Begins the work. It may take `seconds`, unless the process has its own limit; 0: any time.
  CadWork(std::string_view doing, std::string_view file, double seconds = 0);
  ~CadWork();
  CadWork(const CadWork&) = delete;
  CadWork& operator=(const CadWork&) = delete;
};

/// Tells the supervisor when the process must end.
void supervise_time(Deadline deadline);

/// Tells the supervisor to remove this folder if the process dies.
void supervise_folder(std::string_view folder);

}  // namespace collarmesh::process
