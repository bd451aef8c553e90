#include "predict/vertex_counts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "check/region_locator.h"
#include "common/distance_tree.h"
#include "location/triangle_hierarchy.h"
#include "predict/graded_size.h"
#include "predict/solid_angles.h"
#include "refine/curvature.h"
#include "refine/sizing.h"

namespace collarmesh::prediction {

namespace {

constexpr std::size_t most_pieces = 200000;  // of surface and of space, for one prediction
constexpr double most_pieces_of_segment = 1000;
constexpr double least_share = 0.002;  // of the size that walls and strips make

/// From 0 to 1 between two bounds.
double ramp(double x, double from, double to) { return std::clamp((x - from) / (to - from), 0.0, 1.0); }

class Counter {
 public:
  Counter(const Plc& plc, const MeshOptions& options, const Model& model)
      : plc_(plc),
        options_(options),
        model_(model),
        sizing_(plc, options, Frame()),
        radii_(curvature_sizes(plc, 2 * std::numbers::pi)),
        angles_(solid_angles(plc)),
        surface_(plc.points, corners_of_triangles(plc)),
        borders_(borders()),
        pieces_(pieces_of_curves()),
        sizes_(sources(), growth()) {}

  VertexCounts run() {
    for (const double share : angles_.of_vertex) add(counts_.on_vertices, 1, share);
    for (Index c = 0; c < plc_.curves.size(); ++c) count_on_curve(c);
    count_on_patches();
    count_inside();
    return counts_;
  }

 private:
  /// A part of a curve's segment and its edge length.
  struct CurvePiece {
    Point from, to;
    double size;
  };
  /// The segments of a patch's curves.
  struct Border {
    std::unique_ptr<TriangleHierarchy> segments;
    std::vector<Index> curve;  // of each
  };

  static std::vector<std::array<Index, 3>> corners_of_triangles(const Plc& plc) {
    std::vector<std::array<Index, 3>> corners;
    for (const Plc::Triangle& triangle : plc.triangles) corners.push_back(triangle.points);
    return corners;
  }

  void add(double& count, double vertices, double share) {
    count += vertices;
    counts_.tets += model_.tets_per_vertex * share * vertices;
  }

  double growth() const {
    constexpr double growth_in_gaps = 0.25;  // as in target_sizes
    if (options_.gradation > 0) return options_.gradation;
    return options_.elements_across_gap > 0 ? growth_in_gaps : model_.growth;
  }

  /// The longest chord of a circle of this radius.
  double chord(double radius) const { return std::sqrt(8 * radius * model_.chord * options_.distance); }

  /// Parts of curves' segments with what their curve asks for there by itself.
  std::vector<std::vector<CurvePiece>> pieces_of_curves() const {
    std::vector<std::vector<CurvePiece>> all(plc_.curves.size());
    for (Index c = 0; c < plc_.curves.size(); ++c)
      for (std::size_t i = 0; i < segment_count(c); ++i) {
        const auto [a, b] = segment(c, i);
        const double length = distance(a, b);
        const auto count = static_cast<std::size_t>(
            std::clamp(std::ceil(2 * length / own_size(c, i)), 1.0, most_pieces_of_segment));
        Point from = a;
        for (std::size_t k = 1; k <= count; ++k) {
          const Point to = a + static_cast<double>(k) / static_cast<double>(count) * (b - a);
          const double own = own_size(c, i);
          all[c].push_back({from, to, std::min(own, strip_size(c, 0.5 * (from + to), b - a, own))});
          from = to;
        }
      }
    return all;
  }

