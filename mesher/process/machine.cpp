#include "process/machine.h"

#include <unistd.h>

#include <algorithm>
#include <fstream>

namespace collarmesh::process {

std::size_t memory_of_the_machine() {
  auto bytes =
      static_cast<std::size_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  std::size_t allowed = 0;
  // Control groups version 2; the file holds "max" if there is no limit.
  if (std::ifstream("/sys/fs/cgroup/memory.max") >> allowed && allowed > 0) bytes = std::min(bytes, allowed);
  return bytes;
}

}  // namespace collarmesh::process
