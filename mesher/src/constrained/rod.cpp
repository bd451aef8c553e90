#include "constrained/rod.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace collarmesh::constrained {

namespace {

constexpr double full_turn = 2 * std::numbers::pi;
// The largest radius of a rod, as a share of the size, and its least length, in radii.
constexpr double thinner_than_size = 0.5, least_length = 8;
// Largest permitted ratio of the largest to the smallest distance of the patch from the axis in one section.
constexpr double roundest = 1.25;
// Rings are at most this many radii apart. Then a tet between the chord of a ring and a piece of the axis has
// a dihedral angle below 150 degrees at the chord.
constexpr double apart = 6.2;
// Share of the tolerance for chords around the rod.
constexpr double share_around = 0.75;
constexpr std::size_t fewest_in_ring = 8, most_in_ring = 24;
// The smallest permitted dihedral angle of tets, degrees: a little above the bound for thin tets.
constexpr double least_angle = 8.2;
// Largest permitted measured distance of the patch from chords around a straight rod and around a bent one,
// as shares of the tolerance.
constexpr double share_measured = 0.95, share_measured_of_bent = 0.6;
constexpr std::size_t rays_of_section = 16, most_sections = 200'000, fewest_rings_of_loop = 8;
constexpr double step_in_radii = 1, rays_per_radius = 8;

/// Returns the largest permitted distance between neighbouring rings with this many vertices, in radii of the
/// rod. The smallest angle of the tets is that at an edge from the axis to a ring, between the plane that
/// contains the axis and the plane through the next vertex of the ring.
double largest_spacing(std::size_t in_ring) {
  const double chord = 2 * std::sin(std::numbers::pi / static_cast<double>(in_ring)),
               slope = std::tan(least_angle * std::numbers::pi / 180) / chord, rest = slope * slope - 0.25;
  return rest > 0 ? std::min(apart, 1 / std::sqrt(rest)) : apart;
}

Vector unit_of(const Vector& v) { return v / norm(v); }
double area_of(const Plc& plc, const Plc::Triangle& t) {
  const auto& [a, b, c] = t.points;
  return 0.5 * norm(cross(plc.points[b] - plc.points[a], plc.points[c] - plc.points[a]));
}

Vector any_across(const Vector& along) {
  const Vector least = std::fabs(along.x) < std::fabs(along.y)
                           ? (std::fabs(along.x) < std::fabs(along.z) ? Vector{1, 0, 0} : Vector{0, 0, 1})
                           : (std::fabs(along.y) < std::fabs(along.z) ? Vector{0, 1, 0} : Vector{0, 0, 1});
  return unit_of(cross(along, least));
}
/// Returns the points of a closed curve, without repeating the first one.
std::vector<Index> points_of(const Plc::Curve& curve) {
  std::vector<Index> points = curve.points;
  if (!curve.closed) points.pop_back();
  return points;
}

}  // namespace

Vector RodSection::turned(double angle) const {
  return std::cos(angle) * across + std::sin(angle) * cross(along, across);
}

Rod::Rod(const Plc& plc, const SurfaceTolerance& tolerance, double size, const Execution& execution,
         Index region, const std::vector<Index>& patches)
    : plc_(plc), tolerance_(tolerance), execution_(execution), size_(size), region_(region) {
  for (const Index p : patches) {
    if (plc.patches[p].planar)
      planar_.push_back(p);
    else if (std::exchange(patch_, p) != none)
      planar_.resize(3);  // refused by `begin`
  }
}

std::size_t Rod::fewest_vertices() const {
  return static_cast<std::size_t>(fewest_in_ring * length_ / (apart * radius_));
}

bool Rod::find_axis() {
  hierarchy_ = hierarchy_of_patch(plc_, patch_);
  return find_sections();
}

