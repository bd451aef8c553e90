#include "repair/small_features.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>

#include "common/distances.h"
#include "repair/snap_cuts.h"
#include "repair/snap_points.h"
#include "repair/snap_state.h"

namespace collarmesh::repairing {

using namespace facets;

namespace {

constexpr double sharp_tip = 0.01;  // radians; sharper tips are blunted
constexpr std::size_t most_feature_rounds = 200;

std::array<double, 3> key_of(const Point& p) { return {p.x, p.y, p.z}; }

Corners sorted(Corners corners) {
  std::sort(corners.begin(), corners.end());
  return corners;
}
Corners as_corners(const Edge& edge) { return {edge[0], edge[1], none}; }

double length_of(const Plc& plc, const Plc::Curve& curve) {
  double length = 0;
  for (std::size_t i = 0; i + 1 < curve.points.size() + (curve.closed ? 1 : 0); ++i)
    length += distance(plc.points[curve.points[i]], plc.points[curve.points[(i + 1) % curve.points.size()]]);
  return length;
}

/// The sides of a triangle and its height above the longest one.
struct Needle {
  unsigned longest = 0, shortest = 0;
  double least = 0, most = 0;  // lengths of the shortest and the longest side
  double height = 0;
};

Needle needle_of(const ComplexDraft& draft, const Corners& c) {
  Needle needle;
  std::array<double, 3> lengths{};
  for (unsigned i = 0; i < 3; ++i) lengths[i] = distance(draft.points[c[i]], draft.points[c[(i + 1) % 3]]);
  const auto [least, most] = std::minmax_element(lengths.begin(), lengths.end());
  needle.shortest = static_cast<unsigned>(least - lengths.begin());
  needle.longest = static_cast<unsigned>(most - lengths.begin());
  needle.least = *least;
  needle.most = *most;
  needle.height = *most > 0 ? 2 * area_of(draft, c) / *most : 0;
  return needle;
}

/// The patches and curves of a complex that are small and may be collapsed.
class SmallOnes {
 public:
  SmallOnes(const Plc& plc, const ComplexDraft& draft, double size, const RepairOptions& options)
      : plc_(plc),
        size_(size),
        patches_(plc.patches.size()),
        curves_(plc.curves.size()),
        kept_(patches_.size(), false) {
    for (Index p = 0; p < patches_.size(); ++p)
      if (const double width = width_of(plc.patches[p]); width < size) patches_[p] = width;
    for (Index c = 0; c < curves_.size(); ++c)
      if (const double length = length_of(plc, plc.curves[c]); length < size) curves_[c] = length;
    find_kept(options);
    keep_groups(draft);
    for (Index p = 0; p < patches_.size(); ++p)
      if (kept_[p]) patches_[p] = 0;
    for (Index c = 0; c < curves_.size(); ++c)
      if (std::ranges::any_of(plc.curves[c].patches, [&](Index p) { return kept_[p]; })) curves_[c] = 0;
  }

  /// Returns the width of a patch that is to be collapsed; 0: it stays.
  double patch(Index p) const { return patches_[p]; }
  /// Returns the length of a curve that is to be collapsed; 0: it stays.
  double curve(Index c) const { return curves_[c]; }
  /// Returns whether a patch stays, however small it is.
  bool is_kept(Index p) const { return kept_[p]; }

 private:
  // Returns the mean width; infinity if a triangle is wider than `size_`, because the patch is not narrow
  // there.
  double width_of(const Plc::Patch& patch) const {
    double area = 0, border = 0;
    for (Index t = patch.first_triangle; t < patch.first_triangle + patch.triangle_count; ++t) {
      const auto& [a, b, c] = plc_.triangles[t].points;
      const Point &p = plc_.points[a], &q = plc_.points[b], &r = plc_.points[c];
      const double twice = norm(cross(q - p, r - p));
      area += twice / 2;
      if (twice > size_ * std::max({distance(p, q), distance(q, r), distance(r, p)})) return INFINITY;
    }
    for (const Index c : patch.curves) border += length_of(plc_, plc_.curves[c]);
    return border > 0 ? 2 * area / border : INFINITY;
  }

