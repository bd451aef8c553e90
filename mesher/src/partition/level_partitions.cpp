#include "partition/level_partitions.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <queue>
#include <span>
#include <unordered_map>
#include <utility>

namespace collarmesh {

namespace {

using Part = GraphIndex;
using Tet = GraphIndex;

class Levelling {
 public:
  Levelling(const DualGraph& graph, std::size_t partitions, std::size_t most, std::vector<Part>& part_of)
      : graph_(graph), most_(most), part_of_(part_of), place_(part_of.size()), members_(partitions) {
    for (std::size_t t = 0; t < part_of.size(); ++t) enter(static_cast<Tet>(t), part_of[t]);
  }

  void run() {
    fill_empty_ones();
    for (std::size_t p = 0; p < members_.size(); ++p)
      while (members_[p].size() > most_) relieve(static_cast<Part>(p));
  }

 private:
  std::vector<Tet>& members(Part part) { return members_[static_cast<std::size_t>(part)]; }
  Part& part_of(Tet tet) { return part_of_[static_cast<std::size_t>(tet)]; }
  std::span<const Tet> beside(Tet tet) const {
    const auto t = static_cast<std::size_t>(tet);
    return std::span(graph_.neighbours)
        .subspan(static_cast<std::size_t>(graph_.starts[t]),
                 static_cast<std::size_t>(graph_.starts[t + 1] - graph_.starts[t]));
  }

  void enter(Tet tet, Part part) {
    part_of(tet) = part;
    place_[static_cast<std::size_t>(tet)] = members(part).size();
    members(part).push_back(tet);
  }

  void move(Tet tet, Part to) {
    std::vector<Tet>& from = members(part_of(tet));
    const std::size_t place = place_[static_cast<std::size_t>(tet)];
    from[place] = from.back();
    place_[static_cast<std::size_t>(from[place])] = place;
    from.pop_back();
    enter(tet, to);
  }

  /// Fills empty partitions with tets of the largest ones.
  void fill_empty_ones() {
    std::priority_queue<std::pair<std::size_t, Part>> donors;
    std::vector<Part> empty;
    for (std::size_t p = 0; p < members_.size(); ++p) {
      donors.emplace(members_[p].size(), static_cast<Part>(p));
      if (members_[p].empty()) empty.push_back(static_cast<Part>(p));
    }
    for (const Part part : empty) {
      const Part donor = donors.top().second;
      donors.pop();
      move(cheapest(donor, part), part);
      donors.emplace(members(donor).size(), donor);
    }
  }

  /// Takes one tet from a partition with too many, and passes tets on to one with room.
  void relieve(Part full) {
    std::unordered_map<Part, Part> before{{full, full}};
    std::queue<Part> reached;
    reached.push(full);
    Part end = full;
    for (; !reached.empty() && end == full; reached.pop())
      for (const Tet tet : members(reached.front()))
        for (const Tet other : beside(tet))
          if (before.try_emplace(part_of(other), reached.front()).second) {
            reached.push(part_of(other));
            if (end == full && members(part_of(other)).size() < most_) end = part_of(other);
          }
    if (end == full) {  // all partitions that it is connected with are full
      move(cheapest(full, none_), with_room());
      return;
    }
    std::vector<Part> way{end};
    while (way.back() != full) way.push_back(before.at(way.back()));
    for (auto to = way.rbegin() + 1; to != way.rend(); ++to) move(cheapest(*(to - 1), *to), *to);
  }

  Part with_room() const {
    const auto found =
        std::ranges::find_if(members_, [&](const std::vector<Tet>& each) { return each.size() < most_; });
    return static_cast<Part>(found - members_.begin());
  }

  /// Returns the tet of partition `from` that adds the fewest cut faces if moved to `to`: a tet beside `to`,
  /// if there is one.
  Tet cheapest(Part from, Part to) {
    Tet best = members(from).front();
    auto best_cost = std::pair(true, std::numeric_limits<std::ptrdiff_t>::max());
    for (const Tet tet : members(from)) {
      const auto others = beside(tet);
      const auto of = [&](Part part) {
        return std::ranges::count_if(others, [&](Tet other) { return part_of(other) == part; });
      };
      const auto cost = std::pair(of(to) == 0, of(from) - of(to));
      if (std::pair(cost, tet) < std::pair(best_cost, best)) {
        best_cost = cost;
        best = tet;
      }
    }
    return best;
  }

  static constexpr Part none_ = -1;

  const DualGraph& graph_;
  std::size_t most_;
  std::vector<Part>& part_of_;
  std::vector<std::size_t> place_;  // position of each tet among the members of its partition
  std::vector<std::vector<Tet>> members_;
};

}  // namespace

void level_partitions(const DualGraph& graph, std::size_t partitions, std::size_t most,
                      std::vector<GraphIndex>& partition_of) {
  assert(partition_of.size() >= partitions && most * partitions >= partition_of.size());
  Levelling(graph, partitions, most, partition_of).run();
}

}  // namespace collarmesh
