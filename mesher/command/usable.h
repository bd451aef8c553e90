#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace collarmesh::command {

/// Throws Stopped if no solver can use a mesh that misses this guarantee. Calls `tell` before it throws.
void require_usable(
    std::string_view missed, const std::string& message, const std::function<void()>& tell = [] {});

}  // namespace collarmesh::command