  // Keeps features whose tags the options list as kept, curves with a name, and patches around regions
  // thinner than the size.
  void find_kept(const RepairOptions& options) {
    const std::vector<bool> thin = thin_regions();
    for (Index p = 0; p < kept_.size(); ++p)
      kept_[p] = std::ranges::count(options.kept_patches, plc_.patches[p].tag) > 0 ||
                 std::ranges::any_of(plc_.patches[p].regions, [&](Index r) { return thin[r]; });
    for (Index c = 0; c < curves_.size(); ++c)
      if (const Tag tag = plc_.curves[c].tag;
          std::ranges::count(options.kept_curves, tag) > 0 || plc_.names.of(1).contains(tag))
        curves_[c] = 0;
  }

  std::vector<bool> thin_regions() const {
    std::vector<double> area(plc_.regions.size(), 0);
    for (const Plc::Triangle& t : plc_.triangles) {
      const Point &a = plc_.points[t.points[0]], &b = plc_.points[t.points[1]], &c = plc_.points[t.points[2]];
      for (const Index r : plc_.patches[t.patch].regions) area[r] += norm(cross(b - a, c - a)) / 2;
    }
    std::vector<bool> thin(area.size(), false);
    for (Index r = 1; r < thin.size(); ++r) thin[r] = 2 * std::fabs(plc_.regions[r].volume) < size_ * area[r];
    return thin;
  }

  // Keeps all patches of a tag if all of them are small, unless the tag is only the number of a CAD face,
  // without a name.
  void keep_groups(const ComplexDraft& draft) {
    if (plc_.numbered_patches) return;
    std::set<Tag> stay;
    for (Index p = 0; p < patches_.size(); ++p)
      if (patches_[p] == 0) stay.insert(plc_.patches[p].tag);
    for (Index p = 0; p < patches_.size(); ++p) {
      const Plc::Patch& patch = plc_.patches[p];
      const bool is_number = draft.soup_gives_features[patch.file] && !plc_.names.of(2).contains(patch.tag);
      if (!is_number && !stay.contains(patch.tag)) kept_[p] = true;
    }
  }

  const Plc& plc_;
  double size_;
  std::vector<double> patches_, curves_;
  std::vector<bool> kept_;  // by patch: whether it and its curves stay, however small
};

/// A map from the points of a complex to those of the draft that it was built from.
class DraftPoints {
 public:
  DraftPoints(const Plc& plc, const ComplexDraft& draft) : of_plc_(plc.points.size(), none) {
    std::map<std::array<double, 3>, Index> at;
    for (const Corners& c : draft.triangles)
      for (const Index p : c) at.emplace(key_of(draft.points[p]), p);
    for (Index p = 0; p < plc.points.size(); ++p)
      if (const auto found = at.find(key_of(plc.points[p])); found != at.end()) of_plc_[p] = found->second;
  }
  Index operator[](Index p) const { return of_plc_[p]; }

 private:
  std::vector<Index> of_plc_;
};

class FeatureCollapser {
 public:
  FeatureCollapser(ComplexDraft& draft, const Plc& plc, double size, const RepairOptions& options, Work& work)
      : draft_(draft), plc_(plc), size_(size), state_(draft, size, SnapWhat::all, work, {}), cuts_(state_) {
    const SmallOnes small(plc, draft, size, options);
    const DraftPoints points(plc, draft);
    find_curves(small, points);
    find_patches(small, points);
    rank_points(small, points);
  }

  std::vector<CollapsedFeature> run() {
    for (std::size_t round = 0; round < most_feature_rounds && run_round(); ++round) {
    }
    draft_ = state_.triangles().compacted();
    return std::move(collapsed_);
  }

 private:
  void find_curves(const SmallOnes& small, const DraftPoints& points) {
    for (Index c = 0; c < plc_.curves.size(); ++c) {
      const Plc::Curve& curve = plc_.curves[c];
      Edge edge{none, none};
      for (std::size_t i = 0; i + 1 < curve.points.size() + (curve.closed ? 1 : 0); ++i) {
        const Index a = points[curve.points[i]], b = points[curve.points[(i + 1) % curve.points.size()]];
        if (a == none || b == none) continue;
        edge = edge_key(a, b);
        features_.insert(edge);
        if (small.curve(c) > 0) short_.insert(edge);
      }
      if (small.curve(c) > 0 && edge[0] != none)
        collapsed_.push_back({{SmallFeature::Kind::curve, small.curve(c), curve.tag, draft_.points[edge[0]]},
                              as_corners(edge)});
    }
  }

