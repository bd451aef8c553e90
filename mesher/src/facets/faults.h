#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "collarmesh/error.h"

namespace collarmesh::facets {

/// The faults found so far: keeps the first ones of each kind and counts all.
class Faults {
 public:
  void add(PlcFault::Kind kind, std::string message, std::vector<Index> points, const Point& where);

  bool empty() const { return faults_.empty(); }
  /// Is another fault of this kind only counted?
  bool full(PlcFault::Kind kind) const { return counts_[static_cast<std::size_t>(kind)] >= listed_per_kind; }

  /// The first ones of each kind.
  const std::vector<PlcFault>& list() const { return faults_; }

  /// Throws PlcError, if there is any fault.
  void raise() const;

 private:
  static constexpr std::size_t listed_per_kind = 50;
  static constexpr std::size_t kinds = 8;

  std::vector<PlcFault> faults_;
  std::array<std::size_t, kinds> counts_{};
};

/// A point for messages.
std::string text(const Point& p);

}  // namespace collarmesh::facets