TetMesh::VertexFeature Rod::feature_of(std::size_t ring, const Point& point) const {
  if (is_loop() || (ring > 0 && ring < steps_)) return {2, patch_};
  const RodEnd& end = ends_[ring == 0 ? 0 : 1];
  for (const Index v : plc_.patches[end.patch].vertices)
    if (plc_.points[plc_.vertices[v].point] == point) return {0, v};
  return {1, end.curve};
}
/// Returns whether the rings at the ends contain the complex's vertices there.
bool Rod::have_vertices() const {
  for (std::size_t end = 0; end < ends_.size(); ++end)
    for (const Index v : plc_.patches[ends_[end].patch].vertices)
      if (std::ranges::count(rings_[end == 0 ? 0 : steps_], plc_.points[plc_.vertices[v].point]) != 1)
        return false;
  return true;
}

bool Rod::find_ends() {
  if (patch().curves.size() != planar_.size()) return false;
  for (const Index p : planar_) {
    const Plc::Patch& plane = plc_.patches[p];
    if (plane.curves.size() != 1 || !std::ranges::binary_search(patch().curves, plane.curves[0]))
      return false;
    const Plc::Curve& curve = plc_.curves[plane.curves[0]];
    if (!(curve.closed || curve.ends[0] == curve.ends[1]) || plane.vertices.size() > 1) return false;
    const std::vector<Index> loop = points_of(curve);
    Point centre{};
    double length = 0;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Point &a = plc_.points[loop[i]], &b = plc_.points[loop[(i + 1) % loop.size()]];
      centre = centre + distance(a, b) / 2 * (a + b);
      length += distance(a, b);
    }
    ends_.push_back({p, plane.curves[0], centre / length,
                     plane.regions[0] == region_ ? plane.normal : -1 * plane.normal});
  }
  return true;
}

/// Returns whether the body is thick or short, as estimated from its volume and surface.
bool Rod::is_thick() {
  double area = 0;
  for (Index i = 0; i < patch().triangle_count; ++i)
    area += area_of(plc_, plc_.triangles[patch().first_triangle + i]);
  radius_ = 2 * std::fabs(plc_.regions[region_].volume) / area;
  length_ = area / (full_turn * radius_);
  reach_ = rays_per_radius * radius_;
  return radius_ > thinner_than_size * size_ || length_ < least_length * radius_;
}

/// Returns the first point where a ray of length `reach_` from `from` meets the patch.
Rod::Hit Rod::hit(const Point& from, const Vector& way) const {
  const Index root = hierarchy_->root();
  Hit nearest;
  hierarchy_->crossings(from, from + reach_ * way, {&root, 1}, crossings_);
  for (const auto& crossing : crossings_) {
    const auto [a, b, c] = hierarchy_->corners(crossing.triangle);
    const Vector normal = cross(b - a, c - a);
    const double distance = dot(a - from, normal) / dot(way, normal);
    if (distance > 0 && distance < nearest.distance)
      nearest = {from + distance * way, crossing.triangle, distance};
  }
  return nearest;
}

/// Moves a place to the centre of its section, and measures the section. Returns whether the section is
/// round.
bool Rod::measure(RodSection& section) const {
  constexpr unsigned rounds = 3;
  if (section.across == Vector{}) section.across = any_across(section.along);
  section.across = unit_of(section.across - dot(section.across, section.along) * section.along);
  for (unsigned round = 0; round < rounds; ++round) {
    Vector sum{};
    double least = INFINITY, most = 0, radius = 0;
    section.tolerance = INFINITY;
    for (std::size_t k = 0; k < rays_of_section; ++k) {
      const Hit there =
          hit(section.centre, section.turned(full_turn * static_cast<double>(k) / rays_of_section));
      if (there.triangle == none) return false;
      sum = sum + (there.at - section.centre);
      radius += there.distance / rays_of_section;
      least = std::min(least, there.distance);
      most = std::max(most, there.distance);
      section.tolerance =
          std::min(section.tolerance, tolerance_.at_triangle(patch().first_triangle + there.triangle));
    }
    section.radius = radius;
    if (round + 1 == rounds) return most <= roundest * least;
    section.centre = section.centre + (2.0 / rays_of_section) * sum;
  }
  return false;
}

