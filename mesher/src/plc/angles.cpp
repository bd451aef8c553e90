#include "plc/angles.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace collarmesh::plc {

using namespace facets;

namespace {

constexpr double degrees = 180 / std::numbers::pi;
// A sector whose angle has a smaller sine counts as a ray.
constexpr double narrow = 1e-12;

// A sector of a fan. Its rays are start cos(s) + side sin(s).
struct Arc {
  Vector start, side;
  double from, length;  // radians along the fan

  Vector at(double s) const { return std::cos(s) * start + std::sin(s) * side; }
};

std::vector<Arc> make_arcs(std::span<const Vector> rays, bool closed) {
  std::vector<Arc> arcs;
  double from = 0;
  const std::size_t count = closed ? rays.size() : rays.size() - 1;
  for (std::size_t i = 0; i < count; ++i) {
    const Vector &u = rays[i], &v = rays[(i + 1) % rays.size()];
    const Vector side = v - dot(u, v) * u;
    const double length = norm(side);
    if (length < narrow) continue;
    arcs.push_back({u, side / length, from, std::atan2(length, dot(u, v))});
    from += arcs.back().length;
  }
  return arcs;
}

// Returns the smallest angle between the rays a.at(a0 + s) and b.at(b0 + s) for s in [0, length].
double smallest_angle_along(const Arc& a, double a0, const Arc& b, double b0, double length) {
  const Vector ua = a.at(a0), va = a.at(a0 + std::numbers::pi / 2), ub = b.at(b0),
               vb = b.at(b0 + std::numbers::pi / 2);
  double best = std::fmin(angle_between(ua, ub), angle_between(a.at(a0 + length), b.at(b0 + length)));
  // The cosine of the angle between the rays is a constant + (p cos 2s + q sin 2s) / 2, largest at `peak`.
  const double p = dot(ua, ub) - dot(va, vb), q = dot(ua, vb) + dot(va, ub);
  const double peak = 0.5 * std::atan2(q, p);
  for (const double s : {peak, peak + std::numbers::pi})
    if (s > 0 && s < length) best = std::fmin(best, angle_between(a.at(a0 + s), b.at(b0 + s)));
  return best;
}

// Returns the smallest angle between rays whose distance along the fan is `apart` (radians). Moves a pair of
// such rays along the fan, from one sector border to the next.
double smallest_angle_apart(const std::vector<Arc>& arcs, double apart, bool closed) {
  const double total = arcs.back().from + arcs.back().length;
  const double last = closed ? total : total - apart;
  std::size_t i = 0, j = 0;
  while (j + 1 < arcs.size() && arcs[j].from + arcs[j].length <= apart) ++j;
  double best = 180, s = 0, lap = 0;
  while (i < arcs.size() && s < last) {
    const double a0 = s - arcs[i].from, b0 = std::fmax(0, s + apart - lap - arcs[j].from);
    const double to_next_i = arcs[i].length - a0, to_next_j = std::fmax(0, arcs[j].length - b0);
    best = std::fmin(
        best, smallest_angle_along(arcs[i], a0, arcs[j], b0, std::min({to_next_i, to_next_j, last - s})));
    if (to_next_i <= to_next_j) {
      s = arcs[i].from + arcs[i].length;
      ++i;
    } else {
      s += to_next_j;
      if (++j < arcs.size()) continue;
      if (!closed) break;
      j = 0;
      lap = total;
    }
  }
  return best;
}

}  // namespace

double angle_between(const Vector& u, const Vector& v) {
  return degrees * std::atan2(norm(cross(u, v)), dot(u, v));
}

double angle_between(const Vector& ray, const Sector& sector) {
  const Vector normal = cross(sector.u, sector.v);
  const double sine = norm(normal);
  if (sine > narrow && dot(cross(sector.u, ray), normal) > 0 && dot(cross(ray, sector.v), normal) > 0)
    return degrees * std::asin(std::fmin(1, std::fabs(dot(ray, normal)) / sine));
  return std::fmin(angle_between(ray, sector.u), angle_between(ray, sector.v));
}

double angle_between(const Sector& s, const Sector& t) {
  return std::min(
      {angle_between(s.u, t), angle_between(s.v, t), angle_between(t.u, s), angle_between(t.v, s)});
}

double fold_angle(std::span<const Vector> rays, bool closed) {
  const std::vector<Arc> arcs = make_arcs(rays, closed);
  if (arcs.empty()) return 180;
  const double total = arcs.back().from + arcs.back().length;
  if (closed) return smallest_angle_apart(arcs, 0.5 * total, true);
  double best = 180;
  for (const double apart : {0.5, 0.75, 1.0})
    if (apart * std::numbers::pi <= total)
      best = std::fmin(best, smallest_angle_apart(arcs, apart * std::numbers::pi, false));
  return best;
}

}  // namespace collarmesh::plc
