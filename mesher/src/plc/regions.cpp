#include "plc/regions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "facets/shells.h"

namespace collarmesh::plc {

using namespace facets;

namespace {

constexpr std::size_t largest_attempt = 1000;

// A sum with compensated rounding errors (Neumaier 1974).
class Sum {
 public:
  void add(double value) {
    const double total = sum_ + value;
    lost_ += std::fabs(sum_) >= std::fabs(value) ? (sum_ - total) + value : (value - total) + sum_;
    sum_ = total;
  }
  double value() const { return sum_ + lost_; }

 private:
  double sum_ = 0, lost_ = 0;
};

// A bounded part of space, separated from the rest by triangles: a component of the surface encloses it.
struct BoundedChamber {
  Index inner_shell = none;  // inner shell of the component that encloses it
  bool complex = false;
  bool claimed = false;           // a facet has this chamber behind it
  bool behind_claimed = false;    // a facet has this chamber in front of it and a claimed chamber behind it
  bool beside_outside = false;    // a facet separates it from the chamber around its component
  Index claiming_surface = none;  // a soup that is a surface and claims this chamber
  Index hole_soup = none;
  Index owner = none;           // the soup that has the largest part of its inner shell
  Index first_triangle = none;  // the owner's first triangle on that shell
  Index region = none;
};

class RegionFinder {
 public:
  RegionFinder(const ComplexDraft& draft, const EdgeTable& edges, const BoxTree& boxes, Faults& faults)
      : draft_(draft),
        faults_(faults),
        count_(static_cast<Index>(draft.triangles.size())),
        outside_(2 * count_),
        components_(count_),
        shells_(find_shells(draft, edges)),
        chambers_(shells_),
        caster_(draft, boxes),
        outer_shell_(count_, none) {
    for (Index e = 0; e < edges.size(); ++e)
      for (const Index side : edges.sides(e)) components_.unite(side / 3, edges.sides(e)[0] / 3);
  }

  Regions run(std::span<const PolygonSoup> soups) {
    nest_components();
    if (!faults_.empty()) return {};
    find_bounded_chambers();
    place_points(soups);
    decide();
    number();
    Regions result;
    fill(soups, result);
    return result;
  }

 private:
  // The part of a chamber's inner shell that comes from one soup.
  struct Share {
    double area = 0;
    Index first_triangle = none;
  };
  // A region or hole point inside a chamber.
  struct PlacedPoint {
    Index soup = 0;
    PolygonSoup::RegionPoint point;
    Index chamber = none;
  };

  double reach() const { return 2 * draft_.bounds.diagonal(); }

  // Casts a line through each component to find its outer shell, and the chamber around the component.
  void nest_components() {
    std::vector<Index> largest(count_, none);
    std::vector<double> area(count_);
    for (Index t = 0; t < count_; ++t) {
      area[t] = squared_norm(
          cross(draft_.corner(t, 1) - draft_.corner(t, 0), draft_.corner(t, 2) - draft_.corner(t, 0)));
      Index& best = largest[components_.find(t)];
      if (best == none || area[t] > area[best]) best = t;
    }
    for (Index c = 0; c < count_; ++c)
      if (components_.find(c) == c && outer_shell_[c] == none) cast_through(c, largest[c]);
  }

  void cast_through(Index component, Index triangle) {
    for (std::size_t attempt = 0; attempt < largest_attempt; ++attempt) {
      // Weights of the triangle's corners; they change with each attempt.
      const Vector w = generic_direction(attempt + 7);
      const double wa = 1 + 0.9 * w.x, wb = 1 + 0.9 * w.y, wc = 1 + 0.9 * w.z;
      const Point at = (wa * draft_.corner(triangle, 0) + wb * draft_.corner(triangle, 1) +
                        wc * draft_.corner(triangle, 2)) /
                       (wa + wb + wc);
      const Vector reach_out = reach() * generic_direction(attempt);
      const auto crossings = caster_.cast(at - reach_out, at + reach_out);
      if (!crossings) continue;
      join_along(*crossings);
      if (outer_shell_[component] != none) return;
    }
    faults_.add(
        PlcFault::Kind::degenerate_facet,
        fmt::format("The facets around {} are too thin to tell their inside from their outside; remove them.",
                    text(draft_.corner(triangle, 0))),
        {draft_.triangles[triangle][0]}, draft_.corner(triangle, 0));
  }

