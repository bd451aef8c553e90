#pragma once

#include <fmt/format.h>

#include <span>

#include "facets/complex_draft.h"
#include "repair/arrangement.h"
#include "support/repair_shapes.h"

namespace collarmesh::testing::faulty {

/// Makes a draft of surfaces as repair gets them; equal points are merged unless `torn`.
inline facets::ComplexDraft draft_of(std::span<const PolygonSoup> soups, bool torn = false) {
  facets::ComplexDraft draft;
  for (Index s = 0; s < soups.size(); ++s) {
    const PolygonSoup soup = triangulated(soups[s]);
    const auto first = static_cast<Index>(draft.points.size());
    draft.points.insert(draft.points.end(), soup.points.begin(), soup.points.end());
    for (Index f = 0; f < soup.facet_count(); ++f) {
      const auto c = soup.polygon(f);
      draft.add_triangle({first + c[0], first + c[1], first + c[2]}, {soup.facet_tag(f), s, f, true});
    }
    draft.soup_names.push_back(fmt::format("soup {}", s));
    draft.soup_is_complex.push_back(false);
    draft.soup_gives_features.push_back(false);
  }
  draft.point_tags.assign(draft.points.size(), 0);
  for (const Point& p : draft.points) draft.bounds.add(p);
  draft.planar_tolerance = 1e-6 * draft.bounds.diagonal();
  if (!torn) repairing::unify_equal_points(draft);
  return draft;
}
inline facets::ComplexDraft draft_of(const PolygonSoup& soup) { return draft_of({&soup, 1}); }

/// Returns the draft with its triangles' corners at (0, 0, 0) and (6, 0, 0) moved to new points nearby.
inline facets::ComplexDraft with_moved_corners(facets::ComplexDraft draft) {
  for (const double x : {0.0, 6.0}) {
    const auto moved = static_cast<Index>(draft.points.size());
    draft.points.push_back({x, 0.1, 0.2});
    draft.point_tags.push_back(0);
    for (auto& t : draft.triangles)
      for (Index& p : t)
        if (draft.points[p] == Point{x, 0, 0}) p = moved;
  }
  return draft;
}

}  // namespace collarmesh::testing::faulty
