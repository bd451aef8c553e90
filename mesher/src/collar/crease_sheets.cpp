#include "collar/crease_sheets.h"

#include <algorithm>

#include "common/segments.h"
#include "common/sorted.h"

namespace collarmesh {

CreaseSheets::CreaseSheets(const Plc& plc, std::span<const Point> points, std::span<const Index> vertices,
                           const std::vector<bool>& is_crease_curve)
    : plc_(plc), points_(points) {
  std::vector<std::array<Index, 2>> segments;
  for (Index c = 0; c < plc.curves.size(); ++c) {
    if (!is_crease_curve[c]) continue;
    visit_segments(plc.curves[c], [&](Index a, Index b) { segments.push_back(sorted(a, b)); });
  }
  std::ranges::sort(segments);
  std::vector<bool> is_vertex(points.size(), false);
  for (const Index v : vertices) is_vertex[plc.vertices[v].point] = true;
  for (Index t = 0; t < plc.triangles.size(); ++t) {
    const auto& v = plc.triangles[t].points;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::array<Index, 2> side = sorted(v[i], v[(i + 1) % 3]);
      if (std::ranges::binary_search(segments, side)) segments_.push_back({side, t});
      if (is_vertex[v[i]] && !plc.patches[plc.triangles[t].patch].planar) vertices_.push_back({v[i], t});
    }
  }
  std::ranges::sort(segments_);
  std::ranges::sort(vertices_);
}

std::vector<Sheet> CreaseSheets::at_segment(const std::array<Index, 2>& ends) const {
  const auto [a, b] = ends;
  const std::array<Index, 2> key = sorted(a, b);
  const Vector along = (points_[b] - points_[a]) / distance(points_[a], points_[b]);
  std::vector<Sheet> sheets;
  for (auto it = std::ranges::lower_bound(segments_, std::pair{key, Index{0}});
       it != segments_.end() && it->first == key; ++it)
    for (const Index corner : plc_.triangles[it->second].points) {
      if (corner == a || corner == b) continue;
      const Vector w = points_[corner] - points_[a];
      const Vector inwards = w - dot(w, along) * along;
      sheets.push_back({plc_.triangles[it->second].patch, inwards / norm(inwards)});
    }
  return sheets;
}

std::vector<Sheet> CreaseSheets::at_vertex(Index vertex) const {
  const Index point = plc_.vertices[vertex].point;
  std::vector<Sheet> sheets;
  for (auto it = std::ranges::lower_bound(vertices_, std::pair{point, Index{0}});
       it != vertices_.end() && it->first == point; ++it) {
    const Plc::Triangle& t = plc_.triangles[it->second];
    const auto corner = static_cast<std::size_t>(std::ranges::find(t.points, point) - t.points.begin());
    const Point &apex = points_[point], &left = points_[t.points[(corner + 1) % 3]],
                &right = points_[t.points[(corner + 2) % 3]];
    for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0}) {
      const Vector direction = left + share * (right - left) - apex;
      sheets.push_back({t.patch, direction / norm(direction)});
    }
  }
  return sheets;
}

}  // namespace collarmesh