  /// What the nearest curve that runs along this one on a common patch asks for.
  double strip_size(Index c, const Point& p, const Vector& along, double size) const {
    constexpr double least_facing = 0.5, least_facing_of_neighbours = 0.966;  // cosines, as in GapWidths
    double squared = std::pow(size / model_.strip, 2);
    for (const Index patch : plc_.curves[c].patches) {
      const Border& border = borders_[patch];
      squared = border.segments->squared_distance_to(p, squared, nullptr, [&](Index i) {
        const Index other = border.curve[i];
        if (other == c) return false;
        const auto [a, b, ignored] = border.segments->corners(i);
        const double cosine = std::fabs(dot(along, b - a)) / (norm(along) * norm(b - a));
        return cosine > (meet(c, other) ? least_facing_of_neighbours : least_facing);
      });
    }
    return std::max(model_.strip * std::sqrt(squared), size * least_share);
  }

  bool meet(Index c, Index d) const {
    const auto &e = plc_.curves[c].ends, &f = plc_.curves[d].ends;
    return std::any_of(e.begin(), e.end(),
                       [&](Index v) { return v != none && (v == f[0] || v == f[1]); });
  }

  std::vector<GradedSize::Source> sources() const {
    std::vector<GradedSize::Source> all;
    for (Index c = 0; c < plc_.curves.size(); ++c) {
      double edges = 0;
      for (const auto& [a, b, size] : pieces_[c]) edges += distance(a, b) / (model_.edge * size);
      const double stretch = edges / whole(c, edges);
      for (const auto& [a, b, size] : pieces_[c]) all.push_back({{a, b, b}, stretch * size});
    }
    for (Index t = 0; t < plc_.triangles.size(); ++t) {
      const auto corners = corners_of(t);
      const double size = across(t, (corners[0] + corners[1] + corners[2]) / 3);
      if (size < sizing_.default_size(corners[0])) all.push_back({corners, size});
    }
    return all;
  }

  /// A curve has at least one edge, a closed one three.
  double whole(Index c, double edges) const {
    const Plc::Curve& curve = plc_.curves[c];
    const bool loop = curve.closed || curve.ends[0] == curve.ends[1];
    return std::max(loop ? 3.0 : 1.0, std::round(edges));
  }
  std::size_t segment_count(Index c) const {
    return plc_.curves[c].points.size() - (plc_.curves[c].closed ? 0 : 1);
  }
  std::array<Point, 2> segment(Index c, std::size_t i) const {
    const auto& points = plc_.curves[c].points;
    return {plc_.points[points[i]], plc_.points[points[(i + 1) % points.size()]]};
  }
  double own_size(Index c, std::size_t i) const {
    const auto [a, b] = segment(c, i);
    const double size = sizing_.curve_size(c, i, i, 0.5 * (a + b));
    return radii_.curve_segment[c].empty() ? size
                                           : std::min(size, chord(radii_.curve_segment[c][i]) / model_.edge);
  }

  void count_on_curve(Index c) {
    double edges = 0;
    for (const auto& [a, b, size] : pieces_[c])
      edges += distance(a, b) / (model_.edge * sizes_.at(0.5 * (a + b), size));
    const bool without_vertex = plc_.curves[c].closed;
    add(counts_.on_curves, whole(c, edges) - (without_vertex ? 0 : 1), angles_.of_curve[c]);
  }

  std::array<Point, 3> corners_of(Index triangle) const {
    const auto& [a, b, c] = plc_.triangles[triangle].points;
    return {plc_.points[a], plc_.points[b], plc_.points[c]};
  }

  /// The edge length in the direction in which a patch curves most.
  double across(Index triangle, const Point& p) const {
    const double size = sizing_.triangle_size(plc_.triangles[triangle].patch, triangle, p);
    return std::min(size, chord(radii_.triangle[triangle]));
  }

  /// A triangle that is cut in two until the size within it is one.
  struct Piece {
    Index triangle;
    std::array<Point, 3> corners;
  };

