#include "repair/distances.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "common/distance_tree.h"
#include "repair/winding_number.h"

namespace collarmesh::repairing {

namespace {

constexpr double spacing_by_diagonal = 0.02;

// Sorts the corners, so that copies of a triangle have them in the same order.
CornerPoints canonical(CornerPoints t) {
  const auto key = [](const Point& p) { return std::array{p.x, p.y, p.z}; };
  std::sort(t.begin(), t.end(), [&](const Point& a, const Point& b) { return key(a) < key(b); });
  return t;
}

bool before(const CornerPoints& s, const CornerPoints& t) {
  for (unsigned i = 0; i < 3; ++i)
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (s[i][axis] != t[i][axis]) return s[i][axis] < t[i][axis];
  return false;
}

// Returns the triangles that are not among `others`, whatever the order of their corners.
std::vector<CornerPoints> without(std::span<const CornerPoints> triangles,
                                  std::span<const CornerPoints> others) {
  std::vector<CornerPoints> sorted;
  sorted.reserve(others.size());
  for (const CornerPoints& t : others) sorted.push_back(canonical(t));
  std::sort(sorted.begin(), sorted.end(), before);
  std::vector<CornerPoints> rest;
  for (const CornerPoints& t : triangles)
    if (!std::binary_search(sorted.begin(), sorted.end(), canonical(t), before)) rest.push_back(t);
  return rest;
}

unsigned steps(double length, double spacing) {
  constexpr double most = 200;
  return static_cast<unsigned>(std::clamp(std::ceil(length / spacing), 1.0, most));
}

// Visits a triangle's corners, its centroid, and points on lines parallel to its longest side. Lines and
// points are no farther apart than the spacing, unless that takes more than 200 steps.
template <class Visit>
void for_each_sample(const CornerPoints& t, double spacing, const Visit& visit) {
  unsigned first = 0;
  for (unsigned i = 1; i < 3; ++i)
    if (distance(t[i], t[(i + 1) % 3]) > distance(t[first], t[(first + 1) % 3])) first = i;
  const Point &a = t[first], &b = t[(first + 1) % 3], &c = t[(first + 2) % 3];
  const double length = distance(a, b), area = norm(cross(b - a, c - a));
  const unsigned lines = steps(length > 0 ? area / length : 0, spacing);
  for (unsigned j = 0; j < lines; ++j) {
    const double up = static_cast<double>(j) / lines;
    const Point from = a + up * (c - a), to = b + up * (c - b);
    const unsigned n = steps((1 - up) * length, spacing);
    for (unsigned i = 0; i <= n; ++i) visit(from + (static_cast<double>(i) / n) * (to - from));
  }
  visit(c);
  visit((1.0 / 3) * (a + b + c));
}

double diagonal_of(std::span<const CornerPoints> triangles) {
  Box box;
  for (const CornerPoints& t : triangles)
    for (const Point& p : t) box.add(p);
  return box.diagonal();
}

/// A search for the sample that is farthest from a surface, among the samples that it does not enclose.
/// Winding numbers cost far more than distances, so they are only computed for the farthest of many samples.
/// If a sample is inside, so is every sample that is nearer to it than the surface.
class FarthestOutside {
 public:
  explicit FarthestOutside(const WindingNumber& winding) : winding_(winding) {}

  double distance() const { return farthest_.distance; }
  const Point& place() const { return farthest_.place; }

  void add(const Point& place, double distance) {
    constexpr std::size_t most = 4000;
    if (distance > farthest_.distance) waiting_.push_back({distance, place});
    if (waiting_.size() == most) finish();
  }

  /// Examines the samples added since the last call.
  void finish() {
    constexpr double half = 0.5;
    std::ranges::stable_sort(waiting_, std::ranges::greater(), &Sample::distance);
    for (const Sample& sample : waiting_) {
      if (sample.distance <= farthest_.distance) break;
      if (is_in_ball_inside(sample.place)) continue;
      if (winding_.at(sample.place) < half)
        farthest_ = sample;
      else
        inside_.push_back(sample);
    }
    waiting_.clear();
    inside_.clear();
  }

 private:
  struct Sample {
    double distance = 0;
    Point place{};
  };