  // Marks the draft's triangles in narrow patches by their facet numbers. The complex may have divided a
  // polygon differently: a triangle that only the draft has is in the narrow patch that has all its corners.
  void find_patches(const SmallOnes& small, const DraftPoints& points) {
    std::map<Corners, Index> patch_of;
    std::vector<std::set<Index>> narrow_at(draft_.points.size());
    for (const Plc::Triangle& t : plc_.triangles) {
      const Corners corners = sorted({points[t.points[0]], points[t.points[1]], points[t.points[2]]});
      patch_of.emplace(corners, t.patch);
      if (corners[2] != none && small.patch(t.patch) > 0)
        for (const Index p : corners) narrow_at[p].insert(t.patch);
    }
    std::vector<bool> listed(plc_.patches.size(), false);
    for (Index t = 0; t < draft_.triangles.size(); ++t) {
      const Corners corners = sorted(draft_.triangles[t]);
      const auto known = patch_of.find(corners);
      Index patch = known != patch_of.end() ? known->second : none;
      for (const Index p : narrow_at[corners[0]])
        if (known == patch_of.end() && narrow_at[corners[1]].contains(p) && narrow_at[corners[2]].contains(p))
          patch = p;
      const bool is_narrow = patch != none && small.patch(patch) > 0;
      draft_.origins[t].facet = is_narrow ? in_narrow_patch : 0;
      if (!is_narrow || listed[patch]) continue;
      listed[patch] = true;
      const Point where = (draft_.corner(t, 0) + draft_.corner(t, 1) + draft_.corner(t, 2)) / 3;
      collapsed_.push_back(
          {{SmallFeature::Kind::patch, small.patch(patch), plc_.patches[patch].tag, where}, corners});
    }
  }

  // Ranks the points: if two points merge, the one of lower rank moves.
  void rank_points(const SmallOnes& small, const DraftPoints& points) {
    constexpr int of_vertex = 1000;
    rank_.assign(draft_.points.size(), 0);
    for (const Plc::Vertex& v : plc_.vertices)
      if (points[v.point] != none) rank_[points[v.point]] += of_vertex;
    for (const Edge& e : features_)
      for (const Index p : e) ++rank_[p];
    for (const Segment& s : draft_.segments)
      for (const Index p : {s.a, s.b}) ++rank_[p];
    for (const Index p : draft_.loose_points) rank_[p] += of_fixed;
    for (const Plc::Triangle& t : plc_.triangles)
      for (const Index p : t.points)
        if (small.is_kept(t.patch) && points[p] != none) rank_[points[p]] = of_fixed;
  }

  bool in_patch(Index t) const { return draft_.origins[t].facet == in_narrow_patch; }
  bool is_feature(Index a, Index b) const { return features_.contains(edge_key(a, b)); }

  // Changes narrow triangles and sharp tips, those with the smallest height first, except where this round
  // has already changed something. Returns whether the round changed anything.
  bool run_round() {
    std::vector<std::pair<double, Index>> found;
    find_narrow();
    for (const Index t : narrow_) {
      const Needle needle = needle_of(draft_, draft_.triangles[t]);
      const bool tip = is_tip(t, needle);
      const bool is_small = needle.height < size_ ? tip || in_patch(t) || has_short_curve(t) : tip;
      if (is_small && !is_at_wall(t)) found.emplace_back(needle.height, t);
    }
    std::sort(found.begin(), found.end());
    touched_.clear();
    cuts_.clear();
    merges_.clear();
    for (const auto& [height, t] : found) change(t);
    return apply();
  }

  // Adds to the list the new triangles that are narrow or have a sharp corner. Removes triangles that no
  // longer exist.
  void find_narrow() {
    std::erase_if(narrow_, [&](Index t) { return !state_.triangles().alive(t); });
    for (; looked_at_ < state_.triangles().end(); ++looked_at_) {
      const Needle needle = needle_of(draft_, draft_.triangles[looked_at_]);
      if (state_.triangles().alive(looked_at_) &&
          (needle.height < size_ || needle.least < sharp_tip * needle.most))
        narrow_.push_back(looked_at_);
    }
  }

