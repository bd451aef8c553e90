#pragma once

namespace collarmesh::process {

/// The exit codes. The mesh is written with codes 0 and 7 only; with 7 not if it has elements that no solver
/// can use, unless --keep-invalid is given.
enum class ExitCode {
  success = 0,
  internal_error = 1,
  usage = 2,
  unreadable = 3,
  invalid_complex = 4,
  budget_hit = 5,
  cancelled = 6,
  guarantee_missed = 7,
  cannot_write = 8
};

}  // namespace collarmesh::process