bool Rod::find_sections() {
  RodSection first;
  if (is_loop() ? !begin_loop(first) : !begin_at_end(first)) return false;
  sections_.push_back(first);
  while (sections_.size() < most_sections && !execution_.cancelled()) {
    const RodSection& last = sections_.back();
    const double step = step_in_radii * last.radius;
    if (!is_loop() && distance(last.centre, ends_[1].centre) < 1.5 * step) return finish_at_end();
    RodSection next = last;
    next.along = direction_after(sections_.size() - 1);
    next.centre = last.centre + step * next.along;
    if (!measure(next) || distance(next.centre, last.centre) > 2 * step) return false;
    if (is_loop() && sections_.size() > 2 && distance(next.centre, first.centre) < 2 * step &&
        dot(next.centre - first.centre, first.along) >= -0.5 * step && dot(next.along, first.along) > 0.5)
      return finish_loop();
    sections_.push_back(next);
  }
  return false;
}

/// Returns the direction in which the axis leaves section `last`, if its curvature stays the same.
Vector Rod::direction_after(std::size_t last) const {
  if (last < 2) return sections_[last].along;
  const Vector now = unit_of(sections_[last].centre - sections_[last - 1].centre),
               before = unit_of(sections_[last - 1].centre - sections_[last - 2].centre);
  return unit_of(2 * now - before);
}

bool Rod::begin_at_end(RodSection& first) const {
  first = section_at_end(0);
  RodSection next = first;
  next.centre = first.centre + radius_ * first.along;
  if (!measure(next)) return false;
  first.radius = next.radius;
  first.tolerance = next.tolerance;
  return true;
}
RodSection Rod::section_at_end(std::size_t end) const {
  RodSection section;
  section.centre = ends_[end].centre;
  section.along = end == 0 ? -1 * ends_[end].outward : ends_[end].outward;
  const std::vector<Index>& vertices = plc_.patches[ends_[end].patch].vertices;
  const Index first =
      vertices.empty() ? plc_.curves[ends_[end].curve].points[0] : plc_.vertices[vertices[0]].point;
  const Vector to = plc_.points[first] - section.centre;
  section.across = unit_of(to - dot(to, section.along) * section.along);
  return section;
}
bool Rod::finish_at_end() {
  RodSection last = section_at_end(1);
  last.radius = sections_.back().radius;
  last.tolerance = sections_.back().tolerance;
  sections_.push_back(last);
  return set_directions();
}

/// Begins the axis at the middle of a chord of the body along some normal of the patch. This chord and the
/// shortest one through its middle span the section.
bool Rod::begin_loop(RodSection& first) const {
  constexpr unsigned directions = 48;
  const auto [a, b, c] = hierarchy_->corners(0);
  const Point from = (a + b + c) / 3;
  const Vector way = (patch().regions[0] == region_ ? -1 : 1) * unit_of(cross(b - a, c - a));
  const Hit opposite = hit(from + 1e-6 * reach_ * way, way);
  if (opposite.triangle == none) return false;
  first.centre = 0.5 * (from + opposite.at);
  RodSection around;
  around.along = way;
  around.across = any_across(way);
  double shortest = INFINITY;
  for (unsigned k = 0; k < directions; ++k) {
    const Vector across = around.turned(full_turn / 2 * k / directions);
    const double length = hit(first.centre, across).distance + hit(first.centre, -1 * across).distance;
    if (length >= shortest) continue;
    shortest = length;
    first.along = unit_of(cross(way, across));
  }
  if (!measure(first)) return false;
  RodSection before = first, after = first;
  before.centre = first.centre - first.radius * first.along;
  after.centre = first.centre + first.radius * first.along;
  if (!measure(before) || !measure(after)) return false;
  first.along = unit_of(after.centre - before.centre);
  if (!measure(first)) return false;
  aim_at_corner(first);
  return true;
}
/// Turns a frame to where the patch is farthest from the axis.
void Rod::aim_at_corner(RodSection& section) const {
  constexpr unsigned directions = 720;
  Vector farthest = section.across;
  double most = 0;
  for (unsigned k = 0; k < directions; ++k) {
    const Vector way = section.turned(full_turn * k / directions);
    const double there = hit(section.centre, way).distance;
    if (there <= most) continue;
    most = there;
    farthest = way;
  }
  section.across = farthest;
}

