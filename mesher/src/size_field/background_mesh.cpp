// Locates places in a mesh, and makes a size field from sizes at its points.
#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "collarmesh/error.h"
#include "collarmesh/locate.h"
#include "collarmesh/size_field.h"
#include "common/box_tree.h"
#include "common/layer_tets.h"
#include "location/triangle_hierarchy.h"

namespace collarmesh {

namespace {

class BackgroundMesh {
 public:
  explicit BackgroundMesh(const TetMesh& mesh)
      : points_(mesh.points),
        tets_(mesh.tets),
        boxes_(boxes_of(mesh)),
        nearest_(points_, as_triangles(points_.size())) {}

  MeshPlace place_of(const Point& p) const {
    MeshPlace place;
    boxes_.for_each_near_segment(p, p, [&](Index tet) {
      if (place.tet == none && shares_in(tet, p, place.shares)) place.tet = tet;
    });
    if (place.tet == none) nearest_.squared_distance_to(p, INFINITY, &place.nearest);
    return place;
  }

  /// Interpolates numbers given at the points: linearly in the tets; outside them, returns the value at the
  /// nearest point.
  double value_at(const Point& p, const std::vector<double>& values) const {
    const MeshPlace place = place_of(p);
    if (place.tet == none) return values[place.nearest];
    double value = 0;
    for (unsigned i = 0; i < 4; ++i) value += place.shares[i] * values[tets_[place.tet][i]];
    return value;
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

  /// Computes the barycentric coordinates of p in a tet. Returns false if p is outside.
  bool shares_in(Index tet, const Point& p, std::array<double, 4>& shares) const {
    const auto& v = tets_[tet];
    std::array<Point, 4> corners;
    for (unsigned i = 0; i < 4; ++i) corners[i] = points_[v[i]];
    const double volume = six_volume(corners[0], corners[1], corners[2], corners[3]);
    if (!(volume > 0)) return false;
    for (unsigned i = 0; i < 4; ++i) {
      auto with_p = corners;
      with_p[i] = p;
      shares[i] = six_volume(with_p[0], with_p[1], with_p[2], with_p[3]) / volume;
      if (shares[i] < -1e-9) return false;
    }
    return true;
  }

  std::vector<Point> points_;
  std::vector<std::array<Index, 4>> tets_;
  BoxTree boxes_;
  TriangleHierarchy nearest_;
};

}  // namespace

namespace {

/// Returns the mesh in first order, with its layers cut into tets.
TetMesh straight_tets(TetMesh mesh) {
  mesh.tet_mid_nodes.clear();
  mesh.face_mid_nodes.clear();
  mesh.edge_mid_nodes.clear();
  mesh.layers.prism_mid_nodes.clear();
  mesh.layers.pyramid_mid_nodes.clear();
  mesh.layers.quad_mid_nodes.clear();
  return tets_of_layers(mesh);
}

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
  const auto background =
      std::make_shared<const BackgroundMesh>(mesh.layers.empty() ? mesh : straight_tets(mesh));
  return [background, values](const Point& p) { return background->value_at(p, values); };
}

std::vector<MeshPlace> locate(const TetMesh& mesh, std::span<const Point> points) {
  require_tets_alone(mesh, "places in a mesh");
  const BackgroundMesh background(mesh);
  std::vector<MeshPlace> places;
  places.reserve(points.size());
  for (const Point& p : points) places.push_back(background.place_of(p));
  return places;
}

}  // namespace collarmesh
