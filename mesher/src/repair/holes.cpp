#include "repair/holes.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>

#include <algorithm>
#include <map>

#include "common/disjoint_sets.h"
#include "facets/edges.h"

namespace collarmesh::repairing {

namespace {

using namespace facets;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

constexpr std::size_t most_edges_for_cubic_time = 200;
constexpr std::size_t work_of_an_edge = 1000;  // work of an edge around a hole, in units of `Work`

// The directed edges, by soup, that more triangles of the soup use than the opposite edges. The missing
// surface would use them in the opposite direction.
struct OpenEdges {
  std::map<Index, std::vector<std::array<Index, 3>>> of_soup;  // from, to, a triangle there
};

OpenEdges find_open_edges(const ComplexDraft& draft) {
  OpenEdges open;
  const EdgeTable edges(draft.triangles, draft.points.size());
  std::vector<std::pair<Index, int>> balance;  // a soup, and how many more of its triangles have the
                                               // edge in ascending than in descending direction
  for (Index e = 0; e < edges.size(); ++e) {
    balance.clear();
    for (const Index side : edges.sides(e)) {
      const Index soup = draft.origins[side / 3].soup;
      auto at = std::find_if(balance.begin(), balance.end(), [&](const auto& b) { return b.first == soup; });
      if (at == balance.end()) at = balance.insert(at, {soup, 0});
      at->second += ascending(draft.triangles, side) ? 1 : -1;
    }
    for (const auto& [soup, sum] : balance) {
      if (sum == 0 || draft.soup_is_complex[soup]) continue;
      const auto [low, high] = edges.ends(e);
      Index triangle = none;
      for (const Index side : edges.sides(e))
        if (draft.origins[side / 3].soup == soup && ascending(draft.triangles, side) == (sum > 0))
          triangle = side / 3;
      for (int i = 0; i < std::abs(sum); ++i)
        open.of_soup[soup].push_back(sum > 0 ? std::array{low, high, triangle}
                                             : std::array{high, low, triangle});
    }
  }
  return open;
}

// Compares points by coordinates, so that the result does not depend on the order of points and facets.
bool comes_before(const ComplexDraft& draft, Index p, Index q) {
  const Point &a = draft.points[p], &b = draft.points[q];
  return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
}

using Loop = std::vector<std::array<Index, 3>>;

// Rotates the loop so that it starts at the first of its points by `comes_before`.
void start_first(const ComplexDraft& draft, Loop& loop) {
  const auto first = std::min_element(loop.begin(), loop.end(), [&](const auto& e, const auto& f) {
    return comes_before(draft, e[0], f[0]);
  });
  std::rotate(loop.begin(), first, loop.end());
}

// Finds closed curves of directed edges, and separates curves that meet in a point. The edges are ordered by
// coordinates, so the curves and their starts do not depend on the order of the facets.
std::vector<Loop> find_loops(const ComplexDraft& draft, std::vector<std::array<Index, 3>> edges) {
  std::sort(edges.begin(), edges.end(), [&](const auto& e, const auto& f) {
    if (comes_before(draft, e[0], f[0])) return true;
    return !comes_before(draft, f[0], e[0]) && comes_before(draft, e[1], f[1]);
  });
  std::multimap<Index, std::size_t> from;
  for (std::size_t i = 0; i < edges.size(); ++i) from.emplace(edges[i][0], i);
  std::vector<bool> used(edges.size(), false);
  std::vector<Loop> loops;
  for (std::size_t start = 0; start < edges.size(); ++start) {
    if (used[start]) continue;
    Loop path;
    std::map<Index, std::size_t> place;  // position of a point in the path
    std::size_t next = start;
    for (;;) {
      used[next] = true;
      place[edges[next][0]] = path.size();
      path.push_back(edges[next]);
      const Index at = edges[next][1];
      if (const auto seen = place.find(at); seen != place.end()) {
        const auto first = path.begin() + static_cast<std::ptrdiff_t>(seen->second);
        loops.emplace_back(first, path.end());
        start_first(draft, loops.back());
        for (auto e = first; e != path.end(); ++e) place.erase((*e)[0]);
        path.erase(first, path.end());
      }
      const auto [low, high] = from.equal_range(at);
      const auto way = std::find_if(low, high, [&](const auto& entry) { return !used[entry.second]; });
      if (way == high) break;
      next = way->second;
    }
  }
  return loops;
}

// The areas of surfaces: for each triangle, the area of the surface that it belongs to.
class SurfaceAreas {
 public:
  explicit SurfaceAreas(const ComplexDraft& draft) : sets_(draft.triangles.size()) {
    const EdgeTable edges(draft.triangles, draft.points.size());
    for (Index e = 0; e < edges.size(); ++e)
      for (const Index side : edges.sides(e)) sets_.unite(side / 3, edges.sides(e)[0] / 3);
    for (Index t = 0; t < draft.triangles.size(); ++t)
      area_[sets_.find(t)] += area_of(draft, draft.triangles[t]);
  }
  double around(Index triangle) { return area_[sets_.find(triangle)]; }

