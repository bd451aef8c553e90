#include "common/module_function.h"

#include <dlfcn.h>
#include <fmt/format.h>

namespace collarmesh {

void* module_function(const char* module, const char* function, std::string& reason) {
  // Searches along the run path. Never closes the module: HDF5 registers functions that run at the end of the
  // program.
  void* const loaded = dlopen(module, RTLD_NOW | RTLD_LOCAL);
  void* const found = loaded == nullptr ? nullptr : dlsym(loaded, function);
  if (found == nullptr)
    reason = fmt::format(
        "{} cannot be loaded ({}); install it with the program or name its folder in LD_LIBRARY_PATH", module,
        dlerror());
  return found;
}

}  // namespace collarmesh
