#pragma once

namespace collarmesh::process {

/// What the program tells its caller. 0 and 7 write the mesh, the others write nothing.
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
