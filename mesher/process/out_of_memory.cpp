#include "process/out_of_memory.h"

#include <fcntl.h>
#include <gmp.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <exception>
#include <memory>
#include <new>
#include <string_view>

#include "process/exit_code.h"
#include "process/failure.h"
#include "process/staged_file.h"

namespace collarmesh::process {

namespace {

constexpr std::string_view program = "collarmesh: ";  // prefix of messages

/// A block that is freed when memory is used up, so that the program has some memory to end with.
std::unique_ptr<char[]> reserve;

[[noreturn]] void end(ExitCode code, std::string_view message) noexcept {
  std::set_new_handler(nullptr);
  reserve.reset();
  const bool abandoned = abandon_staged_files();
  if (!abandoned)
    code = ExitCode::success;  // the files are all in place, so the command succeeded
  else if (write(STDERR_FILENO, message.data(), message.size()) < 0) {
    // Nobody is left to report to.
  }
  if (abandoned) failed(code, message.substr(program.size(), message.find('\n') - program.size()));
  std::_Exit(static_cast<int>(code));
}

[[noreturn]] void end_for_memory() {
  end(ExitCode::budget_hit,
      "collarmesh: the memory is used up; nothing was written; raise --max-memory, or --size for a coarser "
      "mesh\n");
}

[[noreturn]] void end_for_exception() {
  try {
    if (const std::exception_ptr thrown = std::current_exception()) std::rethrow_exception(thrown);
  } catch (const std::bad_alloc&) {
    end_for_memory();
  } catch (...) {
  }
  end(ExitCode::internal_error,
      "collarmesh: internal error; please report it with the input and the options\n");
}

// GMP aborts if it gets no memory.
void* gmp_allocate(std::size_t bytes) { return ::operator new(bytes); }
void gmp_free(void* block, std::size_t) { ::operator delete(block); }
void* gmp_reallocate(void* block, std::size_t old_bytes, std::size_t bytes) {
  void* const grown = ::operator new(bytes);
  std::memcpy(grown, block, old_bytes < bytes ? old_bytes : bytes);
  ::operator delete(block);
  return grown;
}

/// Runs before this program's variables are initialized, because that takes a thousand allocations.
[[gnu::constructor(101)]] void before_all() { std::set_new_handler(end_for_memory); }

/// Returns the bytes of data without allocating.
std::size_t data_bytes() {
  const int file = open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
  if (file < 0) return 0;
  char text[256] = {};
  const bool read_any = read(file, text, sizeof(text) - 1) > 0;
  close(file);
  std::size_t data = 0;
  char* rest = text;
  // The file has numbers of pages: all, resident, shared, text, libraries, data and stacks.
  for (int field = 0; read_any && field < 6; ++field) data = std::strtoull(rest, &rest, 10);
  return data * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

}  // namespace

void end_when_memory_is_used_up() {
  constexpr std::size_t for_the_end = std::size_t{1} << 18;
  reserve = std::make_unique<char[]>(for_the_end);
  mp_set_memory_functions(gmp_allocate, gmp_reallocate, gmp_free);
  std::set_new_handler(end_for_memory);
  std::set_terminate(end_for_exception);
}

void limit_memory(std::size_t bytes) {
  // The limit counts memory reserved for threads' stacks, used or not.
  constexpr std::size_t for_stacks_and_libraries = std::size_t{48} << 20;
  rlimit limit;
  if (bytes == 0 || getrlimit(RLIMIT_DATA, &limit) != 0) return;
  const rlim_t wanted = data_bytes() + bytes + for_stacks_and_libraries;
  if (limit.rlim_cur != RLIM_INFINITY && limit.rlim_cur < wanted) return;
  limit.rlim_cur = wanted;
  setrlimit(RLIMIT_DATA, &limit);
}

bool memory_is_short() {
  rlimit limit;
  return getrlimit(RLIMIT_DATA, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY &&
         data_bytes() > limit.rlim_cur / 2;
}

}  // namespace collarmesh::process