  void count_on_patches() {
    std::deque<Piece> pieces;
    for (Index t = 0; t < plc_.triangles.size(); ++t) pieces.push_back({t, corners_of(t)});
    for (std::size_t done = 0; !pieces.empty(); ++done) {
      const Piece piece = pieces.front();
      pieces.pop_front();
      const auto& [a, b, c] = piece.corners;
      const Point p = place_in(piece, done);
      const double radius = std::max({distance(p, a), distance(p, b), distance(p, c)});
      const double area = 0.5 * norm(cross(b - a, c - a));
      const Index patch = plc_.triangles[piece.triangle].patch;
      const double from_border = std::sqrt(borders_[patch].segments->squared_distance_to(p));
      const double wished = sizing_.triangle_size(patch, piece.triangle, p);
      double size = sizes_.at(p, wished);
      const double change = std::min(sizes_.growth() * radius, 0.5 * size);
      const double widest = std::max(size / model_.wall, sizing_.widest_gap(size));
      const double width = wall_width(p, piece.triangle, widest);
      if (width < widest) size = std::min(size, std::max({model_.wall * width, size * least_share}));
      if (from_border + radius < model_.border_from * (size - change)) continue;
      const bool same = area < 0.15 * size * size ||
                        (change < 0.4 * size && from_border - radius > model_.border_to * (size + change));
      if (!same && done < most_pieces) {
        halve(piece, pieces);
        continue;
      }
      const double small = std::min(size, across(piece.triangle, p));
      const double per_vertex = model_.area * small * std::min(size, model_.aspect * small);
      add(counts_.on_patches,
          ramp(from_border / size, model_.border_from, model_.border_to) * area / per_vertex,
          angles_.of_patch[patch]);
    }
  }

  /// A point of the piece, evenly spread over many (the R2 sequence of M. Roberts, 2018): the pieces of a
  /// sliver are not cut down to its width.
  static Point place_in(const Piece& piece, std::size_t number) {
    double ignored = 0;
    double u = std::modf(0.5 + 0.7548776662466927 * static_cast<double>(number), &ignored);
    double v = std::modf(0.5 + 0.5698402909980532 * static_cast<double>(number), &ignored);
    if (u + v > 1) {
      u = 1 - u;
      v = 1 - v;
    }
    const auto& [a, b, c] = piece.corners;
    return a + u * (b - a) + v * (c - a);
  }

  /// How far away another patch faces this one across a region, without meeting it; at most `widest`.
  double wall_width(const Point& p, Index triangle, double widest) {
    const Index own = plc_.triangles[triangle].patch;
    const auto [a, b, c] = corners_of(triangle);
    Vector normal = cross(b - a, c - a);
    normal = normal / norm(normal);
    double width = widest;
    for (unsigned side = 0; side < 2; ++side) {
      if (plc_.patches[own].regions[side] == 0) continue;
      const Vector way = side == 0 ? -1 * normal : normal;
      const Index root = surface_.root();
      surface_.crossings(p + 1e-6 * widest * way, p + widest * way, {&root, 1}, crossings_);
      for (const auto& [other, direction] : crossings_) {
        if (other == triangle || share_curve(own, plc_.triangles[other].patch)) continue;
        const auto [d, e, f] = corners_of(other);
        const Vector n = cross(e - d, f - d);
        if (std::fabs(dot(n, way)) > 0.5 * norm(n)) width = std::min(width, dot(d - p, n) / dot(n, way));
      }
    }
    return width;
  }

  bool share_curve(Index patch, Index other) const {
    if (patch == other) return false;
    const auto &a = plc_.patches[patch].curves, &b = plc_.patches[other].curves;
    return std::any_of(a.begin(), a.end(), [&](Index c) { return std::binary_search(b.begin(), b.end(), c); });
  }

  std::vector<Border> borders() const {
    std::vector<Border> all;
    for (const Plc::Patch& patch : plc_.patches) {
      Border& border = all.emplace_back();
      std::vector<std::array<Index, 3>> segments;
      for (const Index c : patch.curves) {
        const auto& points = plc_.curves[c].points;
        for (std::size_t i = 0; i < segment_count(c); ++i) {
          const Index next = points[(i + 1) % points.size()];
          segments.push_back({points[i], next, next});
          border.curve.push_back(c);
        }
      }
      border.segments = std::make_unique<TriangleHierarchy>(plc_.points, std::move(segments));
    }
    return all;
  }

