#include "pipeline/lost_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

namespace collarmesh {

namespace {

constexpr double most_of_a_volume = 0.02;           // share that a region may lose or gain
constexpr double most_of_all_in_thin_ones = 0.005;  // share of all volume that may vanish in thin regions

struct Body {
  double volume = 0, area = 0;
  double thickness() const { return area > 0 ? 2 * volume / area : 0; }
};

// Returns the volumes and areas of all regions except the outside, largest volume first.
std::vector<Body> bodies_of(const Plc& plc) {
  std::vector<Body> bodies(plc.regions.size());
  for (std::size_t r = 1; r < bodies.size(); ++r) bodies[r].volume = std::fabs(plc.regions[r].volume);
  for (const Plc::Triangle& t : plc.triangles) {
    const Point &a = plc.points[t.points[0]], &b = plc.points[t.points[1]], &c = plc.points[t.points[2]];
    for (const Index region : plc.patches[t.patch].regions)
      bodies[region].area += 0.5 * norm(cross(b - a, c - a));
  }
  if (!bodies.empty()) bodies.erase(bodies.begin());  // the outside
  std::ranges::sort(bodies, std::ranges::greater(), &Body::volume);
  return bodies;
}

double volume_of(const std::vector<Body>& bodies) {
  double sum = 0;
  for (const Body& body : bodies) sum += body.volume;
  return sum;
}

std::string lost_bodies(const Plc& finer, const Plc& coarser, double tolerance) {
  const std::vector<Body> before = bodies_of(finer);
  std::multiset<double> after;
  for (const Body& body : bodies_of(coarser)) after.insert(body.volume);
  double thin = 0;
  for (const Body& body : before) {
    const double most = most_of_a_volume * body.volume;
    const auto found = after.lower_bound(body.volume - most);
    if (found != after.end() && *found <= body.volume + most)
      after.erase(found);
    else if (body.thickness() < tolerance)
      thin += body.volume;
    else
      return fmt::format("a region of volume {:.3g} would change by more than {}%", body.volume,
                         100 * most_of_a_volume);
  }
  if (thin > most_of_all_in_thin_ones * volume_of(before))
    return fmt::format("thin regions of volume {:.3g} would vanish", thin);
  return {};
}

// Takes the tags that the finer repair (`before`) and the coarser one (`after`) have lost. Returns a sentence
// on a tag that only the coarser one has lost; empty if there is none.
std::string lost_beyond(const std::vector<Tag>& before, const std::vector<Tag>& after, const char* what) {
  for (const Tag tag : after)
    if (std::ranges::find(before, tag) == before.end())
      return fmt::format("nothing of {} {} would be left", what, tag);
  return {};
}

std::string lost_names(const Plc& finer, const Plc& coarser) {
  std::array<std::set<Tag>, 3> before, after;  // by dimension
  for (const auto& [plc, tags] : {std::pair{&finer, &before}, std::pair{&coarser, &after}}) {
    for (const Plc::Curve& curve : plc->curves) (*tags)[1].insert(curve.tag);
    for (const Plc::Patch& patch : plc->patches) (*tags)[2].insert(patch.tag);
  }
  for (const unsigned dimension : {1U, 2U})
    for (const auto& [tag, name] : finer.names.of(dimension))
      if (before[dimension].contains(tag) && !after[dimension].contains(tag))
        return fmt::format("nothing of {} would be left", name);
  return {};
}

}  // namespace

std::string lost_parts(const Plc& finer, const RepairReport& finer_report, const Plc& coarser,
                       const RepairReport& coarser_report) {
  std::string lost =
      lost_beyond(finer_report.lost_regions, coarser_report.lost_regions, "the region with tag");
  if (lost.empty())
    lost = lost_beyond(finer_report.lost_groups, coarser_report.lost_groups, "the facets with tag");
  if (lost.empty()) lost = lost_names(finer, coarser);
  if (lost.empty()) lost = lost_bodies(finer, coarser, coarser_report.tolerance);
  return lost;
}

}  // namespace collarmesh
