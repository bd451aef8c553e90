// Checks of the arrays that must pass before any other check can run.
#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <span>
#include <tuple>

#include "check/mesh_to_check.h"
#include "common/flat_table.h"
#include "common/found_in_ranges.h"
#include "common/groups.h"
#include "common/is_finite.h"
#include "common/parallel_for.h"

namespace collarmesh::checks {

namespace {

void check_length(std::size_t length, std::size_t expected, const char* array, const char* of,
                  Findings& findings) {
  if (length != expected)
    findings.add(guarantee::valid_arrays, {}, {}, "The mesh has {} {} for {} {}; give one for each.", length,
                 array, expected, of);
}

template <std::size_t n>
void check_corners(const std::vector<std::array<Index, n>>& entities, const TetMesh& mesh, const char* kind,
                   Findings& findings) {
  struct Wrong {
    Index entity, place;
    bool repeated;
  };
  const auto all = found_in_ranges<Wrong>(entities.size(), [&](std::size_t i, std::vector<Wrong>& wrong) {
    const auto& corners = entities[i];
    for (std::size_t k = 0; k < n; ++k) {
      const bool repeated =
          std::find(corners.begin(), corners.begin() + k, corners[k]) != corners.begin() + k;
      if (corners[k] >= mesh.points.size() || repeated)
        wrong.push_back({static_cast<Index>(i), static_cast<Index>(k), repeated});
    }
  });
  for (const auto& [i, k, repeated] : all) {
    const Index corner = entities[i][k];
    const Point where = corner < mesh.points.size() ? mesh.points[corner] : Point{};
    findings.add(guarantee::valid_arrays, where, {i},
                 "{} {}: entry {} is point {}, {}; a solver cannot use the mesh. If the mesher made it, "
                 "report it with the input and the options.",
                 kind, i, k, corner,
                 repeated ? "which is an earlier entry, too"
                          : fmt::format("but the mesh has {} points", mesh.points.size()));
  }
}

// Finds values outside [first, end). If `optional`, `none` is allowed: it means unknown.
void check_range(const std::vector<Index>& values, std::size_t first, std::size_t end, bool optional,
                 const char* of, const char* value, Findings& findings) {
  for (Index i = 0; i < values.size(); ++i)
    if ((values[i] < first || values[i] >= end) && !(optional && values[i] == none))
      findings.add(
          guarantee::valid_arrays, {}, {i},
          "{} {} has {} {}, but only {} to {} exist; check the mesh against the complex it was made from.",
          of, i, value, values[i], first, static_cast<std::ptrdiff_t>(end) - 1);
}

void check_face_regions(const TetMesh& mesh, const Plc& plc, Findings& findings) {
  for (Index f = 0; f < mesh.face_regions.size(); ++f)
    for (const Index region : mesh.face_regions[f])
      if (region >= plc.regions.size())
        findings.add(guarantee::valid_arrays, {}, {f},
                     "Face {} has region {} on a side, but the complex has only 0 to {}; check the mesh "
                     "against the complex it was made from.",
                     f, region, static_cast<std::ptrdiff_t>(plc.regions.size()) - 1);
}

void check_lengths(const TetMesh& mesh, Findings& findings) {
  if (!mesh.features.empty())
    check_length(mesh.features.size(), mesh.points.size(), "features", "points", findings);
  check_length(mesh.tet_region.size(), mesh.tets.size(), "regions", "tets", findings);
  check_length(mesh.tet_tag.size(), mesh.tets.size(), "tags", "tets", findings);
  check_length(mesh.tet_collar.size(), mesh.tets.size(), "collar marks", "tets", findings);
  check_length(mesh.tet_crease.size(), mesh.tets.size(), "tags of creases", "tets", findings);
  if (!mesh.tet_thin.empty())
    check_length(mesh.tet_thin.size(), mesh.tets.size(), "marks of thin tets", "tets", findings);
  check_length(mesh.face_regions.size(), mesh.faces.size(), "pairs of regions", "faces", findings);
  check_length(mesh.face_patch.size(), mesh.faces.size(), "patches", "faces", findings);
  check_length(mesh.face_tag.size(), mesh.faces.size(), "tags", "faces", findings);
  check_length(mesh.edge_curve.size(), mesh.edges.size(), "curves", "edges", findings);
  check_length(mesh.edge_tag.size(), mesh.edges.size(), "tags", "edges", findings);
  if (mesh.order() == 1) return;
  check_length(mesh.tet_mid_nodes.size(), mesh.tets.size(), "lists of mid-edge nodes", "tets", findings);
  check_length(mesh.face_mid_nodes.size(), mesh.faces.size(), "lists of mid-edge nodes", "faces", findings);
  check_length(mesh.edge_mid_nodes.size(), mesh.edges.size(), "mid-edge nodes", "edges", findings);
}

void check_features(const TetMesh& mesh, const Plc& plc, Findings& findings) {
  const std::size_t counts[] = {plc.vertices.size(), plc.curves.size(), plc.patches.size()};
  for (Index i = 0; i < mesh.features.size(); ++i) {
    const auto [dimension, feature] = mesh.features[i];
    if (dimension > 3 || (dimension < 3 && feature != none && feature >= counts[dimension]))
      findings.add(
          guarantee::valid_arrays, {}, {i},
          "Point {} names the feature {} of dimension {}, which the complex does not have; check the mesh "
          "against the complex it was made from.",
          i, feature, static_cast<unsigned>(dimension));
  }
}

void check_distinct(const TetMesh& mesh, Findings& findings) {
  const std::vector<Point>& points = mesh.points;
  using Pair = std::array<Index, 2>;
  tbb::enumerable_thread_specific<std::vector<Pair>> of_threads;
  tbb::enumerable_thread_specific<std::vector<Index>> sorted_of_threads;
  for_each_group<Index>(
      points.size(), points.size(),
      [&](std::size_t i, const auto& give) {
        give(hash_of(points[i]) % points.size(), static_cast<Index>(i));
      },
      [&](std::size_t, std::span<const Index> alike) {
        if (alike.size() < 2) return;
        std::vector<Index>& sorted = sorted_of_threads.local();
        sorted.assign(alike.begin(), alike.end());
        const auto key = [&](Index i) { return std::tie(points[i].x, points[i].y, points[i].z); };
        std::sort(sorted.begin(), sorted.end(),
                  [&](Index a, Index b) { return key(a) != key(b) ? key(a) < key(b) : a < b; });
        for (std::size_t k = 1; k < sorted.size(); ++k)
          if (key(sorted[k - 1]) == key(sorted[k])) of_threads.local().push_back({sorted[k - 1], sorted[k]});
      });
  std::vector<Pair> pairs;
  for (const auto& found : of_threads) pairs.insert(pairs.end(), found.begin(), found.end());
  std::sort(pairs.begin(), pairs.end());
  for (const auto& [first, second] : pairs)
    findings.add(guarantee::distinct_points, points[first], {first, second},
                 "Points {} and {} are both at {}; the mesh is cut open or doubled there, merge them.", first,
                 second, At{points[first]});
}

void check_referenced(const TetMesh& mesh, Findings& findings) {
  std::vector<std::uint8_t> referenced(mesh.points.size(), 0);
  const auto refer = [&](const auto& cells) {
    constexpr std::size_t at_once = 8192;
    parallel_for_ranges(cells.size(), at_once, [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i)
        for (const Index p : cells[i]) std::atomic_ref(referenced[p]).store(1, std::memory_order_relaxed);
    });
  };
  refer(mesh.tets);
  refer(mesh.tet_mid_nodes);
  if (mesh.is_surface()) {
    refer(mesh.faces);
    refer(mesh.face_mid_nodes);
  }
  if (mesh.is_curves()) {
    refer(mesh.edges);
    for (const Index p : mesh.edge_mid_nodes) referenced[p] = 1;
  }
  for (Index i = 0; i < mesh.points.size(); ++i)
    if (referenced[i] == 0)
      findings.add(guarantee::referenced_points, mesh.points[i], {i},
                   "Point {} at {} is a node of no {}; leave it out of the mesh.", i, At{mesh.points[i]},
                   mesh.is_surface()  ? "triangle"
                   : mesh.is_curves() ? "edge"
                                      : "tet");
}

void check_collar_balls(const TetMesh& mesh, Findings& findings) {
  for (Index b = 0; b < mesh.collar_balls.size(); ++b) {
    const auto& [point, radius, centre] = mesh.collar_balls[b];
    const bool on_crease = point < mesh.points.size() && point < mesh.features.size() &&
                           mesh.features[point].dimension < 2 && mesh.features[point].feature != none;
    if (!on_crease || !is_finite(centre) || !std::isfinite(radius) || !(radius > 0))
      findings.add(
          guarantee::valid_arrays, {}, {b},
          "Ball {} of a collar is centred at point {} with radius {:.6g}; the point must lie on a vertex or "
          "curve, the radius must be positive and finite, and the centre's coordinates finite.",
          b, point, radius);
  }
}

}  // namespace

