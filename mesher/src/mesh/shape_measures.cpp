#include "collarmesh/shape_measures.h"

#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "common/disjoint_sets.h"
#include "common/round_curves.h"

namespace collarmesh {

namespace {

/// Returns the derivatives of the position by barycentric coordinates, at lambda, in a shape of second order
/// with nodes x. In the derivative by lambda_i, corner i has the weight 4 lambda_i - 1; the mid-edge node of
/// an edge ij has the weight 4 lambda_j.
template <std::size_t corners, std::size_t nodes>
std::array<Vector, corners> derivatives(const std::array<Point, nodes>& x,
                                        const std::array<std::array<unsigned, 2>, nodes - corners>& edges,
                                        const std::array<double, corners>& lambda) {
  const auto from_first = [&](std::size_t node) { return x[node] - x[0]; };  // relative to the first node,
                                                                             // for accuracy of small shapes
                                                                             // far from 0
  std::array<Vector, corners> d{};
  for (std::size_t i = 0; i < corners; ++i) d[i] = (4 * lambda[i] - 1) * from_first(i);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto& [i, j] = edges[e];
    d[i] = d[i] + 4 * lambda[j] * from_first(corners + e);
    d[j] = d[j] + 4 * lambda[i] * from_first(corners + e);
  }
  return d;
}

double six_jacobian(const CurvedTet& nodes, const std::array<double, 4>& lambda) {
  constexpr std::array<std::array<unsigned, 2>, 6> edges{{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};
  const auto d = derivatives<4>(nodes, edges, lambda);
  return dot(cross(d[1] - d[0], d[2] - d[0]), d[3] - d[0]);
}

double doubled_area(const CurvedTriangle& nodes, const std::array<double, 3>& lambda) {
  constexpr std::array<std::array<unsigned, 2>, 3> edges{{{0, 1}, {1, 2}, {2, 0}}};
  const auto d = derivatives<3>(nodes, edges, lambda);
  return norm(cross(d[1] - d[0], d[2] - d[0]));
}

double triangle_area(const Plc& plc, const Plc::Triangle& t) {
  const auto& [a, b, c] = t.points;
  return 0.5 * norm(cross(plc.points[b] - plc.points[a], plc.points[c] - plc.points[a]));
}

/// The volume that oriented triangles enclose, computed with one of their corners as apex: with an apex far
/// away, a tiny volume would be lost in cancellation.
class Enclosed {
 public:
  void add(const Point& a, const Point& b, const Point& c, bool is_outward) {
    if (!origin_) origin_ = a;
    const double cone = six_volume(*origin_, a, b, c);
    six_volume_ += is_outward ? cone : -cone;
  }
  double volume() const { return static_cast<double>(six_volume_ / 6); }

 private:
  std::optional<Point> origin_;
  long double six_volume_ = 0;
};

std::vector<double> enclosed_by_patches(const Plc& plc) {
  std::vector<Enclosed> regions(plc.regions.size());
  for (const Plc::Triangle& t : plc.triangles) {
    const Plc::Patch& patch = plc.patches[t.patch];
    if (patch.regions[0] == patch.regions[1]) continue;
    for (unsigned side = 0; side < 2; ++side)
      regions[patch.regions[side]].add(plc.points[t.points[0]], plc.points[t.points[1]],
                                       plc.points[t.points[2]], side == 0);
  }
  std::vector<double> volumes;
  volumes.reserve(regions.size());
  for (const Enclosed& region : regions) volumes.push_back(region.volume());
  if (!volumes.empty()) volumes[0] = 0;
  return volumes;
}

std::vector<double> enclosed_by_shells(const Plc& plc) {
  std::vector<double> volumes;
  for (const Shell& shell : shells_of(plc)) {
    Enclosed enclosed;
    for (const Index p : shell.patches) {
      const Plc::Patch& patch = plc.patches[p];
      for (Index i = patch.first_triangle; i < patch.first_triangle + patch.triangle_count; ++i) {
        const auto& [a, b, c] = plc.triangles[i].points;
        enclosed.add(plc.points[a], plc.points[b], plc.points[c], patch.regions[0] == shell.region);
      }
    }
    volumes.push_back(std::fabs(enclosed.volume()));
  }
  return volumes;
}

/// Joins sides of patches that bound the same region and meet in a curve. The number of a patch's side is
/// twice the patch's index, plus one for the side in front.
DisjointSets connected_sides(const Plc& plc) {
  DisjointSets sides(2 * plc.patches.size());
  std::map<Index, Index> first_side;  // at one curve, by region
  for (const Plc::Curve& curve : plc.curves) {
    first_side.clear();
    for (const Index p : curve.patches)
      for (Index side = 0; side < 2; ++side)
        sides.unite(2 * p + side,
                    first_side.emplace(plc.patches[p].regions[side], 2 * p + side).first->second);
  }
  return sides;
}

}  // namespace

std::vector<Shell> shells_of(const Plc& plc) {
  DisjointSets sides = connected_sides(plc);
  std::map<std::pair<Index, Index>, std::vector<Index>> parts;  // by region and representative
  std::vector<std::vector<Index>> boundaries(plc.regions.size());
  for (Index p = 0; p < plc.patches.size(); ++p) {
    const Plc::Patch& patch = plc.patches[p];
    if (patch.regions[0] == patch.regions[1]) continue;
    for (Index side = 0; side < 2; ++side) {
      parts[{patch.regions[side], sides.find(2 * p + side)}].push_back(p);
      boundaries[patch.regions[side]].push_back(p);
    }
  }
  std::set<std::vector<Index>> known;
  for (std::size_t r = 1; r < boundaries.size(); ++r) known.insert(std::move(boundaries[r]));
  std::vector<Shell> shells;
  for (auto& [part, patches] : parts)
    if (known.insert(patches).second) shells.push_back({part.first, std::move(patches)});
  return shells;
}

ShapeMeasures measures_of(const Plc& plc) {
  ShapeMeasures measures;
  measures.volumes = enclosed_by_patches(plc);
  measures.shells = enclosed_by_shells(plc);
  for (const Plc::Patch& patch : plc.patches) {
    double& area = measures.areas.emplace_back(0);
    for (Index i = 0; i < patch.triangle_count; ++i)
      area += triangle_area(plc, plc.triangles[patch.first_triangle + i]);
  }
  for (const Plc::Curve& curve : plc.curves) measures.lengths.push_back(length_of(plc, curve));
  return measures;
}

// Integrates the Jacobian determinant, a cubic polynomial, by the rule with five points, which is exact for
// it (Keast, Moderate-degree tetrahedral quadrature formulas, 1986).
double volume(const CurvedTet& nodes) {
  double sum = -0.8 * six_jacobian(nodes, {0.25, 0.25, 0.25, 0.25});
  for (unsigned i = 0; i < 4; ++i) {
    std::array<double, 4> lambda{1. / 6, 1. / 6, 1. / 6, 1. / 6};
    lambda[i] = 0.5;
    sum += 0.45 * six_jacobian(nodes, lambda);
  }
  return sum / 6;
}

// Integrates by six points (Dunavant, High degree efficient symmetrical Gaussian quadrature rules for the
// triangle, 1985).
double area(const CurvedTriangle& nodes) {
  double sum = 0;
  for (const auto& [weight, twice] :
       {std::array{0.223381589678011, 0.445948490915965}, std::array{0.109951743655322, 0.091576213509771}})
    for (unsigned i = 0; i < 3; ++i) {
      std::array<double, 3> lambda{twice, twice, twice};
      lambda[i] = 1 - 2 * twice;
      sum += weight * doubled_area(nodes, lambda);
    }
  return sum / 2;
}

double volume_below(const Point& apex, const CurvedTriangle& nodes) {
  const auto& [a, b, c, ab, bc, ca] = nodes;
  return -volume(CurvedTet{a, b, c, apex, ab, bc, ca, 0.5 * (a + apex), 0.5 * (b + apex), 0.5 * (c + apex)});
}

double length(const CurvedEdge& nodes) {
  constexpr std::array<std::array<unsigned, 2>, 1> edges{{{0, 1}}};
  const double off = std::sqrt(0.15);
  double sum = 0;
  for (const auto& [weight, t] :
       {std::array{5. / 18, 0.5 - off}, std::array{8. / 18, 0.5}, std::array{5. / 18, 0.5 + off}}) {
    const auto d = derivatives<2>(nodes, edges, {1 - t, t});
    sum += weight * norm(d[1] - d[0]);
  }
  return sum;
}

}  // namespace collarmesh
