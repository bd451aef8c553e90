#include "repair/to_soups.h"

#include <algorithm>
#include <set>

#include "facets/edges.h"
#include "facets/flat_clusters.h"

namespace collarmesh::repairing {

namespace {

using namespace facets;

class SoupMaker {
 public:
  SoupMaker(std::span<const PolygonSoup> soups, const ComplexDraft& draft, Index first_new_point)
      : soups_(soups), draft_(draft), first_new_point_(first_new_point) {}

  std::vector<PolygonSoup> run() {
    for (const PolygonSoup& soup : soups_) result_.push_back(frame_of(soup));
    index_.assign(soups_.size(), {});
    for (Index t = 0; t < draft_.triangles.size(); ++t) {
      const Origin& origin = draft_.origins[t];
      const Corners& c = draft_.triangles[t];
      result_[origin.soup].add_facet(
          std::array{point(origin.soup, c[0]), point(origin.soup, c[1]), point(origin.soup, c[2])},
          origin.tag);
    }
    add_segments();
    add_vertices();
    return std::move(result_);
  }

 private:
  static PolygonSoup frame_of(const PolygonSoup& soup) {
    PolygonSoup frame;
    frame.name = soup.name;
    frame.given_features = soup.given_features;
    frame.region_points = soup.region_points;
    frame.named_regions = soup.named_regions;
    frame.hole_points = soup.hole_points;
    frame.region_tag = soup.region_tag;
    frame.tag_names = soup.tag_names;
    return frame;
  }

  Index point(Index soup, Index p) {
    auto& index = index_[soup];
    if (index.empty()) index.assign(draft_.points.size(), none);
    if (index[p] == none) {
      PolygonSoup& s = result_[soup];
      index[p] = static_cast<Index>(s.points.size());
      s.points.push_back(draft_.points[p]);
      s.point_tags.push_back(draft_.point_tags[p]);
    }
    return index[p];
  }
  bool has(Index soup, Index p) const { return !index_[soup].empty() && index_[soup][p] != none; }
  /// Returns whether segments and points of a soup are removed together with its facets.
  bool needs_facets(Index soup) const {
    return !draft_.soup_is_complex[soup] && soups_[soup].facet_count() > 0;
  }

  void add_segments() {
    std::set<std::array<Index, 3>> known;
    for (const Segment& s : draft_.segments) {
      if (s.a == s.b || !known.insert({s.soup, std::min(s.a, s.b), std::max(s.a, s.b)}).second) continue;
      // A segment is removed if the facets at it are gone.
      if (needs_facets(s.soup) && !(has(s.soup, s.a) && has(s.soup, s.b))) continue;
      result_[s.soup].segments.push_back({point(s.soup, s.a), point(s.soup, s.b), s.tag});
    }
    add_new_edges(known);
  }

  // Adds the new edges at which facets of a soup with given features end or meet sharply. They have the tag
  // 0, because any other tag may be that of an edge of the CAD shape.
  void add_new_edges(const std::set<std::array<Index, 3>>& known) {
    if (std::none_of(soups_.begin(), soups_.end(), [](const PolygonSoup& s) { return s.given_features; }))
      return;
    const EdgeTable edges(draft_.triangles, draft_.points.size());
    std::vector<Index> of_soup;
    for (Index e = 0; e < edges.size(); ++e) {
      const auto [a, b] = edges.ends(e);
      if (b < first_new_point_) continue;
      for (const Index side : edges.sides(e)) {
        const Index soup = draft_.origins[side / 3].soup;
        if (!soups_[soup].given_features || known.count({soup, a, b}) > 0) continue;
        of_soup.clear();
        for (const Index other : edges.sides(e))
          if (draft_.origins[other / 3].soup == soup) of_soup.push_back(other / 3);
        if (of_soup[0] != side / 3) continue;
        if (of_soup.size() != 2 || sharp(of_soup[0], of_soup[1]))
          result_[soup].segments.push_back({point(soup, a), point(soup, b), 0});
      }
    }
  }

  bool sharp(Index s, Index t) const {
    constexpr double cosine = 0.866;  // cosine of 30 degrees, the default of PlcOptions::feature_angle
    return dot(unit_normal(draft_, s), unit_normal(draft_, t)) < cosine;
  }

  void add_vertices() {
    const std::vector<std::set<Tag>> tags = tags_of_single_points();
    for (const Index p : draft_.loose_points)
      for (Index s = 0; s < soups_.size(); ++s)
        if (has(s, p) || draft_.soup_is_complex[s] || tags[s].count(draft_.point_tags[p]) > 0)
          result_[s].vertices.push_back(point(s, p));
    for (PolygonSoup& soup : result_) {
      std::sort(soup.vertices.begin(), soup.vertices.end());
      soup.vertices.erase(std::unique(soup.vertices.begin(), soup.vertices.end()), soup.vertices.end());
    }
  }

  /// Returns, by soup, the tags of its vertices. The set is empty if the soup has facets; only a soup without
  /// facets may consist of points alone.
  std::vector<std::set<Tag>> tags_of_single_points() const {
    std::vector<std::set<Tag>> tags(soups_.size());
    for (Index s = 0; s < soups_.size(); ++s)
      if (soups_[s].facet_count() == 0)
        for (const Index v : soups_[s].vertices)
          tags[s].insert(soups_[s].point_tags.empty() ? 0 : soups_[s].point_tags[v]);
    return tags;
  }

  std::span<const PolygonSoup> soups_;
  const ComplexDraft& draft_;
  Index first_new_point_;
  std::vector<PolygonSoup> result_;
  std::vector<std::vector<Index>> index_;  // by soup and point
};

}  // namespace

std::vector<PolygonSoup> to_soups(std::span<const PolygonSoup> soups, const ComplexDraft& draft,
                                  Index first_new_point) {
  return SoupMaker(soups, draft, first_new_point).run();
}

}  // namespace collarmesh::repairing