  void join_along(const std::vector<LineCaster::Crossing>& crossings) {
    Index seen = outside_;
    for (const auto& crossing : crossings) {
      Index& outer = outer_shell_[components_.find(crossing.triangle)];
      if (outer == none) outer = shells_.find(crossing.entry_side());
      chambers_.unite(seen, crossing.entry_side());
      seen = crossing.exit_side();
    }
    chambers_.unite(seen, outside_);
  }

  bool is_outer(Index shell) { return outer_shell_[components_.find(shell / 2)] == shell; }

  // Numbers the bounded chambers, one for each inner shell, and finds the soups that claim each of them.
  void find_bounded_chambers() {
    chamber_of_shell_.assign(2 * count_, none);
    for (Index side = 0; side < 2 * count_; ++side) {
      const Index shell = shells_.find(side);
      if (is_outer(shell)) continue;
      if (chamber_of_shell_[shell] == none) {
        chamber_of_shell_[shell] = static_cast<Index>(list_.size());
        list_.emplace_back().inner_shell = shell;
      }
      if (is_outer(shells_.find(side ^ 1U))) list_[chamber_of_shell_[shell]].beside_outside = true;
      const Origin& origin = draft_.origins[side / 2];
      if (draft_.soup_is_complex[origin.soup] || (origin.oriented && side % 2 == 0)) claim(side, origin.soup);
    }
    for (const Claim& c : draft_.claims) {
      claim(c.side, c.soup);
      if (draft_.soup_is_complex[c.soup]) claim(c.side ^ 1U, c.soup);
    }
    for (Index side = 1; side < 2 * count_; side += 2) {
      if (!draft_.origins[side / 2].oriented) continue;
      const Index front = chamber_at(side), back = chamber_at(side - 1);
      if (front != none && back != none && list_[back].claimed) list_[front].behind_claimed = true;
    }
    find_owners();
  }

  // Returns the bounded chamber whose inner shell has this side.
  Index chamber_at(Index side) { return chamber_of_shell_[shells_.find(side)]; }

  // Claims a side for a soup: a complex claims both sides of its facets; a surface claims the sides behind
  // its facets as solid.
  void claim(Index side, Index soup) {
    const Index at = chamber_at(side);
    if (at == none) return;
    Share& share = shares_[{at, soup}];
    share.area += norm(cross(draft_.corner(side / 2, 1) - draft_.corner(side / 2, 0),
                             draft_.corner(side / 2, 2) - draft_.corner(side / 2, 0)));
    share.first_triangle = std::min(share.first_triangle, side / 2);
    BoundedChamber& chamber = list_[at];
    if (draft_.soup_is_complex[soup]) {
      chamber.complex = true;
      return;
    }
    chamber.claimed = true;
    chamber.claiming_surface = std::min(chamber.claiming_surface, soup);
  }

  // Finds the owner of each chamber: the soup with the largest part of its shell, the first one among equals.
  // So a chamber belongs to the file that encloses it, not to neighbours that share some of its facets.
  void find_owners() {
    constexpr double clearly_more = 1 + 1e-9;
    double area = 0;
    for (const auto& [key, share] : shares_) {
      BoundedChamber& chamber = list_[key[0]];
      if (chamber.owner != none && share.area <= clearly_more * area) continue;
      chamber.owner = key[1];
      chamber.first_triangle = share.first_triangle;
      area = share.area;
    }
    for (BoundedChamber& chamber : list_) {
      if (chamber.owner != none) continue;
      chamber.first_triangle = chamber.inner_shell / 2;
      chamber.owner = draft_.origins[chamber.first_triangle].soup;
    }
  }

  void place_points(std::span<const PolygonSoup> soups) {
    for (Index s = 0; s < soups.size(); ++s) {
      for (const Point& hole : soups[s].hole_points)
        if (const Index at = enclosing_chamber(hole, "hole", s); at != none) {
          list_[at].hole_soup = s;
          holes_.push_back({s, {hole}, at});
        }
      for (const auto* points : {&soups[s].named_regions, &soups[s].region_points})
        for (const auto& point : *points)
          if (const Index at = enclosing_chamber(point.point, "region", s); at != none)
            region_points_.push_back({s, point, at});
    }
  }