  bool is_in_ball_inside(const Point& place) const {
    return std::ranges::any_of(inside_, [&](const Sample& centre) {
      return squared_distance(place, centre.place) < centre.distance * centre.distance;
    });
  }

  const WindingNumber& winding_;
  Sample farthest_;
  std::vector<Sample> waiting_, inside_;
};

WindingNumber winding_of(std::span<const CornerPoints> repaired, std::span<const CornerPoints> filled) {
  std::vector<WeightedTriangle> triangles;
  triangles.reserve(repaired.size() + filled.size());
  for (const auto& list : {repaired, filled})
    for (const CornerPoints& t : list) triangles.push_back({t, 1, 0});
  return WindingNumber(std::move(triangles));
}

}  // namespace

RepairDistances measure_distances(std::span<const CornerPoints> input, std::span<const CornerPoints> repaired,
                                  std::span<const CornerPoints> filled) {
  RepairDistances distances;
  const double spacing = spacing_by_diagonal * diagonal_of(input);
  if (!(spacing > 0) || repaired.empty()) return distances;
  const std::vector<CornerPoints> arisen = without(repaired, input), gone = without(input, repaired);
  if (!arisen.empty()) {
    const DistanceTree tree({input.begin(), input.end()});
    Index hint = none;
    for (const CornerPoints& t : arisen)
      for_each_sample(t, spacing, [&](const Point& p) {
        const DistanceTree::Nearest nearest = tree.nearest(p, distances.of_repaired, hint);
        distances.of_repaired = std::max(distances.of_repaired, nearest.distance);
        hint = nearest.triangle;
      });
  }
  if (gone.empty()) return distances;
  std::vector<CornerPoints> all(repaired.begin(), repaired.end());
  all.insert(all.end(), filled.begin(), filled.end());
  const DistanceTree tree(std::move(all));
  const WindingNumber winding = winding_of(repaired, filled);
  FarthestOutside farthest(winding);
  constexpr double half = 0.5;
  Index hint = none;
  for (const CornerPoints& t : gone) {
    // Most removed triangles lie deep inside, far from all remaining ones.
    const Point centroid = (1.0 / 3) * (t[0] + t[1] + t[2]);
    const double radius =
        std::max({distance(centroid, t[0]), distance(centroid, t[1]), distance(centroid, t[2])});
    if (tree.nearest(centroid, radius, hint).distance > radius && winding.at(centroid) > half) continue;
    for_each_sample(t, spacing, [&](const Point& p) {
      const DistanceTree::Nearest nearest = tree.nearest(p, farthest.distance(), hint);
      farthest.add(p, nearest.distance);
      hint = nearest.triangle;
    });
  }
  farthest.finish();
  distances.of_input = farthest.distance();
  distances.farthest_of_input = farthest.place();
  return distances;
}

KeptVolume kept_volume(std::span<const CornerPoints> input, std::span<const CornerPoints> repaired) {
  constexpr int places = 1000;
  constexpr double nearly = 0.25, most_unclear = 0.2, half = 0.5;
  Box box;
  for (const CornerPoints& t : input)
    for (const Point& p : t) box.add(p);
  const WindingNumber before = winding_of(input, {}), after = winding_of(repaired, {});
  KeptVolume kept;
  int inside = 0, unclear = 0, lost = 0;
  for (int i = 0; i < places; ++i) {
    // M. Roberts' sequence: its points are evenly spread, and the same on every machine.
    constexpr std::array<double, 3> steps{0.8191725133961645, 0.6710436067037893, 0.5497004779019703};
    Point p;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double share = half + i * steps[axis];
      p[axis] = box.min[axis] + (share - std::floor(share)) * (box.max[axis] - box.min[axis]);
    }
    const double winding = std::fabs(before.at(p));
    if (winding < half) continue;
    ++inside;
    if (std::fabs(winding - std::round(winding)) > nearly) ++unclear;
    if (std::fabs(after.at(p)) > half) continue;
    ++lost;
    kept.where = p;
  }
  if (unclear > most_unclear * inside) return {};
  const Vector size = box.max - box.min;
  const double each = size.x * size.y * size.z / places;
  kept.input = inside * each;
  kept.lost = lost * each;
  return kept;
}

}  // namespace collarmesh::repairing
