#include "repair/inside.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "common/disjoint_sets.h"
#include "facets/edges.h"
#include "facets/shells.h"
#include "repair/most_places.h"
#include "repair/winding_number.h"

namespace collarmesh::repairing {

namespace {

using namespace facets;

constexpr std::size_t most_asked =
    3;  // the winding number is computed at up to this many triangles of a shell, a patch or a component

Point centroid(const ComplexDraft& draft, const Corners& t) {
  return (1.0 / 3) * (draft.points[t[0]] + draft.points[t[1]] + draft.points[t[2]]);
}
std::array<Point, 3> corner_points(const ComplexDraft& draft, const Corners& t) {
  return {draft.points[t[0]], draft.points[t[1]], draft.points[t[2]]};
}

void note(std::vector<Point>& places, const Point& p) {
  if (places.size() < most_places) places.push_back(p);
}

bool turned_against(const Corners& a, const Corners& b) {
  const auto at = static_cast<std::size_t>(std::find(b.begin(), b.end(), a[0]) - b.begin());
  return b[(at + 1) % 3] != a[1];
}

// The `count` largest triangles of a set.
class Largest {
 public:
  static constexpr std::size_t count = 24;

  void add(double area, Index item) {
    if (items_.size() == count && items_.back().first >= area) return;
    if (items_.size() == count) items_.pop_back();
    items_.insert(std::upper_bound(items_.begin(), items_.end(), area,
                                   [](double a, const auto& entry) { return a > entry.first; }),
                  {area, item});
  }
  const std::vector<std::pair<double, Index>>& items() const { return items_; }
  std::span<const std::pair<double, Index>> first(std::size_t most) const {
    return std::span(items_).first(std::min(most, items_.size()));
  }

 private:
  std::vector<std::pair<double, Index>> items_;
};

// The triangles of a clean arrangement, with copies merged into sheets. A sheet has the corners and the
// orientation of the first of its copies.
struct Sheets {
  struct Copy {
    Index triangle;
    int sign;  // -1: opposite to the sheet
  };
  ComplexDraft unique;  // one triangle for each sheet
  std::vector<Index> first_copy{0};
  std::vector<Copy> copies;

  explicit Sheets(const ComplexDraft& draft) {
    unique.points = draft.points;
    std::vector<std::pair<Corners, Index>> order;
    order.reserve(draft.triangles.size());
    for (Index t = 0; t < draft.triangles.size(); ++t) {
      Corners key = draft.triangles[t];
      std::sort(key.begin(), key.end());
      order.emplace_back(key, t);
    }
    std::sort(order.begin(), order.end());
    for (std::size_t i = 0; i < order.size(); ++i) {
      const Index t = order[i].second;
      if (i == 0 || order[i].first != order[i - 1].first) {
        if (i > 0) first_copy.push_back(static_cast<Index>(copies.size()));
        unique.add_triangle(draft.triangles[t], draft.origins[t]);
      }
      copies.push_back({t, turned_against(unique.triangles.back(), draft.triangles[t]) ? -1 : 1});
    }
    first_copy.push_back(static_cast<Index>(copies.size()));
  }

  Index size() const { return static_cast<Index>(unique.triangles.size()); }
  std::span<const Copy> of(Index sheet) const {
    return {copies.data() + first_copy[sheet], copies.data() + first_copy[sheet + 1]};
  }
};

class BoundaryKeeper {
 public:
  BoundaryKeeper(ComplexDraft& draft, double thickness)
      : draft_(draft),
        thickness_(thickness),
        sheets_(draft),
        edges_(sheets_.unique.triangles, draft.points.size()) {}

  InsideReport run() {
    find_clusters();
    if (std::none_of(tangled_.begin(), tangled_.end(), [](bool b) { return b; })) return {};
    find_patches();
    for (const Index soup : tangled_soups()) weigh(soup);
    give_away_thin_chambers();
    emit();
    return std::move(report_);
  }