  bool has_short_curve(Index t) const {
    const Corners& c = draft_.triangles[t];
    for (unsigned i = 0; i < 3; ++i)
      if (short_.contains(edge_key(c[i], c[(i + 1) % 3]))) return true;
    return false;
  }

  // Returns whether the facets beside a narrow triangle face opposite ways, as those of a blade do. There, a
  // collapse would remove the thickness of a wall.
  bool is_at_wall(Index t) const {
    constexpr double opposed = -0.5;
    std::vector<Vector> normals;
    add_normals_beside(t, true, normals);
    return std::ranges::any_of(normals, [&](const Vector& n) {
      return std::ranges::any_of(normals, [&](const Vector& m) { return dot(n, m) < opposed; });
    });
  }

  // Adds the normals of the triangles across the long sides that are pieces of curves. If `further`, also
  // adds those across the long sides of a neighbour in a narrow patch, such as the other half of a
  // quadrangle.
  void add_normals_beside(Index t, bool further, std::vector<Vector>& normals) const {
    const Corners& corners = draft_.triangles[t];
    const Needle needle = needle_of(draft_, corners);
    for (unsigned i = 0; i < 3; ++i) {
      if (i == needle.shortest) continue;
      const Edge side = edge_key(corners[i], corners[(i + 1) % 3]);
      for (const Index other_side : state_.triangles().sides(side)) {
        const Index other = other_side / 3;
        if (other == t) continue;
        const Corners& c = draft_.triangles[other];
        const bool is_needle = needle_of(draft_, c).height < size_;  // its normal is unreliable
        const Point& a = draft_.points[c[0]];
        const Vector n = cross(draft_.points[c[1]] - a, draft_.points[c[2]] - a);
        if (is_feature(side[0], side[1]) && !is_needle)
          normals.push_back(n / norm(n));
        else if (further && in_patch(other))
          add_normals_beside(other, false, normals);
      }
    }
  }

  // Returns whether both long sides are pieces of curves.
  bool is_tip(Index t, const Needle& needle) const {
    const Corners& c = draft_.triangles[t];
    for (unsigned i = 0; i < 3; ++i)
      if (i != needle.shortest && !is_feature(c[i], c[(i + 1) % 3])) return false;
    return true;
  }

  void change(Index t) {
    const Corners c = draft_.triangles[t];
    const Needle needle = needle_of(draft_, c);
    const Index a = c[needle.shortest], b = c[(needle.shortest + 1) % 3], tip = c[(needle.shortest + 2) % 3];
    constexpr double below = 0.9;
    double length = needle.most;
    bool changes = false;
    if (needle.least < size_) {
      changes = merge(a, b);
    } else if (needle.height < size_) {
      changes = insert(edge_key(c[needle.longest], c[(needle.longest + 1) % 3]), c[(needle.longest + 2) % 3]);
    } else {
      const double share = below * size_ / needle.least;
      length *= share;
      changes = blunt(tip, a, b, share);
    }
    if (changes && !in_patch(t) && !has_short_curve(t) && tips_.insert(tip).second && tip < first_new())
      collapsed_.push_back(
          {{SmallFeature::Kind::tip, length, draft_.origins[t].tag, draft_.points[tip]}, sorted(c)});
  }
  Index first_new() const { return static_cast<Index>(rank_.size()); }

  bool touch(const std::vector<Index>& triangles) {
    if (std::ranges::any_of(triangles, [&](Index t) { return touched_.contains(t); })) return false;
    touched_.insert(triangles.begin(), triangles.end());
    return true;
  }
  void add_triangles_at(Index p, std::vector<Index>& all) const {
    state_.triangles().for_each_at(p, [&](Index side) { all.push_back(side / 3); });
  }
  void add_triangles_at(const Edge& e, std::vector<Index>& all) const {
    for (const Index side : state_.triangles().sides(e)) all.push_back(side / 3);
  }

  int rank_of(Index p) const { return p < rank_.size() ? rank_[p] : 0; }

