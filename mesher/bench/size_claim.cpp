// Tests the paper's claim on the size of meshes: computes the number of tets divided by the integral of h^-3,
// for families in which an angle or the spread varies. Prints Markdown tables; takes no arguments.
//
// The feature size h(x) is the smallest distance within which x has two features that are disjoint (the local
// feature size, paper, Definition 3) or that meet at a crease (as in the gap size, Definition 2); h is
// 1-Lipschitz and is 0 only at creases. Tets in collars belong neither to the number nor to the integral. The
// target edge length is so large that it has no effect.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "collarmesh/mesher.h"
#include "collarmesh/plc_builder.h"
#include "plc/angles.h"
#include "support/acute_shapes.h"
#include "support/shapes.h"

namespace {

using namespace collarmesh;

double to_segment(const Point& p, const Point& a, const Point& b) {
  const Vector d = b - a;
  const double length = squared_norm(d);
  return distance(p, length > 0 ? a + std::clamp(dot(p - a, d) / length, 0.0, 1.0) * d : a);
}

double to_triangle(const Point& p, const std::array<Point, 3>& t) {
  const Vector n = cross(t[1] - t[0], t[2] - t[0]);
  const Point foot = p - (dot(p - t[0], n) / squared_norm(n)) * n;
  double nearest = INFINITY;
  bool inside = true;
  for (std::size_t k = 0; k < 3; ++k) {
    const Point &a = t[k], &b = t[(k + 1) % 3];
    inside = inside && dot(cross(b - a, foot - a), n) >= 0;
    nearest = std::min(nearest, to_segment(p, a, b));
  }
  return inside ? distance(p, foot) : nearest;
}

Vector unit(const Vector& v) { return v / norm(v); }

/// A vertex, a straight curve or a planar patch.
struct Feature {
  unsigned dimension;
  Index index;
  std::vector<std::array<Point, 3>> triangles;  // degenerate below dimension 2
  std::set<Index> vertices, curves;             // vertices and curves that the feature contains
};

/// The feature size h of a complex of straight curves and planar patches; at(x) returns h(x).
class FeatureSize {
 public:
  explicit FeatureSize(const Plc& plc) : plc_(plc) {
    for (Index v = 0; v < plc.vertices.size(); ++v) {
      const Point p = plc.points[plc.vertices[v].point];
      features_.push_back({0, v, {{p, p, p}}, {v}, {}});
    }
    for (Index c = 0; c < plc.curves.size(); ++c) {
      const auto [a, b] = ends(c);
      features_.push_back({1, c, {{a, b, b}}, {plc.curves[c].ends[0], plc.curves[c].ends[1]}, {c}});
    }
    for (Index p = 0; p < plc.patches.size(); ++p) {
      const Plc::Patch& patch = plc.patches[p];
      Feature f{2,
                p,
                {},
                {patch.vertices.begin(), patch.vertices.end()},
                {patch.curves.begin(), patch.curves.end()}};
      for (Index t = patch.first_triangle; t < patch.first_triangle + patch.triangle_count; ++t) {
        const auto& [a, b, c] = plc.triangles[t].points;
        f.triangles.push_back({plc.points[a], plc.points[b], plc.points[c]});
      }
      features_.push_back(std::move(f));
    }
    separate_.assign(features_.size() * features_.size(), false);
    for (std::size_t i = 0; i < features_.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        separate_[i * features_.size() + j] = separate_[j * features_.size() + i] =
            are_separate(features_[i], features_[j]);
  }

  double at(const Point& x) {
    nearest_.clear();
    for (std::size_t i = 0; i < features_.size(); ++i) {
      double d = INFINITY;
      for (const auto& t : features_[i].triangles)
        d = std::min(d, features_[i].dimension == 2 ? to_triangle(x, t) : to_segment(x, t[0], t[1]));
      nearest_.emplace_back(d, i);
    }
    std::sort(nearest_.begin(), nearest_.end());
    for (std::size_t k = 1; k < nearest_.size(); ++k)
      for (std::size_t l = 0; l < k; ++l)
        if (separate_[nearest_[k].second * features_.size() + nearest_[l].second]) return nearest_[k].first;
    return INFINITY;
  }

 private:
  static constexpr double acute = 60;  // degrees; angles below this make creases

  std::array<Point, 2> ends(Index curve) const {
    const auto& points = plc_.curves[curve].points;
    return {plc_.points[points.front()], plc_.points[points.back()]};
  }

  template <class Set>
  static std::vector<Index> common(const Set& a, const Set& b) {
    std::vector<Index> both;
    std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
    return both;
  }

  // Returns whether two features are disjoint, or meet at an acute angle and neither of them is in the border
  // of the other.
  bool are_separate(const Feature& f, const Feature& g) const {
    const auto curves = common(f.curves, g.curves), vertices = common(f.vertices, g.vertices);
    if (curves.empty() && vertices.empty()) return true;
    const auto contains = [](const Feature& a, const Feature& b) {
      return b.dimension == 0 ? a.vertices.contains(b.index) : b.dimension == 1 && a.curves.contains(b.index);
    };
    if (contains(f, g) || contains(g, f)) return false;
    for (const Index c : curves)
      if (angle_at_curve(f, g, c) < acute) return true;
    const auto on_common_curve = [&](Index v) {
      return std::any_of(curves.begin(), curves.end(),
                         [&](Index c) { return plc_.curves[c].ends[0] == v || plc_.curves[c].ends[1] == v; });
    };
    return std::any_of(vertices.begin(), vertices.end(),
                       [&](Index v) { return !on_common_curve(v) && angle_at_vertex(f, g, v) < acute; });
  }

  // Returns the smallest angle, in degrees, between a half plane of f and one of g at a curve. A patch has
  // two half planes there if it continues on both sides of the curve.
  double angle_at_curve(const Feature& f, const Feature& g, Index curve) const {
    const auto [a, b] = ends(curve);
    const Vector axis = unit(b - a);
    const Point middle = a + 0.5 * (b - a);
    const auto ways = [&](const Feature& patch) {
      std::vector<Vector> found;
      const double near = 1e-9 * distance(a, b);
      for (const auto& t : patch.triangles) {
        if (to_triangle(middle, t) > near) continue;
        const Point centre = (t[0] + t[1] + t[2]) / 3;
        const Vector d = centre - middle;
        found.push_back(unit(d - dot(d, axis) * axis));
      }
      return found;
    };
    double least = 180;
    for (const Vector& u : ways(f))
      for (const Vector& v : ways(g)) least = std::min(least, plc::angle_between(u, v));
    return least;
  }

  double angle_at_vertex(const Feature& f, const Feature& g, Index vertex) const {
    const Point p = plc_.points[plc_.vertices[vertex].point];
    double least = 180;
    for (const plc::Sector& s : sectors(f, p))
      for (const plc::Sector& t : sectors(g, p)) {
        const bool ray = f.dimension == 1, other_ray = g.dimension == 1;
        least = std::min(least, ray && other_ray ? plc::angle_between(s.u, t.u)
                                : ray            ? plc::angle_between(s.u, t)
                                : other_ray      ? plc::angle_between(t.u, s)
                                                 : plc::angle_between(s, t));
      }
    return least;
  }

  // Returns the feature's sectors at p: for each triangle with the corner p, the sector between the rays from
  // p to the other two corners.
  static std::vector<plc::Sector> sectors(const Feature& f, const Point& p) {
    std::vector<plc::Sector> found;
    for (const auto& t : f.triangles)
      for (std::size_t k = 0; k < 3; ++k)
        if (t[k] == p && t[(k + 1) % 3] != p)
          found.push_back({unit(t[(k + 1) % 3] - p),
                           t[(k + 2) % 3] == p ? unit(t[(k + 1) % 3] - p) : unit(t[(k + 2) % 3] - p)});
    return found;
  }

  const Plc& plc_;
  std::vector<Feature> features_;
  std::vector<bool> separate_;
  std::vector<std::pair<double, std::size_t>> nearest_;  // scratch
};

/// Returns the integral of h^-3 over the tets outside collars, estimated at random points of each tet. A few
/// points per tet suffice, because tets are small where h is small.
double integral(const TetMesh& mesh, FeatureSize& h) {
  constexpr int samples = 16;
  std::mt19937_64 random(1);
  std::exponential_distribution<double> share;
  double sum = 0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (mesh.tet_collar[t] != 0) continue;
    std::array<Point, 4> p;
    for (std::size_t k = 0; k < 4; ++k) p[k] = mesh.points[mesh.tets[t][k]];
    const double volume = six_volume(p[0], p[1], p[2], p[3]) / 6;
    for (int s = 0; s < samples; ++s) {
      std::array<double, 4> w{share(random), share(random), share(random), share(random)};
      const double total = w[0] + w[1] + w[2] + w[3];
      const Point x = p[0] + (w[1] / total) * (p[1] - p[0]) + (w[2] / total) * (p[2] - p[0]) +
                      (w[3] / total) * (p[3] - p[0]);
      sum += volume / samples / std::pow(h.at(x), 3);
    }
  }
  return sum;
}

struct Quotients {
  double least = INFINITY, greatest = 0;
};

void row(const std::string& family, const std::string& name, const std::vector<PolygonSoup>& soups,
         std::map<std::string, Quotients>& all) {
  const Plc plc = build_plc(soups);
  MeshOptions options;
  options.size = 10 * plc.bounds.diagonal();
  options.time_limit = 60;
  const MeshResult made = generate(plc, options);
  if (made.status != MeshStatus::complete) {
    fmt::print("| {} | {} | {} | | | |\n", family, name, made.message);
    return;
  }
  FeatureSize h(plc);
  const auto tets = std::count(made.mesh.tet_collar.begin(), made.mesh.tet_collar.end(), 0);
  const double size = integral(made.mesh, h), quotient = static_cast<double>(tets) / size;
  Quotients& of_family = all[family];
  of_family.least = std::min(of_family.least, quotient);
  of_family.greatest = std::max(of_family.greatest, quotient);
  fmt::print("| {} | {} | {} | {} | {:.4g} | {:.2f} |\n", family, name, made.mesh.tets.size(), tets, size,
             quotient);
  std::fflush(stdout);
}

}  // namespace

