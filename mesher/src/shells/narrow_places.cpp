#include "shells/narrow_places.h"

#include <algorithm>

#include "shells/curve_division.h"

namespace collarmesh::shells {

namespace {

// Length of edges on both sides of a narrow place, relative to its width. Angles are then 22 degrees where
// ends of edges face each other, and 39 where ends face middles.
constexpr double length_per_width = 2.5;
// Approximate limit on the number of edges in narrow places. To keep it, edges in the narrowest places are
// longer than good angles need.
constexpr double most_edges = 45'000;

}  // namespace

NarrowPlaces::NarrowPlaces(SurfaceComplex& complex, SurfaceEditor& editor, const SurfaceSizes& sizes,
                           const Execution& execution)
    : complex_(complex), editor_(editor), sizes_(sizes), execution_(execution) {}

void NarrowPlaces::measure() {
  widths_.assign(complex_.edges.size(), INFINITY);
  for_narrow_triangles(complex_, [&](const NarrowTriangle& narrow) {
    widths_[narrow.edge] = std::min(widths_[narrow.edge], length_per_width * narrow.width);
  });
}

/// Raises `widths_` to a lower bound, a share of the target edge length, so that there are not too many
/// edges.
void NarrowPlaces::bound_widths() {
  constexpr unsigned most_steps = 60;
  // The share starts at `first` and grows by the factor `step` until edges are few enough.
  constexpr double step = 1.3, first = 1e-6;
  const auto least = [&](Index e, double share) {
    const auto& [from, to] = complex_.edges[e].at;
    return share * sizes_.on_curve(complex_.edges[e].curve, 0.5 * (from + to));
  };
  const auto count = [&](double share) {
    double sum = 0;
    for (Index e = 0; e < complex_.edges.size(); ++e)
      if (complex_.edges[e].alive() && widths_[e] < INFINITY)
        sum += (complex_.edges[e].at[1] - complex_.edges[e].at[0]) / std::max(widths_[e], least(e, share));
    return sum;
  };
  double share = first;
  for (unsigned i = 0; i < most_steps && count(share) > most_edges; ++i) share *= step;
  bounded_ = share > first;
  for (Index e = 0; e < complex_.edges.size(); ++e)
    if (complex_.edges[e].alive() && widths_[e] < INFINITY)
      widths_[e] = std::max(widths_[e], least(e, share));
}

/// Lowers the sizes at the ends of each edge to `widths_`, unless the edge is more than four times as long as
/// that. Then grades the sizes.
void NarrowPlaces::lower_sizes() {
  constexpr double much_longer = 4;
  for (Index e = 0; e < complex_.edges.size(); ++e) {
    if (!complex_.edges[e].alive() || !(widths_[e] < INFINITY)) continue;
    const auto& [a, b] = complex_.edges[e].ends;
    if (editor_.length(a, b) > much_longer * widths_[e]) continue;
    for (const Index v : {a, b}) complex_.vertices[v].size = std::min(complex_.vertices[v].size, widths_[e]);
  }
  grade(complex_, sizes_.gradation());
}

double NarrowPlaces::size_on(Index edge, double at) const {
  const auto& e = complex_.edges[edge];
  const double first = complex_.vertices[e.ends[0]].size + sizes_.gradation() * (at - e.at[0]),
               last = complex_.vertices[e.ends[1]].size + sizes_.gradation() * (e.at[1] - at);
  return std::min({first, last, sizes_.on_curve(e.curve, at), widths_[edge]});
}

bool NarrowPlaces::divide_at(Index edge, const std::vector<double>& places) {
  bool divided = false;
  for (std::size_t i = 1; i + 1 < places.size(); ++i) {
    const double width = widths_[edge];
    const Index v = editor_.divide_curve_edge(edge, places[i]);
    if (v == none) continue;
    divided = true;
    complex_.vertices[v].size = std::min(complex_.vertices[v].size, places[i + 1] - places[i - 1]);
    editor_.flip_around(v);
    widths_.resize(complex_.edges.size(), width);
    edge = static_cast<Index>(complex_.edges.size() - 1);
  }
  return divided;
}

bool NarrowPlaces::divide_edge(Index edge) {
  constexpr double much_longer = 4, rounding = 0.1;
  const auto [from, to] = complex_.edges[edge].at;
  const auto& [a, b] = complex_.edges[edge].ends;
  if (editor_.length(a, b) > much_longer * widths_[edge])
    return divide_at(edge, {from, 0.5 * (from + to), to});
  return divide_at(edge, divide_by_size([&](double at) { return size_on(edge, at); }, from, to, 1, rounding));
}

/// Divides the tips at a vertex so that they stay equally long.
bool NarrowPlaces::divide_tips(Index vertex) {
  constexpr double least_difference = 1.02;
  std::vector<Index> tips;
  double least = INFINITY, wanted = INFINITY, most = 0;
  for (const Index e : complex_.vertices[vertex].edges) {
    if (complex_.edges[e].tip != vertex) continue;
    tips.push_back(e);
    const double length = complex_.edges[e].at[1] - complex_.edges[e].at[0];
    least = std::min(least, length);
    most = std::max(most, length);
    wanted = std::min(wanted, widths_[e]);
  }
  if (tips.empty()) return false;
  const double count = std::max(1.0, std::ceil(least / wanted - 0.3));
  if (count == 1 && most < least_difference * least) return false;
  const double length = least / count;
  bool divided = false;
  for (const Index e : tips) {
    const auto [from, to] = complex_.edges[e].at;
    const bool ascending = complex_.edges[e].ends[0] == vertex;
    std::vector<double> places{from};
    if (to - from < least_difference * length) continue;
    const double parts = std::max(2.0, std::round((to - from) / length));
    const double rest = (to - from - length) / (parts - 1);
    for (double i = 0; i + 1 < parts; ++i)
      places.push_back(ascending ? from + length + i * rest : from + (i + 1) * rest);
    places.push_back(to);
    divided |= divide_at(e, places);
  }
  return divided;
}

bool NarrowPlaces::divide() {
  bool divided = false;
  std::vector<std::pair<double, Index>> edges;
  for (Index e = 0; e < complex_.edges.size(); ++e)
    if (complex_.edges[e].alive() && complex_.edges[e].tip == none)
      edges.emplace_back(-editor_.length(complex_.edges[e].ends[0], complex_.edges[e].ends[1]), e);
  // Divide the longest edges first; otherwise a curve may cross longer edges of another one.
  std::sort(edges.begin(), edges.end());
  for (const auto& [length, e] : edges)
    if (complex_.vertices.size() < limit_) divided |= divide_edge(e);
  const auto vertices = static_cast<Index>(complex_.vertices.size());
  for (Index v = 0; v < vertices && complex_.vertices.size() < limit_; ++v)
    if (complex_.vertices[v].feature.dimension == 0) divided |= divide_tips(v);
  return divided;
}

bool NarrowPlaces::run(std::size_t most_vertices) {
  constexpr unsigned most_rounds = 16;
  limit_ = complex_.vertices.size() + most_vertices;
  for (unsigned round = 0; round < most_rounds && !execution_.cancelled(); ++round) {
    measure();
    bound_widths();
    lower_sizes();
    if (!divide()) break;
  }
  return bounded_;
}

}  // namespace collarmesh::shells
