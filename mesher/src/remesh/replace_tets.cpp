#include "remesh/replace_tets.h"

#include <algorithm>
#include <cassert>
#include <set>
#include <utility>
#include <vector>

#include "common/cell_shapes.h"
#include "common/sorted.h"
#include "remesh/operations.h"

namespace collarmesh::remeshing {

namespace {

// Replacements that make a tet worse than this share of `least_quality` are not tried.
constexpr double mendable = 0.15;
constexpr unsigned most_repairs = 16;

/// A rule like another one, except that tets with certain corners are worse than all other tets.
class UnwantedRule final : public ShapeRule {
 public:
  UnwantedRule(const ShapeRule& rule, std::set<std::array<Index, 4>> unwanted)
      : rule_(rule), unwanted_(std::move(unwanted)) {}

  double quality(const Corners& p, const std::array<Index, 4>& corners) const override {
    const double quality = rule_.quality(p, corners);
    return quality > 0 && unwanted_.contains(sorted(corners)) ? unwanted_factor * quality : quality;
  }
  bool allows(const Corners& p, const std::array<Index, 4>& corners, double quality) const override {
    return rule_.allows(p, corners, quality);
  }

 private:
  static constexpr double unwanted_factor = 1e-9;

  const ShapeRule& rule_;
  std::set<std::array<Index, 4>> unwanted_;
};

class Replacing {
 public:
  Replacing(EditableMesh& edited, const ShapeRule& rule, double least_quality)
      : edited_(edited), rule_(rule), operations_(edited, rule), least_(least_quality) {
    assert(edited.complex.mesh().features.size() == edited.complex.mesh().points.size());
    edited_.prepare();
  }

  bool replace(const UnwantedTet& unwanted) {
    const Index tet = unwanted.tet;
    const std::array<Index, 4> corners = complex()[tet].corners;
    if (unwanted.edge[0] != none && split(unwanted.edge)) return true;
    Change removal;
    operations_.remove_best_edge(tet, removal);
    if (is_as_good_as(least_, removal)) return mended(std::move(removal));
    const auto edges = edges_to_split(corners);
    return std::ranges::any_of(edges, [this](const auto& edge) { return split(edge); }) ||
           (is_as_good_as(mendable * least_, removal) && mended(std::move(removal)));
  }

 private:
  const TetComplex& complex() const { return edited_.complex; }

  static bool is_as_good_as(double quality, const Change& change) {
    return !change.is_none() && change.quality >= quality;
  }

  bool split(const std::array<Index, 2>& edge) {
    Change insertion;
    operations_.split_edge_anyhow(edge[0], edge[1], mendable * least_, insertion);
    return is_as_good_as(mendable * least_, insertion) && mended(std::move(insertion));
  }

  // Returns the edges between these corners that lie on no curve and no smooth patch, longest first.
  std::vector<std::array<Index, 2>> edges_to_split(const std::array<Index, 4>& corners) const {
    std::vector<std::array<Index, 2>> edges;
    for (const auto& [i, j] : cell_shapes::corner_pairs)
      if (on_no_smooth_patch(corners[i], corners[j])) edges.push_back({corners[i], corners[j]});
    const auto& points = complex().mesh().points;
    std::ranges::sort(edges, std::ranges::greater(), [&](const std::array<Index, 2>& ends) {
      return squared_distance(points[ends[0]], points[ends[1]]);
    });
    return edges;
  }

  // Makes a change and repairs the tets that it leaves too poor. If that fails, undoes all and returns false.
  bool mended(Change change) {
    Trial trial(edited_);
    touched_.clear();
    for (unsigned step = 0; !change.is_none(); ++step) {
      const std::vector<Index>& changed = edited_.apply(std::move(change));
      touched_.insert(touched_.end(), changed.begin(), changed.end());
      const Index worst = tet_to_mend();
      if (worst == none) {
        trial.keep();
        return true;
      }
      change = step < most_repairs ? improvement_of(worst) : Change{};
    }
    trial.undo();
    return false;
  }

  Index tet_to_mend() const {
    Index worst = none;
    double least = least_;
    for (const Index t : touched_) {
      if (!complex()[t].alive) continue;
      const double quality = rule_.quality(complex().corners(t), complex()[t].corners);
      if (quality >= least) continue;
      least = quality;
      worst = t;
    }
    return worst;
  }

  Change improvement_of(Index tet) {
    const auto corners = complex()[tet].corners;
    Change change;
    operations_.remove_best_edge(tet, change);
    for (unsigned i = 0; i < 4 && change.is_none(); ++i)
      if (complex().mesh().features[corners[i]].dimension == 3) operations_.move_vertex(corners[i], change);
    return change;
  }

  bool is_planar(Index patch) const { return patch != none && edited_.plc.patches[patch].planar; }

  bool on_no_smooth_patch(Index a, Index b) const {
    const Index tet = complex().tet_at_edge(a, b);
    if (tet == none || complex().on_curve(a, b)) return false;
    TetComplex::Ring ring;
    complex().ring(tet, a, b, ring);
    for (const Index t : ring.tets)
      for (unsigned k = 0; k < 4; ++k) {
        const Index face = complex()[t].faces[k], opposite = complex()[t].corners[k];
        if (face != none && opposite != a && opposite != b && !is_planar(complex().mesh().face_patch[face]))
          return false;
      }
    return true;
  }

  EditableMesh& edited_;
  const ShapeRule& rule_;
  Operations operations_;
  double least_;
  std::vector<Index> touched_;  // tets that the current trial has made or changed
};

}  // namespace

std::size_t replace_tets(EditableMesh& edited, std::span<const UnwantedTet> unwanted, const ShapeRule& rule,
                         double least_quality) {
  assert(std::ranges::all_of(unwanted, [&](const UnwantedTet& u) { return edited.complex[u.tet].alive; }));
  std::vector<std::array<Index, 4>> corners;
  for (const UnwantedTet& u : unwanted) corners.push_back(sorted(edited.complex[u.tet].corners));
  const UnwantedRule without(rule, {corners.begin(), corners.end()});
  Replacing replacing(edited, without, least_quality);
  std::size_t gone = 0;
  for (std::size_t i = 0; i < unwanted.size(); ++i) {
    const auto& tet = edited.complex[unwanted[i].tet];
    const bool is_there = tet.alive && sorted(tet.corners) == corners[i];  // if not, the removal of
                                                                           // another tet removed it
    if (!is_there || replacing.replace(unwanted[i])) ++gone;
  }
  return gone;
}

}  // namespace collarmesh::remeshing
