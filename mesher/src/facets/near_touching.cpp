#include "facets/near_touching.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/box_frame.h"
#include "common/box_tree.h"
#include "common/distances.h"
#include "common/segments.h"

namespace collarmesh::facets {

namespace {

// A piece of a feature: a point, a segment or a triangle.
struct Element {
  std::array<Index, 3> points;
  unsigned size;
  unsigned dimension;
  Index feature;
  std::array<Vector, 2> axes{};  // for a triangle: unit vectors along its normal and across its longest side
};

constexpr double roundings = 32;

std::array<Vector, 2> axes_of(const Point& a, const Point& b, const Point& c) {
  Vector longest;
  for (const Vector& side : {b - a, c - b, a - c})
    if (squared_norm(side) > squared_norm(longest)) longest = side;
  const Vector normal = cross(b - a, c - a), across = cross(normal, longest);
  if (!(norm(normal) > 0 && norm(across) > 0)) return {};
  return {normal / norm(normal), across / norm(across)};
}

struct Nearest {
  double squared_distance = INFINITY;
  Point where;
};

bool have_common(const std::vector<Index>& a, const std::vector<Index>& b) {
  const auto &few = a.size() < b.size() ? a : b, &many = a.size() < b.size() ? b : a;
  return std::ranges::any_of(few, [&](Index i) { return std::ranges::binary_search(many, i); });
}

class NearTouchingFinder {
 public:
  NearTouchingFinder(const Plc& plc, double limit) : plc_(plc), limit_(limit) {
    for (Index v = 0; v < plc.vertices.size(); ++v) {
      const Index p = plc.vertices[v].point;
      elements_.push_back({{p, p, p}, 1, 0, v});
    }
    for (Index c = 0; c < plc.curves.size(); ++c)
      visit_segments(plc.curves[c], [&](Index a, Index b) { elements_.push_back({{a, b, a}, 2, 1, c}); });
    for (const Plc::Triangle& t : plc.triangles)
      elements_.push_back(
          {t.points, 3, 2, t.patch, axes_of(at(t.points[0]), at(t.points[1]), at(t.points[2]))});
  }

  void run(Faults& faults) {
    std::vector<std::array<Index, 3>> triangles;
    for (const Plc::Triangle& t : plc_.triangles) triangles.push_back(t.points);
    const BoxFrame frame(plc_.points, triangles);
    std::vector<Box> boxes(elements_.size());
    for (std::size_t e = 0; e < elements_.size(); ++e)
      for (unsigned i = 0; i < elements_[e].size; ++i)
        frame.add(boxes[e], at(elements_[e].points[i]), 0.5 * limit_);
    margin_ = limit_ + roundings * std::numeric_limits<double>::epsilon() * plc_.bounds.diagonal();
    BoxTree(boxes, features()).for_each_pair([&](Index i, Index j) {
      const Element &a = elements_[std::min(i, j)], &b = elements_[std::max(i, j)];
      if (have_common_point(a, b) || apart(a, b) || apart(b, a) || related(a, b)) return;
      const Nearest nearest = nearest_of(a, b);
      if (nearest.squared_distance > limit_ * limit_) return;
      Nearest& known = found_[{a.dimension, a.feature, b.dimension, b.feature}];
      if (nearest.squared_distance < known.squared_distance) known = nearest;
    });
    find_slits_between_curves();
    for (const auto& [pair, nearest] : found_) report(pair, nearest, faults);
  }

 private:
  using Pair = std::array<Index, 4>;

  const Point& at(Index p) const { return plc_.points[p]; }

  // Returns the group of each element: its feature, so that elements of one feature are not compared.
  std::vector<Index> features() const {
    const auto vertices = static_cast<Index>(plc_.vertices.size()),
               curves = static_cast<Index>(plc_.curves.size());
    const std::array<Index, 3> first{0, vertices, vertices + curves};
    std::vector<Index> groups;
    groups.reserve(elements_.size());
    for (const Element& e : elements_) groups.push_back(first[e.dimension] + e.feature);
    return groups;
  }

