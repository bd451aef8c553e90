#include "facets/facet_triangulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/sort_uniquely.h"
#include "facets/exact.h"
#include "facets/plane_triangulation.h"

namespace collarmesh::facets {

namespace {

// A facet of a soup, in point indices of the draft.
struct Facet {
  Index soup = 0, number = 0;
  Tag tag = 0;
  std::vector<std::vector<Index>> loops;  // at least three corners each
  std::vector<std::array<Index, 2>> segments;
  std::vector<Index> points;
  std::vector<Point> holes;
};

struct Plane {
  Point origin;
  Vector normal;  // unit vector
};

// Returns twice the area vector of a polygon.
Vector area_vector(const std::vector<Point>& points, const std::vector<Index>& loop) {
  Vector sum{};
  for (std::size_t i = 1; i + 1 < loop.size(); ++i)
    sum = sum + cross(points[loop[i]] - points[loop[0]], points[loop[i + 1]] - points[loop[0]]);
  return sum;
}

class FacetTriangulator {
 public:
  /// If `bent` is given, cuts facets that are not planar into triangles anyway and counts them there;
  /// otherwise reports them as faults.
  FacetTriangulator(ComplexDraft& draft, Faults& faults, BentFacets* bent)
      : draft_(draft), faults_(faults), bent_(bent) {}

  void add(const Facet& facet) {
    for (const auto& [a, b] : facet.segments)
      draft_.segments.push_back({a, b, facet.loops.empty() ? facet.tag : 0, facet.soup});
    draft_.loose_points.insert(draft_.loose_points.end(), facet.points.begin(), facet.points.end());
    if (facet.loops.empty()) return;
    Plane plane;
    if (find_plane(facet, plane) && is_planar(facet, plane)) triangulate(facet, plane);
  }

 private:
  std::string name(const Facet& facet) const {
    return fmt::format("{} of {}", facet.number, draft_.soup_names[facet.soup]);
  }

  bool find_plane(const Facet& facet, Plane& plane) {
    Vector largest{};
    for (const auto& loop : facet.loops) {
      const Vector area = area_vector(draft_.points, loop);
      if (squared_norm(area) > squared_norm(largest)) largest = area;
    }
    std::size_t count = 0;
    for (const auto& loop : facet.loops) {
      count += loop.size();
      for (const Index p : loop) plane.origin = plane.origin + (draft_.points[p] - draft_.bounds.min);
    }
    plane.origin = draft_.bounds.min + plane.origin / static_cast<double>(count);
    const double length = norm(largest);
    if (length > 0) {
      plane.normal = largest / length;
      return true;
    }
    const Point& where = draft_.points[facet.loops[0][0]];
    if (bent_ != nullptr) {
      ++bent_->dropped;
      note_bent(where);
      return false;
    }
    faults_.add(PlcFault::Kind::degenerate_facet,
                fmt::format("Facet {} at {} has no area; remove it or correct its corners.", name(facet),
                            text(where)),
                facet.loops[0], where);
    return false;
  }

  bool is_planar(const Facet& facet, const Plane& plane) {
    Index worst = none;
    double deviation = 0;
    const auto measure = [&](Index p) {
      const double d = std::fabs(dot(plane.normal, draft_.points[p] - plane.origin));
      if (d <= deviation) return;
      deviation = d;
      worst = p;
    };
    for (const auto& loop : facet.loops) std::ranges::for_each(loop, measure);
    for (const auto& segment : facet.segments) std::ranges::for_each(segment, measure);
    std::ranges::for_each(facet.points, measure);
    const double limit = std::max(draft_.planar_tolerance, draft_.rounding());
    if (deviation <= limit) {
      draft_.largest_deviation = std::max(draft_.largest_deviation, deviation);
      return true;
    }
    const Point& where = draft_.points[worst];
    if (bent_ != nullptr) {
      ++bent_->split;
      note_bent(where);
      return true;
    }
    faults_.add(
        PlcFault::Kind::non_planar_polygon,
        fmt::format("Facet {} is not planar: its corner {} lies {:.3g} from its plane, {:.3g} is allowed; "
                    "cut it into triangles or raise the planar tolerance.",
                    name(facet), text(where), deviation, limit),
        {worst}, where);
    return false;
  }

  PlaneKernel::Point_2 project(const Point& p) const { return {p[(axis_ + 1) % 3], p[(axis_ + 2) % 3]}; }