 private:
  const Origin& origin(const Sheets::Copy& copy) const { return draft_.origins[copy.triangle]; }
  bool of_complex(Index sheet) const {
    for (const Sheets::Copy& copy : sheets_.of(sheet))
      if (draft_.soup_is_complex[origin(copy).soup]) return true;
    return false;
  }
  // Returns how often the soup's triangles cover the sheet; triangles of opposite orientation count
  // negatively.
  int weight(Index sheet, Index soup) const {
    int sum = 0;
    for (const Sheets::Copy& copy : sheets_.of(sheet))
      if (origin(copy).soup == soup) sum += copy.sign;
    return sum;
  }

  bool plain(Index edge) const {
    const auto sides = edges_.sides(edge);
    if (sides.size() != 2) return false;
    const Index s = sides[0] / 3, t = sides[1] / 3;
    return sheets_.of(s).size() == 1 && sheets_.of(t).size() == 1 &&
           origin(sheets_.of(s)[0]).soup == origin(sheets_.of(t)[0]).soup &&
           ascending(sheets_.unique.triangles, sides[0]) != ascending(sheets_.unique.triangles, sides[1]);
  }

  // Finds clusters of sheets connected by edges. A cluster is tangled unless at each of its edges two
  // triangles of one soup meet, without copies and with consistent orientation.
  void find_clusters() {
    DisjointSets sets(sheets_.size());
    std::vector<bool> tangled(sheets_.size(), false);
    for (Index e = 0; e < edges_.size(); ++e)
      for (const Index side : edges_.sides(e)) sets.unite(side / 3, edges_.sides(e)[0] / 3);
    for (Index e = 0; e < edges_.size(); ++e)
      if (!plain(e)) tangled[sets.find(edges_.sides(e)[0] / 3)] = true;
    tangled_.resize(sheets_.size());
    for (Index s = 0; s < sheets_.size(); ++s) tangled_[s] = tangled[sets.find(s)];
  }

  // Finds patches (sets of sheets connected by edges that exactly two sheets share), shells, and the largest
  // triangles of both.
  void find_patches() {
    DisjointSets sets(sheets_.size());
    for (Index e = 0; e < edges_.size(); ++e)
      if (edges_.sides(e).size() == 2) sets.unite(edges_.sides(e)[0] / 3, edges_.sides(e)[1] / 3);
    patch_.resize(sheets_.size());
    for (Index s = 0; s < sheets_.size(); ++s) patch_[s] = sets.find(s);
    DisjointSets shells = find_shells(sheets_.unique, edges_);
    shell_.resize(2 * std::size_t{sheets_.size()});
    for (Index side = 0; side < shell_.size(); ++side) shell_[side] = shells.find(side);
    label_.assign(shell_.size(), none);
    for (Index s = 0; s < sheets_.size(); ++s) {
      if (!tangled_[s]) continue;
      const double area = area_of(draft_, sheets_.unique.triangles[s]);
      largest_of_shell_[shell_[back_side(s)]].add(area, back_side(s));
      largest_of_shell_[shell_[front_side(s)]].add(area, front_side(s));
      largest_of_patch_[patch_[s]].add(area, s);
    }
  }

  std::vector<Index> tangled_soups() const {
    std::vector<Index> soups;
    for (Index s = 0; s < sheets_.size(); ++s)
      if (tangled_[s])
        for (const Sheets::Copy& copy : sheets_.of(s)) soups.push_back(origin(copy).soup);
    std::sort(soups.begin(), soups.end());
    soups.erase(std::unique(soups.begin(), soups.end()), soups.end());
    std::erase_if(soups, [&](Index soup) { return draft_.soup_is_complex[soup]; });
    return soups;
  }

