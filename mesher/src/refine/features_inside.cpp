#include "refine/features_inside.h"

#include <algorithm>

namespace collarmesh {

namespace {

bool outside(const Plc::Patch& patch) { return patch.regions[0] == 0 && patch.regions[1] == 0; }

// The features to keep, and their new numbers by old ones; `none` for removed features.
struct KeptNumbers {
  std::vector<Index> kept, number;

  template <class Features, class Keep>
  KeptNumbers(const Features& features, const Keep& keep) : number(features.size(), none) {
    for (Index i = 0; i < features.size(); ++i) {
      if (!keep(features[i])) continue;
      number[i] = static_cast<Index>(kept.size());
      kept.push_back(i);
    }
  }
  bool keeps(Index i) const { return number[i] != none; }
  // Keeps and renumbers the features of a list; it stays sorted.
  void apply(std::vector<Index>& list) const {
    std::erase_if(list, [&](Index i) { return !keeps(i); });
    for (Index& i : list) i = number[i];
  }
};

}  // namespace

FeaturesInside::FeaturesInside(const Plc& complex) : complex_(complex) {
  if (std::none_of(complex.patches.begin(), complex.patches.end(), outside)) return;
  const KeptNumbers patches(complex.patches, [](const Plc::Patch& patch) { return !outside(patch); });
  const auto keeps_some = [](const KeptNumbers& of, const std::vector<Index>& list) {
    return std::any_of(list.begin(), list.end(), [&](Index i) { return of.keeps(i); });
  };
  const KeptNumbers curves(complex.curves, [&](const Plc::Curve& curve) {
    return curve.patches.empty() || keeps_some(patches, curve.patches);
  });
  const KeptNumbers vertices(complex.vertices, [&](const Plc::Vertex& vertex) {
    return (vertex.patches.empty() && vertex.curves.empty()) || keeps_some(patches, vertex.patches) ||
           keeps_some(curves, vertex.curves);
  });

  Plc& reduced = reduced_.emplace(complex);
  reduced.triangles.clear();
  reduced.patches.clear();
  reduced.curves.clear();
  reduced.vertices.clear();
  for (const Index p : patches.kept) {
    Plc::Patch& patch = reduced.patches.emplace_back(complex.patches[p]);
    patch.first_triangle = static_cast<Index>(reduced.triangles.size());
    for (Index i = 0; i < patch.triangle_count; ++i)
      reduced.triangles.push_back(
          {complex.triangles[complex.patches[p].first_triangle + i].points, patches.number[p]});
    curves.apply(patch.curves);
    vertices.apply(patch.vertices);
  }
  for (const Index c : curves.kept) {
    Plc::Curve& curve = reduced.curves.emplace_back(complex.curves[c]);
    for (Index& end : curve.ends)
      if (end != none) end = vertices.number[end];
    patches.apply(curve.patches);
  }
  for (const Index v : vertices.kept) {
    Plc::Vertex& vertex = reduced.vertices.emplace_back(complex.vertices[v]);
    curves.apply(vertex.curves);
    patches.apply(vertex.patches);
  }
  vertices_ = vertices.kept;
  curves_ = curves.kept;
  patches_ = patches.kept;
}

void FeaturesInside::restore_numbers(TetMesh& mesh) const {
  if (!reduced_) return;
  const auto restore = [](Index& feature, const std::vector<Index>& whole) {
    if (feature != none) feature = whole[feature];
  };
  for (Index& patch : mesh.face_patch) restore(patch, patches_);
  for (Index& curve : mesh.edge_curve) restore(curve, curves_);
  for (TetMesh::VertexFeature& feature : mesh.features)
    if (feature.dimension < 3)
      restore(feature.feature, feature.dimension == 0   ? vertices_
                               : feature.dimension == 1 ? curves_
                                                        : patches_);
}

}  // namespace collarmesh