  void triangulate(const Facet& facet, const Plane& plane) {
    const Vector& n = plane.normal;
    const double x = std::fabs(n.x), y = std::fabs(n.y), z = std::fabs(n.z);
    axis_ = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
    if (cut_convex_quadrangle(facet)) return;
    try {
      PlaneTriangulation plane_mesh;
      insert(facet, plane_mesh);
      mark_outside(facet, plane_mesh);
      extract(facet, n[axis_] > 0, plane_mesh);
    } catch (const PlaneTriangulation::Intersection_of_constraints_exception&) {
      const Point& where = draft_.points[facet.loops[0][0]];
      if (bent_ != nullptr) {
        ++bent_->split;
        note_bent(where);
        fan(facet);
        return;
      }
      faults_.add(PlcFault::Kind::intersection,
                  fmt::format("The edges of facet {} (near {}) cross each other; correct its polygons.",
                              name(facet), text(where)),
                  facet.loops[0], where);
    }
  }

  void note_bent(const Point& where) {
    constexpr std::size_t most_places = 100;
    if (bent_->where.size() < most_places) bent_->where.push_back(where);
  }

  // Makes a fan of triangles from the first corner of each loop, whatever its shape, so that the fan keeps
  // the edges that it shares with other facets.
  void fan(const Facet& facet) {
    for (const auto& loop : facet.loops)
      for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
        const Corners t{loop[0], loop[i], loop[i + 1]};
        if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0])
          draft_.add_triangle(t, {facet.tag, facet.soup, facet.number});
      }
  }

  // Cuts a convex quadrangle, the most frequent polygon, without a triangulation. Returns false if the facet
  // is no convex quadrangle.
  bool cut_convex_quadrangle(const Facet& facet) {
    if (facet.loops.size() > 1 || facet.loops[0].size() != 4 || !facet.segments.empty() ||
        !facet.points.empty() || !facet.holes.empty())
      return false;
    const auto& q = facet.loops[0];
    const auto at = [&](std::size_t i) -> const Point& { return draft_.points[q[i % 4]]; };
    const int turn = planar_orientation(axis_, at(0), at(1), at(2));
    if (turn == 0) return false;
    for (std::size_t i = 1; i < 4; ++i)
      if (planar_orientation(axis_, at(i), at(i + 1), at(i + 2)) != turn) return false;
    const std::size_t from = squared_distance(at(0), at(2)) <= squared_distance(at(1), at(3)) ? 0 : 1;
    for (const std::size_t i : {from, from + 2})
      draft_.add_triangle({q[i % 4], q[(i + 1) % 4], q[(i + 2) % 4]}, {facet.tag, facet.soup, facet.number});
    return true;
  }

  void insert(const Facet& facet, PlaneTriangulation& mesh) {
    corners_.clear();
    for (const auto& loop : facet.loops) corners_.insert(corners_.end(), loop.begin(), loop.end());
    for (const auto& segment : facet.segments)
      corners_.insert(corners_.end(), segment.begin(), segment.end());
    corners_.insert(corners_.end(), facet.points.begin(), facet.points.end());
    sort_uniquely(corners_);
    std::vector<std::pair<PlaneKernel::Point_2, Index>> projected;
    for (const Index p : corners_) projected.emplace_back(project(draft_.points[p]), p);
    mesh.insert(projected.begin(), projected.end());

    handles_.assign(corners_.size(), nullptr);
    for (const auto vertex : mesh.finite_vertex_handles()) handles_[position(vertex->info())] = vertex;
    const auto constrain = [&](Index a, Index b) {
      const auto va = handles_[position(a)], vb = handles_[position(b)];
      if (va != nullptr && vb != nullptr && va != vb) mesh.insert_constraint(va, vb);
    };
    for (const auto& loop : facet.loops)
      for (std::size_t i = 0; i < loop.size(); ++i) constrain(loop[i], loop[(i + 1) % loop.size()]);
    for (const auto& [a, b] : facet.segments) constrain(a, b);
  }

  std::size_t position(Index point) const {
    return static_cast<std::size_t>(std::ranges::lower_bound(corners_, point) - corners_.begin());
  }

  // Marks the faces outside the facet by their `info`.
  void mark_outside(const Facet& facet, PlaneTriangulation& mesh) {
    for (const auto face : mesh.all_face_handles()) face->info() = false;
    flood(mesh.infinite_face());
    for (const Point& hole : facet.holes) {
      const auto face = mesh.locate(project(hole));
      if (face != nullptr) flood(face);
    }
  }

  void flood(PlaneTriangulation::Face_handle start) {
    if (start->info()) return;
    start->info() = true;
    std::vector<PlaneTriangulation::Face_handle> stack{start};
    while (!stack.empty()) {
      const auto face = stack.back();
      stack.pop_back();
      for (int i = 0; i < 3; ++i) {
        const auto next = face->neighbor(i);
        if (face->is_constrained(i) || next->info()) continue;
        next->info() = true;
        stack.push_back(next);
      }
    }
  }

  void extract(const Facet& facet, bool counterclockwise, const PlaneTriangulation& mesh) {
    if (mesh.dimension() < 2) return;
    for (const auto face : mesh.finite_face_handles()) {
      if (face->info()) continue;
      Corners t{face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()};
      if (!counterclockwise) std::swap(t[1], t[2]);
      draft_.add_triangle(t, {facet.tag, facet.soup, facet.number});
    }
    // A constrained edge with the facet on both sides is a segment that the input gives.
    for (const auto& [face, i] : mesh.finite_edges()) {
      if (!face->is_constrained(i) || face->info() || face->neighbor(i)->info()) continue;
      draft_.segments.push_back(
          {face->vertex(mesh.cw(i))->info(), face->vertex(mesh.ccw(i))->info(), 0, facet.soup});
    }
  }

  ComplexDraft& draft_;
  Faults& faults_;
  BentFacets* bent_;
  unsigned axis_ = 0;  // the coordinate that projection drops
  std::vector<Index> corners_;
  std::vector<PlaneTriangulation::Vertex_handle> handles_;  // by position in corners_
};

