#include "constrained/sheathed_rods.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>
#include <utility>

#include "constrained/rod.h"

namespace collarmesh {

namespace constrained {
namespace {

constexpr double whole_turn = 2 * std::numbers::pi;

/// Circles of vertices around the axis, all of the same radius. Even layers have circles in the planes of
/// rings, odd ones in the middle between these planes. So, except at the ends, no plane across the axis has
/// vertices of two neighbouring layers.
struct Layer {
  std::size_t count;
  double radius;  // in radii of the rod
};

/// The layers around a rod: the ring itself, and two wider ones with fewer vertices. With these radii the
/// dihedral angles of all tets lie between 8.2 and 148 degrees.
std::array<Layer, 3> layers_around(std::size_t in_ring) {
  constexpr std::size_t fewest = 6;
  constexpr double widest = 2.3, less_by_vertex = 0.05, times = 1.9;
  constexpr std::size_t vertices_of_widest = 12;
  const double first = widest - less_by_vertex * static_cast<double>(std::max(in_ring, vertices_of_widest) -
                                                                     vertices_of_widest);
  return {{{in_ring, 1}, {std::max(fewest, (in_ring + 1) / 2), first}, {fewest, times * first}}};
}

/// Returns the largest permitted distance between neighbouring circles of a layer, thus also between rings of
/// the rod, in radii of the rod.
double sheath_spacing(std::size_t in_ring) {
  constexpr std::size_t many = 22;
  return in_ring > many ? 4.4 : 4.8;
}
// Shares of the tolerance for edges along a bent rod. The first one with which faces keep the tolerance is
// used.
constexpr std::array<double, 3> shares_along{0.35, 0.2, 0.1};
// Rods whose axis turns by more than this angle (radians) over the reach of the sheath get no sheath.
constexpr double sharpest_bend = 0.2;
// The distance of seeds on the axis, relative to the reach of the sheath.
constexpr double between_points = 2;

/// Adds the tets of a rod and its sheath to a mesh.
class SheathFilling {
 public:
  /// `rings`: the number of steps from ring to ring for each step along the other layers.
  SheathFilling(const Rod& rod, std::size_t rings, SheathedRod& made)
      : rod_(rod),
        rings_(rings),
        steps_(rod.steps() / rings),
        made_(made),
        mesh_(made.mesh),
        layers_(layers_around(rod.in_ring())) {}

  void run() {
    add_vertices();
    add_rod();
    for (std::size_t layer = 0; layer + 1 < layers_.size(); ++layer) add_strip(layer);
    add_skin();
    mesh_.tet_collar.assign(mesh_.tets.size(), 0);
    mesh_.tet_crease.assign(mesh_.tets.size(), 0);
    mesh_.tet_thin.assign(mesh_.tets.size(), 0);
  }

  /// Returns the largest number of equal parts of a turn such that the layers look the same after a turn by
  /// one part. In the outermost layer only every second vertex has the same place along the rod.
  static std::size_t parts_of_turn(std::size_t in_ring) {
    std::size_t parts = in_ring;
    for (const Layer& layer : layers_around(in_ring)) parts = std::gcd(parts, layer.count);
    return std::gcd(parts, layers_around(in_ring).back().count / 2);
  }

 private:
  // Every second vertex of the outermost layer is moved along the rod by this share of the distance between
  // neighbouring circles. Otherwise the corners of each of the skin's quadrilaterals would lie on a circle,
  // and Delaunay tetrahedra outside the skin might have either diagonal.
  static constexpr double shifted = 0.15;
  static constexpr std::size_t axis_layer = 3;  // the axis, as a layer of one vertex between rings

