#include "periodic/recut.h"

#include <algorithm>
#include <cassert>
#include <functional>
#include <limits>
#include <queue>

#include "common/cell_shapes.h"
#include "common/edge_key.h"
#include "common/flat_table.h"
#include "common/sort_uniquely.h"
#include "common/sorted.h"
#include "common/tet_sides.h"
#include "periodic/pair_choice.h"

namespace collarmesh::periodicity {

namespace {

struct HashOfTriangle {
  std::size_t operator()(const std::array<Index, 3>& corners) const { return hash_of(corners); }
};
template <class Value>
using ByTriangle = std::unordered_map<std::array<Index, 3>, Value, HashOfTriangle>;

// Largest number of groups that are moved. So there are at most 2^6 copies of the complex. Groups of further
// pairs stay where they are.
constexpr std::size_t most_moved = 6;

std::vector<Index> keys_of(const std::unordered_map<Index, Index>& map) {
  std::vector<Index> keys;
  keys.reserve(map.size());
  for (const auto& [key, value] : map) keys.push_back(key);
  return keys;
}

}  // namespace

Recut::Recut(const TetMesh& mesh, const Plc& plc, const SurfaceTolerance& tolerance,
             const std::vector<PatchPair>& pairs, const std::vector<FeatureImages>& images, Moved moved)
    : mesh_(mesh), plc_(plc) {
  assert(mesh.order() == 1 && mesh.periodic.size() == pairs.size());
  find_seams(pairs, images, moved);
  find_shifts(moved);
  number_copies();
  complex_ = std::make_unique<const TiledComplex>(plc, tolerance, motions_);
  add_vertices();
  add_faces();
  add_edges();
  fix_cuts();
}

void Recut::find_seams(const std::vector<PatchPair>& pairs, const std::vector<FeatureImages>& images,
                       Moved moved) {
  const bool forth = moved != Moved::beside_second;
  seams_.resize(pairs.size());
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    Seam& seam = seams_[k];
    seam.motion = forth ? pairs[k].motion : inverse(pairs[k].motion);
    for (auto [v, image] : mesh_.periodic[k].nodes) {
      if (!forth) std::swap(v, image);
      seam.image_of.emplace(v, image);
      seam.on_other.emplace(image, v);
    }
    const std::array<const FeatureImages::Images*, 3> all{&images[k].vertices, &images[k].curves,
                                                          &images[k].patches};
    for (unsigned dimension = 0; dimension < 3; ++dimension)
      for (auto [f, image] : *all[dimension]) {
        if (!forth) std::swap(f, image);
        seam.image[dimension].emplace(f, image);
        seam.original[dimension].emplace(image, f);
      }
  }
}

// Chooses the tets to move, by distances along edges and across the other seams. So the new cuts lie halfway
// between the groups, or nearer to the group whose tets move (Moved). Moves nothing for a pair if a tet
// touches both of its groups.
void Recut::find_shifts(Moved moved) {
  shifts_.assign(mesh_.tets.size(), 0);
  const double much = moved == Moved::first_half ? 1 : 1.7;
  for (std::size_t k = 0; k < std::min(most_moved, seams_.size()); ++k) {
    const std::vector<Index> first = keys_of(seams_[k].image_of), second = keys_of(seams_[k].on_other);
    const std::vector<double> to_first = distances(k, first), to_second = distances(k, second);
    const auto is_on = [&](Index v, const auto& group) {
      const auto found = group.find(v);
      return found != group.end() && found->second != v;
    };
    std::vector<Shift> shifts = shifts_;
    bool reaches_both = false;
    for (std::size_t t = 0; t < mesh_.tets.size(); ++t) {
      const auto& corners = mesh_.tets[t];
      const bool on_first =
          std::ranges::any_of(corners, [&](Index v) { return is_on(v, seams_[k].image_of); });
      const bool on_second =
          std::ranges::any_of(corners, [&](Index v) { return is_on(v, seams_[k].on_other); });
      reaches_both = reaches_both || (on_first && on_second);
      double nearer = 0;
      for (const Index v : corners) nearer += to_second[v] - much * to_first[v];
      if (on_first || (!on_second && nearer > 0)) shifts[t] |= Shift{1} << k;
    }
    if (!reaches_both) shifts_ = std::move(shifts);
  }
}

