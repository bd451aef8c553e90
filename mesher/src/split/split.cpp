#include "collarmesh/split.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>

#include "collarmesh/error.h"
#include "common/cell_shapes.h"
#include "common/face_finder.h"
#include "common/group_names.h"
#include "common/layer_tets.h"
#include "common/named_tags.h"
#include "common/tet_sides.h"
#include "split/sectors.h"

namespace collarmesh {

namespace {

/// A patch or triangle that may be split: its tag and the regions on its sides.
struct Candidate {
  Tag tag = 0;
  std::array<Index, 2> regions{0, 0};

  bool is_internal() const { return regions[0] != 0 && regions[1] != 0; }
  bool is_interface() const { return is_internal() && regions[0] != regions[1]; }
};

std::string internal_patches(const TagNames& names, const std::vector<Candidate>& all) {
  std::set<Tag> tags;
  for (const Candidate& candidate : all)
    if (candidate.is_internal()) tags.insert(candidate.tag);
  return tags.empty() ? "there are none" : list_of_patches(tags, names);
}

/// The internal patches that the options name.
class PatchChoice {
 public:
  /// Finds the patches. Throws OptionError for a name that no internal patch has, and if regions are to be
  /// kept apart but none touch.
  PatchChoice(const SplitOptions& options, const TagNames& names, const std::vector<Candidate>& all)
      : keep_apart_(options.keep_apart) {
    for (const std::string& text : options.patches) {
      const std::set<Tag> tags = tags_named(text, 2, names);
      const auto named = [&](const Candidate& candidate) { return tags.contains(candidate.tag); };
      if (std::ranges::none_of(all, named))
        throw OptionError(
            fmt::format("split: no patch is called '{}'; only internal patches can be split: {}", text,
                        internal_patches(names, all)));
      if (std::ranges::none_of(all, [&](const Candidate& each) { return named(each) && each.is_internal(); }))
        throw OptionError(
            fmt::format("split: patch '{}' lies on the boundary; only internal patches can be split: {}",
                        text, internal_patches(names, all)));
      tags_.insert(tags.begin(), tags.end());
    }
    if (keep_apart_ && std::ranges::none_of(all, [](const Candidate& each) { return each.is_interface(); }))
      throw OptionError("keep-apart: no two regions touch, so there is nothing to keep apart");
  }

  bool contains(const Candidate& candidate) const {
    return (keep_apart_ && candidate.is_interface()) ||
           (candidate.is_internal() && tags_.contains(candidate.tag));
  }

 private:
  bool keep_apart_;
  std::set<Tag> tags_;
};

/// A triangle of the minus side and the coincident one of the plus side, as faces of the mesh.
struct SidePair {
  Index minus, plus;
};

/// Adds a prism of zero thickness between the two triangles of each pair.
void add_prisms(const TetMesh& mesh, const std::vector<SidePair>& pairs, Interfaces& interfaces) {
  for (const SidePair& pair : pairs) {
    const auto [a, b, c] = mesh.faces[pair.minus];
    const auto [p, r, q] = mesh.faces[pair.plus];  // in the opposite orientation
    interfaces.prisms.push_back({a, b, c, p, q, r});
    interfaces.prism_tag.push_back(mesh.face_tag[pair.minus]);
    if (mesh.order() == 1) continue;
    const auto [ab, bc, ca] = mesh.face_mid_nodes[pair.minus];
    const auto [rp, qr, pq] = mesh.face_mid_nodes[pair.plus];
    interfaces.prism_mid_nodes.push_back({ab, bc, ca, pq, qr, rp});
  }
}

using namespace splitting;

/// The tets on both sides of a triangle of the mesh.
struct Beside {
  Index behind = none, front = none;
  Index any() const { return behind == none ? front : behind; }
};

class Splitter {
 public:
  Splitter(TetMesh& mesh, const SplitOptions& options)
      : mesh_(mesh), options_(options), finder_(mesh.faces), tets_(mesh.tets), mids_(mesh.tet_mid_nodes) {}

