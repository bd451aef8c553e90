#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "collarmesh/error.h"

namespace collarmesh::facets {

/// The faults found so far. Keeps the first ones of each kind and counts all.
class Faults {
 public:
  void add(PlcFault::Kind kind, std::string message, std::vector<Index> points, const Point& where);

  bool empty() const { return faults_.empty(); }
  /// Returns whether further faults of this kind are counted but not kept.
  bool full(PlcFault::Kind kind) const { return counts_[static_cast<std::size_t>(kind)] >= listed_per_kind; }

  /// Returns the kept faults.
  const std::vector<PlcFault>& list() const { return faults_; }

  /// Throws PlcError if there is a fault.
  void raise() const;

 private:
  static constexpr std::size_t listed_per_kind = 50;
  static constexpr std::size_t kinds = 8;

  std::vector<PlcFault> faults_;
  std::array<std::size_t, kinds> counts_{};
};

/// Returns a point as text for messages.
std::string text(const Point& p);

}  // namespace collarmesh::facets
