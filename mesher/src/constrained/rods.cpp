#include "constrained/rods.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "location/triangle_hierarchy.h"

namespace collarmesh {

namespace constrained {
namespace {

constexpr double full_turn = 2 * std::numbers::pi;
// The largest radius of a rod, as a share of the size, and its least length, in radii.
constexpr double thinner_than_size = 0.5, least_length = 8;
// Ratio of the largest to the smallest distance of the patch from the axis in one section.
constexpr double roundest = 1.25;
// Rings are at most this many radii apart: then the angle between the two tets that share the chord of a ring
// and a piece of the axis is below 150 degrees.
constexpr double apart = 6.2;
// Shares of the tolerance for chords around the rod and for edges along a bent one.
constexpr double share_around = 0.75, share_along = 0.1;
constexpr std::size_t fewest_in_ring = 8, most_in_ring = 24;
// The smallest angle of tets, a little above the bound on thin tets, degrees.
constexpr double least_angle = 8.2;
// Shares of the tolerance that the measured distance of the patch from chords around the rod may reach.
constexpr double share_measured = 0.95, share_measured_of_bent = 0.6;
constexpr std::size_t rays_of_section = 16, most_sections = 200'000, fewest_rings_of_loop = 8;
constexpr double step_in_radii = 1, rays_per_radius = 8;

/// Returns the largest distance of rings with this many vertices, in radii. The smallest angle is that at an
/// edge from the axis to a ring, between the planes through the axis and through the next vertex of the ring.
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

/// A place on the axis of a rod, and a frame there.
struct Section {
  Point centre;
  Vector along, across;
  double radius = 0, tolerance = 0;
  double spacing = 0;  // the distance of rings
  double rings = 0;    // the number of rings up to here
};

/// A planar end of a rod.
struct RodEnd {
  Index patch, curve;
  Point centre;
  Vector outward;
};

/// A rod's axis and the rings of vertices around it.
class Rod {
 public:
  /// Keeps references to the complex, the tolerance and the execution.
  Rod(const Plc& plc, const SurfaceTolerance& tolerance, double size, const Execution& execution,
      Index region, const std::vector<Index>& patches)
      : plc_(plc), tolerance_(tolerance), execution_(execution), size_(size), region_(region) {
    for (const Index p : patches) {
      if (plc.patches[p].planar)
        planar_.push_back(p);
      else if (std::exchange(patch_, p) != none)
        planar_.resize(3);  // refused below
    }
  }

  /// Returns whether the body may be a rod, by its patches, volume and surface.
  bool begin() {
    return patch_ != none && (planar_.empty() || planar_.size() == 2) && find_ends() && !is_thick();
  }
  /// Finds the axis. Returns whether the body is a rod that rings can keep within the tolerance.
  bool measure() {
    hierarchy_ = hierarchy_of_patch(plc_, patch_);
    return find_axis() && find_spacing();
  }
  /// Adds the tets, faces and edges. Returns whether there are rings.
  bool add_to(TetMesh& mesh) {
    const bool found = find_rings();
    if (found) Filling(*this, mesh).run();
    return found;
  }

  /// Returns the fewest vertices that a rod of this length takes, after `begin`.
  std::size_t fewest_vertices() const {
    return static_cast<std::size_t>(fewest_in_ring * length_ / (apart * radius_));
  }
  /// Returns the number of vertices, after `measure`.
  std::size_t vertices() const {
    return is_loop() ? steps_ * (in_ring_ + 1) : steps_ * (in_ring_ + 1) + in_ring_ + 2;
  }

 private:
  /// The filling of a rod: numbers its vertices in a mesh, and adds its elements.
  class Filling {
   public:
    Filling(const Rod& rod, TetMesh& mesh)
        : rod_(rod), mesh_(mesh), first_(static_cast<Index>(mesh.points.size())) {}

    void run() {
      add_vertices();
      const std::size_t steps = rod_.steps_;
      for (std::size_t j = 0; j < steps; ++j) add_between(j);
      for (std::size_t j = rod_.is_loop() ? 0 : 1; j < steps; ++j)
        add_around(axis(j > 0 ? j - 1 : steps - 1), axis(j), j);
      for (std::size_t end = 0; end < rod_.ends_.size(); ++end) add_end(end);
    }

   private:
    std::size_t ring_size() const { return rod_.in_ring_; }
    Index at(std::size_t ring, std::size_t k) const {
      const std::size_t n = ring_size();
      if (ring == rod_.rings_.size()) return at(0, k + n - rod_.shift_);  // of a loop
      return first_ + static_cast<Index>(ring * n + k % n);
    }
    Index axis(std::size_t step) const {
      return first_ + static_cast<Index>(rod_.rings_.size() * ring_size() + step);
    }
    Index centre(std::size_t end) const { return axis(rod_.steps_ + end); }

