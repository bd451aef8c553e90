#include "pipeline/rods_in_blocks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "collarmesh/error.h"
#include "common/thread_limit.h"
#include "pipeline/complex_without_rods.h"
#include "pipeline/rod_cavity.h"
#include "pipeline/rod_filling.h"
#include "pipeline/rod_room.h"
#include "pipeline/vertex_bound.h"
#include "remesh/thin_shape.h"

namespace collarmesh::pipeline {

namespace {

// Widths of the cavity for a sheath, relative to the sheath, in the order in which they are tried. Several
// are needed, because rounding of points decides whether a cavity can be filled.
constexpr std::array<double, 3> rooms{1.4, 1.6, 1.8};

/// Puts rods and sheaths into a mesh, in the place of the tets of their cavities.
class Assembly {
 public:
  Assembly(const Plc& plc, const MeshAroundRods& around, const std::vector<RodFilling>& fillings)
      : plc_(plc), around_(around), mesh_(around.mesh), fillings_(fillings) {}

  /// Returns the mesh of the whole complex.
  TetMesh run() {
    copy_rest();
    for (std::size_t rod = 0; rod < fillings_.size(); ++rod) {
      const auto first = static_cast<Index>(made_.points.size());
      add_rod(around_.rods[rod]);
      add_gap(fillings_[rod], first);
    }
    return std::move(made_);
  }
  /// Returns the vertices of the rods without their sheaths.
  std::vector<Index>& fixed() { return fixed_; }