  static bool is_between_rings(std::size_t layer) { return layer % 2 == 1; }
  std::size_t count(std::size_t layer) const { return layer == axis_layer ? 1 : layers_[layer].count; }
  bool is_loop() const { return rod_.is_loop(); }
  /// Returns the number of levels of a layer for each step.
  std::size_t levels(std::size_t layer) const { return layer == 0 ? rings_ : 1; }
  /// Returns the last level of a layer, in the plane of the second end.
  std::size_t last(std::size_t layer) const {
    return levels(layer) * steps_ + (is_between_rings(layer) ? 1 : 0);
  }

  /// Returns a vertex. A layer in the planes of rings has level 0 at the first ring. A layer between these
  /// planes has level 1 in the middle of the first step; its level 0 and its last level lie in the planes of
  /// the ends. In a closed rod, levels beyond the first or the last one wrap around.
  Index at(std::size_t layer, std::size_t level, std::size_t k) const {
    const std::size_t n = count(layer);
    if (is_loop()) {
      // The first ring lags behind the ring that would follow the last one by some parts of a turn.
      const std::size_t lag = rod_.shift() * (n / std::gcd(n, parts_of_turn(rod_.in_ring()))) % n,
                        first = is_between_rings(layer) ? 1 : 0, all = levels(layer) * steps_;
      if (level < first) level += all, k += lag;
      if (level >= first + all) level -= all, k += n - lag;
      level -= first;
    }
    return first_[layer] + static_cast<Index>(level * n + k % n);
  }

  void add_vertices() {
    for (std::size_t layer = 0; layer <= axis_layer; ++layer) {
      first_[layer] = static_cast<Index>(mesh_.points.size());
      const std::size_t all = levels(layer) * steps_;
      const auto share = [&](double level) { return level / static_cast<double>(all); };
      if (is_between_rings(layer)) {
        if (!is_loop()) add_circle(layer, 0, 0);
        for (std::size_t j = 0; j < all; ++j) add_circle(layer, j + 1, share(static_cast<double>(j) + 0.5));
        if (!is_loop()) add_circle(layer, all + 1, 1);
      } else {
        for (std::size_t j = 0; j < all + (is_loop() ? 0 : 1); ++j)
          add_circle(layer, j, share(static_cast<double>(j)));
      }
    }
  }
  void add_circle(std::size_t layer, std::size_t level, double share) {
    const bool at_start = !is_loop() && level == 0, at_finish = !is_loop() && level == last(layer);
    const SheathedRod::End* const end = at_start ? &made_.ends[0] : at_finish ? &made_.ends[1] : nullptr;
    if (layer == axis_layer) {
      if (end != nullptr)
        add(layer, rod_.ends()[at_start ? 0 : 1].centre, {2, end->patch});
      else
        add(layer, rod_.frame_at(share).centre, {});
      return;
    }
    if (layer == 0) {
      for (const Point& point : rod_.rings()[level]) add(layer, point, rod_.feature_of(level, point));
      return;
    }
    const std::size_t n = count(layer);
    for (std::size_t k = 0; k < n; ++k) {
      const double more = end == nullptr && is_shifted(layer, k) ? shifted / static_cast<double>(steps_) : 0;
      const RodSection frame = rod_.frame_at(share + more);
      const double angle = whole_turn * static_cast<double>(k) / static_cast<double>(n);
      const double away = layers_[layer].radius * frame.radius;
      made_.reach = std::max(made_.reach, away);
      const Point point = frame.centre + away * frame.turned(angle);
      if (end == nullptr) {
        add(layer, point, {});
      } else {
        const Plc::Patch& host = rod_.plc().patches[end->host];
        add(layer, point - dot(point - host.origin, host.normal) * host.normal, {2, end->host});
      }
    }
  }
  bool is_shifted(std::size_t layer, std::size_t k) const {
    return layer + 1 == layers_.size() && k % 2 == 1;
  }
  /// Calls `visit` with the corners of the two triangles that join two neighbouring vertices of a level of a
  /// layer to the same two of the next level.
  template <class Visit>
  void divide(std::size_t layer, std::size_t level, std::size_t k, const Visit& visit) const {
    const Index a = at(layer, level, k), b = at(layer, level, k + 1), c = at(layer, level + 1, k),
                d = at(layer, level + 1, k + 1);
    if (is_shifted(layer, k)) {
      visit(a, b, d);
      visit(a, d, c);
    } else {
      visit(a, b, c);
      visit(b, d, c);
    }
  }
  void add(std::size_t layer, const Point& point, const TetMesh::VertexFeature& feature) {
    if (layer == 0 || layer == axis_layer) made_.fixed.push_back(static_cast<Index>(mesh_.points.size()));
    mesh_.points.push_back(point);
    mesh_.features.push_back(feature);
  }

