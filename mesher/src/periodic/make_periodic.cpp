#include <algorithm>
#include <utility>

#include "collarmesh/periodic.h"
#include "periodic/cavity.h"
#include "periodic/chains.h"
#include "periodic/feature_images.h"
#include "periodic/make_periodic.h"
#include "periodic/pair_choice.h"
#include "periodic/patch_editor.h"

namespace collarmesh {

namespace periodicity {
namespace {

constexpr unsigned rounds = 8;  // in which curves get nodes that others of their class could not lose

struct Periodicity {
  std::vector<PatchPair> pairs;
  std::vector<FeatureImages> images;  // by pair
};

Periodicity find_periodicity(const PeriodicOptions& options, const Plc& plc, double distance,
                             Direction direction = Direction::forward) {
  Periodicity found{choose_pairs(options, plc), {}};
  if (direction == Direction::backward)
    for (PatchPair& pair : found.pairs) {
      std::swap(pair.first, pair.second);
      pair.motion = inverse(pair.motion);
    }
  for (const PatchPair& pair : found.pairs) found.images.push_back(find_images(pair, plc, distance));
  return found;
}

/// Makes the mesh of the second group of each pair that of the first: curves, then patches.
class Maker {
 public:
  Maker(TetMesh& mesh, const Plc& plc, Periodicity periodicity)
      : mesh_(mesh),
        plc_(plc),
        periodicity_(std::move(periodicity)),
        editor_(mesh),
        chains_(chains_of(mesh, plc)) {}

  PeriodicReport run() {
    for (const CurveClass& of : curve_classes(periodicity_.pairs, periodicity_.images, plc_.curves.size()))
      make_alike(of);
    collect_faces();
    for (std::size_t k = 0; k < periodicity_.pairs.size(); ++k) make_patches_alike(k);
    editor_.store();
    return std::move(report_);
  }

 private:
  // Nodes that an image cannot lose are put on the original as well.
  void make_alike(const CurveClass& of) {
    Chain& original = chains_[of.original];
    for (unsigned round = 0; round < rounds; ++round) {
      std::vector<Point> stuck;
      for (const CurveImage& image : of.images) {
        const ChainChange change =
            put_nodes(editor_, image.curve, chains_[image.curve], places_of(original, image.motion));
        count(change);
        const Motion back = inverse(image.motion);
        for (const Point& place : change.stuck) stuck.push_back(back(place));
      }
      if (stuck.empty()) return;
      std::vector<Point> places = places_of(original, {});
      places.insert(places.end(), stuck.begin(), stuck.end());
      count(put_nodes(editor_, of.original, original, places));
    }
  }

  void count(const ChainChange& change) {
    report_.inserted_nodes += change.inserted;
    report_.removed_nodes += change.removed;
  }

  // Of the nodes between the ends, which stay where they are.
  std::vector<Point> places_of(const Chain& chain, const Motion& motion) const {
    std::vector<Point> places;
    for (const Index node : chain.nodes)
      if (mesh_.features[node].dimension == 1) places.push_back(motion(mesh_.points[node]));
    return places;
  }

  void collect_faces() {
    faces_.resize(plc_.patches.size());
    for (Index f = 0; f < mesh_.faces.size(); ++f)
      if (mesh_.face_patch[f] != none) faces_[mesh_.face_patch[f]].push_back(f);
  }

  void make_patches_alike(std::size_t k) {
    const PatchPair& pair = periodicity_.pairs[k];
    const FeatureImages& images = periodicity_.images[k];
    image_of_.assign(mesh_.points.size(), none);
    for (const auto& [curve, image] : images.curves) {
      const std::vector<Index> nodes = corresponding(editor_, chains_[curve], chains_[image], pair.motion);
      for (std::size_t i = 0; i < nodes.size(); ++i) image_of_[chains_[curve].nodes[i]] = nodes[i];
    }
    std::vector<Index> node_of(plc_.vertices.size(), none);
    for (Index v = 0; v < mesh_.features.size(); ++v)
      if (mesh_.features[v].dimension == 0) node_of[mesh_.features[v].feature] = v;
    for (const auto& [vertex, image] : images.vertices) image_of_[node_of[vertex]] = node_of[image];
    for (const auto& [patch, image] : images.patches) make_patch_alike(patch, image, pair.motion);
  }

  void make_patch_alike(Index patch, Index image, const Motion& motion) {
    std::vector<Index> inside;
    for (const Index face : faces_[patch])
      for (const Index v : mesh_.faces[face])
        if (mesh_.features[v].dimension == 2) inside.push_back(v);
    std::sort(inside.begin(), inside.end());
    inside.erase(std::unique(inside.begin(), inside.end()), inside.end());
    std::vector<Point> places;
    for (const Index v : inside) places.push_back(motion(mesh_.points[v]));
    PatchEditor of_image(editor_, plc_, image, faces_[image]);
    const std::vector<Index> nodes = of_image.put_nodes(places);
    for (std::size_t i = 0; i < inside.size(); ++i) image_of_[inside[i]] = nodes[i];
    std::vector<PatchEditor::Edge> edges;
    for (const Index face : faces_[patch]) {
      const auto& corners = mesh_.faces[face];
      for (unsigned i = 0; i < 3; ++i) {
        const Index a = image_of_[corners[i]], b = image_of_[corners[(i + 1) % 3]];
        if (a != none && b != none) edges.push_back({std::min(a, b), std::max(a, b)});
      }
    }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    of_image.make_edges(edges);
    report_.inserted_nodes += of_image.change().inserted;
    report_.removed_nodes += of_image.change().removed;
    report_.turned_edges += of_image.change().turned;
  }

  TetMesh& mesh_;
  const Plc& plc_;
  const Periodicity periodicity_;
  CavityEditor editor_;
  std::vector<Chain> chains_;              // by curve
  std::vector<std::vector<Index>> faces_;  // by patch
  std::vector<Index> image_of_;            // by node of the pair's first group
  PeriodicReport report_;
};

std::vector<Tag> tags_of(const std::vector<Index>& patches, const Plc& plc) {
  std::vector<Tag> tags;
  for (const Index patch : patches) tags.push_back(plc.patches[patch].tag);
  std::sort(tags.begin(), tags.end());
  tags.erase(std::unique(tags.begin(), tags.end()), tags.end());
  return tags;
}

}  // namespace
}  // namespace periodicity

void require_periodic_patches(const PeriodicOptions& options, const Plc& plc, double distance) {
  periodicity::find_periodicity(options, plc, distance);
}

PeriodicReport make_periodic(TetMesh& mesh, const Plc& plc, const PeriodicOptions& options, double distance) {
  return periodicity::make_periodic(mesh, plc, options, distance, periodicity::Direction::forward);
}

PeriodicReport periodicity::make_periodic(TetMesh& mesh, const Plc& plc, const PeriodicOptions& options,
                                          double distance, Direction direction) {
  PeriodicReport report = Maker(mesh, plc, find_periodicity(options, plc, distance, direction)).run();
  mesh.periodic.clear();
  for (const PatchPair& pair : choose_pairs(options, plc)) {
    mesh.periodic.push_back({tags_of(pair.first, plc), tags_of(pair.second, plc), pair.motion, {}});
    report.pairs.push_back({.text = pair.text});
  }
  return report;
}

}  // namespace collarmesh
