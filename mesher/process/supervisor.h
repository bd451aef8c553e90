#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "process/exit_code.h"

namespace collarmesh::process {

/// Runs a command in a child of this process, which only watches it. CAD files make OpenCASCADE crash, or go
/// on without an end; then the child dies, and this process says in what file and at what, removes what is
/// unfinished and has the exit code for it. Signals that ask to stop are passed on; the child dies with this
/// process. Where no child can be made the command runs here. Precondition: there is one thread. Cost: a
/// millisecond, whatever the command takes.
ExitCode run_supervised(const std::function<ExitCode()>& command);

/// OpenCASCADE is at work on a file, as long as this lives: "cutting faces into triangles".
/// Where one begins while another lives, the inner one counts; they are made by one thread.
class CadWork {
 public:
  /// It may take so many seconds, unless the process has a limit of its own; 0: any time.
  CadWork(std::string_view doing, std::string_view file, double seconds = 0);
  ~CadWork();
  CadWork(const CadWork&) = delete;
  CadWork& operator=(const CadWork&) = delete;
};

/// For the supervisor: the process has to be over so many seconds from now; 0: any time.
void supervise_time(double seconds);

/// For the supervisor: this folder is to be removed where the process dies.
void supervise_folder(std::string_view folder);

}  // namespace collarmesh::process