// Returns the distance of every vertex from the nearest of some vertices.
std::vector<double> Recut::distances(std::size_t k, const std::vector<Index>& from) const {
  if (neighbours_.empty()) find_neighbours();
  std::vector<double> distances(mesh_.points.size(), std::numeric_limits<double>::infinity());
  using Next = std::pair<double, Index>;
  std::priority_queue<Next, std::vector<Next>, std::greater<>> queue;
  const auto reach = [&](Index v, double d) {
    if (d >= distances[v]) return;
    distances[v] = d;
    queue.emplace(d, v);
  };
  for (const Index v : from) reach(v, 0);
  while (!queue.empty()) {
    const auto [d, v] = queue.top();
    queue.pop();
    if (d > distances[v]) continue;
    for (const Index w : neighbours_[v]) reach(w, d + distance(mesh_.points[v], mesh_.points[w]));
    for (std::size_t j = 0; j < seams_.size(); ++j)
      if (j != k)
        for (const auto* other : {&seams_[j].image_of, &seams_[j].on_other})
          if (const auto found = other->find(v); found != other->end()) reach(found->second, d);
  }
  return distances;
}

void Recut::find_neighbours() const {
  std::vector<std::uint64_t> edges;
  edges.reserve(cell_shapes::corner_pairs.size() * mesh_.tets.size());
  for (const auto& tet : mesh_.tets)
    for (const auto& [i, j] : cell_shapes::corner_pairs) edges.push_back(edge_key(tet[i], tet[j]));
  sort_uniquely(edges);
  neighbours_.resize(mesh_.points.size());
  for (const std::uint64_t edge : edges) {
    const auto a = static_cast<Index>(edge >> 32U), b = static_cast<Index>(edge);
    neighbours_[a].push_back(b);
    neighbours_[b].push_back(a);
  }
}

void Recut::number_copies() {
  copies_ = shifts_;
  copies_.push_back(0);
  sort_uniquely(copies_);
  for (const Shift shift : std::vector<Shift>(copies_))  // a vertex of a feature on several seams belongs to
                                                         // a copy that is moved by fewer pairs
    for (Shift part = shift; part > 0; part = (part - 1) & shift) copies_.push_back(part);
  sort_uniquely(copies_);
  for (const Shift shift : copies_) {
    copy_of_.emplace(shift, static_cast<Index>(motions_.size()));
    motions_.push_back(motion_of(shift));
  }
}

Motion Recut::motion_of(Shift shift) const {
  Motion motion;
  for (std::size_t k = 0; k < seams_.size(); ++k)
    if ((shift >> k & 1U) != 0) motion = composed(motion, seams_[k].motion);
  return motion;
}

// Returns the same place without motions that take its vertex onto its image on a seam: the image's place.
Recut::Place Recut::on_seam(Place place) const {
  for (std::size_t k = 0; k < seams_.size(); ++k) {
    if ((place.shift >> k & 1U) == 0) continue;
    const auto image = seams_[k].image_of.find(place.vertex);
    if (image == seams_[k].image_of.end()) continue;
    place = {image->second, place.shift & ~(Shift{1} << k)};
  }
  return place;
}

Index Recut::vertex_at(Place place) {
  const Place at = on_seam(place);
  const auto [found, is_new] =
      vertex_at_.try_emplace(pair_key(at.vertex, at.shift), static_cast<Index>(places_.size()));
  if (is_new) {
    places_.push_back(at);
    const Index copy = copy_of_.at(at.shift);
    made_.points.push_back(at.shift == 0 ? mesh_.points[at.vertex] : motions_[copy](mesh_.points[at.vertex]));
    TetMesh::VertexFeature feature = mesh_.features[at.vertex];
    if (feature.dimension < 3 && feature.feature != none)
      feature.feature += static_cast<Index>(copy * count(feature.dimension));
    made_.features.push_back(feature);
  }
  return found->second;
}

// Adds vertices and tets. A tet's region tells which copy it belongs to.
void Recut::add_vertices() {
  const std::size_t regions = plc_.regions.size();
  for (std::size_t t = 0; t < mesh_.tets.size(); ++t) {
    std::array<Index, 4> corners;
    for (unsigned i = 0; i < 4; ++i) corners[i] = vertex_at({mesh_.tets[t][i], shifts_[t]});
    made_.tets.push_back(corners);
    made_.tet_region.push_back(static_cast<Index>(copy_of_.at(shifts_[t]) * regions) + mesh_.tet_region[t]);
  }
  made_.tet_tag = mesh_.tet_tag;
  made_.tet_collar.assign(mesh_.tets.size(), 0);
  made_.tet_crease.assign(mesh_.tets.size(), 0);
  points_ = made_.points;
}

