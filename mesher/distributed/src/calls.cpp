#include "calls.h"

#include <fmt/format.h>

#include <chrono>
#include <exception>
#include <new>
#include <string>
#include <string_view>
#include <thread>

namespace collarmesh::distributed {

namespace {

std::string first_message;
bool out_of_memory = false;  // whether this first error was a lack of memory

PetscErrorCode remember(MPI_Comm, int, const char* function, const char*, PetscErrorCode code,
                        PetscErrorType type, const char* message, void*) {
  if (type == PETSC_ERROR_INITIAL) {
    first_message = fmt::format("{} ({})", message != nullptr ? message : "no reason given", function);
    // If PETSc 3.18 cannot allocate, it returns the number of a line as its code.
    out_of_memory = code == PETSC_ERR_MEM || std::string_view(function).starts_with("PetscMalloc");
  }
  return code;
}

/// The class of a caught exception, from which `rethrow` on other ranks makes an equal one.
enum class Kind { nothing, option, read, plc, write, memory, petsc, other };

struct Thrown {
  Kind kind = Kind::nothing;
  std::string message;
  std::exception_ptr original;
};

Thrown caught(const std::function<void()>& work) {
  const auto thrown = [](Kind kind, const char* message) {
    return Thrown{kind, message, std::current_exception()};
  };
  try {
    work();
  } catch (const OptionError& error) {
    return thrown(Kind::option, error.what());
  } catch (const ReadError& error) {
    return thrown(Kind::read, error.what());
  } catch (const PlcError& error) {
    return thrown(Kind::plc, error.what());
  } catch (const WriteError& error) {
    return thrown(Kind::write, error.what());
  } catch (const std::bad_alloc& error) {
    return thrown(Kind::memory, error.what());
  } catch (const PetscFailure& error) {
    return thrown(Kind::petsc, error.what());
  } catch (const std::exception& error) {
    return thrown(Kind::other, error.what());
  }
  return {};
}

[[noreturn]] void rethrow(Kind kind, const std::string& message) {
  switch (kind) {
    case Kind::option: throw OptionError(message);
    case Kind::read: throw ReadError(message);
    case Kind::plc: throw PlcError(message, {});
    case Kind::write: throw WriteError(message);
    case Kind::memory: throw std::bad_alloc();
    case Kind::petsc: throw PetscFailure(message);
    default: throw std::runtime_error(message);
  }
}

/// Waits for a request without using the processor, which other ranks on the machine may need; MPI's own
/// waiting would keep it busy.
void wait_quietly(MPI_Request request) {
  using namespace std::chrono_literals;
  auto pause = 10us;
  for (int done = 0; MPI_Test(&request, &done, MPI_STATUS_IGNORE), done == 0;) {
    std::this_thread::sleep_for(pause);
    if (pause < 10ms) pause *= 2;
  }
}

}  // namespace

PetscMessages::PetscMessages() {
  first_message.clear();
  out_of_memory = false;
  PetscPushErrorHandler(remember, nullptr);
}
PetscMessages::~PetscMessages() { PetscPopErrorHandler(); }

void fail(PetscErrorCode code) {
  const char* text = nullptr;
  if (first_message.empty()) PetscErrorMessage(code, &text, nullptr);
  const std::string message = fmt::format("PETSc: {}", text != nullptr         ? text
                                                       : first_message.empty() ? "unknown error"
                                                                               : first_message);
  if (out_of_memory) throw PetscOutOfMemory(message);
  throw PetscFailure(message);
}

void agree(MPI_Comm communicator, const std::function<void()>& work) {
  const Thrown own = caught(work);
  const Ranks ranks(communicator);
  int first = own.kind == Kind::nothing ? ranks.count : ranks.rank;
  MPI_Request request = MPI_REQUEST_NULL;
  int least = first;
  MPI_Iallreduce(&first, &least, 1, MPI_INT, MPI_MIN, communicator, &request);
  wait_quietly(request);
  if (least == ranks.count) return;
  int kind = static_cast<int>(own.kind);
  MPI_Bcast(&kind, 1, MPI_INT, least, communicator);
  const std::string message = broadcast(communicator, own.message, least);
  if (least == ranks.rank) std::rethrow_exception(own.original);
  rethrow(static_cast<Kind>(kind), message);
}

std::string broadcast(MPI_Comm communicator, std::string text, int from) {
  int length = static_cast<int>(text.size());
  MPI_Bcast(&length, 1, MPI_INT, from, communicator);
  text.resize(static_cast<std::size_t>(length));
  MPI_Bcast(text.data(), length, MPI_CHAR, from, communicator);
  return text;
}

double all_reduce(MPI_Comm communicator, double value, MPI_Op operation) {
  MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_DOUBLE, operation, communicator);
  return value;
}
std::int64_t all_reduce(MPI_Comm communicator, std::int64_t value, MPI_Op operation) {
  MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_INT64_T, operation, communicator);
  return value;
}
std::uint64_t all_reduce(MPI_Comm communicator, std::uint64_t value, MPI_Op operation) {
  MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_UINT64_T, operation, communicator);
  return value;
}

}  // namespace collarmesh::distributed
