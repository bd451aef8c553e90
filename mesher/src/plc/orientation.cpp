#include "plc/orientation.h"

#include <fmt/format.h>

#include <span>
#include <utility>

#include "plc/edges.h"

namespace collarmesh::build {

namespace {

class Orienter {
 public:
  Orienter(Draft& draft, Index first, Index last, Faults& faults)
      : draft_(draft),
        faults_(faults),
        first_(first),
        triangles_(draft.triangles.data() + first, last - first),
        edges_(triangles_, draft.points.size()),
        turned_(triangles_.size(), unvisited) {}

  void run() {
    for (Index t = 0; t < triangles_.size(); ++t) {
      if (turned_[t] != unvisited) continue;
      collect_component(t);
      apply();
    }
  }

 private:
  static constexpr signed char unvisited = -1;

  void collect_component(Index start) {
    component_.assign(1, start);
    turned_[start] = 0;
    for (std::size_t next = 0; next < component_.size(); ++next)
      for (unsigned i = 0; i < 3; ++i) visit_across(3 * component_[next] + i);
  }

  void visit_across(Index side) {
    const auto sides = edges_.sides(edges_.edge_of(side));
    if (sides.size() != 2) return;
    const Index other = sides[0] == side ? sides[1] : sides[0];
    const bool agree = ascending(triangles_, side) != ascending(triangles_, other);
    const auto turn = static_cast<signed char>(agree ? turned_[side / 3] : 1 - turned_[side / 3]);
    if (turned_[other / 3] == unvisited) {
      turned_[other / 3] = turn;
      component_.push_back(other / 3);
    } else if (turned_[other / 3] != turn && side < other) {
      report(edges_.ends(edges_.edge_of(side)), side / 3);
    }
  }

  void report(const std::array<Index, 2>& edge, Index triangle) {
    const Point &a = draft_.points[edge[0]], &b = draft_.points[edge[1]];
    const Origin& origin = draft_.origins[first_ + triangle];
    faults_.add(
        PlcFault::Kind::not_orientable,
        fmt::format("The surface of {} around facet {} has one side only (a Moebius strip); its facets "
                    "disagree at the edge {} - {}; cut it there or remove it.",
                    draft_.soup_names[origin.soup], origin.facet, text(a), text(b)),
        {edge[0], edge[1]}, 0.5 * (a + b));
  }

  void apply() {
    std::size_t turns = 0;
    for (const Index t : component_) turns += static_cast<std::size_t>(turned_[t]);
    const signed char turn = 2 * turns > component_.size() ? 0 : 1;
    for (const Index t : component_) {
      if (turned_[t] == turn) std::swap(triangles_[t][1], triangles_[t][2]);
      draft_.origins[first_ + t].oriented = turns == 0 || turns == component_.size();
    }
  }

  Draft& draft_;
  Faults& faults_;
  Index first_;
  std::span<Corners> triangles_;
  EdgeTable edges_;
  std::vector<signed char> turned_;
  std::vector<Index> component_;
};

}  // namespace

void orient_components(Draft& draft, Faults& faults) {
  const auto count = static_cast<Index>(draft.triangles.size());
  for (Index first = 0, last = 0; first < count; first = last) {
    const Index soup = draft.origins[first].soup;
    while (last < count && draft.origins[last].soup == soup) ++last;
    Orienter(draft, first, last, faults).run();
  }
}

}  // namespace collarmesh::build