int main() {
  using namespace collarmesh::testing;
  std::map<std::string, Quotients> all;
  fmt::print(
      "| family | member | tets | outside collars | integral | quotient |\n|---|---|---|---|---|---|\n");
  for (const double angle : {55.0, 40.0, 20.0, 10.0, 5.0, 2.0, 1.0})
    row("wedge", fmt::format("{} degrees", angle), acute::wedge(angle).soups, all);
  for (const double angle : {50.0, 30.0, 15.0, 8.0, 4.0})
    row("needle", fmt::format("{} degrees", angle), acute::pyramid(4, angle).soups, all);
  for (const unsigned sheets : {7U, 12U, 24U, 48U})
    row("fan", fmt::format("{} sheets", sheets), acute::fan(sheets).soups, all);
  for (const int k : {2, 4, 8, 12, 16, 20, 24, 28})
    row("small facet", fmt::format("2^-{}", k), {box_with_small_facet(std::ldexp(1.0, -k))}, all);
  for (const unsigned levels : {1U, 2U, 4U, 6U})
    row("nested boxes", fmt::format("{}", levels), nested_boxes(levels), all);
  for (const unsigned points : {5U, 20U, 80U})
    row("points on skew lines", fmt::format("2 x {}", points), {box_with_skew_lines(points)}, all);
  fmt::print("\n| family | least | greatest | ratio |\n|---|---|---|---|\n");
  for (const auto& [family, q] : all)
    fmt::print("| {} | {:.2f} | {:.2f} | {:.1f} |\n", family, q.least, q.greatest, q.greatest / q.least);
  return 0;
}
