#pragma once

namespace collarmesh::process {

/// The program's exit codes. The mesh is written with codes 0 and 7 only, and with 7 only if its elements are
/// usable (or with --keep-invalid).
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
