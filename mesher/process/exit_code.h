#pragma once

namespace collarmesh::process {

/// The programs' exit codes. The mesh is written with codes 0 and 7 only. With 7 it may have elements that no
/// solver can use; such a mesh is written only if --keep-invalid is given.
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
