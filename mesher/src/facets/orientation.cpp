#include "facets/orientation.h"

#include <fmt/format.h>

#include <utility>

namespace collarmesh::facets {

namespace {

class Orienter {
 public:
  Orienter(ComplexDraft& draft, EdgeTable& edges, Faults& faults)
      : draft_(draft), edges_(edges), faults_(faults), turned_(draft.triangles.size(), unvisited) {}

  void run() {
    if (all_agree()) return;
    for (Index t = 0; t < turned_.size(); ++t) {
      if (turned_[t] != unvisited) continue;
      collect_component(t);
      apply();
    }
  }

 private:
  static constexpr signed char unvisited = -1;

  // Returns whether no triangle needs to be turned, as in almost all files.
  bool all_agree() const {
    for (Index e = 0; e < edges_.size(); ++e)
      for (const Index side : edges_.sides(e)) {
        const Index other = across(side);
        if (other != none && ascending(draft_.triangles, side) == ascending(draft_.triangles, other))
          return false;
      }
    return true;
  }

  void collect_component(Index start) {
    component_.assign(1, start);
    turned_[start] = 0;
    for (std::size_t next = 0; next < component_.size(); ++next)
      for (unsigned i = 0; i < 3; ++i) visit_across(3 * component_[next] + i);
  }

  // Returns the other side of the same soup on the same edge; none unless there is exactly one.
  Index across(Index side) const {
    const Index soup = draft_.origins[side / 3].soup;
    Index other = none;
    for (const Index s : edges_.sides(edges_.edge_of(side))) {
      if (s == side || draft_.origins[s / 3].soup != soup) continue;
      if (other != none) return none;
      other = s;
    }
    return other;
  }

  void visit_across(Index side) {
    const Index other = across(side);
    if (other == none) return;
    const bool agree = ascending(draft_.triangles, side) != ascending(draft_.triangles, other);
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
    const Origin& origin = draft_.origins[triangle];
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
      if (turned_[t] == turn) {
        std::swap(draft_.triangles[t][1], draft_.triangles[t][2]);
        edges_.turn(t);
      }
      draft_.origins[t].oriented = turns == 0 || turns == component_.size();
    }
  }

  ComplexDraft& draft_;
  EdgeTable& edges_;
  Faults& faults_;
  std::vector<signed char> turned_;
  std::vector<Index> component_;
};

}  // namespace

void orient_components(ComplexDraft& draft, EdgeTable& edges, Faults& faults) {
  Orienter(draft, edges, faults).run();
}

}  // namespace collarmesh::facets