  bool merge(Index a, Index b) {
    if (std::pair(rank_of(b), a) < std::pair(rank_of(a), b)) std::swap(a, b);
    std::vector<Index> around;
    add_triangles_at(a, around);
    add_triangles_at(b, around);
    if (rank_of(a) >= of_fixed || !touch(around)) return false;
    merges_.emplace_back(a, b);
    return true;
  }

  bool insert(const Edge& e, Index p) {
    const double parameter = parameter_on_segment(draft_.points[p], draft_.points[e[0]], draft_.points[e[1]]);
    std::vector<Index> around;
    add_triangles_at(e, around);
    if (!(parameter > 0 && parameter < 1) || !touch(around)) return false;
    cuts_.add(e, {parameter, p}, 0);
    return true;
  }

  // Cuts the long sides of a tip at the same share of their lengths.
  bool blunt(Index tip, Index a, Index b, double share) {
    std::vector<Index> around;
    add_triangles_at(edge_key(tip, a), around);
    add_triangles_at(edge_key(tip, b), around);
    if (!touch(around)) return false;
    for (const Index end : {a, b}) {
      const Index p = static_cast<Index>(draft_.points.size());
      draft_.points.push_back(draft_.points[tip] + share * (draft_.points[end] - draft_.points[tip]));
      draft_.point_tags.push_back(0);
      cuts_.add(edge_key(tip, end), {tip < end ? share : 1 - share, p}, 0);
    }
    return true;
  }

  bool apply() {
    if (merges_.empty() && cuts_.empty()) return false;
    std::vector<Edge> cut;
    cuts_.for_each_edge([&](const Edge& e) { cut.push_back(e); });
    for (const Edge& e : cut)
      for (std::set<Edge>* set : {&features_, &short_}) {
        if (set->erase(e) == 0) continue;
        const std::vector<Index> points = cuts_.chain(e[0], e[1]);
        for (std::size_t i = 0; i + 1 < points.size(); ++i) set->insert(edge_key(points[i], points[i + 1]));
      }
    cuts_.apply();
    rename_edges();
    rename_points(state_, merges_);
    cancel_new_duplicates(state_);
    return true;
  }

  void rename_edges() {
    const std::map<Index, Index> name(merges_.begin(), merges_.end());
    for (std::set<Edge>* set : {&features_, &short_}) {
      std::vector<Edge> changed;
      for (const Edge& e : *set)
        if (name.contains(e[0]) || name.contains(e[1])) changed.push_back(e);
      for (const Edge& e : changed) {
        set->erase(e);
        const auto renamed = [&](Index p) { return name.contains(p) ? name.at(p) : p; };
        if (renamed(e[0]) != renamed(e[1])) set->insert(edge_key(renamed(e[0]), renamed(e[1])));
      }
    }
  }

  static constexpr int of_fixed = 100'000;     // rank of points that stay
  static constexpr Index in_narrow_patch = 1;  // facet number that marks triangles in narrow patches

