#pragma once

namespace collarmesh::cli {

/// The whole program; returns its exit code (exit_code.h).
int run(int argc, const char* const* argv);

}  // namespace collarmesh::cli