 private:
  DisjointSets sets_;
  std::map<Index, double> area_;
};

// Returns a lower bound on the area of surfaces with this border: the length of the border's area vector.
double least_area(const ComplexDraft& draft, const Loop& loop) {
  const Point& origin = draft.points[loop[0][0]];
  Vector twice{};
  for (const auto& edge : loop)
    twice = twice + cross(draft.points[edge[0]] - origin, draft.points[edge[1]] - origin);
  return 0.5 * norm(twice);
}

std::vector<Corners> triangulate(const ComplexDraft& draft, const Loop& loop) {
  // The hole's triangles use the edges around it in the opposite direction.
  std::vector<Index> corners;
  corners.reserve(loop.size());
  for (auto e = loop.rbegin(); e != loop.rend(); ++e) corners.push_back((*e)[1]);
  if (corners.size() == 3) return {{corners[0], corners[1], corners[2]}};
  std::vector<Kernel::Point_3> polyline;
  polyline.reserve(corners.size());
  for (const Index p : corners)
    polyline.emplace_back(draft.points[p].x, draft.points[p].y, draft.points[p].z);
  struct Face {
    int a, b, c;
    Face(int i, int j, int k) : a(i), b(j), c(k) {}
  };
  std::vector<Face> faces;
  // Tries the edges of the Delaunay triangulation of the points first; if these contain no triangulation of a
  // short curve, tries all edges, which takes cubic time.
  CGAL::Polygon_mesh_processing::triangulate_hole_polyline(
      polyline, std::back_inserter(faces),
      CGAL::parameters::do_not_use_cubic_algorithm(corners.size() > most_edges_for_cubic_time));
  std::vector<Corners> triangles;
  triangles.reserve(faces.size());
  const auto at = [&](int i) { return corners[static_cast<std::size_t>(i)]; };
  for (const Face& face : faces) triangles.push_back({at(face.a), at(face.b), at(face.c)});
  // The first edge shows which orientation the library has chosen.
  for (const Corners& t : triangles)
    for (unsigned i = 0; i < 3; ++i)
      if (t[i] == corners[1] && t[(i + 1) % 3] == corners[0]) {
        for (Corners& turned : triangles) std::swap(turned[1], turned[2]);
        return triangles;
      }
  return triangles;
}

}  // namespace

std::size_t count_open_edges(const ComplexDraft& draft) {
  std::size_t count = 0;
  for (const auto& [soup, edges] : find_open_edges(draft).of_soup) count += edges.size();
  return count;
}

std::vector<FilledHole> fill_holes(ComplexDraft& draft, Tag first_tag, Work* work, double largest_share) {
  std::vector<FilledHole> filled;
  const OpenEdges open = find_open_edges(draft);
  if (open.of_soup.empty()) return filled;
  SurfaceAreas surfaces(draft);
  Tag tag = first_tag;
  for (const auto& [soup, edges] : open.of_soup)
    for (const Loop& loop : find_loops(draft, edges)) {
      if (loop.size() < 3) continue;
      const double most_area = largest_share * surfaces.around(loop[0][2]);
      if (least_area(draft, loop) > most_area) continue;
      if (work != nullptr) work->spend(work_of_an_edge * loop.size());
      const std::vector<Corners> triangles = triangulate(draft, loop);
      FilledHole hole;
      hole.tag = tag;
      hole.edges = loop.size();
      for (const Corners& t : triangles) hole.area += area_of(draft, t);
      for (const auto& edge : loop) {
        hole.length += distance(draft.points[edge[0]], draft.points[edge[1]]);
        hole.where = hole.where + (1.0 / static_cast<double>(loop.size())) * draft.points[edge[0]];
      }
      if (triangles.empty() || hole.area > most_area) continue;
      for (const Corners& t : triangles) draft.add_triangle(t, {tag, soup, 0, true});
      filled.push_back(hole);
      ++tag;
    }
  return filled;
}

}  // namespace collarmesh::repairing
