#pragma once

#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "tessellation.h"

namespace collarmesh::brep {

class EdgeCurve;
class FaceSurface;

/// A search for nearest points on the exact edges and surfaces. It starts from the tessellation.
class NearestOnShape {
 public:
  explicit NearestOnShape(const Tessellation& tessellation);
  ~NearestOnShape();

  std::optional<Point> on_edge(int number, const Point& p) const;
  std::optional<Point> on_face(int number, const Point& p) const;

 private:
  const Tessellation& tessellation_;
  // By number; filled on first use.
  mutable std::map<int, std::vector<std::unique_ptr<EdgeCurve>>> curves_;
  mutable std::map<int, std::vector<std::unique_ptr<FaceSurface>>> surfaces_;
};

}  // namespace collarmesh::brep