// Adds the faces, moved with their tets. On a seam, the faces of both groups become one, on the patch of the
// group that stays.
void Recut::add_faces() {
  ByTriangle<Index> face_at;
  for (Index f = 0; f < mesh_.faces.size(); ++f) face_at.emplace(sorted(mesh_.faces[f]), f);
  ByTriangle<Index> made_at;
  for (Index t = 0; t < mesh_.tets.size(); ++t)
    for (unsigned i = 0; i < 4; ++i) {
      const auto found = face_at.find(sorted(side_corners(mesh_.tets[t], i)));
      if (found == face_at.end()) continue;
      std::array<Index, 3> corners = mesh_.faces[found->second];
      Index patch = mesh_.face_patch[found->second];
      Shift shift = shifts_[t];
      bool behind = six_volume(mesh_.points[corners[0]], mesh_.points[corners[1]], mesh_.points[corners[2]],
                               mesh_.points[mesh_.tets[t][i]]) < 0;
      for (Index& v : corners) v = vertex_at({v, shift});
      for (std::size_t k = 0; k < seams_.size(); ++k) {
        const auto image = seams_[k].image[2].find(patch);
        if ((shift >> k & 1U) == 0 || image == seams_[k].image[2].end()) continue;
        patch = image->second;
        shift &= ~(Shift{1} << k);
        std::swap(corners[1], corners[2]);
        behind = !behind;
        break;
      }
      const auto [at, is_new] = made_at.try_emplace(sorted(corners), static_cast<Index>(made_.faces.size()));
      if (is_new) {
        made_.faces.push_back(corners);
        made_.face_patch.push_back(
            patch == none ? none : static_cast<Index>(copy_of_.at(shift) * plc_.patches.size()) + patch);
        made_.face_tag.push_back(static_cast<Tag>(made_.face_patch.back()));  // for restoring the mesh later
        made_.face_regions.push_back({0, 0});
      }
      made_.face_regions[at->second][behind ? 0 : 1] = made_.tet_region[t];
    }
}

// Adds the edges, moved with their tets.
void Recut::add_edges() {
  std::unordered_map<std::uint64_t, Index> edge_at, made_at;
  for (Index e = 0; e < mesh_.edges.size(); ++e)
    edge_at.emplace(edge_key(mesh_.edges[e][0], mesh_.edges[e][1]), e);
  for (Index t = 0; t < mesh_.tets.size(); ++t)
    for (const auto& [i, j] : cell_shapes::corner_pairs) {
      const auto found = edge_at.find(edge_key(mesh_.tets[t][i], mesh_.tets[t][j]));
      if (found == edge_at.end()) continue;
      const Index a = made_.tets[t][i], b = made_.tets[t][j];
      if (!made_at.try_emplace(edge_key(a, b), 0).second) continue;
      Shift shift = shifts_[t];
      Index curve = mesh_.edge_curve[found->second];
      for (std::size_t k = 0; k < seams_.size(); ++k) {
        const auto image = seams_[k].image[1].find(curve);
        if ((shift >> k & 1U) == 0 || image == seams_[k].image[1].end()) continue;
        curve = image->second;
        shift &= ~(Shift{1} << k);
      }
      made_.edges.push_back({a, b});
      made_.edge_curve.push_back(
          curve == none ? none : static_cast<Index>(copy_of_.at(shift) * plc_.curves.size()) + curve);
      made_.edge_tag.push_back(mesh_.edge_tag[found->second]);
    }
}

