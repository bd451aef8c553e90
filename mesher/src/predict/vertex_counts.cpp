#include "predict/vertex_counts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <utility>
#include <vector>

#include "predict/graded_size.h"
#include "refine/sizing.h"

namespace collarmesh::prediction {

namespace {

// Limits on the number of pieces and cubes; beyond these, the remaining ones are not divided.
constexpr std::size_t most_pieces = 40000, most_cubes = 20000;
// Limits on the number of pieces of one segment, and of all curves (not counting the first piece of each
// segment).
constexpr double most_pieces_of_segment = 1000, most_pieces_of_curves = 40000;
constexpr double least_share = 0.002;  // smallest size that walls and strips ask for, relative to the target

/// Returns a value that rises from 0 to 1 between two bounds.
double ramp(double x, double from, double to) { return std::clamp((x - from) / (to - from), 0.0, 1.0); }

}  // namespace

class TetCounter::Counter {
 public:
  Counter(const Shape& shape, const MeshOptions& options, const Model& model)
      : shape_(shape),
        plc_(shape.plc()),
        options_(options),
        tolerance_(tolerance_of(plc_, options.bounds, options.size)),
        model_(model),
        sizing_(plc_, options, Frame()),
        pieces_(pieces_of_curves()),
        sizes_(sources()) {
    const Vector extent = plc_.bounds.max - plc_.bounds.min;
    cubes_.push_back({plc_.bounds.centre(), 0.5 * std::max({extent.x, extent.y, extent.z})});
    for (Index t = 0; t < plc_.triangles.size(); ++t) triangles_.push_back({t, shape_.corners(t)});
    most_triangles_ = most_pieces + triangles_.size();
  }

  // Begins with the regions, where most tets are found in the least time.
  double count_up_to(double enough) {
    enough_ = enough;
    count_inside();
    if (is_enough()) return tets_;
    if (!std::exchange(has_vertices_, true))
      for (const double share : shape_.angles().of_vertex) add(1, share);
    while (next_curve_ < plc_.curves.size() && !is_enough()) count_on_curve(next_curve_++);
    count_on_patches();
    return tets_;
  }

 private:
  /// A part of a curve's segment, with the edge length that the curve itself asks for.
  struct CurvePiece {
    Point from, to;
    double size;
  };
  /// A part of a triangle.
  struct Piece {
    Index triangle;
    std::array<Point, 3> corners;
  };
  /// A cube of an octree. Its region is known unless the cube may meet the surface.
  struct Cube {
    Point centre;
    double half;
    Index region = none;
    Index nearest = none;  // the triangle nearest to the centre of this cube, or of the cube it is part of
  };

  bool is_enough() const { return tets_ >= enough_; }
  void add(double vertices, double share) {
    if (vertices > 0)  // avoids 0 times infinity
      tets_ += model_.tets_per_vertex * share * vertices;
  }

  double growth(double by_model) const {
    constexpr double growth_in_gaps = 0.25;  // as in coarsen/target_sizes.cpp
    if (options_.gradation > 0) return options_.gradation;
    return options_.elements_across_gap > 0 ? growth_in_gaps : by_model;
  }

  /// Returns the longest chord of a circle of this radius that is within the tolerance.
  double chord(double radius, double tolerance) const {
    return std::sqrt(8 * radius * model_.chord * tolerance);
  }

  double size_of_segment(Index c, std::size_t i) const {
    const auto [a, b] = shape_.segment(c, i);
    const std::vector<Index>& points = plc_.curves[c].points;
    const double tolerance = tolerance_.at_segment(points[i], points[(i + 1) % points.size()]);
    return std::min(sizing_.curve_size(c, i, i, 0.5 * (a + b)),
                    chord(shape_.radius_of_segment(c, i), tolerance) / model_.edge);
  }

  /// Returns the size in the direction in which the patch curves most.
  double size_across(Index triangle, const Point& p) const {
    return std::min(sizing_.triangle_size(plc_.triangles[triangle].patch, triangle, p),
                    chord(shape_.radius_of_triangle(triangle), tolerance_.at_triangle(triangle)));
  }

  double size_of_wall(Index triangle, const Point& p, double size) const {
    const double widest = std::max(size / model_.wall, sizing_.widest_gap(size));
    const double width = shape_.wall_width(p, triangle, widest);
    if (width < Sizing::narrow_gap_per_size * size) return std::min(size, sizing_.gap_size(width));
    return width < widest
               ? std::min({size, std::max(model_.wall * width, least_share * size), sizing_.gap_size(width)})
               : size;
  }

  /// Returns the number of pieces to divide a length into: each is half an edge long, longer in very fine
  /// meshes.
  static double pieces_wanted(double length, double size) {
    return std::clamp(std::ceil(2 * length / size), 1.0, most_pieces_of_segment);
  }

