#include "repair/polygon_cutter.h"

#include <cmath>
#include <map>
#include <set>

#include "facets/plane_triangulation.h"

namespace collarmesh::repairing {

namespace {

using facets::PlaneTriangulation;

class PolygonCutter {
 public:
  PolygonCutter(const std::vector<Point>& points, const Vector& normal, const PolygonCuts& cuts)
      : points_(points), cuts_(cuts) {
    const double x = std::fabs(normal.x), y = std::fabs(normal.y), z = std::fabs(normal.z);
    axis_ = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
    turned_ = normal[axis_] < 0;
  }

  std::optional<std::vector<facets::Corners>> run() {
    try {
      for (const auto* list : {&cuts_.border, &cuts_.inside})
        for (const Index p : *list)
          if (!insert(p)) return std::nullopt;
      for (std::size_t i = 0; i < cuts_.border.size(); ++i)
        mesh_.insert_constraint(handles_[cuts_.border[i]], handles_[next(i)]);
      for (const auto& [a, b] : cuts_.edges)
        if (handles_.count(a) > 0 && handles_.count(b) > 0 && a != b)
          mesh_.insert_constraint(handles_[a], handles_[b]);
    } catch (const PlaneTriangulation::Intersection_of_constraints_exception&) {
      return std::nullopt;
    }
    if (mesh_.dimension() < 2) return std::nullopt;  // all points lie on one line
    mark_outside();
    return triangles();
  }

 private:
  Index next(std::size_t i) const { return cuts_.border[(i + 1) % cuts_.border.size()]; }

  // Inserts a point. Returns false if it coincides with another one in the projection.
  bool insert(Index p) {
    const auto [at, added] = handles_.try_emplace(p);
    if (!added) return true;
    const std::size_t before = mesh_.number_of_vertices();
    at->second = mesh_.insert({points_[p][(axis_ + 1) % 3], points_[p][(axis_ + 2) % 3]});
    if (mesh_.number_of_vertices() == before) return false;
    at->second->info() = p;
    return true;
  }

  void mark_outside() {
    std::set<Edge> border;
    for (std::size_t i = 0; i < cuts_.border.size(); ++i) border.insert(edge_key(cuts_.border[i], next(i)));
    for (const auto face : mesh_.all_face_handles()) face->info() = false;
    std::vector<PlaneTriangulation::Face_handle> stack{mesh_.infinite_face()};
    stack.back()->info() = true;
    while (!stack.empty()) {
      const auto face = stack.back();
      stack.pop_back();
      for (int i = 0; i < 3; ++i) {
        const auto across = face->neighbor(i);
        if (across->info()) continue;
        const auto a = face->vertex(mesh_.cw(i)), b = face->vertex(mesh_.ccw(i));
        if (!mesh_.is_infinite(a) && !mesh_.is_infinite(b) &&
            border.count(edge_key(a->info(), b->info())) > 0)
          continue;
        across->info() = true;
        stack.push_back(across);
      }
    }
  }

  // Returns the triangles; nothing if their border is not the polygon.
  std::optional<std::vector<facets::Corners>> triangles() const {
    std::vector<facets::Corners> result;
    std::set<Edge> sides;  // directed sides of the triangles
    for (const auto face : mesh_.finite_face_handles()) {
      if (face->info()) continue;
      facets::Corners t{face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()};
      if (turned_) std::swap(t[1], t[2]);
      result.push_back(t);
      for (unsigned i = 0; i < 3; ++i) sides.insert({t[i], t[(i + 1) % 3]});
    }
    for (std::size_t i = 0; i < cuts_.border.size(); ++i)
      if (sides.count({cuts_.border[i], next(i)}) == 0) return std::nullopt;
    return result;
  }

  const std::vector<Point>& points_;
  const PolygonCuts& cuts_;
  unsigned axis_;
  bool turned_;
  PlaneTriangulation mesh_;
  std::map<Index, PlaneTriangulation::Vertex_handle> handles_;
};

}  // namespace

std::optional<std::vector<facets::Corners>> cut_polygon(const std::vector<Point>& points,
                                                        const Vector& normal, const PolygonCuts& cuts) {
  return PolygonCutter(points, normal, cuts).run();
}

}  // namespace collarmesh::repairing