  SplitReport run() {
    choose();
    find_tets_beside();
    copies_.assign(mesh_.points.size(), 0);
    split_corners();
    leave_closed_triangles();
    split_mid_nodes();
    count_nodes();
    number_sides();
    replace_faces();
    replace_edges();
    mesh_.tets = std::move(tets_);
    mesh_.tet_mid_nodes = std::move(mids_);
    if (options_.cohesive) add_prisms(mesh_, pairs_, report_.interfaces);
    report_.interfaces.interaction = options_.interaction;
    return std::move(report_);
  }

 private:
  Candidate candidate(Index face) const { return {mesh_.face_tag[face], mesh_.face_regions[face]}; }
  bool is_marked(const auto& corners) const {
    return std::ranges::any_of(corners, [&](Index v) { return marked_[v]; });
  }

  void choose() {
    std::vector<Candidate> all;
    for (Index f = 0; f < mesh_.faces.size(); ++f) all.push_back(candidate(f));
    const PatchChoice choice(options_, mesh_.names, all);
    marked_.assign(mesh_.points.size(), false);
    for (Index f = 0; f < mesh_.faces.size(); ++f) {
      chosen_.push_back(choice.contains(all[f]));
      if (!chosen_[f]) continue;
      for (const Index v : mesh_.faces[f]) marked_[v] = true;
      if (mesh_.order() == 2)
        for (const Index v : mesh_.face_mid_nodes[f]) marked_[v] = true;
    }
  }

  void find_tets_beside() {
    beside_.resize(mesh_.faces.size());
    for (Index t = 0; t < mesh_.tets.size(); ++t) {
      if (!is_marked(mesh_.tets[t])) continue;
      for (unsigned corner = 0; corner < 4; ++corner) {
        const auto outward = side_corners(mesh_.tets[t], corner);
        const Index face = finder_.find(outward);
        if (face == none) continue;
        const bool is_behind = FaceFinder::alike(mesh_.faces[face], outward);
        (is_behind ? beside_[face].behind : beside_[face].front) = t;
      }
    }
    for (Index f = 0; f < chosen_.size(); ++f)
      chosen_[f] = chosen_[f] && beside_[f].behind != none && beside_[f].front != none;
  }

  bool is_split(const Key& key) {
    const Index face = finder_.find(key);
    return face != none && chosen_[face];
  }

  Index copy_of(Index node) {
    ++copies_[node];
    mesh_.points.push_back(Point(mesh_.points[node]));
    if (!mesh_.features.empty()) mesh_.features.push_back(TetMesh::VertexFeature(mesh_.features[node]));
    return static_cast<Index>(mesh_.points.size() - 1);
  }

  void split_corners() {
    std::vector<NodeOfTet> nodes;
    for (Index t = 0; t < mesh_.tets.size(); ++t)
      for (std::uint8_t k = 0; k < 4; ++k)
        if (const Index v = mesh_.tets[t][k]; marked_[v]) nodes.push_back({v, t, k});
    for_each_further_sector(
        mesh_, std::move(nodes), [&](const Key& key) { return is_split(key); },
        [&](Index node, const std::vector<NodeOfTet>& sector) {
          const Index copy = copy_of(node);
          for (const NodeOfTet& member : sector) tets_[member.tet][member.place] = copy;
        });
  }

  void split_mid_nodes() {
    std::vector<NodeOfTet> nodes;
    for (Index t = 0; t < mids_.size(); ++t)
      for (std::uint8_t k = 0; k < 6; ++k)
        if (const Index v = mesh_.tet_mid_nodes[t][k]; marked_[v])
          nodes.push_back({v, t, static_cast<std::uint8_t>(4 + k)});
    for_each_further_sector(
        mesh_, std::move(nodes), [&](const Key& key) { return is_split(key); },
        [&](Index node, const std::vector<NodeOfTet>& sector) {
          const Index copy = copy_of(node);
          for (const NodeOfTet& member : sector) mids_[member.tet][member.place - 4U] = copy;
        });
  }

  Index corner_in(Index tet, Index corner) const { return tets_[tet][place_of(corner, mesh_.tets[tet])]; }
  std::array<Index, 3> face_in(Index tet, const std::array<Index, 3>& face) const {
    return {corner_in(tet, face[0]), corner_in(tet, face[1]), corner_in(tet, face[2])};
  }
  Index mid_node_in(Index tet, Index a, Index b) const {
    const auto i = place_of(a, mesh_.tets[tet]), j = place_of(b, mesh_.tets[tet]);
    for (std::size_t k = 0; k < cell_shapes::tet_edges.size(); ++k)
      if (const auto& [p, q] = cell_shapes::tet_edges[k]; (p == i && q == j) || (p == j && q == i))
        return mids_[tet][k];
    return none;
  }
  std::array<Index, 3> mid_nodes_in(Index tet, const std::array<Index, 3>& face) const {
    const auto& [a, b, c] = face;
    return {mid_node_in(tet, a, b), mid_node_in(tet, b, c), mid_node_in(tet, c, a)};
  }

