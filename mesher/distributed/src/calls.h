#pragma once

#include <petscsys.h>

#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>

#include "collarmesh/error.h"

/// Errors of PETSc and MPI, and errors that concern all ranks.
namespace collarmesh::distributed {

/// Thrown if a call of PETSc failed. Ranks may no longer agree then, so the program can only end.
struct PetscFailure : std::runtime_error {
  using std::runtime_error::runtime_error;
};
struct PetscOutOfMemory : PetscFailure {
  using PetscFailure::PetscFailure;
};

/// Collects PETSc's message about its first error in one line. PETSc prints nothing during its lifetime.
class PetscMessages {
 public:
  PetscMessages();
  ~PetscMessages();
  PetscMessages(const PetscMessages&) = delete;
  PetscMessages& operator=(const PetscMessages&) = delete;
};

/// Throws PetscOutOfMemory, or another PetscFailure, with PETSc's message.
[[noreturn]] void fail(PetscErrorCode code);
inline void call(PetscErrorCode code) {
  if (code != 0) fail(code);
}

/// Does work of each rank that is not collective. If it throws on some ranks, all ranks throw the exception
/// of the first of them, with its message: of the same class if that is one of collarmesh/error.h or
/// std::bad_alloc. Waiting for other ranks takes no processor time.
void agree(MPI_Comm communicator, const std::function<void()>& work);

/// A rank and the number of ranks.
struct Ranks {
  explicit Ranks(MPI_Comm communicator) {
    MPI_Comm_rank(communicator, &rank);
    MPI_Comm_size(communicator, &count);
  }
  int rank = 0, count = 1;
};

/// Returns the text or values of rank 0 on all ranks.
std::string broadcast(MPI_Comm communicator, std::string text);

double all_reduce(MPI_Comm communicator, double value, MPI_Op operation);
std::int64_t all_reduce(MPI_Comm communicator, std::int64_t value, MPI_Op operation);
std::uint64_t all_reduce(MPI_Comm communicator, std::uint64_t value, MPI_Op operation);

}  // namespace collarmesh::distributed