 private:
  void copy_rest() {
    const ComplexWithoutRods& without = around_.without;
    std::vector<bool> is_face_taken(mesh_.faces.size(), false);
    for (const RodFilling& filling : fillings_)
      for (const Index f : filling.faces) is_face_taken[f] = true;
    number_.assign(mesh_.points.size(), none);
    made_.names = mesh_.names;
    for (std::size_t t = 0; t < mesh_.tets.size(); ++t) {
      if (around_.taken[t]) continue;
      std::array<Index, 4> tet = mesh_.tets[t];
      for (Index& v : tet) v = kept(v);
      made_.tets.push_back(tet);
      made_.tet_region.push_back(without.region_of[mesh_.tet_region[t]]);
      made_.tet_tag.push_back(mesh_.tet_tag[t]);
      made_.tet_collar.push_back(mesh_.tet_collar[t]);
      made_.tet_crease.push_back(mesh_.tet_crease[t]);
      made_.tet_thin.push_back(0);
    }
    for (std::size_t f = 0; f < mesh_.faces.size(); ++f) {
      if (is_face_taken[f]) continue;
      const auto& [a, b, c] = mesh_.faces[f];
      const auto& [behind, before] = mesh_.face_regions[f];
      made_.faces.push_back({kept(a), kept(b), kept(c)});
      made_.face_regions.push_back({without.region_of[behind], without.region_of[before]});
      made_.face_patch.push_back(without.patch_of[mesh_.face_patch[f]]);
      made_.face_tag.push_back(mesh_.face_tag[f]);
    }
    for (std::size_t e = 0; e < mesh_.edges.size(); ++e) {
      made_.edges.push_back({kept(mesh_.edges[e][0]), kept(mesh_.edges[e][1])});
      made_.edge_curve.push_back(without.curve_of[mesh_.edge_curve[e]]);
      made_.edge_tag.push_back(mesh_.edge_tag[e]);
    }
    for (TetMesh::CollarBall ball : mesh_.collar_balls) {
      if (number_[ball.point] == none) continue;  // a vertex on an axis
      ball.point = number_[ball.point];
      made_.collar_balls.push_back(ball);
    }
  }
  /// Returns the number, in the made mesh, of a vertex that is kept from the refined mesh. Adds the vertex if
  /// it is not there yet.
  Index kept(Index v) {
    if (number_[v] == none) {
      auto [dimension, feature] = mesh_.features[v];
      if (feature != none)
        feature = (dimension == 0   ? around_.without.vertex_of
                   : dimension == 1 ? around_.without.curve_of
                                    : around_.without.patch_of)[feature];
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
  }

  /// Adds the elements that fill the gap around a rod. `first_of_rod`: number of the rod's first vertex.
  void add_gap(const RodFilling& filling, Index first_of_rod) {
    const TetMesh& gap = filling.gap;
    std::vector<Index> number;
    for (std::size_t v = 0; v < gap.points.size(); ++v) {
      if (const RodFilling::Origin* const origin = filling.origin_of(gap.points[v])) {
        number.push_back(origin->is_of_rod ? first_of_rod + origin->vertex : kept(origin->vertex));
        continue;
      }
      const auto& [dimension, patch] = gap.features[v];
      TetMesh::VertexFeature feature;
      if (dimension == 2) feature = {2, filling.hosts[patch]};
      number.push_back(add_point(gap.points[v], feature));
    }
    for (std::size_t f = 0; f < gap.faces.size(); ++f) {
      const Index host = filling.hosts[gap.face_patch[f]];
      if (host == none) continue;
      const auto& [a, b, c] = gap.faces[f];
      std::array<Index, 2> regions = plc_.patches[host].regions;
      if (regions[0] == 0) std::swap(regions[0], regions[1]);
      made_.faces.push_back({number[a], number[b], number[c]});
      made_.face_regions.push_back(regions);
      made_.face_patch.push_back(host);
      made_.face_tag.push_back(plc_.patches[host].tag);
    }
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
  const MeshAroundRods& around_;
  const TetMesh& mesh_;
  const std::vector<RodFilling>& fillings_;
  TetMesh made_;
  std::vector<Index> fixed_;
  std::vector<Index> number_;  // by vertex of the refined mesh
};

/// Finds the tets near each rod. Returns false if cancelled.
bool find_near(MeshAroundRods& around, const Execution& execution) {
  constexpr std::size_t tets_per_look = 1024;
  const TetMesh& mesh = around.mesh;
  for (Index t = 0; t < mesh.tets.size(); ++t) {
    if (t % tets_per_look == 0 && execution.cancelled()) return false;
    const auto& [a, b, c, d] = mesh.tets[t];
    const Point middle = (mesh.points[a] + mesh.points[b] + mesh.points[c] + mesh.points[d]) / 4;
    double radius = 0;
    for (const Index v : mesh.tets[t]) radius = std::max(radius, distance(middle, mesh.points[v]));
    for (const Index rod : around.axes.rods_near(middle, rooms.back(), radius)) around.near[rod].push_back(t);
  }
  return true;
}

/// Tries to fill the cavity of a rod, and sets `filled`. Returns false if cancelled.
bool fill_in_some_room(const Plc& plc, MeshAroundRods& around, Index rod, RodFilling& filling, bool& filled,
                       const Execution& execution) {
  filled = false;
  for (const double room : rooms) {
    if (execution.cancelled()) return false;
    try {
      std::optional<RodFilling> made = fill_cavity(plc, around, rod, room, execution);
      if (!made) return false;
      filling = std::move(*made);
      for (const Index t : filling.tets) around.taken[t] = true;
      filled = true;
      return true;
    } catch (const NoRoom&) {
      continue;
    } catch (const PlcError&) {  // features are too near each other
      continue;
    }
  }
  return true;
}

/// Puts rods into the refined mesh of the complex without them. Returns false if some rods have no room; it
/// then only removes these from the list. Returns false, too, if cancelled; it then changes nothing.
bool insert_rods(const Plc& plc, const ComplexWithoutRods& without, std::vector<SheathedRod>& rods,
                 TetMesh& mesh, std::vector<Index>& fixed, const Execution& execution) {
  MeshAroundRods around(mesh, without, rods);
  if (!find_near(around, execution)) return false;
  std::vector<RodFilling> fillings(rods.size());
  std::vector<bool> stays(rods.size(), false);
  for (Index rod = 0; rod < rods.size(); ++rod) {
    bool filled = false;
    if (!fill_in_some_room(plc, around, rod, fillings[rod], filled, execution)) return false;
    stays[rod] = filled;
  }
  if (std::ranges::count(stays, false) > 0) {
    std::vector<SheathedRod> kept;
    for (std::size_t rod = 0; rod < rods.size(); ++rod)
      if (stays[rod]) kept.push_back(std::move(rods[rod]));
    rods = std::move(kept);
    return false;
  }
  Assembly assembly(plc, around, fillings);
  mesh = assembly.run();
  fixed = std::move(assembly.fixed());
  return true;
}

/// Refines the complex without rods in place of the job's complex. Tets where sheaths will be, and beside
/// them, get about the size of the sheaths, so that cavities touch no other features.
void refine_without(MeshJob& job, const ComplexWithoutRods& without, const std::vector<SheathedRod>& rods,
                    Fineness fineness) {
  // The size of these tets, and the distance from the axis up to which tets get this size; both in multiples
  // of the sheath's reach.
  constexpr double size_beside = 1.5, as_far_as = 2.2;
  const RodAxes axes(rods);
  const Plc* const whole = job.plc;
  const MeshOptions refined_with = job.refined_with;
  const auto restore = [&] {
    const bool lower = job.refined_with.bounds.lower_where_forced;
    job.plc = whole;
    job.refined_with = refined_with;
    job.refined_with.bounds.lower_where_forced = lower;
  };
  job.plc = &without.plc;
  job.refined_with.bounds.tolerance = without.tolerance_from(*refined_with.bounds.tolerance);
  job.refined_with.size_field = [&](const Point& p) {
    double size = INFINITY;
    for (const Index rod : axes.rods_near(p, as_far_as, 0))
      size = std::min(size, size_beside * rods[rod].reach);
    return size;
  };
  try {
    refine(job, fineness);
  } catch (...) {
    restore();
    throw;
  }
  restore();
  job.neighbours = KnownNeighbours();  // they belong to the complex without rods
}

/// Returns whether all tets of a rod and its sheath keep the bounds on the angles of thin tets. Tets miss
/// them where rings of vertices are much nearer to each other than layers are, as in a bend.
bool keeps_angles(const TetMesh& mesh, double thin_angle) {
  return std::ranges::all_of(mesh.tets, [&](const std::array<Index, 4>& tet) {
    const auto& p = mesh.points;
    const auto angles = remeshing::extreme_angles({p[tet[0]], p[tet[1]], p[tet[2]], p[tet[3]]});
    return angles.smallest >= thin_angle && angles.largest <= remeshing::ThinShape::largest_angle;
  });
}

}  // namespace

std::vector<SheathedRod> find_sheathed_rods(MeshJob& job) {
  std::vector<SheathedRod> rods;
  if (job.plc->regions.size() < 3) return rods;  // no region lies in another one
  ThreadLimit(job.options.mesh.threads).run([&] {
    const RodLimits limits{.size = smallest_size(job.options.mesh, job.plc->bounds.diagonal()),
                           .most_vertices = job.given.mesh.max_vertices};
    rods = sheathed_rods(*job.plc, *job.options.mesh.bounds.tolerance, limits, job.execution());
    std::erase_if(rods, [&](const SheathedRod& rod) {
      return !keeps_angles(rod.mesh, job.refined_with.bounds.thin_angle);
    });
    remove_rods_without_room(*job.plc, rods, job.execution());
  });
  job.control.stop_if_asked();
  return rods;
}

bool refine_around_rods(MeshJob& job, std::vector<SheathedRod>& rods, std::vector<Index>& fixed,
                        Fineness fineness) {
  constexpr unsigned most_refinements = 2;
  TetMesh& mesh = job.made.result.mesh;
  const bool lower = job.refined_with.bounds.lower_where_forced;
  for (unsigned refinement = 0; refinement < most_refinements && !rods.empty(); ++refinement) {
    const std::optional<ComplexWithoutRods> without = complex_without_rods(*job.plc, rods);
    if (!without) return false;
    job.refined_with.bounds.lower_where_forced = lower;
    refine_without(job, *without, rods, fineness);
    if (job.made.result.status != MeshStatus::complete) return false;
    job.control.begin("tetrahedralize", 0.6, 0.6);
    bool inserted = false;
    job.control.watch([&](const Execution& watched) {
      ThreadLimit(job.options.mesh.threads).run([&] {
        inserted = insert_rods(*job.plc, *without, rods, mesh, fixed, watched);
      });
    });
    if (!inserted) continue;
    job.trace("rods", mesh);
    const std::size_t most = job.given.mesh.max_vertices;
    return most == 0 || mesh.points.size() <= most;
  }
  return false;
}

}  // namespace collarmesh::pipeline
