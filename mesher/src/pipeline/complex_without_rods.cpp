#include "pipeline/complex_without_rods.h"

#include <algorithm>
#include <utility>

namespace collarmesh::pipeline {

namespace {

/// Returns the old numbers of the features that are kept, in order. Sets `numbers` to the new numbers, by old
/// number; none for dropped features.
std::vector<Index> kept(const std::vector<bool>& dropped, std::vector<Index>& numbers) {
  std::vector<Index> kept;
  numbers.assign(dropped.size(), none);
  for (Index i = 0; i < dropped.size(); ++i) {
    if (dropped[i]) continue;
    numbers[i] = static_cast<Index>(kept.size());
    kept.push_back(i);
  }
  return kept;
}

/// Gives sorted features their new numbers, and leaves out those that are dropped.
void renumber(std::vector<Index>& features, const std::vector<Index>& numbers) {
  for (Index& feature : features) feature = numbers[feature];
  std::erase(features, none);
}

class Removal {
 public:
  Removal(const Plc& whole, const std::vector<SheathedRod>& rods)
      : whole_(whole),
        rods_(rods),
        regions_(whole.regions.size(), false),
        patches_(whole.patches.size(), false),
        curves_(whole.curves.size(), false),
        vertices_(whole.vertices.size(), false),
        filled_(whole.patches.size()) {
    for (const SheathedRod& rod : rods) {
      regions_[rod.region] = true;
      patches_[rod.patch] = true;
      for (const SheathedRod::End& end : rod.ends) {
        patches_[end.patch] = curves_[end.curve] = true;
        filled_[end.host].push_back(end.patch);
      }
    }
    for (Index v = 0; v < vertices_.size(); ++v)
      vertices_[v] = std::ranges::any_of(whole.vertices[v].curves, [&](Index c) { return curves_[c]; });
  }

  /// Returns whether the vertices to drop lie on no curve that is kept.
  bool is_possible() const {
    for (Index v = 0; v < vertices_.size(); ++v)
      if (vertices_[v] &&
          !std::ranges::all_of(whole_.vertices[v].curves, [&](Index c) { return curves_[c]; }))
        return false;
    return true;
  }

  ComplexWithoutRods run() {
    ComplexWithoutRods made;
    std::vector<Index> regions, patches, curves, vertices;
    made.region_of = kept(regions_, regions);
    made.patch_of = kept(patches_, patches);
    made.curve_of = kept(curves_, curves);
    made.vertex_of = kept(vertices_, vertices);
    Plc& plc = made.plc;
    plc.points = whole_.points;
    plc.names = whole_.names;
    plc.bounds = whole_.bounds;
    plc.planar_tolerance = whole_.planar_tolerance;
    plc.largest_deviation = whole_.largest_deviation;
    plc.numbered_patches = whole_.numbered_patches;
    plc.numbered_curves = whole_.numbered_curves;
    for (const Index r : made.region_of) plc.regions.push_back(whole_.regions[r]);
    for (const SheathedRod& rod : rods_)
      plc.regions[regions[rod.around]].volume += whole_.regions[rod.region].volume;
    for (const Index p : made.patch_of) {
      Plc::Patch patch = whole_.patches[p];
      renumber(patch.curves, curves);
      renumber(patch.vertices, vertices);
      for (Index& r : patch.regions) r = regions[r];
      patch.first_triangle = static_cast<Index>(plc.triangles.size());
      add_triangles(made, p, false);
      for (const Index end : filled_[p])
        add_triangles(made, end, dot(whole_.patches[end].normal, patch.normal) < 0);
      patch.triangle_count = static_cast<Index>(plc.triangles.size()) - patch.first_triangle;
      for (Index t = patch.first_triangle; t < plc.triangles.size(); ++t)
        plc.triangles[t].patch = static_cast<Index>(plc.patches.size());
      plc.patches.push_back(std::move(patch));
    }
    for (const Index c : made.curve_of) {
      Plc::Curve& curve = plc.curves.emplace_back(whole_.curves[c]);
      for (Index& end : curve.ends)
        if (end != none) end = vertices[end];
      renumber(curve.patches, patches);
    }
    for (const Index v : made.vertex_of) {
      Plc::Vertex& vertex = plc.vertices.emplace_back(whole_.vertices[v]);
      renumber(vertex.curves, curves);
      renumber(vertex.patches, patches);
    }
    for (const SheathedRod& rod : rods_)
      for (const Point& seed : rod.seeds) {
        plc.vertices.emplace_back().point = static_cast<Index>(plc.points.size());
        plc.points.push_back(seed);
        made.vertex_of.push_back(none);
      }
    return made;
  }

 private:
  void add_triangles(ComplexWithoutRods& made, Index patch, bool turned) const {
    const Plc::Patch& of = whole_.patches[patch];
    for (Index t = of.first_triangle; t < of.first_triangle + of.triangle_count; ++t) {
      Plc::Triangle& triangle = made.plc.triangles.emplace_back(whole_.triangles[t]);
      if (turned) std::swap(triangle.points[1], triangle.points[2]);
      made.triangle_of.push_back(t);
    }
  }

  const Plc& whole_;
  const std::vector<SheathedRod>& rods_;
  std::vector<bool> regions_, patches_, curves_, vertices_;  // whether they are dropped
  std::vector<std::vector<Index>> filled_;                   // by host: the patches at ends of rods there
};

}  // namespace

SurfaceTolerance ComplexWithoutRods::tolerance_from(const SurfaceTolerance& whole) const {
  if (!whole.varies()) return whole;
  std::vector<double> triangles;
  triangles.reserve(triangle_of.size());
  for (const Index t : triangle_of) triangles.push_back(whole.at_triangle(t));
  return {plc, std::move(triangles), whole.largest()};
}

std::optional<ComplexWithoutRods> complex_without_rods(const Plc& whole,
                                                       const std::vector<SheathedRod>& rods) {
  Removal removal(whole, rods);
  if (!removal.is_possible()) return std::nullopt;
  return removal.run();
}

}  // namespace collarmesh::pipeline