  // Labels the shells that are inside this soup but not inside an earlier soup.
  void weigh(Index soup) {
    std::vector<int> weights(sheets_.size());
    for (Index s = 0; s < sheets_.size(); ++s) weights[s] = weight(s, soup);
    remove_open_sheets(soup, weights);
    const WindingNumber winding = winding_of(weights, false);
    for (const auto& [shell, largest] : largest_of_shell_) {
      if (label_[shell] != none) continue;
      double sum = 0, total = 0;
      std::size_t asked = 0;
      for (const auto& [area, side] : largest.items()) {
        const Index s = side / 2;
        const Point p = centroid(draft_, sheets_.unique.triangles[s]);
        if (winding.is_on_another(p, s)) continue;
        const double own = 0.5 * weights[s] * (side % 2 == 0 ? 1 : -1);
        sum += area * (winding.at(p, s) + own);
        total += area;
        if (++asked == most_asked) break;
      }
      if (total > 0 && sum > 0.5 * total) label_[shell] = soup;
    }
  }

  WindingNumber winding_of(const std::vector<int>& weights, bool by_patch) const {
    std::vector<WeightedTriangle> triangles;
    for (Index s = 0; s < sheets_.size(); ++s)
      if (weights[s] != 0)
        triangles.push_back(
            {corner_points(draft_, sheets_.unique.triangles[s]), weights[s], by_patch ? patch_[s] : s});
    return WindingNumber(std::move(triangles));
  }

  // Removes open sheets: patches at edges where the soup is open. Such a patch bounds nothing if the winding
  // number at the patch, computed without the patch, is nearly an integer; at a boundary it would be the mean
  // of the numbers inside and outside. Starts with the smallest patch. Otherwise, in a box with a wall
  // inside, half of the box might be removed and the wall kept, because the wall closes the other half.
  void remove_open_sheets(Index soup, std::vector<int>& weights) {
    constexpr std::size_t most = 100;
    for (std::size_t count = 0; count < most; ++count) {
      const Index patch = find_open_sheet(weights);
      if (patch == none) return;
      walls_.push_back({patch, soup});
      for (Index s = 0; s < sheets_.size(); ++s)
        if (patch_[s] == patch) weights[s] = 0;
    }
  }

  // Returns the patches whose removal reduces the length of the soup's open edges, smallest areas first.
  std::vector<Index> open_patches(const std::vector<int>& weights) const {
    std::map<Index, double> gain;
    std::vector<std::pair<Index, int>> own;  // the soup's patches at the edge, and their weights
    for (Index e = 0; e < edges_.size(); ++e) {
      int sum = 0;
      own.clear();
      for (const Index side : edges_.sides(e)) {
        const int weight = weights[side / 3] * (ascending(sheets_.unique.triangles, side) ? 1 : -1);
        if (weight == 0) continue;
        sum += weight;
        const Index patch = patch_[side / 3];
        const auto at = std::find_if(own.begin(), own.end(), [&](const auto& o) { return o.first == patch; });
        if (at == own.end())
          own.emplace_back(patch, weight);
        else
          at->second += weight;
      }
      const auto [a, b] = edges_.ends(e);
      const double length = distance(draft_.points[a], draft_.points[b]);
      for (const auto& [patch, weight] : own)
        gain[patch] += (std::abs(sum) - std::abs(sum - weight)) * length;
    }
    std::map<Index, double> area;
    for (const auto& [patch, length] : gain)
      if (length > 0) area[patch] = 0;
    for (Index s = 0; s < sheets_.size() && !area.empty(); ++s)
      if (const auto at = area.find(patch_[s]); at != area.end())
        at->second += area_of(draft_, sheets_.unique.triangles[s]);
    std::vector<Index> patches;
    patches.reserve(area.size());
    for (const auto& [patch, size] : area) patches.push_back(patch);
    std::stable_sort(patches.begin(), patches.end(),
                     [&](Index a, Index b) { return area.at(a) < area.at(b); });
    return patches;
  }

