// Wraps facets. Only this source includes Alpha_wrap_3, which takes long to compile.
#include "repair/wrap.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/alpha_wrap_3.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <vector>

#include "facets/complex_draft.h"
#include "facets/facet_triangulation.h"
#include "facets/faults.h"
#include "facets/weld.h"

namespace collarmesh::repairing {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point3 = Kernel::Point_3;
using Triangle3 = Kernel::Triangle_3;
using Surface = CGAL::Surface_mesh<Point3>;

// Ratio of alpha to the offset. Gaps wider than four offsets stay open, and convex edges are cut off by about
// an offset.
constexpr double alpha_by_offset = 2;
constexpr Tag wrap_tag = 1;

Point3 to_cgal(const Point& p) { return {p.x, p.y, p.z}; }

struct Triangles {
  std::vector<Point3> points;
  std::vector<facets::Corners> corners;
  double diagonal = 0;
};

// Returns all facets as triangles, except those without area.
Triangles triangles_of(std::span<const PolygonSoup> soups) {
  facets::ComplexDraft draft;
  facets::Faults faults;
  const facets::PointMap map = facets::weld_points(soups, 0, draft, faults);
  faults.raise();
  draft.planar_tolerance = draft.rounding();
  facets::triangulate_any_facets(soups, map, draft);
  Triangles result;
  result.diagonal = draft.bounds.diagonal();
  for (const Point& p : draft.points) result.points.push_back(to_cgal(p));
  for (const facets::Corners& t : draft.triangles)
    if (!CGAL::collinear(result.points[t[0]], result.points[t[1]], result.points[t[2]]))
      result.corners.push_back(t);
  return result;
}

PolygonSoup to_soup(const Surface& surface) {
  PolygonSoup soup;
  soup.name = "the surface around everything";
  for (const auto v : surface.vertices()) {
    const Point3& p = surface.point(v);
    soup.points.push_back({p.x(), p.y(), p.z()});
  }
  for (const auto f : surface.faces()) {
    std::array<Index, 3> corners{};
    std::size_t k = 0;
    for (const auto v : surface.vertices_around_face(surface.halfedge(f)))
      corners.at(k++) = static_cast<Index>(v.idx());
    soup.add_facet(corners, wrap_tag);
  }
  return soup;
}

std::array<Point3, 7> samples(const Triangle3& t) {
  return {t[0],
          t[1],
          t[2],
          CGAL::midpoint(t[0], t[1]),
          CGAL::midpoint(t[1], t[2]),
          CGAL::midpoint(t[2], t[0]),
          CGAL::centroid(t)};
}

// Returns the facet tags that wrapping loses; none if all facets have one tag, because it distinguishes
// nothing.
std::vector<Tag> lost_tags(std::span<const PolygonSoup> soups) {
  std::set<Tag> tags;
  for (const PolygonSoup& soup : soups)
    for (Index f = 0; f < soup.facet_count(); ++f) tags.insert(soup.facet_tag(f));
  if (tags.size() == 1) return {};
  tags.erase(wrap_tag);
  return {tags.begin(), tags.end()};
}

}  // namespace

PolygonSoup wrap(std::span<const PolygonSoup> soups, double alpha, double offset) {
  const Triangles input = triangles_of(soups);
  Surface surface;
  if (!input.corners.empty()) CGAL::alpha_wrap_3(input.points, input.corners, alpha, offset, surface);
  return to_soup(surface);
}

double largest_distance_from(std::span<const PolygonSoup> soups, const PolygonSoup& surface) {
  using Primitive = CGAL::AABB_triangle_primitive<Kernel, std::vector<Triangle3>::const_iterator>;
  const Triangles input = triangles_of(soups);
  std::vector<Triangle3> triangles;
  for (const facets::Corners& t : input.corners)
    triangles.emplace_back(input.points[t[0]], input.points[t[1]], input.points[t[2]]);
  if (triangles.empty()) return 0;
  CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>> tree(triangles.cbegin(), triangles.cend());
  tree.accelerate_distance_queries();
  double largest = 0;
  for (Index f = 0; f < surface.facet_count(); ++f) {
    const auto corners = surface.polygon(surface.facet_polygons(f)[0]);
    const Triangle3 t(to_cgal(surface.points[corners[0]]), to_cgal(surface.points[corners[1]]),
                      to_cgal(surface.points[corners[2]]));
    for (const Point3& p : samples(t)) largest = std::max(largest, tree.squared_distance(p));
  }
  return std::sqrt(largest);
}

std::optional<RepairedPlc> build_wrapped_plc(std::span<const PolygonSoup> soups, const PlcOptions& options,
                                             const RepairOptions& repair_options) {
  const double diagonal = triangles_of(soups).diagonal;
  const double offset = repair_options.wrap_offset * diagonal;
  std::vector<PolygonSoup> wrapped{wrap(soups, alpha_by_offset * offset, offset)};
  if (wrapped.front().facet_count() == 0) return std::nullopt;
  RepairReport report;
  report.repaired = report.wrapped = true;
  report.tolerance = repair_options.tolerance * diagonal;
  report.lost_tags = lost_tags(soups);
  report.largest_distance = largest_distance_from(soups, wrapped.front());
  try {
    return RepairedPlc{build_plc(wrapped, options), std::move(report), std::move(wrapped)};
  } catch (const PlcError&) {
    return std::nullopt;
  }
}

}  // namespace collarmesh::repairing
