#pragma once

#include <petscsys.h>

#include <cstdint>
#include <functional>
#include <numeric>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

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

/// A collector of PETSc's message about its first error, in one line. While it exists, PETSc prints
/// nothing.
class PetscMessages {
 public:
  PetscMessages();
  ~PetscMessages();
  PetscMessages(const PetscMessages&) = delete;
  PetscMessages& operator=(const PetscMessages&) = delete;
};

/// Throws PetscOutOfMemory if memory ran out, else PetscFailure; both with PETSc's message.
[[noreturn]] void fail(PetscErrorCode code);
inline void call(PetscErrorCode code) {
  if (code != 0) fail(code);
}

/// Does work on each rank; the work must not be collective. If it throws on some ranks, all ranks throw the
/// exception of the first of these, with its message: of the same class if that is one of collarmesh/error.h
/// or std::bad_alloc. Waiting for other ranks takes no processor time.
void agree(MPI_Comm communicator, const std::function<void()>& work);

/// A rank and the number of ranks.
struct Ranks {
  explicit Ranks(MPI_Comm communicator) {
    MPI_Comm_rank(communicator, &rank);
    MPI_Comm_size(communicator, &count);
  }
  int rank = 0, count = 1;
};

/// Returns, on all ranks, the text of the rank `from`.
std::string broadcast(MPI_Comm communicator, std::string text, int from = 0);

/// Returns, on all ranks, the values of all ranks, rank by rank. Values: a text, or a vector of plain values.
template <class Values>
Values gathered(MPI_Comm communicator, const Values& own) {
  constexpr std::size_t bytes = sizeof(typename Values::value_type);
  static_assert(std::is_trivially_copyable_v<typename Values::value_type>);
  const int size = static_cast<int>(bytes * own.size());
  std::vector<int> sizes(static_cast<std::size_t>(Ranks(communicator).count)), begins(sizes.size());
  MPI_Allgather(&size, 1, MPI_INT, sizes.data(), 1, MPI_INT, communicator);
  std::exclusive_scan(sizes.begin(), sizes.end(), begins.begin(), 0);
  Values all(static_cast<std::size_t>(begins.back() + sizes.back()) / bytes, typename Values::value_type{});
  MPI_Allgatherv(own.data(), size, MPI_BYTE, all.data(), sizes.data(), begins.data(), MPI_BYTE, communicator);
  return all;
}

double all_reduce(MPI_Comm communicator, double value, MPI_Op operation);
std::int64_t all_reduce(MPI_Comm communicator, std::int64_t value, MPI_Op operation);
std::uint64_t all_reduce(MPI_Comm communicator, std::uint64_t value, MPI_Op operation);

}  // namespace collarmesh::distributed