  // Returns the bounded chamber that contains a point; none if the point is outside all chambers.
  Index enclosing_chamber(const Point& point, const char* what, Index soup) {
    for (std::size_t attempt = 0; attempt < largest_attempt; ++attempt) {
      const auto crossings = caster_.cast(point, point + reach_to(point) * generic_direction(attempt));
      if (!crossings) continue;
      const Index at = crossings->empty() ? none : bounded_chamber(crossings->front().entry_side());
      if (at == none)
        warn(point, fmt::format("{}: the {} point {} lies outside of every region and has no effect; move it "
                                "inside one or remove it.",
                                draft_.soup_names[soup], what, text(point)));
      return at;
    }
    faults_.add(PlcFault::Kind::bad_point,
                fmt::format("{}: the {} point {} lies on a facet; move it inside.", draft_.soup_names[soup],
                            what, text(point)),
                {}, point);
    return none;
  }

  void warn(const Point& where, std::string message) { warnings_.push_back({std::move(message), where}); }

  double reach_to(const Point& point) const { return reach() + 2 * distance(point, draft_.bounds.centre()); }

  Index bounded_chamber(Index side) {
    for (Index at = 0; at < list_.size(); ++at)
      if (chambers_.same(list_[at].inner_shell, side)) return at;
    return none;
  }

  // Decides which chambers are regions, from the outside inwards, so that the chamber around another one is
  // decided first.
  void decide() {
    region_of_chamber_.assign(2 * count_ + 1, none);
    region_of_chamber_[chambers_.find(outside_)] = 0;
    std::multimap<Index, Index> children;
    for (Index i = 0; i < list_.size(); ++i) children.emplace(parent(list_[i]), i);
    std::vector<Index> stack{chambers_.find(outside_)};
    while (!stack.empty()) {
      const Index around = stack.back();
      stack.pop_back();
      const auto [first, last] = children.equal_range(around);
      for (auto child = first; child != last; ++child) {
        BoundedChamber& chamber = list_[child->second];
        chamber.region = is_region(chamber, region_of_chamber_[around] != 0) ? 1 : 0;
        const Index set = chambers_.find(chamber.inner_shell);
        region_of_chamber_[set] = chamber.region;
        stack.push_back(set);
      }
    }
  }

  // Returns the chamber around the component of the surface that encloses this chamber.
  Index parent(const BoundedChamber& chamber) {
    return chambers_.find(outer_shell_[components_.find(chamber.inner_shell / 2)]);
  }

  // Returns whether a chamber is a region. A cavity that touches the surface around it lies in front of that
  // surface's facets everywhere. A chamber that also has facets to the outside is not a cavity but a body
  // whose facets are turned inside out.
  static bool is_region(const BoundedChamber& chamber, bool inside_region) {
    const bool filled = chamber.claiming_surface != none && chamber.claiming_surface != chamber.hole_soup;
    if (chamber.hole_soup != none) return filled;
    return chamber.complex || chamber.claimed ||
           !(inside_region || (chamber.behind_claimed && !chamber.beside_outside));
  }

  // Numbers the regions from 1, in the order of their owners, then of the owner's first triangle there.
  void number() {
    std::vector<Index> order;
    for (Index i = 0; i < list_.size(); ++i)
      if (list_[i].region != 0) order.push_back(i);
    std::ranges::sort(order, {}, [&](Index i) { return std::pair(list_[i].owner, list_[i].first_triangle); });
    for (Index n = 0; n < order.size(); ++n) {
      list_[order[n]].region = n + 1;
      region_of_chamber_[chambers_.find(list_[order[n]].inner_shell)] = n + 1;
    }
  }

