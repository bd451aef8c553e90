// Builds a complex from polygon soups. `build_plc` at the end shows the order of the steps.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "collarmesh/options.h"
#include "collarmesh/plc_builder.h"
#include "common/sort_uniquely.h"
#include "facets/box_around.h"
#include "facets/cleanup.h"
#include "facets/facet_triangulation.h"
#include "facets/faults.h"
#include "facets/flat_clusters.h"
#include "facets/intersections.h"
#include "facets/near_touching.h"
#include "facets/orientation.h"
#include "facets/weld.h"
#include "plc/angles.h"
#include "plc/curves.h"
#include "plc/features.h"
#include "plc/interfaces.h"
#include "plc/lost_bodies.h"
#include "plc/regions.h"

namespace collarmesh {

namespace {

using namespace facets;
using namespace plc;

void name_soups(std::span<const PolygonSoup> soups, ComplexDraft& draft) {
  for (Index s = 0; s < soups.size(); ++s) {
    draft.soup_names.push_back(soups[s].name.empty() ? fmt::format("input {}", s + 1) : soups[s].name);
    draft.soup_is_complex.push_back(is_complex(soups[s]));
    draft.soup_gives_features.push_back(soups[s].given_features);
  }
}

// Adds the unused points of complexes as vertices.
void add_unused_points(const PointMap& map, ComplexDraft& draft) {
  std::vector<bool> used(draft.points.size(), false);
  for (const Corners& t : draft.triangles)
    for (const Index p : t) used[p] = true;
  for (const Segment& s : draft.segments) used[s.a] = used[s.b] = true;
  for (Index s = 0; s < map.merged.size(); ++s)
    if (draft.soup_is_complex[s])
      for (const Index p : map.merged[s])
        if (!used[p]) draft.loose_points.push_back(p);
}

void add_named_vertices(std::span<const PolygonSoup> soups, const PointMap& map, ComplexDraft& draft) {
  for (Index s = 0; s < soups.size(); ++s)
    for (const Index v : soups[s].vertices) draft.loose_points.push_back(map.merged[s][v]);
}

void require_content(const ComplexDraft& draft, Faults& faults) {
  if (draft.triangles.empty() && draft.segments.empty() && draft.loose_points.empty())
    faults.add(PlcFault::Kind::empty,
               "The input holds no facet with an area; check that these are the right files.", {}, {});
}

// Adds a fault that tells why the facets enclose no region.
void report_nothing_solid(const ComplexDraft& draft, std::span<const PolygonSoup> soups, Faults& faults) {
  for (Index s = 0; s < soups.size(); ++s)
    if (!soups[s].hole_points.empty()) {
      const Point& hole = soups[s].hole_points.front();
      faults.add(PlcFault::Kind::empty,
                 fmt::format("The facets enclose no region, because hole points mark the space inside as "
                             "empty; the first is {} of {}. Remove it to mesh the space around it.",
                             text(hole), draft.soup_names[s]),
                 {}, hole);
      return;
    }
  const Point at = draft.points.empty() ? Point{} : draft.points.front();
  if (draft.triangles.empty() && !draft.segments.empty()) {
    faults.add(PlcFault::Kind::empty,
               fmt::format("The input has lines (the first begins near {}) but no facets, so it encloses no "
                           "region; add facets, or mesh its curves with lines (--dimension 1).",
                           text(at)),
               {}, at);
    return;
  }
  faults.add(
      PlcFault::Kind::empty,
      fmt::format("The {} triangles of the input, which begin at {}, enclose no region; add the facets "
                  "that close the surface.",
                  draft.triangles.size(), text(at)),
      {}, at);
}

void require_region(const ComplexDraft& draft, const EdgeTable& edges, const Regions& regions,
                    std::span<const PolygonSoup> soups, Faults& faults) {
  if (regions.list.size() > 1) return;
  std::size_t count = 0;
  Index first = none;
  for (Index e = 0; e < edges.size(); ++e) {
    if (edges.sides(e).size() != 1) continue;
    if (count++ == 0) first = e;
  }
  if (count == 0) {
    report_nothing_solid(draft, soups, faults);
    return;
  }
  const auto [a, b] = edges.ends(first);
  const Point &pa = draft.points[a], &pb = draft.points[b];
  faults.add(PlcFault::Kind::open_boundary,
             fmt::format("The surface is open and encloses nothing: {} border edge{}, the first one {} - {}; "
                         "close it, or raise the weld distance if its borders should touch.",
                         count, count == 1 ? "" : "s", text(pa), text(pb)),
             {a, b}, 0.5 * (pa + pb));
}

// Adds the patches to the complex, each with its triangles in one range. Turns a patch around if a region is
// in front of it and the outside behind it.
void add_patches(ComplexDraft& draft, const Regions& regions, const std::vector<Index>& patch_of,
                 Index patch_count, Plc& plc) {
  std::vector<std::vector<Index>> triangles(patch_count);
  for (Index t = 0; t < draft.triangles.size(); ++t) triangles[patch_of[t]].push_back(t);
  for (Index p = 0; p < patch_count; ++p) {
    const Index first = triangles[p].front();
    Plc::Patch patch;
    patch.first_triangle = static_cast<Index>(plc.triangles.size());
    patch.triangle_count = static_cast<Index>(triangles[p].size());
    patch.regions = {regions.of_side[back_side(first)], regions.of_side[front_side(first)]};
    patch.tag = draft.origins[first].tag;
    patch.file = draft.origins[first].soup;
    fit_plane(draft, triangles[p], patch);
    const bool turn = patch.regions[0] == 0 && patch.regions[1] != 0;
    if (turn) {
      std::swap(patch.regions[0], patch.regions[1]);
      if (patch.planar) patch.normal = -1.0 * patch.normal;
    }
    for (const Index t : triangles[p]) {
      Corners corners = draft.triangles[t];
      if (turn) std::swap(corners[1], corners[2]);
      plc.triangles.push_back({corners, p});
    }
    plc.patches.push_back(std::move(patch));
  }
}

// Links patches to their curves and vertices. Precondition: curves have their patches and vertices their
// curves.
void link_patches(const ComplexDraft& draft, Plc& plc) {
  for (Index c = 0; c < plc.curves.size(); ++c)
    for (const Index p : plc.curves[c].patches) plc.patches[p].curves.push_back(c);
  std::vector<Index> vertex_at(draft.points.size(), none);
  for (Index v = 0; v < plc.vertices.size(); ++v) vertex_at[plc.vertices[v].point] = v;
  for (const Plc::Triangle& t : plc.triangles)
    for (const Index point : t.points)
      if (vertex_at[point] != none) plc.vertices[vertex_at[point]].patches.push_back(t.patch);
  for (Index v = 0; v < plc.vertices.size(); ++v) {
    sort_uniquely(plc.vertices[v].patches);
    for (const Index p : plc.vertices[v].patches) plc.patches[p].vertices.push_back(v);
  }
}

void warn_of_patches_outside(Plc& plc) {
  std::size_t count = 0;
  double area = 0;
  Point first;
  Tag tag = 0;
  for (const Plc::Patch& patch : plc.patches) {
    if (patch.regions[0] != 0 || patch.regions[1] != 0) continue;
    for (Index t = patch.first_triangle; t < patch.first_triangle + patch.triangle_count; ++t) {
      const auto& v = plc.triangles[t].points;
      const Point &a = plc.points[v[0]], &b = plc.points[v[1]], &c = plc.points[v[2]];
      if (count++ == 0) {
        first = (a + b + c) / 3;
        tag = patch.tag;
      }
      area += 0.5 * norm(cross(b - a, c - a));
    }
  }
  if (count == 0) return;
  plc.warnings.push_back(
      {fmt::format("Part of the surface bounds no region and is not meshed: an area of {:.3g} (triangles: "
                   "{}), beginning at {} on a patch with tag {}. Close the surface there, or remove it.",
                   area, count, text(first), tag),
       first});
}

}  // namespace

Plc build_plc(std::span<const PolygonSoup> soups, const PlcOptions& options) {
  validate({{.complex = options}});
  if (options.domain == DomainShape::box) return build_plc(with_box(soups, options), enclosed(options));
  ComplexDraft draft;
  Faults faults;
  name_soups(soups, draft);
  const PointMap map = weld_points(soups, options.weld, draft, faults);
  faults.raise();
  const bool welding_moved = draft.largest_deviation > 0;
  draft.planar_tolerance = options.planar_tolerance * draft.bounds.diagonal();

  triangulate_facets(soups, map, draft, faults);
  add_unused_points(map, draft);
  add_named_vertices(soups, map, draft);
  remove_collinear_triangles(draft);
  remove_duplicates_within_soups(draft);
  require_content(draft, faults);
  EdgeTable edges(draft.triangles, draft.points.size());
  orient_components(draft, edges, faults);
  if (soups.size() > 1) {
    unify_interfaces(draft);
    merge_duplicates_across_soups(draft);
    edges = EdgeTable(draft.triangles, draft.points.size());
  }
  const Simplices simplices(draft, edges);
  find_intersections(draft, simplices, faults);
  faults.raise();

  Regions regions = find_regions(draft, edges, simplices.boxes(), soups, faults);
  faults.raise();
  if (options.require_solid) require_region(draft, edges, regions, soups, faults);
  faults.raise();

  const auto segments = find_segments(
      draft, edges, find_flat_clusters(draft, edges, ClusterBorder::given_features), options.feature_angle);
  std::vector<Index> patch_of;
  const Index patch_count = find_patches(draft, edges, segments, patch_of);
  Plc plc;
  plc.planar_tolerance = draft.planar_tolerance;
  add_patches(draft, regions, patch_of, patch_count, plc);
  find_curves(draft, edges, segments, patch_of, find_folds(draft.points, plc, segments),
              options.feature_angle, plc);
  link_patches(draft, plc);
  plc.points = std::move(draft.points);
  plc.regions = std::move(regions.list);
  plc.warnings = std::move(regions.warnings);
  plc.bounds = draft.bounds;
  plc.largest_deviation = draft.largest_deviation;
  plc.cleanup = draft.cleanup;
  if (welding_moved) {
    const double distance = options.weld * plc.bounds.diagonal();
    std::ranges::copy(lost_bodies(soups, plc, distance), std::back_inserter(plc.warnings));
  }
  for (const PolygonSoup& soup : soups) plc.names.add(soup.tag_names);
  number_untagged(soups, plc);
  if (plc.regions.size() > 1) warn_of_patches_outside(plc);
  find_near_touching(plc, options.weld * plc.bounds.diagonal(), faults);
  faults.raise();
  return plc;
}

}  // namespace collarmesh
