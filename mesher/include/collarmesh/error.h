#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "collarmesh/geometry.h"

/// Errors for faults of the user's input. Each names the entity, its coordinates and what to do next. Faults
/// of our own are asserts; cancellation and spent budgets are statuses of the result.
namespace collarmesh {

struct Error : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A file that cannot be read: missing, truncated, malformed. The message starts with the path and the line
/// or byte.
struct ReadError : Error {
  using Error::Error;
};

/// A file that cannot be written.
struct WriteError : Error {
  using Error::Error;
};

/// One fault of a complex.
struct PlcFault {
  enum class Kind {
    duplicate_points,
    degenerate_facet,
    non_planar_polygon,
    intersection,    ///< two features meet outside a common feature
    not_orientable,  ///< the facets cannot be oriented consistently
    open_boundary,   ///< a region was asked for and its boundary is open
    empty,           ///< nothing to mesh
    bad_point        ///< a coordinate is not finite or an index is out of range
  };
  Kind kind;
  std::string message;        ///< full sentence: entities, coordinates, what to do next
  std::vector<Index> points;  ///< indices of the complex's points concerned
  Point where;                ///< a place to look at, input units
};

/// A complex that is not a PLC. Carries every fault found (the first ones if there are very many).
struct PlcError : Error {
  PlcError(const std::string& message, std::vector<PlcFault> faults_found)
      : Error(message), faults(std::move(faults_found)) {}
  std::vector<PlcFault> faults;
};

/// Options that contradict each other or are out of range.
struct OptionError : Error {
  using Error::Error;
};

}  // namespace collarmesh