  void fill(std::span<const PolygonSoup> soups, Regions& result) {
    result.of_side.resize(2 * count_);
    for (Index side = 0; side < 2 * count_; ++side)
      result.of_side[side] = region_of_chamber_[chambers_.find(side)];
    result.list.emplace_back().name = "outside";
    std::vector<const BoundedChamber*> by_region{nullptr};
    for (const BoundedChamber& c : list_) {
      if (c.region == 0) continue;
      if (c.region >= by_region.size()) by_region.resize(c.region + 1);
      by_region[c.region] = &c;
    }
    for (Index r = 1; r < by_region.size(); ++r) {
      const Index soup = by_region[r]->owner;
      const std::string& name = draft_.soup_names[soup];
      result.list.push_back({soups[soup].region_tag.value_or(static_cast<Tag>(r)), 0, 0,
                             name.empty() ? fmt::format("region {}", r) : name});
    }
    set_parameters(result);
    add_volumes(result);
    result.warnings = std::move(warnings_);
  }

  // Applies the properties of region points; in each region the last point counts.
  void set_parameters(Regions& result) {
    std::map<Index, const PlacedPoint*> last;
    for (const PlacedPoint& p : region_points_) {
      const Index r = list_[p.chamber].region;
      if (r == 0) {
        warn_of_hole(p);
        continue;
      }
      const PlacedPoint*& before = last[r];
      if (before != nullptr && (before->point.tag != p.point.tag || before->point.size != p.point.size))
        warn(p.point.point, fmt::format("{} lies in the same region as {}; the latter has no effect. Remove "
                                        "one of them, or close the facets that should part them.",
                                        description(p), description(*before)));
      before = &p;
      result.list[r].tag = p.point.tag;
      result.list[r].size = p.point.size;
    }
  }

  void warn_of_hole(const PlacedPoint& p) {
    const auto hole =
        std::ranges::find_if(holes_, [&](const PlacedPoint& h) { return h.chamber == p.chamber; });
    if (hole == holes_.end())
      warn(p.point.point,
           fmt::format("{} lies in a cavity and has no effect; move it inside a region, turn the "
                       "cavity's facets around, or remove it.",
                       description(p)));
    else
      warn(
          p.point.point,
          fmt::format("{} lies in the hole that the hole point {} of {} marks, and has no effect; remove one "
                      "of these points, or close the facets that should separate them.",
                      description(p), text(hole->point.point), draft_.soup_names[hole->soup]));
  }

  std::string description(const PlacedPoint& p) const {
    return fmt::format("{}: the region point {} (tag {}{})", draft_.soup_names[p.soup], text(p.point.point),
                       p.point.tag, p.point.size > 0 ? fmt::format(", size {:.6g}", p.point.size) : "");
  }

  void add_volumes(Regions& result) const {
    std::vector<Sum> sums(result.list.size());
    const Point centre = draft_.bounds.centre();
    for (Index t = 0; t < count_; ++t) {
      const double v = six_volume(draft_.corner(t, 0), draft_.corner(t, 1), draft_.corner(t, 2), centre);
      sums[result.of_side[back_side(t)]].add(-v);
      sums[result.of_side[front_side(t)]].add(v);
    }
    for (std::size_t r = 1; r < sums.size(); ++r) result.list[r].volume = sums[r].value() / 6;
  }

  const ComplexDraft& draft_;
  Faults& faults_;
  Index count_;
  Index outside_;            // element of the sets of sides that stands for the outside
  DisjointSets components_;  // sets of triangles
  DisjointSets shells_;      // sets of sides, within components
  DisjointSets chambers_;    // sets of sides
  LineCaster caster_;
  std::vector<Index> outer_shell_;  // by component
  std::vector<BoundedChamber> list_;
  std::vector<Index> chamber_of_shell_;           // index in list_
  std::vector<Index> region_of_chamber_;          // by representative in chambers_
  std::map<std::array<Index, 2>, Share> shares_;  // by chamber and soup
  std::vector<PlacedPoint> holes_, region_points_;
  std::vector<Plc::Warning> warnings_;
};

}  // namespace

Regions find_regions(const ComplexDraft& draft, const EdgeTable& edges, const BoxTree& boxes,
                     std::span<const PolygonSoup> soups, Faults& faults) {
  return RegionFinder(draft, edges, boxes, faults).run(soups);
}

}  // namespace collarmesh::plc