// Fixes the vertices at the new cuts, where sides of tets have no neighbour. Faces there belong to no patch,
// so they stay.
void Recut::fix_cuts() {
  ByTriangle<unsigned> uses, uses_before;
  for (std::size_t t = 0; t < made_.tets.size(); ++t)
    for (unsigned i = 0; i < 4; ++i) {
      ++uses[sorted(side_corners(made_.tets[t], i))];
      ++uses_before[sorted(side_corners(mesh_.tets[t], i))];
    }
  for (Index f = 0; f < mesh_.faces.size(); ++f)
    for (const Seam& seam : seams_)
      if (seam.image[2].contains(mesh_.face_patch[f]) || seam.original[2].contains(mesh_.face_patch[f]))
        uses_before[sorted(mesh_.faces[f])] = 2;  // used twice, because the seam closes the mesh to a torus
  std::vector<bool> is_fixed(made_.points.size(), false);
  ByTriangle<bool> cut;
  for (std::size_t t = 0; t < made_.tets.size(); ++t)
    for (unsigned i = 0; i < 4; ++i) {
      const auto side = side_corners(made_.tets[t], i);
      if (uses.at(sorted(side)) > 1 || uses_before.at(sorted(side_corners(mesh_.tets[t], i))) < 2) continue;
      for (const Index v : side) is_fixed[v] = true;
      cut.emplace(sorted(side), true);
    }
  for (Index f = 0; f < made_.faces.size(); ++f)
    if (cut.contains(sorted(made_.faces[f]))) made_.face_patch[f] = none;
  for (Index v = 0; v < is_fixed.size(); ++v)
    if (is_fixed[v]) fixed_.push_back(v);
}

std::vector<bool> Recut::farther_than(unsigned edges) const {
  std::vector<bool> far(made_.points.size());
  for (Index v = 0; v < far.size(); ++v)
    far[v] = std::ranges::none_of(seams_, [&](const Seam& seam) {
      return seam.image_of.contains(places_[v].vertex) || seam.on_other.contains(places_[v].vertex);
    });
  for (unsigned edge = 0; edge < edges; ++edge) {
    const std::vector<bool> before = far;
    for (const auto& tet : made_.tets)
      if (!std::ranges::all_of(tet, [&](Index v) { return before[v]; }))
        for (const Index v : tet) far[v] = false;
  }
  return far;
}

std::size_t Recut::count(unsigned dimension) const {
  return dimension == 0 ? plc_.vertices.size() : dimension == 1 ? plc_.curves.size() : plc_.patches.size();
}

SizeField Recut::sizes(const SizeField& of_mesh) const {
  if (!of_mesh) return of_mesh;
  std::vector<Motion> back;
  for (const Motion& motion : motions_) back.push_back(inverse(motion));
  return [of_mesh, back, box = plc_.bounds](const Point& p) {
    const auto inside = [&](const Point& q) {
      for (std::size_t axis = 0; axis < 3; ++axis)
        if (q[axis] < box.min[axis] || q[axis] > box.max[axis]) return false;
      return true;
    };
    if (inside(p)) return of_mesh(p);
    for (const Motion& motion : back)
      if (const Point q = motion(p); inside(q)) return of_mesh(q);
    return of_mesh(p);
  };
}

void Recut::note_vertices(const remeshing::TetComplex& complex) {
  std::size_t kept = 0;
  for (Index v = 0; v < places_.size(); ++v) {
    if (!complex.in_use(v)) continue;
    places_[kept] = places_[v];
    points_[kept++] = points_[v];
  }
  places_.resize(kept);
  points_.resize(kept);
}

// Returns the original of a feature of the tiled complex, for the tets of the copy with this shift. A feature
// on a seam has two originals, one in each group of the pair; the shift determines which one.
Index Recut::feature_back(unsigned dimension, Index feature, Shift shift) const {
  if (feature == none) return none;
  const Shift own = copies_[feature / count(dimension)];
  feature %= static_cast<Index>(count(dimension));
  for (std::size_t k = 0; k < seams_.size(); ++k)
    if (((shift & ~own) >> k & 1U) != 0) feature = seams_[k].original[dimension].at(feature);
  return feature;
}

Index Recut::vertex_back(Place place, Shift shift) const {
  for (std::size_t k = 0; k < seams_.size(); ++k)
    if (((shift & ~place.shift) >> k & 1U) != 0) place.vertex = seams_[k].on_other.at(place.vertex);
  return place.vertex;
}

namespace {

/// A builder of a mesh. It creates a vertex when the vertex's key is first used.
class Restored {
 public:
  explicit Restored(const TetMesh& like) {
    made_.group_names = like.group_names;
    made_.names = like.names;
    made_.periodic = like.periodic;
    for (TetMesh::PeriodicFaces& faces : made_.periodic) faces.nodes.clear();
  }

  TetMesh& mesh() { return made_; }
  template <class Make>
  Index vertex(std::uint64_t key, const Make& make) {
    const auto [found, is_new] = numbers_.try_emplace(key, static_cast<Index>(made_.points.size()));
    if (is_new) {
      const auto [point, feature] = make();
      made_.points.push_back(point);
      made_.features.push_back(feature);
    }
    return found->second;
  }

