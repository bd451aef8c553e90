#pragma once

#include "process/exit_code.h"

namespace collarmesh::distributed {

/// `mpirun -n P collarmesh-mpi INPUT... -o OUT.h5`, on each rank: all of them return the same, and one of
/// them says what is wrong. Initializes MPI and PETSc and finalizes them.
process::ExitCode run(int argc, char** argv);

}  // namespace collarmesh::distributed
