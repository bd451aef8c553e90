#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "process/exit_code.h"

namespace collarmesh::process {

/// Runs a command in a child of this process, which only watches it. CAD files can make OpenCASCADE crash or
/// never end; then the child dies, and this process reports the file and the operation, removes unfinished
/// files and returns the exit code for it. Signals that ask to stop are passed on; the child dies with this
/// process. If no child can be created, the command runs here. Precondition: there is one thread. Cost: about
/// a millisecond.
ExitCode run_supervised(const std::function<ExitCode()>& command);

/// Reports that OpenCASCADE works on a file, as long as this lives: "cutting faces into triangles". If one
/// begins while another lives, the inner one counts; one thread makes them.
class CadWork {
 public:
  /// Begins the work. It may take this many seconds, unless the process has its own limit; 0: any time.
  CadWork(std::string_view doing, std::string_view file, double seconds = 0);
  ~CadWork();
  CadWork(const CadWork&) = delete;
  CadWork& operator=(const CadWork&) = delete;
};

/// Tells the supervisor that the process must end within this many seconds; 0: any time.
void supervise_time(double seconds);

/// Tells the supervisor to remove this folder if the process dies.
void supervise_folder(std::string_view folder);

}  // namespace collarmesh::process