  void add_tet(Index a, Index b, Index c, Index d, Index region) {
    const auto& p = mesh_.points;
    if (six_volume(p[a], p[b], p[c], p[d]) < 0) std::swap(c, d);
    mesh_.tets.push_back({a, b, c, d});
    mesh_.tet_region.push_back(region);
    mesh_.tet_tag.push_back(rod_.plc().regions[region].tag);
  }
  /// Adds a face. The normal of abc must point away from `region`; the corners are swapped if this region is
  /// the face's second one.
  void add_face(Index a, Index b, Index c, Index patch, Index region) {
    const Plc::Patch& of = rod_.plc().patches[patch];
    std::array<Index, 2> regions = of.regions;
    if (regions[0] == 0) std::swap(regions[0], regions[1]);
    if (regions[0] != region) std::swap(b, c);
    mesh_.faces.push_back({a, b, c});
    mesh_.face_regions.push_back(regions);
    mesh_.face_patch.push_back(patch);
    mesh_.face_tag.push_back(of.tag);
  }
  /// Adds a face in the plane of an end.
  void add_face_at(std::size_t end, Index a, Index b, Index c, Index patch, Index region) {
    const auto& p = mesh_.points;
    if (dot(cross(p[b] - p[a], p[c] - p[a]), rod_.ends()[end].outward) < 0) std::swap(b, c);
    add_face(a, b, c, patch, region);
  }

  /// Adds the tets of a column along the rod, and the column's faces at the ends. Its section is a triangle
  /// with two corners in one layer and one corner in a neighbouring layer.
  void add_column(std::size_t pair, std::size_t k, std::size_t apex, std::size_t of_apex, Index region) {
    const bool is_apex_between = is_between_rings(apex);
    const auto a = [&](std::size_t level) { return at(pair, level, k); };
    const auto b = [&](std::size_t level) { return at(pair, level, k + 1); };
    const auto o = [&](std::size_t level) { return at(apex, level, of_apex); };
    // The column consists of a pyramid, cut into two tets, between neighbouring levels of the pair and, at
    // each level of the pair, a tet that also has two neighbouring apices.
    if (is_apex_between) {
      const std::size_t by_step = levels(pair);
      for (std::size_t j = 0; j < steps_ * by_step; ++j)
        divide(pair, j, k, [&](Index p, Index q, Index r) { add_tet(o(j / by_step + 1), p, q, r, region); });
      for (std::size_t j = 0; j < steps_ + (is_loop() ? 0 : 1); ++j)
        add_tet(o(j), o(j + 1), a(j * by_step), b(j * by_step), region);
    } else {
      const std::size_t by_step = levels(apex);
      for (std::size_t j = 0; j < steps_ + (is_loop() ? 0 : 1); ++j)
        divide(pair, j, k, [&](Index p, Index q, Index r) { add_tet(o(j * by_step), p, q, r, region); });
      for (std::size_t j = 0; j < steps_ * by_step; ++j)
        add_tet(o(j), o(j + 1), a(j / by_step + 1), b(j / by_step + 1), region);
    }
    for (std::size_t end = 0; end < made_.ends.size(); ++end) {
      const auto level = [&](std::size_t layer) { return end == 0 ? 0 : last(layer); };
      add_face_at(end, a(level(pair)), b(level(pair)), o(level(apex)),
                  region == made_.region ? made_.ends[end].patch : made_.ends[end].host, region);
    }
  }

