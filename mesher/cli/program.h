#pragma once

#include "process/process.h"

namespace collarmesh::cli {

/// Runs the whole program; returns its exit code (exit_code.h).
int run(process::Process& process, int argc, const char* const* argv);

}  // namespace collarmesh::cli
