#include "pipeline/rods_in_blocks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "collarmesh/plc_builder.h"
#include "common/cell_shapes.h"
#include "common/thread_limit.h"
#include "constrained/constrained_tetrahedra.h"
#include "constrained/sheathed_rods.h"
#include "location/triangle_hierarchy.h"
#include "pipeline/complex_without_rods.h"
#include "pipeline/refinement.h"
#include "pipeline/vertex_bound.h"

namespace collarmesh::pipeline {

namespace {

using Corners = std::array<Index, 3>;

/// Thrown if there is no room for the sheaths.
struct NoRoom {};

/// Points by their coordinates.
class PointNumbers {
 public:
  /// Returns the number of a point, which must be new if it has none yet.
  Index number(const Point& point, Index if_new) {
    return numbers_.try_emplace(std::tuple(point.x, point.y, point.z), if_new).first->second;
  }

 private:
  std::map<std::tuple<double, double, double>, Index> numbers_;
};

/// The corners of a tet's face opposite a corner, with the normal away from the tet.
Corners face_of(const std::array<Index, 4>& tet, unsigned opposite) {
  constexpr std::array<std::array<unsigned, 3>, 4> faces{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
  const auto& [a, b, c] = faces[opposite];
  return {tet[a], tet[b], tet[c]};
}

/// The part of a refined mesh that makes room for rods and their sheaths.
class Cavity {
 public:
  /// `room`: its width, in terms of the sheath's.
  Cavity(const TetMesh& mesh, const ComplexWithoutRods& without, const std::vector<SheathedRod>& rods,
         double room)
      : mesh_(mesh), without_(without), rods_(rods), removed_(mesh.tets.size(), false) {
    for (const SheathedRod& rod : rods) remove_around(rod, room);
    find_walls();
  }

  bool has(std::size_t tet) const { return removed_[tet]; }
  bool has_face(std::size_t face) const { return removed_face_[face]; }
  /// A face between the cavity and the rest of the mesh. Its normal points away from the cavity.
  struct Wall {
    Corners corners;
    Index region;
  };
  const std::vector<Wall>& walls() const { return walls_; }
  /// Returns the edges around the faces of the cavity on planar patches, by patch of the whole complex.
  const std::map<Index, std::vector<std::array<Index, 2>>>& outlines() const { return outlines_; }

 private:
  // Size of the pieces of tets that are looked at, in terms of the sheath's width.
  static constexpr double between_places = 0.4;

  void remove_around(const SheathedRod& rod, double room) {
    std::vector<Corners> pieces;
    for (Index i = 0; i + 1 < rod.axis.size(); ++i) pieces.push_back({i, i + 1, i + 1});
    const TriangleHierarchy axis(rod.axis, std::move(pieces));
    const double bound = room * rod.reach;
    const auto away = [&](const Point& p) { return std::sqrt(axis.squared_distance_to(p)); };
    for (std::size_t t = 0; t < mesh_.tets.size(); ++t) {
      const auto& [a, b, c, d] = mesh_.tets[t];
      if (!comes_within(bound, {mesh_.points[a], mesh_.points[b], mesh_.points[c], mesh_.points[d]},
                        between_places * rod.reach, away))
        continue;
      if (without_.region_of[mesh_.tet_region[t]] != rod.around) throw NoRoom();
      removed_[t] = true;
    }
  }

  /// Returns whether a tet has a place within this distance from the axis, looking at pieces of this size.
  template <class Away>
  static bool comes_within(double bound, const std::array<Point, 4>& p, double smallest, const Away& away) {
    const Point middle = (p[0] + p[1] + p[2] + p[3]) / 4;
    double radius = 0, longest = 0;
    std::array<unsigned, 2> edge{};
    for (const Point& corner : p) radius = std::max(radius, distance(middle, corner));
    for (const auto& ends : cell_shapes::corner_pairs)
      if (const double length = distance(p[ends[0]], p[ends[1]]); length > longest) {
        longest = length;
        edge = {ends[0], ends[1]};
      }
    const double there = away(middle);
    if (there <= bound || there > bound + radius || longest < smallest) return there <= bound;
    for (const unsigned end : edge) {
      std::array<Point, 4> half = p;
      half[end] = 0.5 * (p[edge[0]] + p[edge[1]]);
      if (comes_within(bound, half, smallest, away)) return true;
    }
    return false;
  }

  void find_walls() {
    std::map<Corners, Index> faces;
    for (Index f = 0; f < mesh_.faces.size(); ++f) {
      Corners corners = mesh_.faces[f];
      std::ranges::sort(corners);
      faces.emplace(corners, f);
    }
    removed_face_.assign(mesh_.faces.size(), false);
    struct Face {
      Corners corners;
      Index region;
      unsigned times = 0;
    };
    std::map<Corners, Face> of_cavity;
    for (std::size_t t = 0; t < mesh_.tets.size(); ++t) {
      if (!removed_[t]) continue;
      require_inner(mesh_.tets[t]);
      for (unsigned k = 0; k < 4; ++k) {
        const Corners corners = face_of(mesh_.tets[t], k);
        Corners key = corners;
        std::ranges::sort(key);
        ++of_cavity.try_emplace(key, Face{corners, without_.region_of[mesh_.tet_region[t]]})
              .first->second.times;
      }
    }
    for (const auto& [key, face] : of_cavity) {
      const auto on_patch = faces.find(key);
      if (on_patch == faces.end()) {
        if (face.times == 1) walls_.push_back({face.corners, face.region});
        continue;
      }
      const Index patch = without_.patch_of[mesh_.face_patch[on_patch->second]];
      if (face.times != 1 || !is_host(patch)) throw NoRoom();
      removed_face_[on_patch->second] = true;
      for (unsigned i = 0; i < 3; ++i) add_outline(patch, face.corners[i], face.corners[(i + 1) % 3]);
    }
    for (auto& [patch, edges] : outlines_)
      std::erase_if(edges, [](const std::array<Index, 2>& edge) { return edge[0] == none; });
  }
  /// Throws NoRoom if the tet has a corner on a curve or a vertex that stays.
  void require_inner(const std::array<Index, 4>& tet) const {
    for (const Index v : tet) {
      const auto& [dimension, feature] = mesh_.features[v];
      if (dimension == 1 || (dimension == 0 && without_.vertex_of[feature] != none)) throw NoRoom();
    }
  }
  bool is_host(Index patch) const {
    return std::ranges::any_of(rods_, [&](const SheathedRod& rod) {
      return std::ranges::any_of(rod.ends, [&](const SheathedRod::End& end) { return end.host == patch; });
    });
  }
  /// Adds an edge to the outline on a patch, or removes it with the edge in the opposite direction.
  void add_outline(Index patch, Index a, Index b) {
    std::vector<std::array<Index, 2>>& edges = outlines_[patch];
    const auto opposite = std::ranges::find(edges, std::array{b, a});
    if (opposite == edges.end())
      edges.push_back({a, b});
    else
      *opposite = {none, none};
  }

  const TetMesh& mesh_;
  const ComplexWithoutRods& without_;
  const std::vector<SheathedRod>& rods_;
  std::vector<bool> removed_, removed_face_;
  std::vector<Wall> walls_;
  std::map<Index, std::vector<std::array<Index, 2>>> outlines_;
};

/// Puts rods and sheaths into a mesh, and fills the room between them and the rest of the mesh.
class Insertion {
 public:
  Insertion(const Plc& plc, const TetMesh& mesh, const ComplexWithoutRods& without,
            const std::vector<SheathedRod>& rods, double room)
      : plc_(plc), mesh_(mesh), without_(without), rods_(rods), cavity_(mesh, without, rods, room) {
    gap_.regions = plc.regions;
  }

  /// Returns the mesh of the whole complex. Throws NoRoom, and PlcError if features are too near each other.
  TetMesh run(const Execution& execution) {
    copy_rest();
    for (const SheathedRod& rod : rods_) add_rod(rod);
    add_walls();
    add_planes();
    const TetMesh gap = constrained_tetrahedra(gap_, execution).mesh;
    if (gap.tets.empty()) throw NoRoom();  // or cancelled
    add_gap(gap);
    return std::move(made_);
  }
  /// Returns the vertices of the rods themselves.
  const std::vector<Index>& fixed() const { return fixed_; }

 private:
  void copy_rest() {
    number_.assign(mesh_.points.size(), none);
    made_.names = mesh_.names;
    for (std::size_t t = 0; t < mesh_.tets.size(); ++t) {
      if (cavity_.has(t)) continue;
      std::array<Index, 4> tet = mesh_.tets[t];
      for (Index& v : tet) v = kept(v);
      made_.tets.push_back(tet);
      made_.tet_region.push_back(without_.region_of[mesh_.tet_region[t]]);
      made_.tet_tag.push_back(mesh_.tet_tag[t]);
      made_.tet_collar.push_back(mesh_.tet_collar[t]);
      made_.tet_crease.push_back(mesh_.tet_crease[t]);
      made_.tet_thin.push_back(0);
    }
    for (std::size_t f = 0; f < mesh_.faces.size(); ++f) {
      if (cavity_.has_face(f)) continue;
      const auto& [a, b, c] = mesh_.faces[f];
      const auto& [behind, before] = mesh_.face_regions[f];
      made_.faces.push_back({kept(a), kept(b), kept(c)});
      made_.face_regions.push_back({without_.region_of[behind], without_.region_of[before]});
      made_.face_patch.push_back(without_.patch_of[mesh_.face_patch[f]]);
      made_.face_tag.push_back(mesh_.face_tag[f]);
    }
    for (std::size_t e = 0; e < mesh_.edges.size(); ++e) {
      made_.edges.push_back({kept(mesh_.edges[e][0]), kept(mesh_.edges[e][1])});
      made_.edge_curve.push_back(without_.curve_of[mesh_.edge_curve[e]]);
      made_.edge_tag.push_back(mesh_.edge_tag[e]);
    }
    made_.collar_balls = mesh_.collar_balls;
    for (TetMesh::CollarBall& ball : made_.collar_balls) ball.point = kept(ball.point);
  }
  /// Returns the number of a vertex of the rest.
  Index kept(Index v) {
    if (number_[v] == none) {
      auto [dimension, feature] = mesh_.features[v];
      if (feature != none)
        feature = (dimension == 0   ? without_.vertex_of
                   : dimension == 1 ? without_.curve_of
                                    : without_.patch_of)[feature];
      number_[v] = add_point(mesh_.points[v], {dimension, feature});
    }
    return number_[v];
  }
  Index add_point(const Point& point, const TetMesh::VertexFeature& feature) {
    made_.points.push_back(point);
    made_.features.push_back(feature);
    return static_cast<Index>(made_.points.size() - 1);
  }

  void add_rod(const SheathedRod& rod) {
    const TetMesh& of = rod.mesh;
    const auto first = static_cast<Index>(made_.points.size());
    const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
    const auto append_shifted = [&](auto& to, const auto& from) {
      for (auto corners : from) {
        for (Index& v : corners) v += first;
        to.push_back(corners);
      }
    };
    for (const Index v : rod.fixed) fixed_.push_back(first + v);
    append(made_.points, of.points);
    append(made_.features, of.features);
    append_shifted(made_.tets, of.tets);
    append(made_.tet_region, of.tet_region);
    append(made_.tet_tag, of.tet_tag);
    append(made_.tet_collar, of.tet_collar);
    append(made_.tet_crease, of.tet_crease);
    append(made_.tet_thin, of.tet_thin);
    append_shifted(made_.faces, of.faces);
    append(made_.face_regions, of.face_regions);
    append(made_.face_patch, of.face_patch);
    append(made_.face_tag, of.face_tag);
    append_shifted(made_.edges, of.edges);
    append(made_.edge_curve, of.edge_curve);
    append(made_.edge_tag, of.edge_tag);
    for (const auto& [a, b, c] : rod.skin) add_facet({a + first, b + first, c + first}, {0, rod.around});
    for (const SheathedRod::End& end : rod.ends) {
      std::vector<Index>& rim = rims_[end.host].emplace_back(end.rim);
      for (Index& v : rim) v += first;
    }
  }

  /// Adds a triangle to the complex of the gap, as a patch of its own. So it stays as it is.
  void add_facet(const Corners& corners, const std::array<Index, 2>& regions) {
    const auto patch = static_cast<Index>(gap_.patches.size());
    Plc::Patch& added = gap_.patches.emplace_back();
    added.first_triangle = static_cast<Index>(gap_.triangles.size());
    added.triangle_count = 1;
    added.regions = regions;
    gap_.triangles.push_back({{in_gap(corners[0]), in_gap(corners[1]), in_gap(corners[2])}, patch});
  }
  Index in_gap(Index v) {
    const Point& point = made_.points[v];
    const auto next = static_cast<Index>(gap_.points.size());
    const Index found = numbers_.number(point, next);
    if (found == next) {
      gap_.points.push_back(point);
      of_gap_.push_back(v);
    }
    return found;
  }

  void add_walls() {
    for (const auto& [corners, region] : cavity_.walls())
      add_facet({kept(corners[0]), kept(corners[1]), kept(corners[2])}, {region, 0});
    single_ = gap_.patches.size();
  }

  /// Adds the parts of planar patches between the rims of sheaths and the rest of the mesh.
  void add_planes() {
    for (const auto& [host, edges] : cavity_.outlines()) {
      PolygonSoup soup;
      std::vector<Index> vertices;
      soup.begin_facet();
      const auto add_loop = [&](const std::vector<Index>& loop) {
        std::vector<Index> corners;
        for (const Index v : loop) {
          corners.push_back(static_cast<Index>(soup.points.size()));
          soup.points.push_back(made_.points[v]);
        }
        soup.add_polygon(corners);
      };
      for (const std::vector<Index>& loop : loops_of(edges)) add_loop(loop);
      for (const std::vector<Index>& rim : rims_[host]) {
        add_loop(rim);
        Point centre{};
        for (const Index v : rim) centre = centre + made_.points[v];
        soup.facet_holes.push_back({0, centre / static_cast<double>(rim.size())});
      }
      PlcOptions options;
      options.require_solid = false;
      add_plane(host, build_plc(std::vector{soup}, options));
    }
  }
  /// Returns the loops of vertices along edges around faces.
  std::vector<std::vector<Index>> loops_of(const std::vector<std::array<Index, 2>>& edges) {
    std::map<Index, Index> after;
    for (const auto& [a, b] : edges)
      if (!after.emplace(a, b).second) throw NoRoom();
    std::vector<std::vector<Index>> loops;
    while (!after.empty()) {
      std::vector<Index>& loop = loops.emplace_back();
      for (auto at = after.begin(); at != after.end();) {
        loop.push_back(kept(at->first));
        const Index next = at->second;
        after.erase(at);
        at = after.find(next);
      }
    }
    return loops;
  }
  void add_plane(Index host, const Plc& plane) {
    const Plc::Patch& patch = plc_.patches[host];
    const bool is_solid_behind = patch.regions[0] != 0;
    const auto number = static_cast<Index>(gap_.patches.size());
    Plc::Patch& added = gap_.patches.emplace_back();
    added.first_triangle = static_cast<Index>(gap_.triangles.size());
    added.triangle_count = static_cast<Index>(plane.triangles.size());
    added.planar = true;
    added.normal = is_solid_behind ? patch.normal : -1 * patch.normal;
    added.origin = patch.origin;
    added.regions = {patch.regions[is_solid_behind ? 0 : 1], 0};
    hosts_.push_back(host);
    const std::size_t points = gap_.points.size();
    for (const Plc::Triangle& t : plane.triangles) {
      Corners corners{};
      for (unsigned i = 0; i < 3; ++i)
        corners[i] = numbers_.number(plane.points[t.points[i]], static_cast<Index>(points));
      if (std::ranges::count(corners, static_cast<Index>(points)) > 0) throw NoRoom();
      const auto& p = gap_.points;
      if (dot(cross(p[corners[1]] - p[corners[0]], p[corners[2]] - p[corners[0]]), added.normal) < 0)
        std::swap(corners[1], corners[2]);
      gap_.triangles.push_back({corners, number});
    }
  }

  void add_gap(const TetMesh& gap) {
    std::vector<Index> number;
    for (std::size_t v = 0; v < gap.points.size(); ++v) {
      const auto next = static_cast<Index>(gap_.points.size());
      const Index found = numbers_.number(gap.points[v], next);
      TetMesh::VertexFeature feature;
      if (gap.features[v].dimension == 2 && gap.features[v].feature >= single_)
        feature = {2, hosts_[gap.features[v].feature - single_]};
      number.push_back(found == next ? add_point(gap.points[v], feature) : of_gap_[found]);
      if (found == next) {
        gap_.points.push_back(gap.points[v]);
        of_gap_.push_back(number.back());
      }
    }
    std::vector<unsigned> times(single_, 0);
    for (std::size_t f = 0; f < gap.faces.size(); ++f) {
      if (gap.face_patch[f] < single_) {
        ++times[gap.face_patch[f]];
        continue;
      }
      const Index host = hosts_[gap.face_patch[f] - single_];
      const auto& [a, b, c] = gap.faces[f];
      std::array<Index, 2> regions = plc_.patches[host].regions;
      if (regions[0] == 0) std::swap(regions[0], regions[1]);
      made_.faces.push_back({number[a], number[b], number[c]});
      made_.face_regions.push_back(regions);
      made_.face_patch.push_back(host);
      made_.face_tag.push_back(plc_.patches[host].tag);
    }
    // A divided face would not fit to the tets on its other side.
    if (std::ranges::any_of(times, [](unsigned n) { return n != 1; })) throw NoRoom();
    for (std::size_t t = 0; t < gap.tets.size(); ++t) {
      const auto& [a, b, c, d] = gap.tets[t];
      made_.tets.push_back({number[a], number[b], number[c], number[d]});
      made_.tet_region.push_back(gap.tet_region[t]);
      made_.tet_tag.push_back(gap.tet_tag[t]);
      made_.tet_collar.push_back(0);
      made_.tet_crease.push_back(0);
      made_.tet_thin.push_back(0);
    }
  }

  const Plc& plc_;
  const TetMesh& mesh_;
  const ComplexWithoutRods& without_;
  const std::vector<SheathedRod>& rods_;
  Cavity cavity_;
  TetMesh made_;
  std::vector<Index> fixed_;
  std::vector<Index> number_;  // by vertex of the refined mesh
  Plc gap_;
  PointNumbers numbers_;
  std::vector<Index> of_gap_;  // by point of the gap's complex
  std::size_t single_ = 0;     // number of patches of the gap's complex that are one triangle
  std::vector<Index> hosts_;   // patches of the whole complex for the others
  std::map<Index, std::vector<std::vector<Index>>> rims_;  // by host
};

}  // namespace

std::vector<SheathedRod> find_sheathed_rods(MeshJob& job) {
  std::vector<SheathedRod> rods;
  if (job.plc->regions.size() < 3) return rods;  // no region lies in another one
  ThreadLimit(job.options.mesh.threads).run([&] {
    const RodLimits limits{.size = smallest_size(job.options.mesh, job.plc->bounds.diagonal()),
                           .most_vertices = job.refined_with.max_vertices};
    rods = sheathed_rods(*job.plc, *job.options.mesh.bounds.tolerance, limits, job.execution());
  });
  job.control.stop_if_asked();
  return rods;
}

bool refine_around_rods(MeshJob& job, const std::vector<SheathedRod>& rods, std::vector<Index>& fixed) {
  const Plc& whole = *job.plc;
  const std::optional<ComplexWithoutRods> without = complex_without_rods(whole, rods);
  if (!without) return false;
  const SurfaceTolerance tolerance = *job.refined_with.bounds.tolerance;
  job.plc = &without->plc;
  job.refined_with.bounds.tolerance = without->tolerance_from(tolerance);
  try {
    refine(job);
  } catch (...) {
    job.plc = &whole;  // the other complex ends here
    throw;
  }
  job.plc = &whole;
  job.refined_with.bounds.tolerance = tolerance;
  job.neighbours = KnownNeighbours();
  TetMesh& mesh = job.made.result.mesh;
  if (job.made.result.status != MeshStatus::complete) return false;
  // Widths of the cavity for the sheaths, in terms of theirs. Rounded points decide whether one can be
  // filled.
  constexpr std::array<double, 3> rooms{1.4, 1.6, 1.8};
  const bool made = std::ranges::any_of(rooms, [&](double room) {
    try {
      job.control.watch([&](const Execution& watched) {
        ThreadLimit(job.options.mesh.threads).run([&] {
          Insertion insertion(whole, mesh, *without, rods, room);
          mesh = insertion.run(watched);
          fixed = insertion.fixed();
        });
      });
      return true;
    } catch (const NoRoom&) {
      return false;
    } catch (const PlcError&) {  // features are too near each other
      return false;
    }
  });
  if (!made) return false;
  job.control.stop_if_asked();
  job.trace("rods", mesh);
  return true;
}

}  // namespace collarmesh::pipeline
