#include <algorithm>
#include <map>
#include <utility>

#include "collarmesh/periodic.h"
#include "common/distance_tree.h"
#include "common/sort_uniquely.h"
#include "periodic/cavity.h"
#include "periodic/chains.h"
#include "periodic/feature_images.h"
#include "periodic/make_periodic.h"
#include "periodic/pair_choice.h"
#include "periodic/patch_editor.h"
#include "periodic/sparse_nodes.h"

namespace collarmesh {

namespace periodicity {
namespace {

// Qualities that edge flips must leave, if possible.
constexpr double good = 0.15, fair = 0.05;
constexpr unsigned rounds = 8;  // rounds in which curves get nodes that other curves of their class could not
                                // lose

struct Periodicity {
  std::vector<PatchPair> pairs;
  std::vector<FeatureImages> images;  // by pair
};

Periodicity find_periodicity(const PeriodicOptions& options, const Plc& plc, double distance) {
  Periodicity found{choose_pairs(options, plc), {}};
  for (const PatchPair& pair : found.pairs) found.images.push_back(find_images(pair, plc, distance));
  return found;
}

/// Returns the curves of a class, the original first, each with the motion from the original.
std::vector<CurveImage> with_original(const CurveClass& of) {
  std::vector<CurveImage> curves{{of.original, {}}};
  curves.insert(curves.end(), of.images.begin(), of.images.end());
  return curves;
}

std::vector<Point> moved(std::vector<Point> places, const Motion& motion) {
  for (Point& place : places) place = motion(place);
  return places;
}

/// Adds the moved places of `others`, except a place whose distance from an existing place is less than half
/// of its own spacing.
void add_places(std::vector<Point>& places, const std::vector<SpacedPlace>& others, const Motion& motion) {
  constexpr double nearest = 0.5;  // relative to the spacing
  std::vector<DistanceTree::Triangle> before;
  before.reserve(places.size());
  for (const Point& place : places) before.push_back({place, place, place});
  const DistanceTree tree(std::move(before));
  for (const auto& [place, spacing] : others)
    if (const Point at = motion(place); tree.nearest(at).distance > nearest * spacing) places.push_back(at);
}

/// A mesh with the chains of its curves and the faces of its patches.
struct Surface {
  Surface(const TetMesh& mesh, const Plc& plc) : chains(chains_of(mesh, plc)), faces(plc.patches.size()) {
    find_faces(mesh);
  }

  void find_faces(const TetMesh& mesh) {
    for (auto& of_patch : faces) of_patch.clear();
    for (Index f = 0; f < mesh.faces.size(); ++f)
      if (mesh.face_patch[f] != none) faces[mesh.face_patch[f]].push_back(f);
  }
  /// Returns the places of the nodes between the ends of a curve, or of all nodes of a closed one.
  std::vector<Point> places_on_curve(const TetMesh& mesh, Index curve) const {
    std::vector<Point> places;
    for (const Index node : chains[curve].nodes)
      if (mesh.features[node].dimension == 1) places.push_back(mesh.points[node]);
    return places;
  }
  std::vector<Index> nodes_inside(const TetMesh& mesh, Index patch) const {
    std::vector<Index> inside;
    for (const Index face : faces[patch])
      for (const Index v : mesh.faces[face])
        if (mesh.features[v].dimension == 2) inside.push_back(v);
    sort_uniquely(inside);
    return inside;
  }
  std::vector<SpacedPlace> spaced_on_curve(const TetMesh& mesh, Index curve) const {
    const Chain& chain = chains[curve];
    std::vector<SpacedPlace> places;
    for (std::size_t i = 0; i < chain.nodes.size(); ++i) {
      const Index node = chain.nodes[i];
      if (mesh.features[node].dimension != 1) continue;
      const Index before = chain.nodes[(i + chain.nodes.size() - 1) % chain.nodes.size()];
      const auto to = [&](Index other) { return distance(mesh.points[node], mesh.points[other]); };
      places.push_back({mesh.points[node], std::min(to(before), to(chain.end(i)))});
    }
    return places;
  }
  /// Returns the places of the nodes inside a patch, each with the length of its shortest edge there. If
  /// there are target edge lengths (`targets`, by vertex), returns only nodes far enough from each other,
  /// with these lengths (see `sparse_nodes`).
  std::vector<SpacedPlace> spaced_inside(const TetMesh& mesh, Index patch,
                                         const std::vector<double>& targets) const {
    if (!targets.empty()) return sparse_nodes(mesh, faces[patch], targets);
    std::map<Index, double> spacing;
    for (const Index face : faces[patch])
      for (unsigned i = 0; i < 3; ++i) {
        const Index a = mesh.faces[face][i], b = mesh.faces[face][(i + 1) % 3];
        const double length = distance(mesh.points[a], mesh.points[b]);
        for (const Index v : {a, b})
          if (const auto [found, is_new] = spacing.try_emplace(v, length); !is_new)
            found->second = std::min(found->second, length);
      }
    std::vector<SpacedPlace> places;
    for (const auto& [v, length] : spacing)
      if (mesh.features[v].dimension == 2) places.push_back({mesh.points[v], length});
    return places;
  }
  std::vector<Point> places_on_border(const TetMesh& mesh, Index patch) const {
    std::vector<Point> places;
    for (const Index face : faces[patch])
      for (const Index v : mesh.faces[face])
        if (mesh.features[v].dimension < 2) places.push_back(mesh.points[v]);
    return places;
  }
  std::vector<Point> places_inside(const TetMesh& mesh, Index patch) const {
    std::vector<Point> places;
    for (const Index v : nodes_inside(mesh, patch)) places.push_back(mesh.points[v]);
    return places;
  }

