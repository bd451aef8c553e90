#pragma once

#include <string>

namespace collarmesh {

/// Returns a function of a module, a shared library that is loaded on first use, because other runs do not
/// need its libraries. If it cannot be loaded, returns null, and `reason` says why and what to do.
void* module_function(const char* module, const char* function, std::string& reason);

}  // namespace collarmesh