  // Finds curves with the same ends that are near each other along their whole length. They enclose nothing,
  // like the two long sides of a facet of zero height.
  void find_slits_between_curves() {
    std::map<std::array<Index, 2>, std::vector<Index>> between;
    for (Index c = 0; c < plc_.curves.size(); ++c) {
      const auto& [a, b] = plc_.curves[c].ends;
      if (!plc_.curves[c].closed && a != b) between[{std::min(a, b), std::max(a, b)}].push_back(c);
    }
    for (const auto& [ends, curves] : between)
      for (std::size_t i = 0; i < curves.size(); ++i)
        for (std::size_t j = i + 1; j < curves.size(); ++j) {
          const auto apart = largest_distance(curves[i], curves[j]);
          if (apart) found_[{1, curves[i], 1, curves[j]}] = *apart;
        }
  }

  // Returns the largest distance of a point of either curve from the other; nothing if it exceeds the limit.
  std::optional<Nearest> largest_distance(Index c, Index d) const {
    Nearest largest{0, at(plc_.curves[c].points.front())};
    for (const auto& [from, to] : {std::pair(c, d), std::pair(d, c)}) {
      const auto &points = plc_.curves[from].points, &others = plc_.curves[to].points;
      for (const Index p : points) {
        Nearest nearest;
        for (std::size_t i = 0; i + 1 < others.size() && nearest.squared_distance > 0; ++i)
          keep_nearer(nearest, at(p),
                      nearest_point(at(p), {{others[i], others[i + 1], others[i]}, 2, 1, to}));
        if (nearest.squared_distance > limit_ * limit_) return std::nullopt;
        if (nearest.squared_distance > largest.squared_distance) largest = nearest;
      }
    }
    return largest;
  }

  static bool have_common_point(const Element& a, const Element& b) {
    const auto end = b.points.begin() + b.size;
    return std::any_of(a.points.begin(), a.points.begin() + a.size,
                       [&](Index p) { return std::find(b.points.begin(), end, p) != end; });
  }

  // Returns whether b is surely farther than the limit from the triangle a. Boxes of needles overlap by the
  // million, so a quick test pays off.
  bool apart(const Element& a, const Element& b) const {
    return a.size == 3 && std::ranges::any_of(a.axes, [&](const Vector& axis) {
             double low = INFINITY, high = -INFINITY, low_of_a = 0, high_of_a = 0;
             for (unsigned i = 1; i < a.size; ++i) {
               const double along = dot(axis, at(a.points[i]) - at(a.points[0]));
               low_of_a = std::min(low_of_a, along);
               high_of_a = std::max(high_of_a, along);
             }
             for (unsigned i = 0; i < b.size; ++i) {
               const double along = dot(axis, at(b.points[i]) - at(a.points[0]));
               low = std::min(low, along);
               high = std::max(high, along);
             }
             return low > high_of_a + margin_ || high < low_of_a - margin_;
           });
  }

  // Returns whether one of two features is part of the other, or whether both meet in a third one.
  // Precondition: the dimension of the first is not higher than that of the second.
  bool related(const Element& a, const Element& b) const {
    if (a.dimension == 0) {
      if (b.dimension == 1) return plc_.vertex_on_curve(a.feature, b.feature);
      return b.dimension == 2 && plc_.vertex_on_patch(a.feature, b.feature);
    }
    if (a.dimension == 1) {
      const auto& ends = plc_.curves[a.feature].ends;
      if (b.dimension == 1) {
        const auto& others = plc_.curves[b.feature].ends;
        return std::ranges::any_of(
            ends, [&](Index v) { return v != none && std::ranges::find(others, v) != others.end(); });
      }
      return plc_.curve_on_patch(a.feature, b.feature) || std::ranges::any_of(ends, [&](Index v) {
               return v != none && plc_.vertex_on_patch(v, b.feature);
             });
    }
    const Plc::Patch &p = plc_.patches[a.feature], &q = plc_.patches[b.feature];
    return have_common(p.vertices, q.vertices) || have_common(p.curves, q.curves);
  }