  void add_side(std::array<Index, 3> corners, bool behind, Index patch, const Plc& plc, Index region) {
    const auto [at, is_new] = face_at_.try_emplace(sorted(corners), static_cast<Index>(made_.faces.size()));
    if (is_new) {
      made_.faces.push_back(corners);
      made_.face_patch.push_back(patch);
      made_.face_tag.push_back(plc.patches[patch].tag);
      made_.face_regions.push_back({0, 0});
    }
    made_.face_regions[at->second][behind ? 0 : 1] = region;
  }

  void add_edge(Index a, Index b, Index curve, const Plc& plc) {
    if (!edges_.try_emplace(edge_key(a, b), 0).second) return;
    made_.edges.push_back({a, b});
    made_.edge_curve.push_back(curve);
    made_.edge_tag.push_back(plc.curves[curve].tag);
  }

 private:
  TetMesh made_;
  std::unordered_map<std::uint64_t, Index> numbers_, edges_;
  ByTriangle<Index> face_at_;
};

}  // namespace

TetMesh Recut::back() const {
  Restored restored(mesh_);
  const auto regions = static_cast<Index>(plc_.regions.size());
  std::vector<Motion> motions_back;
  for (const Motion& motion : motions_) motions_back.push_back(inverse(motion));
  ByTriangle<Index> face_at;
  for (Index f = 0; f < made_.faces.size(); ++f) face_at.emplace(sorted(made_.faces[f]), f);
  std::unordered_map<std::uint64_t, Index> edge_at;
  for (Index e = 0; e < made_.edges.size(); ++e)
    edge_at.emplace(edge_key(made_.edges[e][0], made_.edges[e][1]), e);

  const auto vertex_of = [&](Index v, Index copy) {
    const bool was_there = v < places_.size();
    const Index before = was_there ? vertex_back(places_[v], copies_[copy]) : none;
    const std::uint64_t key = was_there ? pair_key(none, before) : pair_key(v, copy);
    return restored.vertex(key, [&] {
      const bool stays = was_there && made_.points[v] == points_[v];
      TetMesh::VertexFeature feature = made_.features[v];
      if (feature.dimension < 3)
        feature.feature = feature_back(feature.dimension, feature.feature, copies_[copy]);
      return std::pair(stays ? mesh_.points[before] : motions_back[copy](made_.points[v]), feature);
    });
  };
  TetMesh& mesh = restored.mesh();
  for (std::size_t t = 0; t < made_.tets.size(); ++t) {
    const auto& tet = made_.tets[t];
    const Index copy = made_.tet_region[t] / regions, region = made_.tet_region[t] % regions;
    std::array<Index, 4> corners;
    for (unsigned i = 0; i < 4; ++i) corners[i] = vertex_of(tet[i], copy);
    mesh.tets.push_back(corners);
    mesh.tet_region.push_back(region);
    mesh.tet_tag.push_back(plc_.regions[region].tag);
    for (unsigned i = 0; i < 4; ++i) {
      const auto found = face_at.find(sorted(side_corners(tet, i)));
      if (found == face_at.end()) continue;
      std::array<Index, 3> face = made_.faces[found->second];
      bool behind = six_volume(made_.points[face[0]], made_.points[face[1]], made_.points[face[2]],
                               made_.points[tet[i]]) < 0;
      for (Index& v : face) v = vertex_of(v, copy);
      const auto patch = static_cast<Index>(made_.face_tag[found->second]);
      if (copies_[patch / count(2)] != copies_[copy]) {
        std::swap(face[1], face[2]);
        behind = !behind;
      }
      restored.add_side(face, behind, feature_back(2, patch, copies_[copy]), plc_, region);
    }
    for (const auto& [i, j] : cell_shapes::corner_pairs)
      if (const auto found = edge_at.find(edge_key(tet[i], tet[j])); found != edge_at.end())
        restored.add_edge(corners[i], corners[j],
                          feature_back(1, made_.edge_curve[found->second], copies_[copy]), plc_);
  }
  mesh.tet_collar.assign(mesh.tets.size(), 0);
  mesh.tet_crease.assign(mesh.tets.size(), 0);
  return std::move(mesh);
}

}  // namespace collarmesh::periodicity
