#pragma once

#include <string_view>

namespace collarmesh::io {

/// The first line of our own files, in which the reference of a tet is the index of its region.
constexpr std::string_view medit_signature = "# Written by collarmesh.\n";

}  // namespace collarmesh::io
