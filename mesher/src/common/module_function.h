#pragma once

#include <string>

namespace collarmesh {

/// A function of a module: a shared library that is loaded when it is first used, because other runs have no
/// need of the libraries that it brings. Null, and in `reason` why and what helps, where it cannot be loaded.
void* module_function(const char* module, const char* function, std::string& reason);

}  // namespace collarmesh
