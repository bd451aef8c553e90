#include "predict/solid_angles.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <utility>

namespace collarmesh::prediction {

namespace {

using Edge = std::pair<Index, Index>;

constexpr double full_circle = 2 * std::numbers::pi, full_space = 4 * std::numbers::pi;

Edge edge(Index a, Index b) { return {std::min(a, b), std::max(a, b)}; }

Edge middle_segment(const Plc::Curve& curve) {
  const std::size_t first = (curve.points.size() - 1) / 2;
  return edge(curve.points[first], curve.points[(first + 1) % curve.points.size()]);
}

/// The triangles at an edge and their angles around it.
class Wheel {
 public:
  Wheel(const Plc& plc, const Edge& axis) : plc_(plc), from_(axis.first), to_(axis.second) {
    const Vector along = plc.points[to_] - plc.points[from_];
    along_ = along / norm(along);
    const Vector other = std::fabs(along_.x) < 0.5 ? Vector{1, 0, 0} : Vector{0, 1, 0};
    u_ = cross(along_, other);
    u_ = u_ / norm(u_);
    v_ = cross(along_, u_);
  }

  void add(const Plc::Triangle& triangle) {
    const auto& t = triangle.points;
    for (unsigned i = 0; i < 3; ++i) {
      const Index a = t[i], b = t[(i + 1) % 3], apex = t[(i + 2) % 3];
      if (edge(a, b) != edge(from_, to_)) continue;
      const Vector w = plc_.points[apex] - plc_.points[from_];
      // If the triangle's border follows the edge in the axis's direction, the triangle's normal points
      // towards increasing angles.
      spokes_.push_back(
          {std::atan2(dot(w, v_), dot(w, u_)), plc_.patches[triangle.patch].regions[a == from_ ? 1 : 0]});
    }
  }

  /// Returns the sum of the angles of the wedges within regions, radians, and the number of these wedges.
  std::pair<double, int> inside() {
    std::ranges::sort(spokes_);
    std::pair<double, int> sum{0, 0};
    for (std::size_t i = 0; i < spokes_.size(); ++i) {
      const bool last = i + 1 == spokes_.size();
      const double next = last ? spokes_.front().first + full_circle : spokes_[i + 1].first;
      if (spokes_[i].second == 0) continue;
      sum.first += next - spokes_[i].first;
      ++sum.second;
    }
    return sum;
  }

 private:
  const Plc& plc_;
  Index from_, to_;
  Vector along_, u_, v_;
  std::vector<std::pair<double, Index>> spokes_;  // angle, and region at larger angles
};

}  // namespace

SolidAngles solid_angles(const Plc& plc) {
  SolidAngles shares;
  for (const Plc::Patch& patch : plc.patches)
    shares.of_patch.push_back((patch.regions[0] > 0 ? 0.5 : 0) + (patch.regions[1] > 0 ? 0.5 : 0));

  std::map<Edge, Wheel> wheels;
  for (const Plc::Curve& curve : plc.curves) {
    const Edge middle = middle_segment(curve);
    if (plc.points[middle.first] == plc.points[middle.second]) continue;
    wheels.try_emplace(middle, plc, middle);
  }
  for (const Plc::Triangle& triangle : plc.triangles)
    for (unsigned i = 0; i < 3; ++i)
      if (const auto wheel = wheels.find(edge(triangle.points[i], triangle.points[(i + 1) % 3]));
          wheel != wheels.end())
        wheel->second.add(triangle);
  std::vector<std::pair<double, int>> wedges;  // by curve: the sum of angles, and the number of wedges
  for (const Plc::Curve& curve : plc.curves) {
    const auto wheel = wheels.find(middle_segment(curve));
    wedges.push_back(curve.patches.empty() || wheel == wheels.end() ? std::pair{full_circle, 1}
                                                                    : wheel->second.inside());
    shares.of_curve.push_back(wedges.back().first / full_circle);
  }

  // Uses Girard's theorem: the solid angle of a cone with n edges is the sum of their dihedral angles minus
  // (n - 2) pi.
  for (Index v = 0; v < plc.vertices.size(); ++v) {
    const Plc::Vertex& vertex = plc.vertices[v];
    std::set<Index> regions;
    for (const Index patch : vertex.patches)
      for (const Index region : plc.patches[patch].regions)
        if (region > 0) regions.insert(region);
    double angle = full_circle * static_cast<double>(regions.size());
    bool has_edges = false;
    for (const Index c : vertex.curves) {
      const auto& [sum, count] = wedges[c];
      const int ends = static_cast<int>(std::ranges::count(plc.curves[c].ends, v));
      angle += ends * (sum - std::numbers::pi * count);
      has_edges = has_edges || ends > 0;
    }
    if (!has_edges) angle = regions.size() > 1 || vertex.patches.empty() ? full_space : full_space / 2;
    shares.of_vertex.push_back(std::clamp(angle / full_space, 0.02, 1.0));
  }
  return shares;
}

}  // namespace collarmesh::prediction