  std::vector<Chain> chains;              // by curve
  std::vector<std::vector<Index>> faces;  // by patch
};

/// The procedure that makes the meshes of both groups of each pair correspond: curves, then patches.
class Maker {
 public:
  Maker(TetMesh& mesh, const Plc& plc, Periodicity periodicity)
      : mesh_(mesh), plc_(plc), periodicity_(std::move(periodicity)), editor_(mesh), surface_(mesh, plc) {}

  std::vector<Index> add_nodes(const TetMesh& source, const std::vector<double>& targets) {
    const Surface of_source(source, plc_);
    std::vector<Index> nodes;
    for (const CurveClass& of : classes()) {
      std::vector<Point> places;
      for (const auto& [curve, motion] : with_original(of))
        add_places(places, of_source.spaced_on_curve(source, curve), inverse(motion));
      for (const auto& [curve, motion] : with_original(of))
        periodicity::add_nodes(editor_, curve, surface_.chains[curve], moved(places, motion), nodes);
    }
    surface_.find_faces(mesh_);
    for (std::size_t k = 0; k < periodicity_.pairs.size(); ++k)
      for (const auto& [patch, image] : periodicity_.images[k].patches) {
        const Motion& to_image = periodicity_.pairs[k].motion;
        const std::vector<Point> border = surface_.places_on_border(mesh_, patch);
        std::vector<Point> places = border;
        add_places(places, of_source.spaced_inside(source, patch, targets), {});
        add_places(places, of_source.spaced_inside(source, image, targets), inverse(to_image));
        places.erase(places.begin(), places.begin() + static_cast<std::ptrdiff_t>(border.size()));
        for (const auto& [at, motion] : {std::pair{patch, Motion()}, std::pair{image, to_image}}) {
          PatchEditor editor(editor_, plc_, at, surface_.faces[at]);
          for (const Index v : editor.add_nodes(moved(places, motion)))
            if (v != none) nodes.push_back(v);
        }
      }
    editor_.store();
    return nodes;
  }

  PeriodicReport make_alike() {
    for (const CurveClass& of : classes()) make_curves_alike(of);
    surface_.find_faces(mesh_);
    for (std::size_t k = 0; k < periodicity_.pairs.size(); ++k) make_patches_alike(k);
    editor_.store();
    return std::move(report_);
  }

 private:
  std::vector<CurveClass> classes() const {
    return curve_classes(periodicity_.pairs, periodicity_.images, plc_.curves.size());
  }

  // Makes the curves of a class correspond. Nodes that one curve cannot lose are added to the other curves as
  // well.
  void make_curves_alike(const CurveClass& of) {
    std::vector<Point> places = surface_.places_on_curve(mesh_, of.original);
    for (unsigned round = 0; round < rounds; ++round) {
      const std::size_t before = places.size();
      for (const auto& [curve, motion] : with_original(of)) {
        const ChainChange change = put_nodes(editor_, curve, surface_.chains[curve], moved(places, motion));
        report_.inserted_nodes += change.inserted;
        report_.removed_nodes += change.removed;
        for (const Point& place : moved(change.stuck, inverse(motion))) places.push_back(place);
      }
      if (places.size() == before) return;
    }
  }