  void add_rod() {
    for (std::size_t k = 0; k < count(0); ++k) {
      add_column(0, k, axis_layer, 0, made_.region);
      for (std::size_t j = 0; j < rod_.steps(); ++j)
        divide(0, j, k, [&](Index a, Index b, Index c) { add_face(a, b, c, made_.patch, made_.region); });
      for (std::size_t end = 0; end < made_.ends.size(); ++end) {
        const std::size_t level = end == 0 ? 0 : last(0);
        mesh_.edges.push_back({at(0, level, k), at(0, level, k + 1)});
        mesh_.edge_curve.push_back(made_.ends[end].curve);
        mesh_.edge_tag.push_back(rod_.plc().curves[made_.ends[end].curve].tag);
      }
    }
  }

  /// Adds the columns between a layer and the next one.
  void add_strip(std::size_t inner) {
    const std::size_t outer = inner + 1, n = count(inner), m = count(outer);
    std::size_t i = 0, j = 0;
    while (i < n || j < m) {
      // The third corner is the vertex, of either layer, that comes next around the axis.
      const bool steps_inside = j == m || (i < n && (2 * i + 1) * m <= (2 * j + 1) * n);
      if (steps_inside)
        add_column(inner, i++, outer, j, made_.around);
      else
        add_column(outer, j++, inner, i, made_.around);
    }
  }

  void add_skin() {
    const std::size_t layer = layers_.size() - 1;
    for (std::size_t k = 0; k < count(layer); ++k)
      for (std::size_t j = 0; j < steps_; ++j)
        divide(layer, j, k, [&](Index a, Index b, Index c) { made_.skin.push_back({a, b, c}); });
    for (std::size_t end = 0; end < made_.ends.size(); ++end)
      for (std::size_t k = 0; k < count(layer); ++k)
        made_.ends[end].rim.push_back(at(layer, end == 0 ? 0 : last(layer), k));
  }