  std::vector<std::vector<CurvePiece>> pieces_of_curves() const {
    double wanted = 0;
    for (Index c = 0; c < plc_.curves.size(); ++c)
      for (std::size_t i = 0; i < shape_.segment_count(c); ++i) {
        const auto [a, b] = shape_.segment(c, i);
        wanted += pieces_wanted(distance(a, b), size_of_segment(c, i));
      }
    const double share = std::min(1.0, most_pieces_of_curves / wanted);
    std::vector<std::vector<CurvePiece>> all(plc_.curves.size());
    for (Index c = 0; c < plc_.curves.size(); ++c)
      for (std::size_t i = 0; i < shape_.segment_count(c); ++i) {
        const auto [a, b] = shape_.segment(c, i);
        const double size = size_of_segment(c, i);
        const double count = std::ceil(share * pieces_wanted(distance(a, b), size));
        Point from = a;
        for (double k = 1; k <= count; ++k) {
          const Point to = a + k / count * (b - a);
          const double width = shape_.strip_width(0.5 * (from + to), c, b - a, size / model_.strip);
          const bool narrow = width < Sizing::narrow_gap_per_size * size;
          all[c].push_back({from, to, narrow ? size : std::max(model_.strip * width, least_share * size)});
          from = to;
        }
      }
    return all;
  }

  /// Rounds the number of edges of a curve to a whole number: at least one, for a loop at least three.
  double whole(Index c, double edges) const {
    const Plc::Curve& curve = plc_.curves[c];
    const bool loop = curve.closed || curve.ends[0] == curve.ends[1];
    return std::max(loop ? 3.0 : 1.0, std::round(edges));
  }

  std::vector<GradedSize::Source> sources() const {
    std::vector<GradedSize::Source> all;
    for (Index c = 0; c < plc_.curves.size(); ++c) {
      double edges = 0;
      for (const auto& [a, b, size] : pieces_[c]) edges += distance(a, b) / (model_.edge * size);
      const double stretch = edges / whole(c, edges);
      const bool asked = options_.curve_size.contains(plc_.curves[c].tag);
      const double grows = growth(asked ? model_.asked_growth : model_.growth);
      for (const auto& [a, b, size] : pieces_[c]) all.push_back({{a, b, b}, stretch * size, grows});
    }
    for (Index t = 0; t < plc_.triangles.size(); ++t) {
      const auto corners = shape_.corners(t);
      const Point centre = (corners[0] + corners[1] + corners[2]) / 3;
      double size = size_across(t, centre);
      if (options_.elements_across_gap > 0)
        size = std::min(size, sizing_.gap_size(shape_.wall_width(centre, t, sizing_.widest_gap(size))));
      if (size < sizing_.default_size(centre)) all.push_back({corners, size, growth(model_.growth)});
    }
    return all;
  }

  void count_on_curve(Index c) {
    double edges = 0;
    for (const auto& [a, b, size] : pieces_[c])
      edges += distance(a, b) / (model_.edge * sizes_.at(0.5 * (a + b), size));
    const bool has_vertex = !plc_.curves[c].closed;
    add(whole(c, edges) - (has_vertex ? 1 : 0), shape_.angles().of_curve[c]);
  }

  /// Counts the vertices on patches: halves triangles until the size varies little in each piece.
  void count_on_patches() {
    for (; !triangles_.empty() && !is_enough(); ++triangles_done_) {
      const Piece piece = triangles_.front();
      triangles_.pop_front();
      const auto& [a, b, c] = piece.corners;
      const Point p = place_in(piece, triangles_done_);
      const double radius = std::max({distance(p, a), distance(p, b), distance(p, c)});
      const double area = 0.5 * norm(cross(b - a, c - a));
      const Index patch = plc_.triangles[piece.triangle].patch;
      const double to_border = shape_.distance_to_border(p, patch);
      const double graded = sizes_.at(p, sizing_.triangle_size(patch, piece.triangle, p));
      const double change = std::min(sizes_.growth() * radius, 0.5 * graded);
      const double size = size_of_wall(piece.triangle, p, graded);
      if (to_border + radius < model_.border_from * std::min(size, graded - change)) continue;
      const bool one_size = area < 0.15 * size * size ||
                            (change < 0.4 * size && to_border - radius > model_.border_to * (size + change));
      if (!one_size && triangles_done_ + triangles_.size() < most_triangles_) {
        halve(piece, triangles_);
        continue;
      }
      const double across = std::min(size, size_across(piece.triangle, p));
      const double per_vertex = model_.area * across * std::min(size, model_.aspect * across);
      add(ramp(to_border / size, model_.border_from, model_.border_to) * area / per_vertex,
          shape_.angles().of_patch[patch]);
    }
  }