  void make_patches_alike(std::size_t k) {
    const PatchPair& pair = periodicity_.pairs[k];
    const FeatureImages& images = periodicity_.images[k];
    image_of_.clear();
    for (const auto& [curve, image] : images.curves) {
      const Chain &first = surface_.chains[curve], &second = surface_.chains[image];
      const std::vector<Index> nodes = corresponding(mesh_, first, second, pair.motion);
      for (std::size_t i = 0; i < nodes.size(); ++i) image_of_[first.nodes[i]] = nodes[i];
    }
    std::vector<Index> node_of(plc_.vertices.size(), none);
    for (Index v = 0; v < mesh_.features.size(); ++v)
      if (mesh_.features[v].dimension == 0) node_of[mesh_.features[v].feature] = v;
    for (const auto& [vertex, image] : images.vertices) image_of_[node_of[vertex]] = node_of[image];
    for (const auto& [patch, image] : images.patches) make_patch_alike(patch, image, pair.motion);
  }

  // Makes two patches correspond. If an edge exists on one side only, flips it on the side where that leaves
  // better tets.
  void make_patch_alike(Index patch, Index image, const Motion& motion) {
    PatchEditor first(editor_, plc_, patch, surface_.faces[patch]);
    PatchEditor second(editor_, plc_, image, surface_.faces[image]);
    std::vector<Index> inside = surface_.nodes_inside(mesh_, patch);
    std::vector<Index> nodes = second.put_nodes(moved(surface_.places_inside(mesh_, patch), motion));
    const std::vector<Point> others = second.places_of_others();
    const std::vector<Index> on_first = first.add_nodes(moved(others, inverse(motion))),
                             on_second = second.add_nodes(others);
    inside.insert(inside.end(), on_first.begin(), on_first.end());
    nodes.insert(nodes.end(), on_second.begin(), on_second.end());
    std::map<Index, Index> original_of;
    for (std::size_t i = 0; i < inside.size(); ++i) image_of_[inside[i]] = nodes[i];
    for (const auto& [node, of] : image_of_) original_of[of] = node;
    for (const double least : {good, fair, 0.0}) {
      second.make_edges(named(first.edges(), image_of_), least, false);
      if (least > 0) first.make_edges(named(second.edges(), original_of), least, false);
    }
    second.make_edges(named(first.edges(), image_of_), 0, true);
    for (const PatchEditor* each : {&first, &second}) {
      report_.inserted_nodes += each->change().inserted;
      report_.removed_nodes += each->change().removed;
      report_.turned_edges += each->change().turned;
    }
  }

  // Translates edges to corresponding nodes; leaves out an edge if one of its nodes has no counterpart.
  static std::vector<PatchEditor::Edge> named(const std::vector<PatchEditor::Edge>& edges,
                                              const std::map<Index, Index>& node_of) {
    std::vector<PatchEditor::Edge> named;
    for (const auto& [a, b] : edges) {
      const auto c = node_of.find(a), d = node_of.find(b);
      if (c != node_of.end() && d != node_of.end() && c->second != none && d->second != none)
        named.push_back({std::min(c->second, d->second), std::max(c->second, d->second)});
    }
    return named;
  }

  TetMesh& mesh_;
  const Plc& plc_;
  const Periodicity periodicity_;
  CavityEditor editor_;
  Surface surface_;
  std::map<Index, Index> image_of_;  // images of the nodes of the current pair's first group
  PeriodicReport report_;
};

std::vector<Tag> tags_of(const std::vector<Index>& patches, const Plc& plc) {
  std::vector<Tag> tags;
  tags.reserve(patches.size());
  for (const Index patch : patches) tags.push_back(plc.patches[patch].tag);
  sort_uniquely(tags);
  return tags;
}

}  // namespace
}  // namespace periodicity

void require_periodic_patches(const PeriodicOptions& options, const Plc& plc, double distance) {
  periodicity::find_periodicity(options, plc, distance);
}

PeriodicReport make_periodic(TetMesh& mesh, const Plc& plc, const PeriodicOptions& options, double distance) {
  using namespace periodicity;
  PeriodicReport report = Maker(mesh, plc, find_periodicity(options, plc, distance)).make_alike();
  mesh.periodic.clear();
  for (const PatchPair& pair : choose_pairs(options, plc)) {
    mesh.periodic.push_back({tags_of(pair.first, plc), tags_of(pair.second, plc), pair.motion, {}});
    report.pairs.push_back({.text = pair.text});
  }
  return report;
}

std::vector<Index> periodicity::add_periodic_nodes(TetMesh& mesh, const TetMesh& source, const Plc& plc,
                                                   const PeriodicOptions& options, double distance,
                                                   const std::vector<double>& targets) {
  return Maker(mesh, plc, find_periodicity(options, plc, distance)).add_nodes(source, targets);
}

}  // namespace collarmesh