// The hole points of a soup's facets, by facet.
class FacetHoles {
 public:
  explicit FacetHoles(const PolygonSoup& soup) : holes_(soup.facet_holes) {
    std::ranges::stable_sort(holes_, [](const auto& a, const auto& b) { return a.facet < b.facet; });
  }
  /// Returns the hole points of a facet. Call it for facets in ascending order.
  std::vector<Point> take(Index facet) {
    std::vector<Point> points;
    for (; next_ < holes_.size() && holes_[next_].facet <= facet; ++next_)
      if (holes_[next_].facet == facet) points.push_back(holes_[next_].point);
    return points;
  }

 private:
  std::vector<PolygonSoup::FacetHole> holes_;
  std::size_t next_ = 0;
};

// Adds a polygon to the facet as a loop, a segment or a point, in indices of the draft and without repeated
// corners.
void add_polygon(std::span<const Index> polygon, const std::vector<Index>& merged, Facet& facet) {
  std::vector<Index> loop;
  for (const Index corner : polygon)
    if (loop.empty() || loop.back() != merged[corner]) loop.push_back(merged[corner]);
  while (loop.size() > 1 && loop.front() == loop.back()) loop.pop_back();
  if (loop.size() == 1 && polygon.size() == 1) facet.points.push_back(loop[0]);
  if (loop.size() == 2 && polygon.size() == 2) facet.segments.push_back({loop[0], loop[1]});
  if (loop.size() > 2) facet.loops.push_back(std::move(loop));
}

void triangulate(std::span<const PolygonSoup> soups, const PointMap& map, ComplexDraft& draft, Faults& faults,
                 BentFacets* bent) {
  FacetTriangulator triangulator(draft, faults, bent);
  for (Index s = 0; s < soups.size(); ++s) {
    const PolygonSoup& soup = soups[s];
    const std::vector<Index>& merged = map.merged[s];
    FacetHoles holes(soup);
    for (Index f = 0; f < soup.facet_count(); ++f) {
      const auto [first, last] = soup.facet_polygons(f);
      if (last - first == 1 && soup.polygon(first).size() == 3) {
        const auto corners = soup.polygon(first);
        const Corners t{merged[corners[0]], merged[corners[1]], merged[corners[2]]};
        if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0])
          draft.add_triangle(t, {soup.facet_tag(f), s, f});
        else
          ++draft.cleanup.degenerate_triangles;
        continue;
      }
      Facet facet{s, f, soup.facet_tag(f), {}, {}, {}, holes.take(f)};
      for (Index q = first; q < last; ++q) add_polygon(soup.polygon(q), merged, facet);
      triangulator.add(facet);
    }
    for (const auto& segment : soup.segments)
      if (merged[segment.a] != merged[segment.b])
        draft.segments.push_back({merged[segment.a], merged[segment.b], segment.tag, s});
  }
}

}  // namespace

void triangulate_facets(std::span<const PolygonSoup> soups, const PointMap& map, ComplexDraft& draft,
                        Faults& faults) {
  triangulate(soups, map, draft, faults, nullptr);
}

BentFacets triangulate_any_facets(std::span<const PolygonSoup> soups, const PointMap& map,
                                  ComplexDraft& draft) {
  BentFacets bent;
  Faults none_found;
  triangulate(soups, map, draft, none_found, &bent);
  return bent;
}

}  // namespace collarmesh::facets
