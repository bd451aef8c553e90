#pragma once

#include <cstddef>

namespace collarmesh::report {

/// Number of lines after which lists in texts are cut off; --json has all.
inline constexpr std::size_t listed = 20;

}  // namespace collarmesh::report
