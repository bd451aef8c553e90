#include "process/machine.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>

namespace collarmesh::process {

namespace {

/// Returns the size in bytes of this process's data and stacks; allocates nothing.
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

std::size_t memory_of_the_machine() {
  auto bytes =
      static_cast<std::size_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  std::size_t allowed = 0;
  // Control groups version 2; the file holds "max" if there is no limit.
  if (std::ifstream("/sys/fs/cgroup/memory.max") >> allowed && allowed > 0) bytes = std::min(bytes, allowed);
  return bytes;
}

void limit_memory(std::size_t bytes) {
  // RLIMIT_DATA also counts memory that is reserved for threads' stacks but not used.
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
