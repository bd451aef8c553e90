#pragma once

#include "process/process.h"

namespace collarmesh::distributed {

/// Runs `mpirun -n P collarmesh-mpi INPUT... -o OUT.h5` on each rank. All ranks return the same code, and one
/// of them prints errors. Initializes MPI and PETSc and finalizes them.
process::ExitCode run(process::Process& process, int argc, char** argv);

}  // namespace collarmesh::distributed