  Index find_open_sheet(const std::vector<int>& weights) const {
    const std::vector<Index> candidates = open_patches(weights);
    if (candidates.empty()) return none;
    const WindingNumber winding = winding_of(weights, true);
    for (const Index patch : candidates) {
      const auto found = largest_of_patch_.find(patch);
      if (found == largest_of_patch_.end()) continue;
      double sum = 0, total = 0;
      for (const auto& [area, s] : found->second.first(most_asked)) {
        sum += area * winding.at(centroid(draft_, sheets_.unique.triangles[s]), patch);
        total += area;
      }
      const double mean = total > 0 ? sum / total : 0;
      if (std::fabs(mean - std::floor(mean) - 0.5) > 0.25) return patch;
    }
    return none;
  }

  bool is_wall(Index sheet) const {
    return std::any_of(walls_.begin(), walls_.end(), [&](const auto& w) {
      return w.first == patch_[sheet] &&
             std::any_of(sheets_.of(sheet).begin(), sheets_.of(sheet).end(),
                         [&](const auto& c) { return origin(c).soup == w.second; });
    });
  }

  // A part of space that triangles separate from the rest, thinner than `thickness`.
  struct ThinChamber {
    Point origin;
    double volume = 0, area = 0;
    std::vector<std::pair<Index, double>> neighbours;  // for each triangle: the shell beyond it, and its area
  };

  std::map<Index, ThinChamber> thin_chambers() const {
    std::map<Index, ThinChamber> chambers;
    for (Index side = 0; side < shell_.size(); ++side) {
      if (!tangled_[side / 2]) continue;
      const auto p = corner_points(draft_, sheets_.unique.triangles[side / 2]);
      const auto [at, added] = chambers.try_emplace(shell_[side]);
      ThinChamber& chamber = at->second;
      if (added) chamber.origin = p[0];
      const double area = 0.5 * norm(cross(p[1] - p[0], p[2] - p[0]));
      chamber.volume +=
          (side == back_side(side / 2) ? 1 : -1) * six_volume(p[0], p[1], p[2], chamber.origin) / -6;
      chamber.area += area;
      if (shell_[side ^ 1U] != shell_[side]) chamber.neighbours.emplace_back(shell_[side ^ 1U], area);
    }
    std::erase_if(chambers, [&](const auto& entry) {
      const ThinChamber& c = entry.second;
      return c.volume < 0 || 2 * c.volume > thickness_ * c.area || c.neighbours.empty();
    });
    return chambers;
  }

  // Gives each thin chamber the label of the neighbours with which it has the largest common area. Begins
  // with thin chambers beside thick ones.
  void give_away_thin_chambers() {
    std::map<Index, ThinChamber> left = thin_chambers();
    while (!left.empty()) {
      std::vector<std::pair<Index, Index>> labelled;
      for (const auto& [shell, chamber] : left) {
        std::map<Index, double> area;  // common area by label
        for (const auto& [neighbour, common] : chamber.neighbours)
          if (left.count(neighbour) == 0) area[label_[neighbour]] += common;
        if (area.empty()) continue;
        const auto most = std::max_element(area.begin(), area.end(),
                                           [](const auto& a, const auto& b) { return a.second < b.second; });
        labelled.emplace_back(shell, most->first);
      }
      if (labelled.empty()) return;  // only thin chambers are left, beside each other
      for (const auto& [shell, label] : labelled) {
        if (label_[shell] != label) {
          report_.chamber_volume += left.at(shell).volume;
          report_.chamber_places.push_back(left.at(shell).origin);
        }
        label_[shell] = label;
        left.erase(shell);
      }
    }
  }