bool Rod::finish_loop() {
  sections_.push_back(sections_.front());
  return sections_.size() > fewest_rings_of_loop && set_directions();
}

/// Sets the directions of the axis, and turns frames as little as possible from one to the next. Returns
/// false if the axis meets an end at a slant.
bool Rod::set_directions() {
  constexpr double least_cosine_at_ends = 0.98;
  const std::size_t last = sections_.size() - 1;
  for (std::size_t i = is_loop() ? 0 : 1; i < last; ++i) {
    const Point& before = sections_[i > 0 ? i - 1 : last - 1].centre;
    sections_[i].along = unit_of(sections_[i + 1].centre - before);
  }
  if (is_loop()) sections_[last].along = sections_[0].along;
  if (!is_loop())
    for (const std::size_t i : {std::size_t{0}, last - 1})
      if (dot(unit_of(sections_[i + 1].centre - sections_[i].centre), sections_[i == 0 ? 0 : last].along) <
          least_cosine_at_ends)
        return false;
  aim_ = sections_[last].across;
  for (std::size_t i = 1; i <= last; ++i) {
    const Vector& along = sections_[i].along;
    const Vector& before = sections_[i - 1].across;
    sections_[i].across = unit_of(before - dot(before, along) * along);
  }
  return true;
}

bool Rod::find_vertices_around() {
  double around = fewest_in_ring;
  for (const RodSection& section : sections_) {
    const double off = std::min(share_around * section.tolerance, section.radius);
    around = std::max(around, std::numbers::pi / std::acos(1 - off / section.radius));
  }
  constexpr double rounding = 1e-9;
  in_ring_ = static_cast<std::size_t>(std::ceil(around - rounding));
  while (in_ring_ <= most_in_ring && !chords_keep_tolerance()) ++in_ring_;
  return in_ring_ <= most_in_ring;
}

bool Rod::set_in_ring(std::size_t vertices) {
  in_ring_ = vertices;
  return in_ring_ <= most_in_ring;
}

/// Returns the curvature of the axis after a section; for the last section, the curvature before it.
double Rod::bend_after(std::size_t section) const {
  const std::size_t i = std::min(section, sections_.size() - 2);
  const double length = distance(sections_[i].centre, sections_[i + 1].centre);
  return norm(sections_[i + 1].along - sections_[i].along) / length;
}

double Rod::largest_bend() const {
  double largest = 0;
  for (std::size_t i = 0; i + 1 < sections_.size(); ++i) largest = std::max(largest, bend_after(i));
  return largest;
}

void Rod::find_spacing(double most_radii, double share_along, std::size_t times) {
  const std::size_t last = sections_.size() - 1;
  for (std::size_t i = 0; i <= last; ++i) {
    RodSection& section = sections_[i];
    const double bend = bend_after(i);
    section.spacing = std::min(std::min(largest_spacing(in_ring_), most_radii) * section.radius, size_);
    if (bend > 0)
      section.spacing = std::min(section.spacing, std::sqrt(8 * share_along * section.tolerance / bend));
  }
  for (std::size_t i = 1; i <= last; ++i) {
    const RodSection& before = sections_[i - 1];
    sections_[i].rings = before.rings + distance(before.centre, sections_[i].centre) /
                                            std::min(before.spacing, sections_[i].spacing);
  }
  steps_ = std::max<std::size_t>(static_cast<std::size_t>(std::ceil(sections_.back().rings)),
                                 is_loop() ? fewest_rings_of_loop : 1);
  steps_ = (steps_ + times - 1) / times * times;
}