    void add_vertices() {
      const auto add = [&](const Point& point, const TetMesh::VertexFeature& feature) {
        mesh_.points.push_back(point);
        mesh_.features.push_back(feature);
      };
      for (std::size_t j = 0; j < rod_.rings_.size(); ++j)
        for (const Point& point : rod_.rings_[j]) add(point, rod_.feature_of(j, point));
      for (const Point& point : rod_.axis_) add(point, {});
      for (const RodEnd& end : rod_.ends_) add(end.centre, {2, end.patch});
    }

    void add_tet(Index a, Index b, Index c, Index d) {
      mesh_.tets.push_back({a, b, c, d});
      mesh_.tet_region.push_back(rod_.region_);
      mesh_.tet_tag.push_back(rod_.plc_.regions[rod_.region_].tag);
    }
    void add_face(Index a, Index b, Index c, Index patch) {
      mesh_.faces.push_back({a, b, c});
      mesh_.face_regions.push_back({rod_.region_, 0});
      mesh_.face_patch.push_back(patch);
      mesh_.face_tag.push_back(rod_.plc_.patches[patch].tag);
    }

    /// Adds the tets between the faces from one ring to the next and the vertex on the axis between the
    /// rings.
    void add_between(std::size_t j) {
      for (std::size_t k = 0; k < ring_size(); ++k) {
        const Index a = at(j, k), b = at(j, k + 1), c = at(j + 1, k), d = at(j + 1, k + 1);
        add_tet(axis(j), a, b, c);
        add_tet(axis(j), b, d, c);
        add_face(a, b, c, rod_.patch_);
        add_face(b, d, c, rod_.patch_);
      }
    }
    /// Adds the tets between a ring and a piece of the axis.
    void add_around(Index before, Index after, std::size_t ring) {
      for (std::size_t k = 0; k < ring_size(); ++k) add_tet(before, after, at(ring, k), at(ring, k + 1));
    }
    void add_end(std::size_t end) {
      const auto& [patch, curve, place, outward] = rod_.ends_[end];
      const std::size_t ring = end == 0 ? 0 : rod_.steps_;
      const Index inside = axis(end == 0 ? 0 : rod_.steps_ - 1);
      add_around(end == 0 ? centre(end) : inside, end == 0 ? inside : centre(end), ring);
      for (std::size_t k = 0; k < ring_size(); ++k) {
        const Index a = at(ring, k), b = at(ring, k + 1);
        add_face(centre(end), end == 0 ? b : a, end == 0 ? a : b, patch);
        mesh_.edges.push_back({a, b});
        mesh_.edge_curve.push_back(curve);
        mesh_.edge_tag.push_back(rod_.plc_.curves[curve].tag);
      }
    }

    const Rod& rod_;
    TetMesh& mesh_;
    Index first_;
  };

  TetMesh::VertexFeature feature_of(std::size_t ring, const Point& point) const {
    if (is_loop() || (ring > 0 && ring < steps_)) return {2, patch_};
    const RodEnd& end = ends_[ring == 0 ? 0 : 1];
    for (const Index v : plc_.patches[end.patch].vertices)
      if (plc_.points[plc_.vertices[v].point] == point) return {0, v};
    return {1, end.curve};
  }
  /// Returns whether the rings at the ends contain the vertices there.
  bool have_vertices() const {
    for (std::size_t end = 0; end < ends_.size(); ++end)
      for (const Index v : plc_.patches[ends_[end].patch].vertices)
        if (std::ranges::count(rings_[end == 0 ? 0 : steps_], plc_.points[plc_.vertices[v].point]) != 1)
          return false;
    return true;
  }

  const Plc::Patch& patch() const { return plc_.patches[patch_]; }
  bool is_loop() const { return ends_.empty(); }