  void emit() {
    std::vector<Corners> triangles;
    std::vector<Origin> origins;
    const auto add = [&](Corners corners, bool turned, Origin from, Index soup) {
      if (turned) std::swap(corners[1], corners[2]);
      from.soup = soup;
      triangles.push_back(corners);
      origins.push_back(from);
    };
    for (Index s = 0; s < sheets_.size(); ++s) {
      const Corners& corners = sheets_.unique.triangles[s];
      if (!tangled_[s] || of_complex(s)) {
        for (const Sheets::Copy& copy : sheets_.of(s))
          add(draft_.triangles[copy.triangle], false, origin(copy), origin(copy).soup);
        continue;
      }
      const Index back = label_[shell_[back_side(s)]], front = label_[shell_[front_side(s)]];
      if (back != front) {
        if (back != none) add(corners, false, origin_for(s, back), back);
        if (front != none) add(corners, true, origin_for(s, front), front);
        continue;
      }
      if (!is_wall(s)) {
        ++report_.removed_triangles;
        report_.removed_area += area_of(draft_, corners);
        note(report_.places, centroid(draft_, corners));
      } else if (back != none) {
        ++report_.internal_facets;
        add(corners, false, origin(sheets_.of(s)[0]), origin(sheets_.of(s)[0]).soup);
      } else {
        ++report_.dropped_sheets;
        report_.dropped_area += area_of(draft_, corners);
        note(report_.dropped_places, centroid(draft_, corners));
      }
    }
    draft_.triangles = std::move(triangles);
    draft_.origins = std::move(origins);
  }

  // Returns the origin of the soup's own copy of the sheet or, if there is none, of the first copy.
  Origin origin_for(Index sheet, Index soup) const {
    for (const Sheets::Copy& copy : sheets_.of(sheet))
      if (origin(copy).soup == soup) return origin(copy);
    return origin(sheets_.of(sheet)[0]);
  }

  ComplexDraft& draft_;
  double thickness_;
  Sheets sheets_;
  EdgeTable edges_;            // edges of the sheets
  std::vector<bool> tangled_;  // by sheet
  std::vector<Index> patch_;   // by sheet
  std::vector<Index> shell_;   // by side of a sheet
  std::vector<Index> label_;   // by shell: the soup that contains it; none if it is outside all
  std::map<Index, Largest> largest_of_shell_, largest_of_patch_;
  std::vector<std::pair<Index, Index>> walls_;  // pairs of a patch and its soup
  InsideReport report_;
};

// Components: triangles connected by edges at which exactly two triangles of one soup meet, with consistent
// orientation.
struct Components {
  std::vector<Index> of;  // by triangle: the first triangle of its component
  std::map<Index, std::vector<Index>> triangles;
  std::map<Index, bool> closed;