  /// Returns a place in a piece. The places of many pieces are evenly spread (the R2 sequence of M. Roberts,
  /// 2018), so slivers need not be divided down to their width.
  static Point place_in(const Piece& piece, std::size_t number) {
    double whole = 0;
    double u = std::modf(0.5 + 0.7548776662466927 * static_cast<double>(number), &whole);
    double v = std::modf(0.5 + 0.5698402909980532 * static_cast<double>(number), &whole);
    if (u + v > 1) {
      u = 1 - u;
      v = 1 - v;
    }
    const auto& [a, b, c] = piece.corners;
    return a + u * (b - a) + v * (c - a);
  }

  static void halve(const Piece& piece, std::deque<Piece>& pieces) {
    const auto& corners = piece.corners;
    unsigned longest = 0;
    const auto side = [&](unsigned i) { return squared_distance(corners[i], corners[(i + 1) % 3]); };
    for (unsigned i = 1; i < 3; ++i)
      if (side(i) > side(longest)) longest = i;
    const Point &a = corners[longest], &b = corners[(longest + 1) % 3], &c = corners[(longest + 2) % 3];
    const Point middle = 0.5 * (a + b);
    pieces.push_back({piece.triangle, {a, middle, c}});
    pieces.push_back({piece.triangle, {middle, b, c}});
  }

  /// Counts the vertices of regions: divides the bounding box into cubes until the size varies little in
  /// each.
  void count_inside() {
    for (; !cubes_.empty() && !is_enough(); ++cubes_done_) {
      Cube cube = cubes_.front();
      cubes_.pop_front();
      const bool last = cubes_done_ + cubes_.size() >= most_cubes;
      const Point p = last ? place_in(cube, cubes_done_) : cube.centre;
      const double radius = std::sqrt(3.0) * cube.half;
      const auto [depth, nearest] = shape_.nearest(p, cube.nearest);
      cube.nearest = nearest;
      if (cube.region == none && depth > (last ? 0 : radius)) cube.region = shape_.region_at(p, nearest);
      if (cube.region == 0) continue;
      const double wished =
          cube.region == none ? sizing_.default_size(p) : sizing_.region_size(cube.region, p);
      const double most_change = sizes_.growth() * radius;
      const double graded = sizes_.at(p, wished + most_change);
      const double size = std::min(wished, graded), change = std::min(most_change, 0.5 * size);
      if (depth + radius < model_.depth_from * (size - change)) continue;
      const bool one_size = radius < 0.5 * size || ((graded >= wished + most_change || change < 0.4 * size) &&
                                                    depth - radius > model_.depth_to * size);
      if (!last && (cube.region == none || !one_size)) {
        divide(cube, cubes_);
        continue;
      }
      if (cube.region == none) continue;
      add(ramp(depth / size, model_.depth_from, model_.depth_to) * std::pow(2 * cube.half / size, 3) /
              model_.volume,
          1);
    }
  }

  static Point place_in(const Cube& cube, std::size_t number) {
    const auto place = [&](double step) {
      double whole = 0;
      return cube.half * (2 * std::modf(0.5 + step * static_cast<double>(number), &whole) - 1);
    };
    return cube.centre +
           Vector{place(0.8191725133961645), place(0.6710436067037893), place(0.5497004779019703)};
  }

  static void divide(const Cube& cube, std::deque<Cube>& cubes) {
    const double h = 0.5 * cube.half;
    for (const double x : {-h, h})
      for (const double y : {-h, h})
        for (const double z : {-h, h})
          cubes.push_back({cube.centre + Vector{x, y, z}, h, cube.region, cube.nearest});
  }

  const Shape& shape_;
  const Plc& plc_;
  const MeshOptions& options_;
  SurfaceTolerance tolerance_;
  const Model model_;
  double enough_ = 0;
  Sizing sizing_;
  std::vector<std::vector<CurvePiece>> pieces_;  // by curve
  GradedSize sizes_;
  double tets_ = 0;
  // Where the next call goes on:
  std::deque<Cube> cubes_;
  std::size_t cubes_done_ = 0;
  bool has_vertices_ = false;
  Index next_curve_ = 0;
  std::deque<Piece> triangles_;
  std::size_t triangles_done_ = 0, most_triangles_ = 0;
};

TetCounter::TetCounter(const Shape& shape, const MeshOptions& options, const Model& model)
    : counter_(std::make_unique<Counter>(shape, options, model)) {}

TetCounter::~TetCounter() = default;

double TetCounter::count_up_to(double enough) { return counter_->count_up_to(enough); }

double count_tets(const Shape& shape, const MeshOptions& options, const Model& model, double enough) {
  return TetCounter(shape, options, model).count_up_to(enough);
}

}  // namespace collarmesh::prediction
