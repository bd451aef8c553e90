#include "collarmesh/merge_soups.h"

#include <algorithm>
#include <set>
#include <vector>

#include "facets/complex_draft.h"
#include "facets/facet_triangulation.h"
#include "facets/faults.h"
#include "facets/weld.h"

namespace collarmesh {

namespace {

using namespace facets;

/// A facet whose polygons are lists of merged points.
struct MergedFacet {
  Tag tag = 0;
  std::vector<std::vector<Index>> polygons;
};

/// A search for facets with the same corners in any order.
class RepeatedFacets {
 public:
  bool add(const MergedFacet& facet) {
    std::vector<Index> key;
    for (const auto& polygon : facet.polygons) key.insert(key.end(), polygon.begin(), polygon.end());
    std::ranges::sort(key);
    return seen_.insert(std::move(key)).second;
  }

 private:
  std::set<std::vector<Index>> seen_;
};

class Merger {
 public:
  Merger(std::span<const PolygonSoup> soups, const MergeSoupsOptions& options, MergeReport& report)
      : soups_(soups),
        options_(options),
        report_(report),
        map_(weld_points(soups, options.weld, draft_, faults_)) {
    faults_.raise();
  }

  PolygonSoup run() {
    result_.points = draft_.points;
    for (const PolygonSoup& soup : soups_)
      if (!soup.point_tags.empty()) result_.point_tags = draft_.point_tags;
    report_.welded_points = draft_.cleanup.welded_points;
    for (std::size_t s = 0; s < soups_.size(); ++s) add_soup(s);
    return std::move(result_);
  }

 private:
  void add_soup(std::size_t s) {
    const PolygonSoup& soup = soups_[s];
    if (result_.name.empty()) result_.name = soup.name;
    result_.tag_names.add(soup.tag_names);
    report_.unused_points += static_cast<Index>(std::ranges::count(map_.merged[s], none));
    std::vector<Index> number(soup.facet_count(), none);
    has_hole_.assign(soup.facet_count(), false);
    for (const auto& hole : soup.facet_holes) has_hole_[hole.facet] = true;
    for (Index f = 0; f < soup.facet_count(); ++f) number[f] = add_facet(s, f);
    for (const auto& segment : soup.segments) {
      const Index a = map_.merged[s][segment.a], b = map_.merged[s][segment.b];
      if (a != b) result_.segments.push_back({a, b, segment.tag});
    }
    for (const auto& hole : soup.facet_holes)
      if (number[hole.facet] != none) result_.facet_holes.push_back({number[hole.facet], hole.point});
    result_.region_points.insert(result_.region_points.end(), soup.region_points.begin(),
                                 soup.region_points.end());
    result_.named_regions.insert(result_.named_regions.end(), soup.named_regions.begin(),
                                 soup.named_regions.end());
    result_.hole_points.insert(result_.hole_points.end(), soup.hole_points.begin(), soup.hole_points.end());
  }

  /// Adds a facet. Returns its number in the result; none if it was dropped or cut.
  Index add_facet(std::size_t s, Index f) {
    const PolygonSoup& soup = soups_[s];
    const MergedFacet facet = merged_facet(s, f);
    const auto [first, last] = soup.facet_polygons(f);
    bool spans = false, spanned = false;
    for (Index q = first; q < last; ++q) spanned = spanned || soup.polygon(q).size() >= 3;
    for (const auto& polygon : facet.polygons) spans = spans || polygon.size() >= 3;
    if (facet.polygons.empty() || (spanned && !spans)) {
      ++report_.degenerate_facets;
      return none;
    }
    if (!repeated_.add(facet)) {
      ++report_.repeated_facets;
      return none;
    }
    const bool complex = facet.polygons.size() > 1 || facet.polygons[0].size() < 3 || has_hole_[f];
    if (options_.cut != CutFacets::nothing &&
        (complex || (options_.cut == CutFacets::all && facet.polygons[0].size() > 3))) {
      cut(soup, f, facet);
      return none;
    }
    result_.begin_facet(facet.tag);
    for (const auto& polygon : facet.polygons) result_.add_polygon(polygon);
    return result_.facet_count() - 1;
  }

  MergedFacet merged_facet(std::size_t s, Index f) const {
    const PolygonSoup& soup = soups_[s];
    MergedFacet facet{soup.facet_tag(f), {}};
    const auto [first, last] = soup.facet_polygons(f);
    for (Index q = first; q < last; ++q) {
      std::vector<Index> loop;
      for (const Index corner : soup.polygon(q))
        if (loop.empty() || loop.back() != map_.merged[s][corner]) loop.push_back(map_.merged[s][corner]);
      while (loop.size() > 1 && loop.front() == loop.back()) loop.pop_back();
      if (loop.size() >= std::min<std::size_t>(3, soup.polygon(q).size())) facet.polygons.push_back(loop);
    }
    return facet;
  }

  void cut(const PolygonSoup& soup, Index f, const MergedFacet& facet) {
    PolygonSoup one;
    one.name = soup.name;
    one.begin_facet(facet.tag);
    for (const auto& polygon : facet.polygons) one.add_polygon(polygon);
    for (const auto& hole : soup.facet_holes)
      if (hole.facet == f) one.facet_holes.push_back({0, hole.point});
    if (identity_.merged.empty()) {
      identity_.merged.emplace_back(draft_.points.size());
      for (Index p = 0; p < draft_.points.size(); ++p) identity_.merged[0][p] = p;
    }
    if (draft_.soup_names.empty()) draft_.soup_names.push_back(soup.name);
    draft_.planar_tolerance = planar_tolerance * draft_.bounds.diagonal();
    draft_.triangles.clear();
    draft_.origins.clear();
    draft_.segments.clear();
    triangulate_facets({&one, 1}, identity_, draft_, faults_);
    faults_.raise();
    for (const Corners& t : draft_.triangles) result_.add_facet(t, facet.tag);
    for (const Segment& segment : draft_.segments)
      result_.segments.push_back({segment.a, segment.b, segment.tag});
    ++report_.cut_facets;
  }

  static constexpr double planar_tolerance = 1e-6;  // as the default of PlcOptions

  std::span<const PolygonSoup> soups_;
  const MergeSoupsOptions& options_;
  MergeReport& report_;
  ComplexDraft draft_;
  Faults faults_;
  PointMap map_;
  PointMap identity_;
  RepeatedFacets repeated_;
  std::vector<bool> has_hole_;  // by facet of the current soup
  PolygonSoup result_;
};

}  // namespace

PolygonSoup merge_soups(std::span<const PolygonSoup> soups, const MergeSoupsOptions& options,
                        MergeReport& report) {
  report = {};
  return Merger(soups, options, report).run();
}

}  // namespace collarmesh