  const Rod& rod_;
  std::size_t rings_, steps_;
  SheathedRod& made_;
  TetMesh& mesh_;
  std::array<Layer, 3> layers_;
  std::array<Index, 4> first_{};
};

/// Returns the planar patch that surrounds an end of a rod in its plane, between the region `around` and the
/// outside; none if there is no such patch.
Index host_of(const Plc& plc, const RodEnd& end, Index smooth, Index around) {
  const Plc::Patch& own = plc.patches[end.patch];
  if (own.regions[0] != 0 && own.regions[1] != 0) return none;
  Index host = none;
  for (const Index p : plc.curves[end.curve].patches) {
    if (p == end.patch || p == smooth) continue;
    const Plc::Patch& patch = plc.patches[p];
    const bool bounds_it = (patch.regions[0] == around && patch.regions[1] == 0) ||
                           (patch.regions[1] == around && patch.regions[0] == 0);
    constexpr double parallel = 1 - 1e-9;
    if (host != none || !patch.planar || !bounds_it || std::fabs(dot(patch.normal, end.outward)) < parallel)
      return none;
    host = p;
  }
  return host;
}

/// Returns whether a region is a rod that can have a sheath, and finds its ends.
bool find_rod(const Plc& plc, Rod& rod, double size, SheathedRod& made) {
  if (!rod.begin()) return false;
  made.region = rod.region();
  made.patch = rod.patch_index();
  const auto& regions = plc.patches[made.patch].regions;
  made.around = regions[0] == made.region ? regions[1] : regions[0];
  if (made.around == 0 || made.around == made.region) return false;
  std::size_t vertices = 0;
  for (const RodEnd& end : rod.ends()) {
    const Index host = host_of(plc, end, made.patch, made.around);
    if (host == none) return false;
    made.ends.push_back({end.patch, end.curve, host, {}});
    vertices += plc.patches[end.patch].vertices.size();
  }
  if (plc.patches[made.patch].vertices.size() != vertices) return false;
  const double reach = layers_around(0)[2].radius * rod.radius();
  return between_points * reach <= size && rod.find_axis() && rod.largest_bend() * reach <= sharpest_bend &&
         rod.find_vertices_around();
}

/// Finds the rings of a rod. Returns the number of steps from ring to ring for each step along the other
/// layers; 0 if no rings keep the tolerance.
std::size_t find_rings(Rod& rod) {
  constexpr std::size_t more = 4, most_odd = 12;  // larger odd numbers do not fit the next layer
  const std::size_t fewest = rod.in_ring();
  for (const double share : shares_along)
    for (std::size_t in_ring = fewest; in_ring <= fewest + more && rod.set_in_ring(in_ring); ++in_ring) {
      if (in_ring > most_odd && in_ring % 2 == 1) continue;
      const double most = sheath_spacing(in_ring);
      rod.find_spacing(most, share);
      const double in_sheath = static_cast<double>(rod.steps()) * most * rod.radius() / rod.length();
      const auto rings = std::max<std::size_t>(1, static_cast<std::size_t>(in_sheath));
      rod.find_spacing(most, share, rings);
      const std::size_t parts = rod.is_loop() ? SheathFilling::parts_of_turn(in_ring) : 0;
      if (rod.find_rings(parts) && rod.faces_keep_tolerance()) return rings;
    }
  return 0;
}

/// Finds the axis and the seeds on it.
void trace_axis(const Rod& rod, SheathedRod& made) {
  const std::size_t places = 2 * rod.steps();
  const auto centre = [&](double i, std::size_t of) {
    return rod.frame_at(i / static_cast<double>(of)).centre;
  };
  for (std::size_t i = 0; i <= places; ++i) made.axis.push_back(centre(static_cast<double>(i), places));
  double length = 0;
  for (std::size_t i = 0; i < places; ++i) length += distance(made.axis[i], made.axis[i + 1]);
  const auto points = static_cast<std::size_t>(std::ceil(length / (between_points * made.reach)));
  for (std::size_t i = 0; i < points; ++i) made.seeds.push_back(centre(static_cast<double>(i) + 0.5, points));
}

/// Returns the patches of each region.
std::vector<std::vector<Index>> patches_of_regions(const Plc& plc) {
  std::vector<std::vector<Index>> patches(plc.regions.size());
  for (Index p = 0; p < plc.patches.size(); ++p) {
    const auto& [behind, before] = plc.patches[p].regions;
    patches[behind].push_back(p);
    if (before != behind) patches[before].push_back(p);
  }
  return patches;
}

}  // namespace
}  // namespace constrained

std::vector<SheathedRod> sheathed_rods(const Plc& plc, const SurfaceTolerance& tolerance,
                                       const RodLimits& limits, const Execution& execution) {
  using constrained::Rod;
  using constrained::SheathFilling;
  const auto patches = constrained::patches_of_regions(plc);
  std::vector<SheathedRod> found;
  std::size_t vertices = 0;
  for (Index region = 1; region < patches.size(); ++region) {
    if (execution.cancelled()) return {};
    if (patches[region].empty() || patches[region].size() > 3) continue;
    Rod rod(plc, tolerance, limits.size, execution, region, patches[region]);
    SheathedRod made;
    if (!constrained::find_rod(plc, rod, limits.size, made)) continue;
    const std::size_t rings = constrained::find_rings(rod);
    if (rings == 0) continue;
    vertices += rod.vertices();
    if (limits.most_vertices > 0 && vertices > limits.most_vertices) return {};
    SheathFilling(rod, rings, made).run();
    constrained::trace_axis(rod, made);
    found.push_back(std::move(made));
  }
  return found;
}

}  // namespace collarmesh
