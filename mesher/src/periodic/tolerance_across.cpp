#include "periodic/tolerance_across.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/box_tree.h"
#include "periodic/feature_images.h"
#include "periodic/pair_choice.h"

namespace collarmesh::periodicity {

namespace {

constexpr double slope = 0.1;  // increase of the tolerance per unit of distance from curves that are images
                               // of each other; the same as beside wedges

struct Sample {
  Point place;
  double tolerance;
};

std::vector<Sample> samples_on(const Plc& plc, Index curve, const SurfaceTolerance& tolerance) {
  std::vector<Sample> samples;
  for (const Index p : plc.curves[curve].points) samples.push_back({plc.points[p], tolerance.at_point(p)});
  return samples;
}

/// Adds to `smaller` each moved sample of `from` whose nearest sample of `to` has a larger tolerance.
void compare(const std::vector<Sample>& from, const std::vector<Sample>& to, const Motion& motion,
             std::vector<Sample>& smaller) {
  for (const Sample& sample : from) {
    const Point image = motion(sample.place);
    const auto nearest = std::min_element(to.begin(), to.end(), [&](const Sample& a, const Sample& b) {
      return squared_distance(a.place, image) < squared_distance(b.place, image);
    });
    if (nearest->tolerance > sample.tolerance) smaller.push_back({image, sample.tolerance});
  }
}

Point centre(const Plc& plc, Index triangle) {
  const auto& [a, b, c] = plc.triangles[triangle].points;
  return (plc.points[a] + plc.points[b] + plc.points[c]) / 3;
}

}  // namespace

SurfaceTolerance tolerance_across(const SurfaceTolerance& tolerance, const Plc& plc,
                                  const PeriodicOptions& options, double distance) {
  if (!tolerance.varies()) return tolerance;
  std::vector<Sample> smaller;
  for (const PatchPair& pair : choose_pairs(options, plc))
    for (const auto& [curve, image] : find_images(pair, plc, distance).curves) {
      if (plc.curves[curve].straight) continue;
      const std::vector<Sample> first = samples_on(plc, curve, tolerance),
                                second = samples_on(plc, image, tolerance);
      compare(first, second, pair.motion, smaller);
      compare(second, first, inverse(pair.motion), smaller);
    }
  if (smaller.empty()) return tolerance;
  std::vector<double> of_triangles;
  std::vector<Box> boxes;
  for (Index t = 0; t < plc.triangles.size(); ++t) {
    of_triangles.push_back(tolerance.at_triangle(t));
    Box& box = boxes.emplace_back();
    for (const Index p : plc.triangles[t].points) box.add(plc.points[p]);
  }
  const BoxTree tree(boxes);
  for (const Sample& sample : smaller) {
    const Point& place = sample.place;
    const double allowed = sample.tolerance, reach = (tolerance.largest() - allowed) / slope;
    const Vector margin{reach, reach, reach};
    tree.for_each_meeting({place - margin, place + margin}, [&](Index t) {
      double nearest = norm(centre(plc, t) - place);
      for (const Index p : plc.triangles[t].points) nearest = std::min(nearest, norm(plc.points[p] - place));
      of_triangles[t] = std::min(of_triangles[t], allowed + slope * nearest);
    });
  }
  return {plc, std::move(of_triangles), tolerance.largest()};
}

}  // namespace collarmesh::periodicity