bool Rod::is_bent() const {
  constexpr double straight = 1e-6;
  return std::ranges::any_of(sections_, [&](const RodSection& section) {
    return norm(section.along - sections_.front().along) > straight;
  });
}

/// Returns whether the patch is as near to the chords around the rod as the tolerance asks. Tests some of the
/// sections.
bool Rod::chords_keep_tolerance() const {
  constexpr std::size_t looked_at = 40, places = 4;
  const double piece = full_turn / static_cast<double>(in_ring_),
               share = is_bent() ? share_measured_of_bent : share_measured;
  for (std::size_t i = 1; i + 1 < sections_.size(); i += sections_.size() / looked_at + 1) {
    const RodSection& section = sections_[i];
    const auto at = [&](double pieces) { return hit(section.centre, section.turned(piece * pieces)).at; };
    for (std::size_t k = 0; k < in_ring_; ++k) {
      const auto from = static_cast<double>(k);
      const Point a = at(from), b = at(from + 1);
      for (std::size_t place = 1; place < places; ++place) {
        const Point p = at(from + static_cast<double>(place) / places);
        if (norm(cross(p - a, b - a)) > share * section.tolerance * distance(a, b)) return false;
      }
    }
  }
  return true;
}

/// Returns the section at this share of the number of rings, between 0 and 1.
RodSection Rod::at_share(double share) const {
  const double rings = share * sections_.back().rings;
  const auto found = std::ranges::lower_bound(sections_, rings, {}, &RodSection::rings);
  const auto next = found == sections_.begin() ? found + 1 : found == sections_.end() ? found - 1 : found;
  const RodSection &a = *(next - 1), &b = *next;
  const double t = b.rings > a.rings ? (rings - a.rings) / (b.rings - a.rings) : 0;
  RodSection between = a;
  between.centre = a.centre + t * (b.centre - a.centre);
  between.radius = a.radius + t * (b.radius - a.radius);
  between.along = unit_of(a.along + t * (b.along - a.along));
  between.across = a.across + t * (b.across - a.across);
  between.across = unit_of(between.across - dot(between.across, between.along) * between.along);
  return between;
}

/// Finds the angle by which frames are turned over the whole length. Thus turned, the last ring begins at the
/// vertex of the second end or, in a loop, fits the first ring.
void Rod::find_turn(std::size_t parts_of_turn) {
  if (!is_loop() && plc_.patches[ends_[1].patch].vertices.empty()) return;
  const double piece = full_turn / static_cast<double>(parts_of_turn);
  const RodSection& last = sections_.back();
  const Vector& to = is_loop() ? sections_.front().across : aim_;
  const double angle = std::atan2(dot(to, cross(last.along, last.across)), dot(to, last.across));
  const double pieces = std::round(angle / piece);
  turn_ = angle - pieces * piece;
  const auto n = static_cast<long>(parts_of_turn);
  shift_ = static_cast<std::size_t>(((static_cast<long>(pieces) % n) + n) % n);
}

