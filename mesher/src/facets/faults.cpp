#include "facets/faults.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace collarmesh::facets {

namespace {

// Returns the rank of a kind of fault: kinds that make others meaningless come first.
int rank(PlcFault::Kind kind) {
  using Kind = PlcFault::Kind;
  switch (kind) {
    case Kind::bad_point: return 0;
    case Kind::non_planar_polygon: return 1;
    case Kind::degenerate_facet: return 2;
    case Kind::duplicate_points: return 3;
    case Kind::intersection: return 4;
    case Kind::not_orientable: return 5;
    case Kind::open_boundary: return 6;
    case Kind::empty: return 7;
  }
  return 8;
}

}  // namespace

void Faults::add(PlcFault::Kind kind, std::string message, std::vector<Index> points, const Point& where) {
  if (!full(kind)) faults_.push_back({kind, std::move(message), std::move(points), where});
  ++counts_[static_cast<std::size_t>(kind)];
}

void Faults::raise() const {
  if (faults_.empty()) return;
  std::vector<PlcFault> sorted = faults_;
  std::ranges::stable_sort(sorted,
                           [](const PlcFault& a, const PlcFault& b) { return rank(a.kind) < rank(b.kind); });
  const std::size_t others = std::accumulate(counts_.begin(), counts_.end(), std::size_t{0}) - 1;
  std::string message = sorted.front().message;
  if (others > 0) message += fmt::format(" ({} other fault{} found.)", others, others == 1 ? "" : "s");
  throw PlcError(message, std::move(sorted));
}

std::string text(const Point& p) { return fmt::format("({:.9g}, {:.9g}, {:.9g})", p.x, p.y, p.z); }

}  // namespace collarmesh::facets
