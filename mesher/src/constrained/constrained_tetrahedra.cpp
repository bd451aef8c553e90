#include "constrained/constrained_tetrahedra.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "collarmesh/error.h"
#include "common/edge_key.h"
#include "constrained/boundary_recovery.h"
#include "constrained/tetrahedra.h"

namespace collarmesh {

namespace constrained {
namespace {

constexpr std::size_t steps_between_reports = 1024;

/// The regions of the tetrahedra: tetrahedra that are connected without crossing a facet are in one region.
class Labels {
 public:
  Labels(const Tetrahedra& mesh, const std::vector<Facet>& facets, const Plc& plc)
      : mesh_(mesh), facets_(facets), plc_(plc), region_(mesh.size(), none) {
    std::vector<Index> part;
    for (Index t = 0; t < mesh.size(); ++t)
      if (mesh.alive(t) && region_[t] == none) label_part(t, part);
  }

  Index of(Index tet) const { return region_[tet]; }

 private:
  void label_part(Index first, std::vector<Index>& part) {
    part.assign(1, first);
    region_[first] = 0;
    Index region = none;
    for (std::size_t i = 0; i < part.size(); ++i)
      for (unsigned k = 0; k < 4; ++k) {
        const Tetrahedra::Face face{part[i], k};
        if (const Index facet = mesh_.facet(face); facet != none) {
          agree(region, beside(face, facets_[facet]), mesh_.point(facets_[facet].corners[0]));
        } else if (const Index next = mesh_.beyond(face); next == none) {
          agree(region, 0, mesh_.point(mesh_.corners(face.tet)[(face.corner + 1) % 4]));
        } else if (region_[next] == none) {
          region_[next] = 0;
          part.push_back(next);
        }
      }
    for (const Index t : part) region_[t] = region == none ? 0 : region;
  }

  static void agree(Index& region, Index beside, const Point& p) {
    if (region == none) region = beside;
    if (region == beside) return;
    const std::string message = fmt::format(
        "The facets around ({:.9g}, {:.9g}, {:.9g}) do not agree about the region between them; "
        "repair the complex.",
        p.x, p.y, p.z);
    throw PlcError(message, {{PlcFault::Kind::open_boundary, message, {}, p}});
  }

  /// Returns the region on this tetrahedron's side of a facet.
  Index beside(const Tetrahedra::Face& face, const Facet& facet) const {
    const Plc::Patch& patch = plc_.patches[facet.patch];
    const auto& [a, b, c] = facet.corners;
    return patch.regions[mesh_.orientation(a, b, c, mesh_.corners(face.tet)[face.corner]) < 0 ? 0 : 1];
  }

  const Tetrahedra& mesh_;
  const std::vector<Facet>& facets_;
  const Plc& plc_;
  std::vector<Index> region_;
};

class Extraction {
 public:
  Extraction(const Tetrahedra& mesh, const BoundaryRecovery& recovery, const Plc& plc)
      : mesh_(mesh), recovery_(recovery), plc_(plc), number_(mesh.point_count(), none) {}

  TetMesh run() {
    const Labels regions(mesh_, recovery_.facets(), plc_);
    for (Index t = 0; t < mesh_.size(); ++t)
      if (mesh_.alive(t) && regions.of(t) != 0) add_tet(mesh_.corners(t), regions.of(t));
    for (const Facet& facet : recovery_.facets())
      if (facet.alive && plc_.patches[facet.patch].regions != std::array<Index, 2>{0, 0}) add_face(facet);
    add_edges();
    for (Index v = 0; v < plc_.vertices.size(); ++v)
      if (const Index n = number_[plc_.vertices[v].point]; n != none) made_.features[n] = {0, v};
    made_.names = plc_.names;
    return std::move(made_);
  }

 private:
  Index number(Index point) {
    if (number_[point] == none) {
      number_[point] = static_cast<Index>(made_.points.size());
      made_.points.push_back(mesh_.point(point));
      made_.features.emplace_back();
    }
    return number_[point];
  }

