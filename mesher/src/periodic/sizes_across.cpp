#include "periodic/sizes_across.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <unordered_map>
#include <vector>

#include "common/box_tree.h"
#include "periodic/pair_choice.h"

namespace collarmesh::periodicity {

namespace {

constexpr double clearly = 1.5;  // edges so many times as long are clearly longer
constexpr double growth = 0.3;   // of sizes, per unit length, as that of size fields

struct Sample {
  Point place;
  double length;  // of the edges there
};

/// The nodes of patches with the mean length of their edges there.
std::vector<Sample> samples_on(const TetMesh& mesh, const std::vector<Index>& patches) {
  struct Sum {
    double length = 0, edges = 0;
  };
  std::unordered_map<Index, Sum> sums;
  std::vector<Index> nodes;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    if (!std::binary_search(patches.begin(), patches.end(), mesh.face_patch[f])) continue;
    for (unsigned i = 0; i < 3; ++i) {
      const Index a = mesh.faces[f][i], b = mesh.faces[f][(i + 1) % 3];
      const double length = distance(mesh.points[a], mesh.points[b]);
      for (const Index v : {a, b}) {
        Sum& sum = sums[v];
        if (sum.edges == 0) nodes.push_back(v);
        sum.length += length, sum.edges += 1;
      }
    }
  }
  std::vector<Sample> samples;
  samples.reserve(nodes.size());
  for (const Index v : nodes) samples.push_back({mesh.points[v], sums[v].length / sums[v].edges});
  return samples;
}

/// Adds the samples of one group, moved, where those of the other are clearly longer.
void compare(const std::vector<Sample>& from, const std::vector<Sample>& to, const Motion& motion,
             std::vector<Sample>& wanted) {
  std::vector<Box> boxes;
  boxes.reserve(to.size());
  for (const Sample& sample : to) boxes.push_back({sample.place, sample.place});
  const BoxTree tree(boxes);
  for (const auto& [place, length] : from) {
    const Point image = motion(place);
    const double reach = clearly * length;
    const Vector margin{reach, reach, reach};
    double nearest = INFINITY, length_there = INFINITY;
    tree.for_each_meeting({image - margin, image + margin}, [&](Index i) {
      const double d = squared_distance(to[i].place, image);
      if (d < nearest) nearest = d, length_there = to[i].length;
    });
    if (length_there > clearly * length) wanted.push_back({image, length});
  }
}

/// The samples that others do not imply, shortest first.
std::vector<Sample> decisive(std::vector<Sample> samples) {
  std::sort(samples.begin(), samples.end(), [](const Sample& a, const Sample& b) {
    return a.length != b.length
               ? a.length < b.length
               : std::array{a.place.x, a.place.y, a.place.z} < std::array{b.place.x, b.place.y, b.place.z};
  });
  std::vector<Sample> kept;
  for (const Sample& sample : samples)
    if (std::ranges::none_of(kept, [&](const Sample& other) {
          return other.length + growth * distance(other.place, sample.place) <= sample.length;
        }))
      kept.push_back(sample);
  return kept;
}

std::optional<SizeField> field_of(std::vector<Sample> samples) {
  if (samples.empty()) return std::nullopt;
  const auto places = std::make_shared<const std::vector<Sample>>(decisive(std::move(samples)));
  return [places](const Point& p) {
    double size = INFINITY;
    for (const auto& [place, length] : *places) size = std::min(size, length + growth * distance(p, place));
    return size;
  };
}

}  // namespace

std::optional<SizeField> sizes_across(const TetMesh& mesh, const Plc& plc, const PeriodicOptions& options) {
  std::vector<Sample> wanted;
  for (const PatchPair& pair : choose_pairs(options, plc)) {
    const std::vector<Sample> first = samples_on(mesh, pair.first), second = samples_on(mesh, pair.second);
    compare(first, second, pair.motion, wanted);
    compare(second, first, inverse(pair.motion), wanted);
  }
  return field_of(std::move(wanted));
}

}  // namespace collarmesh::periodicity