  static void keep_nearer(Nearest& nearest, const Point& p, const Point& q) {
    const double d = squared_distance(p, q);
    if (d < nearest.squared_distance) nearest = {d, 0.5 * (p + q)};
  }

  // Considers the nearest points of the lines through two segments (Ericson: Real-Time Collision Detection,
  // section 5.1.9) if they lie within both segments. Otherwise an end of a segment is nearest; other calls
  // consider the ends.
  static void keep_nearer_of_lines(Nearest& nearest, const Point& p, const Point& q, const Point& r,
                                   const Point& s) {
    const Vector u = q - p, v = s - r, w = p - r;
    const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), uw = dot(u, w), vw = dot(v, w);
    const double determinant = uu * vv - uv * uv;
    if (!(determinant > 0)) return;
    const double a = (uv * vw - vv * uw) / determinant, b = (uu * vw - uv * uw) / determinant;
    if (a >= 0 && a <= 1 && b >= 0 && b <= 1) keep_nearer(nearest, p + a * u, r + b * v);
  }

  Point nearest_point(const Point& p, const Element& e) const {
    const auto corner = [&](unsigned i) { return at(e.points[std::min(i, e.size - 1U)]); };
    return nearest_point_on_triangle(p, corner(0), corner(1), corner(2));
  }

  Nearest nearest_of(const Element& a, const Element& b) const {
    Nearest nearest;
    for (unsigned i = 0; i < a.size; ++i)
      keep_nearer(nearest, at(a.points[i]), nearest_point(at(a.points[i]), b));
    for (unsigned i = 0; i < b.size; ++i)
      keep_nearer(nearest, nearest_point(at(b.points[i]), a), at(b.points[i]));
    for (unsigned i = 0; a.size > 1 && i < a.size; ++i)
      for (unsigned j = 0; b.size > 1 && j < b.size; ++j)
        keep_nearer_of_lines(nearest, at(a.points[i]), at(a.points[(i + 1) % a.size]), at(b.points[j]),
                             at(b.points[(j + 1) % b.size]));
    return nearest;
  }

  std::string name(Index dimension, Index feature) const {
    if (dimension == 0) return fmt::format("vertex {}", text(at(plc_.vertices[feature].point)));
    const Tag tag = dimension == 1 ? plc_.curves[feature].tag : plc_.patches[feature].tag;
    return fmt::format("{} {}{}", dimension == 1 ? "curve" : "patch", feature,
                       tag == 0 ? "" : fmt::format(" (tag {})", tag));
  }

  void report(const Pair& pair, const Nearest& nearest, Faults& faults) const {
    faults.add(
        PlcFault::Kind::intersection,
        fmt::format("The {} and the {} come within {:.3g} of each other at {} and do not meet; that is "
                    "less than the weld distance of {:.3g}. Move them apart, cut one where the other "
                    "touches it, or lower the weld distance.",
                    name(pair[0], pair[1]), name(pair[2], pair[3]), std::sqrt(nearest.squared_distance),
                    text(nearest.where), limit_),
        {}, nearest.where);
  }

  const Plc& plc_;
  double limit_, margin_ = 0;  // `margin_`: the limit plus a bound on rounding errors
  std::vector<Element> elements_;
  std::map<Pair, Nearest> found_;
};

}  // namespace

void find_near_touching(const Plc& plc, double limit, Faults& faults) {
  const bool has_pairs = plc.vertices.size() + plc.curves.size() + plc.patches.size() > 1;
  if (limit > 0 && has_pairs) NearTouchingFinder(plc, limit).run(faults);
}

}  // namespace collarmesh::facets
