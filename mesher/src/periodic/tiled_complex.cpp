#include "periodic/tiled_complex.h"

namespace collarmesh::periodicity {

namespace {

std::vector<Index> shifted(std::vector<Index> indices, std::size_t by) {
  for (Index& i : indices) i += static_cast<Index>(by);
  return indices;
}

Vector turned(const Motion& motion, const Vector& v) {
  return {dot(motion.rows[0], v), dot(motion.rows[1], v), dot(motion.rows[2], v)};
}

void add_copy(const Plc& of, const Motion& motion, std::size_t copy, Plc& all) {
  const std::size_t points = copy * of.points.size(), vertices = copy * of.vertices.size(),
                    curves = copy * of.curves.size(), patches = copy * of.patches.size(),
                    triangles = copy * of.triangles.size(), regions = copy * of.regions.size();
  all.regions.insert(all.regions.end(), of.regions.begin(), of.regions.end());
  for (const Point& p : of.points) {
    all.points.push_back(motion(p));
    all.bounds.add(all.points.back());
  }
  for (Plc::Vertex vertex : of.vertices) {
    vertex.point += static_cast<Index>(points);
    vertex.curves = shifted(std::move(vertex.curves), curves);
    vertex.patches = shifted(std::move(vertex.patches), patches);
    all.vertices.push_back(std::move(vertex));
  }
  for (Plc::Curve curve : of.curves) {
    curve.points = shifted(std::move(curve.points), points);
    for (Index& end : curve.ends)
      if (end != none) end += static_cast<Index>(vertices);
    curve.patches = shifted(std::move(curve.patches), patches);
    all.curves.push_back(std::move(curve));
  }
  for (Plc::Patch patch : of.patches) {
    patch.first_triangle += static_cast<Index>(triangles);
    for (Index& region : patch.regions)
      if (region != 0) region += static_cast<Index>(regions);
    patch.normal = turned(motion, patch.normal);
    patch.origin = motion(patch.origin);
    patch.curves = shifted(std::move(patch.curves), curves);
    patch.vertices = shifted(std::move(patch.vertices), vertices);
    all.patches.push_back(std::move(patch));
  }
  for (Plc::Triangle triangle : of.triangles) {
    for (Index& p : triangle.points) p += static_cast<Index>(points);
    triangle.patch += static_cast<Index>(patches);
    all.triangles.push_back(triangle);
  }
}

Plc tiled(const Plc& of, const std::vector<Motion>& copies) {
  Plc all;
  all.planar_tolerance = of.planar_tolerance;
  all.largest_deviation = of.largest_deviation;
  for (std::size_t k = 0; k < copies.size(); ++k) add_copy(of, copies[k], k, all);
  return all;
}

SurfaceTolerance tiled(const SurfaceTolerance& of, const Plc& plc, const Plc& all, std::size_t copies) {
  if (!of.varies()) return of;
  std::vector<double> triangles;
  triangles.reserve(all.triangles.size());
  for (std::size_t k = 0; k < copies; ++k)
    for (Index t = 0; t < plc.triangles.size(); ++t) triangles.push_back(of.at_triangle(t));
  return {all, std::move(triangles), of.largest()};
}

}  // namespace

TiledComplex::TiledComplex(const Plc& of, const SurfaceTolerance& given, const std::vector<Motion>& copies)
    : plc(tiled(of, copies)), tolerance(tiled(given, of, plc, copies.size())) {}

}  // namespace collarmesh::periodicity