  void leave_closed_triangles() {
    for (Index f = 0; f < chosen_.size(); ++f) {
      if (!chosen_[f]) continue;
      const auto& face = mesh_.faces[f];
      if (face_in(beside_[f].behind, face) != face_in(beside_[f].front, face)) continue;
      chosen_[f] = false;
      SplitReport::Patch& patch = patch_of(f);
      ++patch.closed;
      patch.closed_at = centre(face);
    }
  }

  Point centre(const std::array<Index, 3>& face) const {
    return (mesh_.points[face[0]] + mesh_.points[face[1]] + mesh_.points[face[2]]) / 3;
  }

  SplitReport::Patch& patch_of(Index face) { return patches_[mesh_.face_tag[face]]; }

  void count_nodes() {
    for (Index v = 0; v < copies_.size(); ++v) {
      if (!marked_[v]) continue;
      report_.split_nodes += copies_[v] > 0 ? 1 : 0;
      report_.junction_nodes += copies_[v] > 1 ? 1 : 0;
      report_.front_nodes += copies_[v] == 0 ? 1 : 0;
      report_.new_nodes += copies_[v];
    }
  }

  /// Gives both sides of each split patch a tag and a name.
  void number_sides() {
    std::set<Tag> taken, kept;
    for (Index f = 0; f < mesh_.faces.size(); ++f) {
      taken.insert(mesh_.face_tag[f]);
      if (!chosen_[f]) kept.insert(mesh_.face_tag[f]);
      if (chosen_[f]) add_triangle(patch_of(f), mesh_.faces[f]);
    }
    for (const auto& named : mesh_.names.of(2)) taken.insert(named.first);
    Tag next = taken.empty() ? 1 : std::max<Tag>(*taken.rbegin() + 1, 1);
    for (auto& [tag, patch] : patches_) {
      patch.tag = tag;
      patch.name = group_name(mesh_, 2, tag);
      if (patch.faces > 0) {
        patch.sides = {kept.contains(tag) ? next++ : tag, 0};
        patch.sides.plus = next++;
        mesh_.names.set(2, patch.sides.minus, patch.name + "_minus");
        mesh_.names.set(2, patch.sides.plus, patch.name + "_plus");
        report_.interfaces.sides.push_back(patch.sides);
      }
      report_.patches.push_back(patch);
    }
  }

  void add_triangle(SplitReport::Patch& patch, const std::array<Index, 3>& face) {
    const auto& [a, b, c] = face;
    const double area =
        0.5 * norm(cross(mesh_.points[b] - mesh_.points[a], mesh_.points[c] - mesh_.points[a]));
    if (area > patch.largest) {
      patch.largest = area;
      patch.where = centre(face);
    }
    ++patch.faces;
    patch.area += area;
  }

  void replace_faces() {
    const auto count = static_cast<Index>(mesh_.faces.size());
    for (Index f = 0; f < count; ++f) {
      if (!is_marked(mesh_.faces[f])) continue;
      const std::array<Index, 3> face = mesh_.faces[f];
      const Beside beside = beside_[f];
      if (chosen_[f]) add_front_side(f, beside.front);
      mesh_.faces[f] = face_in(beside.any(), face);
      if (mesh_.order() == 2) mesh_.face_mid_nodes[f] = mid_nodes_in(beside.any(), face);
      if (chosen_[f]) make_back_side(f);
    }
  }

  static bool is_minus_behind(const std::array<Index, 2>& regions) { return regions[0] <= regions[1]; }