bool check_arrays(const TetMesh& mesh, Findings& findings) {
  const std::size_t before = findings.total();
  check_lengths(mesh, findings);
  check_corners(mesh.tets, mesh, "Corners of tet", findings);
  check_corners(mesh.faces, mesh, "Corners of face", findings);
  check_corners(mesh.edges, mesh, "Corners of edge", findings);
  check_corners(mesh.tet_mid_nodes, mesh, "Mid-edge nodes of tet", findings);
  check_corners(mesh.face_mid_nodes, mesh, "Mid-edge nodes of face", findings);
  return findings.total() == before;
}

bool check_labels(const TetMesh& mesh, const Plc& plc, Findings& findings) {
  const std::size_t before = findings.total();
  check_range(mesh.tet_region, 1, plc.regions.size(), false, "Tet", "region", findings);
  check_face_regions(mesh, plc, findings);
  check_range(mesh.face_patch, 0, plc.patches.size(), true, "Face", "patch", findings);
  check_range(mesh.edge_mid_nodes, 0, mesh.points.size(), false, "Edge", "mid-edge node", findings);
  check_range(mesh.edge_curve, 0, plc.curves.size(), true, "Edge", "curve", findings);
  check_features(mesh, plc, findings);
  check_collar_balls(mesh, findings);
  return findings.total() == before;
}

bool check_points(const MeshToCheck& to_check, Findings& findings) {
  const TetMesh& mesh = to_check.mesh;
  bool finite = true;
  for (Index i = 0; i < mesh.points.size(); ++i) {
    const Point& p = mesh.points[i];
    if (is_finite(p)) continue;
    finite = false;
    findings.add(guarantee::finite_points, {}, {i},
                 "Point {} has the coordinates {}; every one must be finite.", i, At{p});
  }
  if (!finite) return false;
  check_distinct(mesh, findings);
  check_referenced(mesh, findings);
  return true;
}

}  // namespace collarmesh::checks