  bool find_ends() {
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

  /// Returns the points of a closed curve, without repeating the first one.
  static std::vector<Index> points_of(const Plc::Curve& curve) {
    std::vector<Index> points = curve.points;
    if (!curve.closed) points.pop_back();
    return points;
  }

  /// Returns whether the body is thick or short, as estimated from its volume and surface.
  bool is_thick() {
    double area = 0;
    for (Index i = 0; i < patch().triangle_count; ++i)
      area += area_of(plc_, plc_.triangles[patch().first_triangle + i]);
    radius_ = 2 * std::fabs(plc_.regions[region_].volume) / area;
    length_ = area / (full_turn * radius_);
    reach_ = rays_per_radius * radius_;
    return radius_ > thinner_than_size * size_ || length_ < least_length * radius_;
  }

  struct Hit {
    Point at;
    Index triangle = none;
    double distance = INFINITY;
  };
  /// Returns the nearest point of the patch in a direction.
  Hit hit(const Point& from, const Vector& way) const {
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

  static Vector turned(const Section& section, double angle) {
    return std::cos(angle) * section.across + std::sin(angle) * cross(section.along, section.across);
  }
  static Vector any_across(const Vector& along) {
    const Vector least = std::fabs(along.x) < std::fabs(along.y)
                             ? (std::fabs(along.x) < std::fabs(along.z) ? Vector{1, 0, 0} : Vector{0, 0, 1})
                             : (std::fabs(along.y) < std::fabs(along.z) ? Vector{0, 1, 0} : Vector{0, 0, 1});
    return unit_of(cross(along, least));
  }

  /// Moves a place to the centre of its section, and measures the section. Returns whether it is round.
  bool measure(Section& section) const {
    constexpr unsigned rounds = 3;
    if (section.across == Vector{}) section.across = any_across(section.along);
    section.across = unit_of(section.across - dot(section.across, section.along) * section.along);
    for (unsigned round = 0; round < rounds; ++round) {
      Vector sum{};
      double least = INFINITY, most = 0, radius = 0;
      section.tolerance = INFINITY;
      for (std::size_t k = 0; k < rays_of_section; ++k) {
        const Hit there =
            hit(section.centre, turned(section, full_turn * static_cast<double>(k) / rays_of_section));
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

  bool find_axis() {
    Section first;
    if (is_loop() ? !begin_loop(first) : !begin_at_end(first)) return false;
    sections_.push_back(first);
    while (sections_.size() < most_sections && !execution_.cancelled()) {
      const Section& last = sections_.back();
      const double step = step_in_radii * last.radius;
      if (!is_loop() && distance(last.centre, ends_[1].centre) < 1.5 * step) return finish_at_end();
      Section next = last;
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

  /// Returns the direction in which the axis leaves its last section, as if its curvature stayed the same.
  Vector direction_after(std::size_t last) const {
    if (last < 2) return sections_[last].along;
    const Vector now = unit_of(sections_[last].centre - sections_[last - 1].centre),
                 before = unit_of(sections_[last - 1].centre - sections_[last - 2].centre);
    return unit_of(2 * now - before);
  }

  bool begin_at_end(Section& first) const {
    first = section_at_end(0);
    Section next = first;
    next.centre = first.centre + radius_ * first.along;
    if (!measure(next)) return false;
    first.radius = next.radius;
    first.tolerance = next.tolerance;
    return true;
  }
  Section section_at_end(std::size_t end) const {
    Section section;
    section.centre = ends_[end].centre;
    section.along = end == 0 ? -1 * ends_[end].outward : ends_[end].outward;
    const std::vector<Index>& vertices = plc_.patches[ends_[end].patch].vertices;
    const Index first =
        vertices.empty() ? plc_.curves[ends_[end].curve].points[0] : plc_.vertices[vertices[0]].point;
    const Vector to = plc_.points[first] - section.centre;
    section.across = unit_of(to - dot(to, section.along) * section.along);
    return section;
  }
  bool finish_at_end() {
    Section last = section_at_end(1);
    last.radius = sections_.back().radius;
    last.tolerance = sections_.back().tolerance;
    sections_.push_back(last);
    return set_directions();
  }

  /// Begins at the middle of a chord along any normal. This chord and the shortest one through its middle
  /// span the section.
  bool begin_loop(Section& first) const {
    constexpr unsigned directions = 48;
    const auto [a, b, c] = hierarchy_->corners(0);
    const Point from = (a + b + c) / 3;
    const Vector way = (patch().regions[0] == region_ ? -1 : 1) * unit_of(cross(b - a, c - a));
    const Hit opposite = hit(from + 1e-6 * reach_ * way, way);
    if (opposite.triangle == none) return false;
    first.centre = 0.5 * (from + opposite.at);
    Section around;
    around.along = way;
    around.across = any_across(way);
    double shortest = INFINITY;
    for (unsigned k = 0; k < directions; ++k) {
      const Vector across = turned(around, full_turn / 2 * k / directions);
      const double length = hit(first.centre, across).distance + hit(first.centre, -1 * across).distance;
      if (length >= shortest) continue;
      shortest = length;
      first.along = unit_of(cross(way, across));
    }
    if (!measure(first)) return false;
    Section before = first, after = first;
    before.centre = first.centre - first.radius * first.along;
    after.centre = first.centre + first.radius * first.along;
    if (!measure(before) || !measure(after)) return false;
    first.along = unit_of(after.centre - before.centre);
    if (!measure(first)) return false;
    aim_at_corner(first);
    return true;
  }
  /// Turns a frame to where the patch is farthest from the axis.
  void aim_at_corner(Section& section) const {
    constexpr unsigned directions = 720;
    Vector farthest = section.across;
    double most = 0;
    for (unsigned k = 0; k < directions; ++k) {
      const Vector way = turned(section, full_turn * k / directions);
      const double there = hit(section.centre, way).distance;
      if (there <= most) continue;
      most = there;
      farthest = way;
    }
    section.across = farthest;
  }

  bool finish_loop() {
    sections_.push_back(sections_.front());
    return sections_.size() > fewest_rings_of_loop && set_directions();
  }

  /// Sets the directions of the axis, and turns frames as little as possible from one to the next.
  bool set_directions() {
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

  /// Finds how many vertices each ring has, and how far apart the rings are.
  bool find_spacing() {
    double around = fewest_in_ring;
    for (const Section& section : sections_) {
      const double off = std::min(share_around * section.tolerance, section.radius);
      around = std::max(around, std::numbers::pi / std::acos(1 - off / section.radius));
    }
    constexpr double rounding = 1e-9;
    in_ring_ = static_cast<std::size_t>(std::ceil(around - rounding));
    while (in_ring_ <= most_in_ring && !chords_keep_tolerance()) ++in_ring_;
    if (in_ring_ > most_in_ring) return false;
    const std::size_t last = sections_.size() - 1;
    for (std::size_t i = 0; i <= last; ++i) {
      Section& section = sections_[i];
      const std::size_t j = std::min(i, last - 1);
      const double length = distance(sections_[j].centre, sections_[j + 1].centre),
                   bend = norm(sections_[j + 1].along - sections_[j].along) / length;
      section.spacing = std::min(largest_spacing(in_ring_) * section.radius, size_);
      if (bend > 0)
        section.spacing = std::min(section.spacing, std::sqrt(8 * share_along * section.tolerance / bend));
    }
    for (std::size_t i = 1; i <= last; ++i) {
      const Section& before = sections_[i - 1];
      sections_[i].rings = before.rings + distance(before.centre, sections_[i].centre) /
                                              std::min(before.spacing, sections_[i].spacing);
    }
    steps_ = std::max<std::size_t>(static_cast<std::size_t>(std::ceil(sections_.back().rings)),
                                   is_loop() ? fewest_rings_of_loop : 1);
    return true;
  }

  bool is_bent() const {
    constexpr double straight = 1e-6;
    return std::ranges::any_of(sections_, [&](const Section& section) {
      return norm(section.along - sections_.front().along) > straight;
    });
  }

  /// Returns whether the patch is as near to the chords around the rod as the tolerance asks, in some of the
  /// sections.
  bool chords_keep_tolerance() const {
    constexpr std::size_t looked_at = 40, places = 4;
    const double piece = full_turn / static_cast<double>(in_ring_),
                 share = is_bent() ? share_measured_of_bent : share_measured;
    for (std::size_t i = 1; i + 1 < sections_.size(); i += sections_.size() / looked_at + 1) {
      const Section& section = sections_[i];
      const auto at = [&](double pieces) { return hit(section.centre, turned(section, piece * pieces)).at; };
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

  /// Returns the place after this share of the rings.
  Section at_share(double share) const {
    const double rings = share * sections_.back().rings;
    const auto found = std::ranges::lower_bound(sections_, rings, {}, &Section::rings);
    const auto next = found == sections_.begin() ? found + 1 : found == sections_.end() ? found - 1 : found;
    const Section &a = *(next - 1), &b = *next;
    const double t = b.rings > a.rings ? (rings - a.rings) / (b.rings - a.rings) : 0;
    Section between = a;
    between.centre = a.centre + t * (b.centre - a.centre);
    between.along = unit_of(a.along + t * (b.along - a.along));
    between.across = a.across + t * (b.across - a.across);
    between.across = unit_of(between.across - dot(between.across, between.along) * between.along);
    return between;
  }

  bool find_rings() {
    const double steps = static_cast<double>(steps_), piece = full_turn / static_cast<double>(in_ring_);
    // The frame turns along the rod, so that at its end a corner of the ring lies in the direction of the
    // vertex there or, in a loop, the corners meet those of the first ring.
    double turn = 0;
    if (is_loop() || !plc_.patches[ends_[1].patch].vertices.empty()) {
      const Section& last = sections_.back();
      const Vector& to = is_loop() ? sections_.front().across : aim_;
      const double angle = std::atan2(dot(to, cross(last.along, last.across)), dot(to, last.across));
      const double pieces = std::round(angle / piece);
      turn = angle - pieces * piece;
      const auto n = static_cast<long>(in_ring_);
      shift_ = static_cast<std::size_t>(((static_cast<long>(pieces) % n) + n) % n);
    }
    for (std::size_t j = 0; j <= steps_; ++j) {
      if (execution_.cancelled()) return false;
      if (j == steps_ && is_loop()) break;
      const double share = static_cast<double>(j) / steps;
      const Section section = at_share(share);
      std::vector<Point>& ring = rings_.emplace_back();
      const bool at_end = !is_loop() && (j == 0 || j == steps_);
      for (std::size_t k = 0; k < in_ring_; ++k) {
        const Vector way = turned(section, piece * static_cast<double>(k) + turn * share);
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

  /// Returns the point of the curve around an end in a direction; its `triangle` is none if there is no such
  /// point.
  Hit on_curve(const RodEnd& end, const Section& section, const Vector& way) const {
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

  const Plc& plc_;
  const SurfaceTolerance& tolerance_;
  const Execution& execution_;
  double size_, radius_ = 0, length_ = 0;
  Index region_, patch_ = none;
  std::vector<Index> planar_;
  std::vector<RodEnd> ends_;
  double reach_ = 0;  // length of rays
  std::unique_ptr<TriangleHierarchy> hierarchy_;
  mutable std::vector<TriangleHierarchy::Crossing> crossings_;
  std::vector<Section> sections_;
  Vector aim_;  // direction of the vertex at the second end
  std::size_t in_ring_ = 0, steps_ = 0;
  std::size_t shift_ = 0;  // in a loop: vertex k of the ring after the last is k - shift_ of the first
  std::vector<std::vector<Point>> rings_;
  std::vector<Point> axis_;
};

/// Returns the patches of each region; nothing if two regions meet or the complex has other features.
std::optional<std::vector<std::vector<Index>>> patches_of_bodies(const Plc& plc) {
  std::vector<std::vector<Index>> bodies(plc.regions.size());
  for (Index p = 0; p < plc.patches.size(); ++p) {
    const auto& [behind, before] = plc.patches[p].regions;
    if ((behind == 0) == (before == 0)) return std::nullopt;
    bodies[std::max(behind, before)].push_back(p);
  }
  const auto is_on_patch = [](const auto& feature) { return !feature.patches.empty(); };
  if (!std::ranges::all_of(plc.curves, is_on_patch) || !std::ranges::all_of(plc.vertices, is_on_patch))
    return std::nullopt;
  return bodies;
}

}  // namespace
}  // namespace constrained

std::optional<TetMesh> tetrahedra_of_rods(const Plc& plc, const SurfaceTolerance& tolerance,
                                          const RodLimits& limits, const Execution& execution) {
  using constrained::Rod;
  const auto bodies = constrained::patches_of_bodies(plc);
  if (!bodies) return std::nullopt;
  const auto exceeds = [&](std::size_t vertices) {
    return limits.most_vertices > 0 && vertices > limits.most_vertices;
  };
  std::vector<Rod> rods;
  std::size_t vertices = 0;
  for (Index region = 1; region < bodies->size(); ++region) {
    Rod& rod = rods.emplace_back(plc, tolerance, limits.size, execution, region, (*bodies)[region]);
    if (!rod.begin()) return std::nullopt;
    vertices += rod.fewest_vertices();
  }
  if (exceeds(vertices)) return std::nullopt;
  vertices = 0;
  for (Rod& rod : rods) {
    if (!rod.measure()) return std::nullopt;
    vertices += rod.vertices();
    if (exceeds(vertices)) return std::nullopt;
  }
  TetMesh mesh;
  for (Rod& rod : rods)
    if (!rod.add_to(mesh)) return std::nullopt;
  mesh.tet_collar.assign(mesh.tets.size(), 0);
  mesh.tet_crease.assign(mesh.tets.size(), 0);
  mesh.tet_thin.assign(mesh.tets.size(), 0);
  mesh.names = plc.names;
  return mesh;
}

}  // namespace collarmesh