  void add_front_side(Index f, Index tet) {
    const auto [a, b, c] = mesh_.faces[f];
    const std::array<Index, 3> turned{a, c, b};
    const Sides sides = patch_of(f).sides;
    const std::array<Index, 2> regions = mesh_.face_regions[f];
    const bool minus = !is_minus_behind(regions);
    const auto copy = static_cast<Index>(mesh_.faces.size());
    pairs_.push_back(minus ? SidePair{copy, f} : SidePair{f, copy});
    mesh_.faces.push_back(face_in(tet, turned));
    if (mesh_.order() == 2) mesh_.face_mid_nodes.push_back(mid_nodes_in(tet, turned));
    mesh_.face_regions.push_back({regions[1], 0});
    mesh_.face_patch.push_back(Index(mesh_.face_patch[f]));
    mesh_.face_tag.push_back(minus ? sides.minus : sides.plus);
  }

  void make_back_side(Index f) {
    const Sides sides = patch_of(f).sides;
    std::array<Index, 2>& regions = mesh_.face_regions[f];
    mesh_.face_tag[f] = is_minus_behind(regions) ? sides.minus : sides.plus;
    regions[1] = 0;
  }

  /// An edge with its mid-edge node, if there is one.
  using EdgeNodes = std::array<Index, 3>;

  /// Lists an edge once for each sector around it.
  void replace_edges() {
    std::map<std::array<Index, 2>, Index> listed;
    for (Index e = 0; e < mesh_.edges.size(); ++e) {
      const auto [a, b] = mesh_.edges[e];
      if (is_marked(mesh_.edges[e])) listed[{std::min(a, b), std::max(a, b)}] = e;
    }
    std::map<Index, std::vector<EdgeNodes>> found;
    for (Index t = 0; t < mesh_.tets.size() && !listed.empty(); ++t) {
      if (!is_marked(mesh_.tets[t])) continue;
      for (const auto& [i, j] : cell_shapes::tet_edges) {
        const Index a = mesh_.tets[t][i], b = mesh_.tets[t][j];
        const auto edge = listed.find({std::min(a, b), std::max(a, b)});
        if (edge == listed.end()) continue;
        const auto [from, to] = mesh_.edges[edge->second];
        const EdgeNodes nodes{corner_in(t, from), corner_in(t, to),
                              mesh_.order() == 2 ? mid_node_in(t, from, to) : none};
        std::vector<EdgeNodes>& all = found[edge->second];
        if (std::ranges::find(all, nodes) == all.end()) all.push_back(nodes);
      }
    }
    for (auto& [edge, all] : found) store(edge, all);
  }

  void store(Index edge, std::vector<EdgeNodes>& all) {
    std::ranges::sort(all);
    for (std::size_t k = 0; k < all.size(); ++k) {
      const auto& [a, b, middle] = all[k];
      if (k == 0) {
        mesh_.edges[edge] = {a, b};
        if (mesh_.order() == 2) mesh_.edge_mid_nodes[edge] = middle;
        continue;
      }
      mesh_.edges.push_back({a, b});
      if (mesh_.order() == 2) mesh_.edge_mid_nodes.push_back(middle);
      mesh_.edge_curve.push_back(Index(mesh_.edge_curve[edge]));
      mesh_.edge_tag.push_back(Tag(mesh_.edge_tag[edge]));
    }
  }

  TetMesh& mesh_;
  const SplitOptions& options_;
  FaceFinder finder_;                          // faces before the split, by their corners
  std::vector<std::array<Index, 4>> tets_;     // after the split
  std::vector<std::array<Index, 6>> mids_;     // after the split
  std::vector<bool> chosen_;                   // by face before the split: whether it is split
  std::vector<bool> marked_;                   // by node: whether it is a node of a chosen face
  std::vector<Beside> beside_;                 // by face with a marked corner: the tets beside it
  std::vector<Index> copies_;                  // by node: the number of its copies
  std::map<Tag, SplitReport::Patch> patches_;  // by tag before the split
  std::vector<SidePair> pairs_;
  SplitReport report_;
};

}  // namespace

void require_known_patches(const SplitOptions& options, const Plc& plc) {
  std::vector<Candidate> all;
  for (const Plc::Patch& patch : plc.patches) all.push_back({patch.tag, patch.regions});
  PatchChoice(options, plc.names, all);
}

SplitReport split(TetMesh& mesh, const SplitOptions& options) {
  require_tets_alone(mesh, "split");
  return Splitter(mesh, options).run();
}

}  // namespace collarmesh
