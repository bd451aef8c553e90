#pragma once

#include <cstddef>

namespace collarmesh::repairing {

/// Number of places that the report lists for each kind of change; further ones are only counted.
inline constexpr std::size_t most_places = 100;

}  // namespace collarmesh::repairing