  void add_tet(const Tetrahedra::Corners& v, Index region) {
    made_.tets.push_back({number(v[0]), number(v[1]), number(v[2]), number(v[3])});
    made_.tet_region.push_back(region);
    made_.tet_tag.push_back(plc_.regions[region].tag);
    made_.tet_collar.push_back(0);
    made_.tet_crease.push_back(0);
    made_.tet_thin.push_back(0);
  }

  void add_face(const Facet& facet) {
    const Plc::Patch& patch = plc_.patches[facet.patch];
    const auto& [a, b, c] = facet.corners;
    std::array<Index, 3> corners{number(a), number(b), number(c)};
    std::array<Index, 2> regions = patch.regions;
    if (regions[0] == 0) {
      std::swap(regions[0], regions[1]);
      std::swap(corners[1], corners[2]);
    }
    made_.faces.push_back(corners);
    made_.face_regions.push_back(regions);
    made_.face_patch.push_back(facet.patch);
    made_.face_tag.push_back(patch.tag);
    for (const Index v : corners) made_.features[v] = {2, facet.patch};
  }

  /// Adds the edges on curves, except on curves outside all regions, where no tetrahedron is kept.
  void add_edges() {
    std::vector<std::uint64_t> of_tets;
    of_tets.reserve(6 * made_.tets.size());
    for (const auto& tet : made_.tets)
      for (unsigned i = 0; i < 4; ++i)
        for (unsigned j = i + 1; j < 4; ++j) of_tets.push_back(edge_key(tet[i], tet[j]));
    std::ranges::sort(of_tets);
    std::vector<std::array<Index, 3>> edges;  // ends and curve of each edge
    recovery_.for_each_curve_edge([&](Index a, Index b, Index curve) {
      const std::array<Index, 2> ends{number_[a], number_[b]};
      if (ends[0] != none && ends[1] != none &&
          std::ranges::binary_search(of_tets, edge_key(ends[0], ends[1])))
        edges.push_back({ends[0], ends[1], curve});
    });
    std::ranges::sort(edges);  // edges were found in arbitrary order
    for (const auto& [a, b, curve] : edges) {
      made_.edges.push_back({a, b});
      made_.edge_curve.push_back(curve);
      made_.edge_tag.push_back(plc_.curves[curve].tag);
      for (const Index v : {a, b}) made_.features[v] = {1, curve};
    }
  }

  const Tetrahedra& mesh_;
  const BoundaryRecovery& recovery_;
  const Plc& plc_;
  TetMesh made_;
  std::vector<Index> number_;
};

/// Makes the tetrahedra by one way of recovery. Returns an empty mesh if the run was cancelled.
ConstrainedTetrahedra recovered(const Plc& plc, const RecoveryWay& way, const Execution& execution) {
  Tetrahedra mesh(plc.points);
  BoundaryRecovery recovery(mesh, plc, way);
  std::size_t step = 0;
  const bool ended = recovery.run([&] {
    if (execution.cancelled()) return false;
    return ++step % steps_between_reports != 0 || !execution.progress ||
           execution.progress({"tetrahedralize", 0, mesh.point_count(), mesh.size()});
  });
  if (!ended) return {};
  return {Extraction(mesh, recovery, plc).run(), recovery.added_points()};
}

}  // namespace
}  // namespace constrained

ConstrainedTetrahedra constrained_tetrahedra(const Plc& plc, const Execution& execution) {
  using constrained::RecoveryWay;
  constexpr std::array<RecoveryWay, 3> ways{
      {{}, {.turns_first = true}, {.turns_first = true, .reversed = true}}};
  for (const RecoveryWay& way : ways) try {
      return constrained::recovered(plc, way, execution);
    } catch (const PlcError&) {
      if (&way == &ways.back()) throw;
    }
  return {};
}

}  // namespace collarmesh
