#pragma once

#include <string>

namespace collarmesh {

/// Returns a function of a module: a shared library that is loaded on first use, so that runs without it do
/// not need its dependencies. If it cannot be loaded, returns null and sets `reason` to the cause and the
/// remedy.
void* module_function(const char* module, const char* function, std::string& reason);

}  // namespace collarmesh
