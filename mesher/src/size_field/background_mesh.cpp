// A size field that is given on the points of a mesh.
#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "collarmesh/error.h"
#include "collarmesh/size_field.h"
#include "common/box_tree.h"
#include "location/triangle_hierarchy.h"

namespace collarmesh {

namespace {

class BackgroundMesh {
 public:
  BackgroundMesh(const TetMesh& mesh, const std::vector<double>& values)
      : points_(mesh.points),
        tets_(mesh.tets),
        values_(values),
        boxes_(boxes_of(mesh)),
        nearest_(points_, as_triangles(points_.size())) {}

  double at(const Point& p) const {
    double found = 0;
    boxes_.for_each_near_segment(p, p, [&](Index tet) {
      if (found == 0) found = value_in(tet, p);
    });
    if (found > 0) return found;
    Index nearest = 0;
    nearest_.squared_distance_to(p, INFINITY, &nearest);
    return values_[nearest];
  }

 private:
  static std::vector<Box> boxes_of(const TetMesh& mesh) {
    std::vector<Box> boxes;
    for (const auto& tet : mesh.tets) {
      Box box;
      for (const Index v : tet) box.add(mesh.points[v]);
      boxes.push_back(box);
    }
    return boxes;
  }

  static std::vector<std::array<Index, 3>> as_triangles(std::size_t points) {
    std::vector<std::array<Index, 3>> triangles;
    for (Index i = 0; i < points; ++i) triangles.push_back({i, i, i});
    return triangles;
  }

  // 0 when p is outside.
  double value_in(Index tet, const Point& p) const {
    const auto& v = tets_[tet];
    std::array<Point, 4> corners;
    for (unsigned i = 0; i < 4; ++i) corners[i] = points_[v[i]];
    const double volume = six_volume(corners[0], corners[1], corners[2], corners[3]);
    if (!(volume > 0)) return 0;
    double value = 0;
    for (unsigned i = 0; i < 4; ++i) {
      auto with_p = corners;
      with_p[i] = p;
      const double share = six_volume(with_p[0], with_p[1], with_p[2], with_p[3]) / volume;
      if (share < -1e-9) return 0;
      value += share * values_[v[i]];
    }
    return value;
  }

  std::vector<Point> points_;
  std::vector<std::array<Index, 4>> tets_;
  std::vector<double> values_;
  BoxTree boxes_;
  TriangleHierarchy nearest_;
};

}  // namespace

SizeField size_field_on_mesh(const TetMesh& mesh, const std::vector<double>& values) {
  if (values.size() != mesh.points.size())
    throw OptionError(fmt::format("a size field of {} values does not fit a mesh of {} points", values.size(),
                                  mesh.points.size()));
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!(values[i] > 0) || !std::isfinite(values[i]))
      throw OptionError(
          fmt::format("the size field is {} at point {}, ({:.9g}, {:.9g}, {:.9g}); sizes must be positive",
                      values[i], i, mesh.points[i].x, mesh.points[i].y, mesh.points[i].z));
  const auto background = std::make_shared<const BackgroundMesh>(mesh, values);
  return [background](const Point& p) { return background->at(p); };
}

}  // namespace collarmesh
