#include "shells/chosen_patches.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "collarmesh/error.h"
#include "common/named_tags.h"

namespace collarmesh::shells {

namespace {

std::set<Tag> tags_of(const Plc& plc, const std::vector<std::string>& names) {
  std::set<Tag> chosen;
  for (const std::string& name : names) {
    const std::set<Tag> tags = tags_named(name, 2, plc.names);
    if (std::none_of(plc.patches.begin(), plc.patches.end(),
                     [&](const Plc::Patch& patch) { return tags.contains(patch.tag); }))
      throw OptionError(
          fmt::format("faces: no patch is called '{}'; the patches are {}", name, list_of_patches(plc)));
    chosen.insert(tags.begin(), tags.end());
  }
  return chosen;
}

/// The new numbers of features by old number, none if they are not kept, and the old numbers by new number.
struct Renumbering {
  std::vector<Index> number, old;

  explicit Renumbering(std::size_t count) : number(count, none) {}
  void keep(Index i) {
    if (number[i] != none) return;
    number[i] = static_cast<Index>(old.size());
    old.push_back(i);
  }
  /// Returns the new numbers of the kept entries of a list, sorted.
  std::vector<Index> operator()(const std::vector<Index>& list) const {
    std::vector<Index> kept;
    for (const Index i : list)
      if (number[i] != none) kept.push_back(number[i]);
    std::sort(kept.begin(), kept.end());
    return kept;
  }
};

/// The builder of a complex of the patches with some tags.
class NamedPart {
 public:
  NamedPart(const Plc& whole, const std::set<Tag>& tags)
      : whole_(whole),
        patches_(whole.patches.size()),
        curves_(whole.curves.size()),
        vertices_(whole.vertices.size()),
        points_(whole.points.size()) {
    for (Index p = 0; p < whole.patches.size(); ++p)
      if (tags.contains(whole.patches[p].tag)) patches_.keep(p);
    for (const Index p : patches_.old) {
      for (const Index c : whole.patches[p].curves) curves_.keep(c);
      for (const Index v : whole.patches[p].vertices) vertices_.keep(v);
    }
  }

  ChosenPatches make() {
    part_.regions = whole_.regions;
    part_.names = whole_.names;
    part_.numbered_patches = whole_.numbered_patches;
    part_.numbered_curves = whole_.numbered_curves;
    part_.planar_tolerance = whole_.planar_tolerance;
    part_.largest_deviation = whole_.largest_deviation;
    part_.cleanup = whole_.cleanup;
    for (const Index p : patches_.old) add(whole_.patches[p]);
    for (const Index c : curves_.old) add(whole_.curves[c]);
    for (const Index v : vertices_.old) add(whole_.vertices[v]);
    for (const Index p : points_.old) {
      part_.points.push_back(whole_.points[p]);
      part_.bounds.add(whole_.points[p]);
    }
    return {std::move(part_), std::move(patches_.old), std::move(curves_.old)};
  }

 private:
  Index point(Index p) {
    points_.keep(p);
    return points_.number[p];
  }

  void add(Plc::Patch patch) {
    const Index first = patch.first_triangle, number = static_cast<Index>(part_.patches.size());
    patch.first_triangle = static_cast<Index>(part_.triangles.size());
    for (Index t = first; t < first + patch.triangle_count; ++t) {
      const auto& [a, b, c] = whole_.triangles[t].points;
      part_.triangles.push_back({{point(a), point(b), point(c)}, number});
    }
    patch.curves = curves_(patch.curves);
    patch.vertices = vertices_(patch.vertices);
    part_.patches.push_back(std::move(patch));
  }

  void add(Plc::Curve curve) {
    for (Index& p : curve.points) p = point(p);
    for (Index& end : curve.ends)
      if (end != none) end = vertices_.number[end];
    curve.patches = patches_(curve.patches);
    part_.curves.push_back(std::move(curve));
  }

  void add(Plc::Vertex vertex) {
    vertex.point = point(vertex.point);
    vertex.curves = curves_(vertex.curves);
    vertex.patches = patches_(vertex.patches);
    part_.vertices.push_back(std::move(vertex));
  }

  const Plc& whole_;
  Renumbering patches_, curves_, vertices_, points_;
  Plc part_;
};

std::vector<double> part_of(const std::vector<double>& all, const std::vector<Index>& chosen) {
  std::vector<double> part;
  if (all.empty()) return part;
  part.reserve(chosen.size());
  for (const Index i : chosen) part.push_back(all[i]);
  return part;
}

}  // namespace

void ChosenPatches::adapt(ShapeMeasures& exact) const {
  exact.areas = part_of(exact.areas, patch);
  exact.lengths = part_of(exact.lengths, curve);
  exact.volumes.clear();
  exact.shells.clear();
}

void ChosenPatches::adapt(PipelineOptions& options) const {
  adapt(options.exact_measures);
  if (!options.exact) return;
  options.exact = [exact = options.exact, patches = patch, curves = curve](unsigned dimension, Index feature,
                                                                           const Point& p) {
    return exact(dimension, dimension == 2 ? patches[feature] : curves[feature], p);
  };
}

ChosenPatches choose_patches(const Plc& whole, const std::vector<std::string>& names) {
  return NamedPart(whole, tags_of(whole, names)).make();
}

}  // namespace collarmesh::shells