bool Rod::find_rings(std::size_t parts_of_turn) {
  rings_.clear();
  axis_.clear();
  turn_ = 0;
  shift_ = 0;
  parts_of_turn_ = parts_of_turn > 0 ? parts_of_turn : in_ring_;
  const double steps = static_cast<double>(steps_), piece = full_turn / static_cast<double>(in_ring_);
  find_turn(parts_of_turn_);
  for (std::size_t j = 0; j <= steps_; ++j) {
    if (execution_.cancelled()) return false;
    if (j == steps_ && is_loop()) break;
    const double share = static_cast<double>(j) / steps;
    const RodSection section = at_share(share);
    std::vector<Point>& ring = rings_.emplace_back();
    const bool at_end = !is_loop() && (j == 0 || j == steps_);
    for (std::size_t k = 0; k < in_ring_; ++k) {
      const Vector way = section.turned(piece * static_cast<double>(k) + turn_ * share);
      Hit there;
      if (at_end)
        there = on_curve(ends_[j == 0 ? 0 : 1], section, way);
      else
        there = hit(section.centre, way);
      if (there.triangle == none) return false;
      ring.push_back(there.at);
    }
  }
  for (std::size_t j = 0; j < steps_; ++j)
    axis_.push_back(at_share((static_cast<double>(j) + 0.5) / steps).centre);
  return have_vertices();
}

bool Rod::faces_keep_tolerance() const {
  constexpr double share = 0.95;
  std::vector<Point> points;
  for (const std::vector<Point>& ring : rings_) points.insert(points.end(), ring.begin(), ring.end());
  const std::size_t n = in_ring_, lag = shift_ * (n / parts_of_turn_);
  const auto at = [&](std::size_t ring, std::size_t k) {
    return static_cast<Index>(ring < rings_.size() ? ring * n + k % n : (k + n - lag) % n);
  };
  std::vector<std::array<Index, 3>> triangles;
  for (std::size_t j = 0; j < steps_; ++j)
    for (std::size_t k = 0; k < n; ++k) {
      triangles.push_back({at(j, k), at(j, k + 1), at(j + 1, k)});
      triangles.push_back({at(j, k + 1), at(j + 1, k + 1), at(j + 1, k)});
    }
  const auto keeps = [&](const TriangleHierarchy& to, const Point& p, double tolerance) {
    return to.squared_distance_to(p) <= share * share * tolerance * tolerance;
  };
  for (const auto& [a, b, c] : triangles) {
    const Point middle = (points[a] + points[b] + points[c]) / 3;
    Index nearest = none;
    hierarchy_->squared_distance_to(middle, INFINITY, &nearest);
    const double tolerance = tolerance_.at_triangle(patch().first_triangle + nearest);
    if (!keeps(*hierarchy_, middle, tolerance) ||
        !keeps(*hierarchy_, 0.5 * (points[b] + points[c]), tolerance))
      return false;
  }
  const TriangleHierarchy faces(points, std::move(triangles));
  for (Index t = patch().first_triangle; t < patch().first_triangle + patch().triangle_count; ++t)
    for (const Index v : plc_.triangles[t].points)
      if (!keeps(faces, plc_.points[v], tolerance_.at_point(v))) return false;
  return true;
}

RodSection Rod::frame_at(double share) const {
  RodSection section = at_share(share);
  section.across = section.turned(turn_ * share);
  return section;
}

/// Returns the point of the curve around an end that lies in the direction `way` from the end's centre; its
/// `triangle` is none if there is no such point.
Rod::Hit Rod::on_curve(const RodEnd& end, const RodSection& section, const Vector& way) const {
  const std::vector<Index> loop = points_of(plc_.curves[end.curve]);
  const Vector beside = cross(section.along, way);
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Point &a = plc_.points[loop[i]], &b = plc_.points[loop[(i + 1) % loop.size()]];
    const double of_a = dot(a - end.centre, beside), of_b = dot(b - end.centre, beside);
    constexpr double near = 1e-7;
    // If a point of the curve lies in the direction, that point itself is the result.
    if (std::fabs(of_a) < near * reach_ && dot(a - end.centre, way) > 0) return {a, 0, 0};
    if (of_a * of_b >= 0) continue;
    const Point at = a + of_a / (of_a - of_b) * (b - a);
    if (dot(at - end.centre, way) > 0) return {at, 0, 0};
  }
  return {};
}

}  // namespace collarmesh::constrained