  static void halve(const Piece& piece, std::deque<Piece>& pieces) {
    unsigned longest = 0;
    const auto side = [&](unsigned i) {
      return squared_distance(piece.corners[i], piece.corners[(i + 1) % 3]);
    };
    for (unsigned i = 1; i < 3; ++i)
      if (side(i) > side(longest)) longest = i;
    const Point &a = piece.corners[longest], &b = piece.corners[(longest + 1) % 3],
                &c = piece.corners[(longest + 2) % 3];
    const Point middle = 0.5 * (a + b);
    pieces.push_back({piece.triangle, {a, middle, c}});
    pieces.push_back({piece.triangle, {middle, b, c}});
  }

  /// A cube of an octree. Its region is known, unless it may meet the surface.
  struct Cube {
    Point centre;
    double half;
    Index region = none;
  };

  void count_inside() {
    std::vector<DistanceTree::Triangle> triangles;
    for (Index t = 0; t < plc_.triangles.size(); ++t) triangles.push_back(corners_of(t));
    const DistanceTree surface(std::move(triangles));
    const checks::RegionLocator locator(plc_);
    std::deque<Cube> cubes{first_cube()};
    for (std::size_t done = 0; !cubes.empty(); ++done) {
      Cube cube = cubes.front();
      cubes.pop_front();
      const double radius = std::sqrt(3.0) * cube.half, depth = surface.nearest(cube.centre).distance;
      const bool last = done >= most_pieces;
      if (cube.region == none && depth > (last ? 0 : radius)) cube.region = locator.region_at(cube.centre);
      if (cube.region == 0) continue;
      const double wished = cube.region == none ? sizing_.default_size(cube.centre)
                                                : sizing_.region_size(cube.region, cube.centre);
      const double graded = sizes_.at(cube.centre, wished + sizes_.growth() * radius);
      const double size = std::min(wished, graded);
      const double change = std::min(sizes_.growth() * radius, 0.5 * size);
      if (depth + radius < model_.depth_from * (size - change)) continue;
      const bool one_size = graded - sizes_.growth() * radius >= wished || change < 0.4 * size;
      const bool same = cube.region != none &&
                        (radius < 0.5 * size || (one_size && depth - radius > model_.depth_to * size));
      if (!same && !last) {
        for (unsigned i = 0; i < 8; ++i) {
          const double h = 0.5 * cube.half;
          const Vector way{(i & 1U) != 0 ? h : -h, (i & 2U) != 0 ? h : -h, (i & 4U) != 0 ? h : -h};
          cubes.push_back({cube.centre + way, h, cube.region});
        }
        continue;
      }
      if (cube.region == none) continue;
      const double volume = 8 * cube.half * cube.half * cube.half;
      add(counts_.inside,
          ramp(depth / size, model_.depth_from, model_.depth_to) * volume /
              (model_.volume * size * size * size),
          1);
    }
  }

  Cube first_cube() const {
    const Vector extent = plc_.bounds.max - plc_.bounds.min;
    return {plc_.bounds.centre(), 0.5 * std::max({extent.x, extent.y, extent.z}), none};
  }

  const Plc& plc_;
  const MeshOptions& options_;
  const Model& model_;
  Sizing sizing_;
  CurvatureSizes radii_;
  SolidAngles angles_;
  TriangleHierarchy surface_;
  std::vector<TriangleHierarchy::Crossing> crossings_;
  std::vector<Border> borders_;                   // by patch
  std::vector<std::vector<CurvePiece>> pieces_;  // by curve
  GradedSize sizes_;
  VertexCounts counts_;
};

}  // namespace

VertexCounts count_vertices(const Plc& plc, const MeshOptions& options, const Model& model) {
  return Counter(plc, options, model).run();
}

}  // namespace collarmesh::prediction