  ComplexDraft& draft_;
  const Plc& plc_;
  double size_;
  SnapState state_;
  SnapCuts cuts_;
  std::set<Edge> features_, short_;  // pieces of all curves; pieces of curves to be collapsed
  std::vector<int> rank_;            // by point, except added ones
  std::vector<CollapsedFeature> collapsed_;
  std::set<Index> tips_;       // apexes of the tips changed so far
  std::vector<Index> narrow_;  // existing triangles that are narrow or have a sharp corner, ascending
  Index looked_at_ = 0;        // triangles before this one have been examined
  // The changes of this round:
  std::set<Index> touched_;                      // triangles that change
  std::vector<std::pair<Index, Index>> merges_;  // a point, and the one that takes its place
};

/// The points of a feature, and its direction: a patch's mean normal, or the vector from a curve's first
/// point to its last one.
struct Shape {
  std::set<std::array<double, 3>> points;
  Vector direction;
};

Vector unit(const Vector& v) { return norm(v) > 0 ? v / norm(v) : Vector(); }

std::vector<Shape> shapes_of_patches(const Plc& plc) {
  std::vector<Shape> shapes(plc.patches.size());
  for (const Plc::Triangle& t : plc.triangles) {
    const Point &a = plc.points[t.points[0]], &b = plc.points[t.points[1]], &c = plc.points[t.points[2]];
    for (const Point& p : {a, b, c}) shapes[t.patch].points.insert(key_of(p));
    shapes[t.patch].direction = shapes[t.patch].direction + cross(b - a, c - a);
  }
  for (Shape& shape : shapes) shape.direction = unit(shape.direction);
  return shapes;
}

std::vector<Shape> shapes_of_curves(const Plc& plc) {
  std::vector<Shape> shapes(plc.curves.size());
  for (Index c = 0; c < shapes.size(); ++c) {
    const std::vector<Index>& points = plc.curves[c].points;
    for (const Index p : points) shapes[c].points.insert(key_of(plc.points[p]));
    shapes[c].direction = unit(plc.points[points.back()] - plc.points[points.front()]);
  }
  return shapes;
}

/// Returns a tag for each new feature: the tag of the old feature with which it has the most points in common
/// (of several, the most parallel one). Gives each old tag at most once. New features that match no old one
/// get numbers above all old tags.
std::vector<Tag> numbers_from(const std::vector<Shape>& before, const std::vector<Tag>& tags,
                              const std::vector<Shape>& after) {
  std::map<std::array<double, 3>, std::vector<Index>> at;
  for (Index i = 0; i < before.size(); ++i)
    for (const auto& p : before[i].points) at[p].push_back(i);
  struct Match {
    double score;
    Index now, old;
  };
  std::vector<Match> matches;
  for (Index i = 0; i < after.size(); ++i) {
    std::map<Index, double> common;
    for (const auto& p : after[i].points)
      if (const auto found = at.find(p); found != at.end())
        for (const Index old : found->second) ++common[old];
    for (const auto& [old, points] : common)
      matches.push_back({points + 0.9 * std::fabs(dot(after[i].direction, before[old].direction)), i, old});
  }
  std::stable_sort(matches.begin(), matches.end(),
                   [](const Match& a, const Match& b) { return a.score > b.score; });
  std::vector<Tag> numbers(after.size(), 0);
  std::vector<bool> taken(before.size(), false);
  for (const Match& match : matches) {
    if (numbers[match.now] != 0 || taken[match.old]) continue;
    numbers[match.now] = tags[match.old];
    taken[match.old] = true;
  }
  Tag next = tags.empty() ? 0 : *std::max_element(tags.begin(), tags.end());
  for (Tag& number : numbers)
    if (number == 0) number = ++next;
  return numbers;
}

template <class Features>
std::vector<Tag> tags_of(const Features& features) {
  std::vector<Tag> tags;
  tags.reserve(features.size());
  for (const auto& feature : features) tags.push_back(feature.tag);
  return tags;
}

}  // namespace

std::vector<CollapsedFeature> collapse_in_draft(ComplexDraft& draft, const Plc& plc, double size,
                                                const RepairOptions& options, Work& work) {
  return FeatureCollapser(draft, plc, size, options, work).run();
}

std::vector<SmallFeature> gone_from(const ComplexDraft& draft,
                                    const std::vector<CollapsedFeature>& features) {
  std::set<Corners> there;
  for (const Corners& c : draft.triangles) {
    there.insert(sorted(c));
    for (unsigned i = 0; i < 3; ++i) there.insert(as_corners(edge_key(c[i], c[(i + 1) % 3])));
  }
  std::vector<SmallFeature> gone;
  for (const CollapsedFeature& each : features)
    if (!there.contains(each.corners)) gone.push_back(each.feature);
  return gone;
}

void keep_numbers(const Plc& before, Plc& after) {
  if (before.numbered_patches && after.numbered_patches) {
    const std::vector<Tag> numbers =
        numbers_from(shapes_of_patches(before), tags_of(before.patches), shapes_of_patches(after));
    for (Index p = 0; p < numbers.size(); ++p) after.patches[p].tag = numbers[p];
  }
  if (before.numbered_curves && after.numbered_curves) {
    const std::vector<Tag> numbers =
        numbers_from(shapes_of_curves(before), tags_of(before.curves), shapes_of_curves(after));
    for (Index c = 0; c < numbers.size(); ++c) after.curves[c].tag = numbers[c];
  }
}

}  // namespace collarmesh::repairing