  explicit Components(const ComplexDraft& draft) {
    const EdgeTable edges(draft.triangles, draft.points.size());
    DisjointSets sets(draft.triangles.size());
    std::vector<bool> open(draft.triangles.size(), false);
    std::vector<Index> of_soup;
    for (Index e = 0; e < edges.size(); ++e) {
      const auto sides = edges.sides(e);
      for (const Index side : sides) {
        of_soup.clear();
        for (const Index other : sides)
          if (draft.origins[other / 3].soup == draft.origins[side / 3].soup) of_soup.push_back(other);
        if (of_soup.size() == 2 &&
            ascending(draft.triangles, of_soup[0]) != ascending(draft.triangles, of_soup[1]))
          sets.unite(of_soup[0] / 3, of_soup[1] / 3);
        else
          open[side / 3] = true;
      }
    }
    of.resize(draft.triangles.size());
    for (Index t = 0; t < of.size(); ++t) {
      of[t] = sets.find(t);
      triangles[of[t]].push_back(t);
      closed.try_emplace(of[t], true).first->second &= !open[t];
    }
  }
};

}  // namespace

bool peels_away(const ComplexDraft& draft) {
  const EdgeTable edges(draft.triangles, draft.points.size());
  std::vector<std::size_t> left(edges.size());  // number of triangles that remain at the edge
  std::vector<bool> gone(draft.triangles.size(), false);
  std::vector<Index> open;
  for (Index e = 0; e < edges.size(); ++e) {
    left[e] = edges.sides(e).size();
    if (left[e] == 1) open.push_back(e);
  }
  std::size_t count = 0;
  while (!open.empty()) {
    const Index e = open.back();
    open.pop_back();
    for (const Index side : edges.sides(e)) {
      const Index t = side / 3;
      if (gone[t]) continue;
      gone[t] = true;
      ++count;
      for (Index i = 0; i < 3; ++i)
        if (--left[edges.edge_of(3 * t + i)] == 1) open.push_back(edges.edge_of(3 * t + i));
    }
  }
  return count == draft.triangles.size();
}

TurnReport turn_components(ComplexDraft& draft) {
  TurnReport report;
  const Components components(draft);
  std::map<Index, std::vector<WeightedTriangle>> by_soup;
  for (Index t = 0; t < draft.triangles.size(); ++t)
    by_soup[draft.origins[t].soup].push_back({corner_points(draft, draft.triangles[t]), 1, components.of[t]});
  std::map<Index, WindingNumber> winding;
  for (auto& [soup, triangles] : by_soup)
    if (!draft.soup_is_complex[soup]) winding.try_emplace(soup, std::move(triangles));
  std::vector<Index> turned;
  const Point origin = draft.bounds.centre();
  for (const auto& [component, triangles] : components.triangles) {
    const auto found = winding.find(draft.origins[component].soup);
    if (found == winding.end() || !components.closed.at(component)) continue;
    double volume = 0, around = 0, total = 0;
    Largest largest;
    for (const Index t : triangles) {
      const auto p = corner_points(draft, draft.triangles[t]);
      volume += dot(p[0] - origin, cross(p[1] - origin, p[2] - origin));
      largest.add(area_of(draft, draft.triangles[t]), t);
    }
    for (const auto& [area, t] : largest.first(most_asked)) {
      around += area * found->second.at(centroid(draft, draft.triangles[t]), component);
      total += area;
    }
    around = total > 0 ? around / total : 0;
    if (around < -0.5 || (volume < 0 && around < 0.5)) turned.push_back(component);
  }
  for (const Index component : turned) {
    for (const Index t : components.triangles.at(component))
      std::swap(draft.triangles[t][1], draft.triangles[t][2]);
    ++report.turned_components;
    note(report.places, centroid(draft, draft.triangles[component]));
  }
  return report;
}

FlakeReport drop_flakes(ComplexDraft& draft, double thickness) {
  constexpr double most_of_all = 1e-3;  // share of the total volume
  FlakeReport report;
  const Components components(draft);
  const Point origin = draft.bounds.centre();
  struct Size {
    double volume = 0, area = 0;
  };
  std::map<Index, Size> sizes;
  double all = 0;
  for (const auto& [component, triangles] : components.triangles) {
    Size& size = sizes[component];
    for (const Index t : triangles) {
      const auto p = corner_points(draft, draft.triangles[t]);
      size.volume += six_volume(p[0], p[1], p[2], origin) / -6;
      size.area += area_of(draft, draft.triangles[t]);
    }
    all += std::fabs(size.volume);
  }
  std::vector<bool> dropped(draft.triangles.size(), false);
  for (const auto& [component, size] : sizes) {
    const double volume = std::fabs(size.volume);
    if (!components.closed.at(component) || draft.soup_is_complex[draft.origins[component].soup] ||
        2 * volume > thickness * size.area || volume > most_of_all * all)
      continue;
    for (const Index t : components.triangles.at(component)) dropped[t] = true;
    report.volume += volume;
    report.places.push_back(centroid(draft, draft.triangles[component]));
  }
  if (report.places.empty()) return report;
  if (report.places.size() == components.triangles.size()) return {};  // do not drop everything
  std::size_t kept = 0;
  for (Index t = 0; t < draft.triangles.size(); ++t) {
    if (dropped[t]) continue;
    draft.triangles[kept] = draft.triangles[t];
    draft.origins[kept++] = draft.origins[t];
  }
  draft.triangles.resize(kept);
  draft.origins.resize(kept);
  return report;
}

InsideReport keep_boundaries(ComplexDraft& draft, double thickness) {
  return BoundaryKeeper(draft, thickness).run();
}

}  // namespace collarmesh::repairing
