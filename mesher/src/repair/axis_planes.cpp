#include "repair/axis_planes.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "repair/most_places.h"

namespace collarmesh::repairing {

namespace {

using namespace facets;

/// A facet perpendicular to the axis, with its lowest and highest coordinate along the axis.
struct FlatFacet {
  double low, high, area;
  Index triangle;
};

/// The flattening along one axis.
class AxisFlattener {
 public:
  AxisFlattener(ComplexDraft& draft, std::size_t axis, double tolerance, FlattenReport& report)
      : draft_(draft), axis_(axis), tolerance_(tolerance), report_(report) {}

  void run(std::vector<bool> stays) {
    const std::vector<FlatFacet> facets = flat_facets();
    for (auto first = facets.begin(); first != facets.end();) {
      auto last = first;
      while (last != facets.end() && last->high <= first->low + tolerance_) ++last;
      if (last == first) ++last;
      move(std::span(first, last), stays);
      first = last;
    }
  }

 private:
  double at(Index point) const { return draft_.points[point][axis_]; }

  std::vector<FlatFacet> flat_facets() const {
    constexpr double flat = 1e-7, along = 0.9;
    const double most = std::min(tolerance_, flat * draft_.bounds.diagonal());
    const std::vector<bool> thin = thin_soups();
    std::vector<FlatFacet> facets;
    for (Index t = 0; t < draft_.triangles.size(); ++t) {
      const auto& [a, b, c] = draft_.triangles[t];
      const auto [low, high] = std::minmax({at(a), at(b), at(c)});
      if (high - low > most || thin[draft_.origins[t].soup]) continue;
      const Vector area = area_vector(draft_, draft_.triangles[t]);
      if (std::fabs(area[axis_]) > along * norm(area)) facets.push_back({low, high, norm(area), t});
    }
    std::ranges::sort(facets, {}, [](const FlatFacet& f) { return std::pair(f.low, f.triangle); });
    return facets;
  }

  std::vector<bool> thin_soups() const {
    std::vector<Box> boxes(draft_.soup_names.size());
    for (Index t = 0; t < draft_.triangles.size(); ++t)
      for (const Index p : draft_.triangles[t]) boxes[draft_.origins[t].soup].add(draft_.points[p]);
    std::vector<bool> thin;
    thin.reserve(boxes.size());
    for (const Box& box : boxes) thin.push_back(box.max[axis_] - box.min[axis_] <= 2 * tolerance_);
    return thin;
  }

  // Moves facets onto one plane. Points that have moved along this axis before stay, so that none moves by
  // more than the tolerance along it.
  void move(std::span<const FlatFacet> facets, std::vector<bool>& stays) {
    const double plane = plane_of(facets);
    for (const FlatFacet& facet : facets)
      for (const Index p : draft_.triangles[facet.triangle]) {
        const double distance = std::fabs(at(p) - plane);
        if (distance == 0 || stays[p]) continue;
        draft_.points[p][axis_] = plane;
        stays[p] = true;
        ++report_.moved_points;
        report_.largest_distance = std::max(report_.largest_distance, distance);
        if (report_.places.size() < most_places) report_.places.push_back(draft_.points[p]);
      }
  }

  // Returns the coordinate at which the facets have the largest area.
  double plane_of(std::span<const FlatFacet> facets) const {
    std::map<double, double> area;
    for (const FlatFacet& facet : facets)
      for (const Index p : draft_.triangles[facet.triangle]) area[at(p)] += facet.area;
    return std::ranges::max_element(area, {}, [](const auto& each) { return each.second; })->first;
  }

  ComplexDraft& draft_;
  std::size_t axis_;
  double tolerance_;
  FlattenReport& report_;
};

}  // namespace

FlattenReport flatten_axis_planes(ComplexDraft& draft, double tolerance) {
  FlattenReport report;
  std::vector<bool> stays(draft.points.size(), false);
  for (const Index p : draft.loose_points) stays[p] = true;
  for (std::size_t axis = 0; axis < 3; ++axis) AxisFlattener(draft, axis, tolerance, report).run(stays);
  return report;
}

}  // namespace collarmesh::repairing
