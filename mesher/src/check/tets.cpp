// Volumes and shapes of the tets.
#include <algorithm>
#include <cassert>
#include <cmath>

#include "check/mesh_to_check.h"
#include "check/predicates.h"
#include "check/touched_features.h"
#include "common/parallel_for.h"

namespace collarmesh::checks {

namespace {

constexpr double shape_slack = 1 + 1e-9;  // factor for the bounds on shape that leaves room for rounding
// Number of tets that a thread measures at once, and number of tets measured before their findings and sums
// are added (4 MB).
constexpr std::size_t measured_at_once = 4096, in_a_batch = 1 << 17;

struct CornersOfTet {
  const Point &a, &b, &c, &d;
  Point centre() const { return 0.25 * ((a + b) + (c + d)); }
};

CornersOfTet corners_of(const TetMesh& mesh, Index tet) {
  const auto& t = mesh.tets[tet];
  return {mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]], mesh.points[t[3]]};
}

/// Tets whose angles miss their bounds. The findings list the worst ones first, with the features that they
/// touch.
class MissedAngles {
 public:
  /// `share`: the factor, above 1, by which the tet's worst angle misses its bound.
  void add(Index tet, double share) { missed_.push_back({tet, share}); }

  /// Calls `add_finding(tet, features)` for each tet, the worst first. The text `features` is empty for
  /// findings that will not be listed.
  template <class AddFinding>
  void report(const MeshToCheck& to_check, const AddFinding& add_finding) {
    if (missed_.empty()) return;
    std::stable_sort(missed_.begin(), missed_.end(),
                     [](const Missed& a, const Missed& b) { return a.share > b.share; });
    const TouchedFeatures touched(to_check);
    for (std::size_t i = 0; i < missed_.size(); ++i)
      add_finding(missed_[i].tet,
                  i < to_check.options.findings_per_guarantee ? touched.of(missed_[i].tet) : "");
  }

 private:
  struct Missed {
    Index tet;
    double share;
  };
  std::vector<Missed> missed_;
};

struct AllMissedAngles {
  MissedAngles collars, thin;
};

/// Widens the report's extreme angles to those of a tet. In a mesh with layers `check_core_angles` judges the
/// angles.
void note_angles(const TetQuality& quality, CheckReport& report) {
  report.min_dihedral = std::min(report.min_dihedral, quality.min_dihedral);
  report.max_dihedral = std::max(report.max_dihedral, quality.max_dihedral);
}

/// Returns the factor by which the worst angle of a thin tet misses its bound.
double missed_share(const TetQuality& quality, double face_angle, double smallest) {
  const double left = 180 - std::max(quality.max_dihedral, face_angle);
  const double share = std::max(smallest / std::max(quality.min_dihedral, 0.0),
                                (180 - ThinCells::largest_angle) / std::max(left, 0.0));
  return std::isnan(share) ? INFINITY : share;
}

void check_shape(Index tet, const CornersOfTet& p, const TetQuality& quality, const MeshToCheck& to_check,
                 const ThinCells& thin, CheckReport& report, AllMissedAngles& missed, Findings& findings) {
  const CheckOptions& options = to_check.options;
  if (to_check.collar[tet] != 0) {
    ++report.collar_tets;
    report.max_collar_dihedral = std::max(report.max_collar_dihedral, quality.max_dihedral);
    if (quality.max_dihedral > options.bounds.collar_angle * shape_slack)
      missed.collars.add(tet, quality.max_dihedral / options.bounds.collar_angle);
    report.min_collar_dihedral = std::min(report.min_collar_dihedral, quality.min_dihedral);
    if (!to_check.coarsened) return;
  } else {
    report.min_dihedral = std::min(report.min_dihedral, quality.min_dihedral);
    report.max_dihedral = std::max(report.max_dihedral, quality.max_dihedral);
  }
  const bool within = quality.radius_edge <= options.bounds.radius_edge * shape_slack;
  if (!within && thin.claimed(tet)) {
    if (to_check.collar[tet] == 0) {
      ++report.thin_tets;
      report.max_thin_radius_edge = std::max(report.max_thin_radius_edge, quality.radius_edge);
    }
    const double face_angle = largest_face_angle(p.a, p.b, p.c, p.d);
    if (!thin.has_place(tet))
      findings.add(guarantee::radius_edge, p.centre(), {tet},
                   "Tet {} at {} has circumradius / shortest edge {:.9g}, allowed is {:.9g} except in narrow "
                   "places and at creases; leave that bound out, so that tets may be thin anywhere, or make "
                   "the size smaller there.",
                   tet, At{p.centre()}, quality.radius_edge, options.bounds.radius_edge);
    if (thin.are_bounded(quality, face_angle, tet)) {
      if (!thin.is_forced(quality, tet)) return;
      ++report.forced_tets;
      report.min_forced_dihedral = std::min(report.min_forced_dihedral, quality.min_dihedral);
      return;
    }
    missed.thin.add(tet, missed_share(quality, face_angle, thin.smallest_angle(tet)));
    return;
  }
  if (to_check.collar[tet] == 0)
    report.max_radius_edge = std::max(report.max_radius_edge, quality.radius_edge);
  if (!within)
    findings.add(
        guarantee::radius_edge, p.centre(), {tet},
        "Tet {} at {} has circumradius / shortest edge {:.9g}, allowed is {:.9g}; refine with that bound, or "
        "check against the bound that the mesh was made with.",
        tet, At{p.centre()}, quality.radius_edge, options.bounds.radius_edge);
}

void report_missed_angles(const MeshToCheck& to_check, const ThinCells& thin, AllMissedAngles& missed,
                          Findings& findings) {
  missed.collars.report(to_check, [&](Index tet, const std::string& features) {
    const Point centre = corners_of(to_check.mesh, tet).centre();
    findings.add(guarantee::collar_dihedral, centre, {tet},
                 "Tet {} of a collar at {}, {}, has a dihedral angle of {:.6g} degrees, at most {:.6g} are "
                 "allowed; choose a smaller size there to resolve the crease.",
                 tet, At{centre}, features, measure_tet(to_check.mesh, tet).max_dihedral,
                 to_check.options.bounds.collar_angle);
  });
  missed.thin.report(to_check, [&](Index tet, const std::string& features) {
    const CornersOfTet p = corners_of(to_check.mesh, tet);
    const TetQuality quality = measure_tet(to_check.mesh, tet);
    findings.add(
        guarantee::thin_angles, p.centre(), {tet},
        "Tet {} at {}, {}, has dihedral angles from {:.6g} to {:.6g} degrees and face angles up to {:.6g}; "
        "{:.6g} to {:.6g} degrees are allowed, because circumradius / shortest edge is {:.6g}, above {:.6g}. "
        "If the mesh was made with another thin-angle, check the mesh with that value.",
        tet, At{p.centre()}, features, quality.min_dihedral, quality.max_dihedral,
        largest_face_angle(p.a, p.b, p.c, p.d), thin.smallest_angle(tet), ThinCells::largest_angle,
        quality.radius_edge, to_check.options.bounds.radius_edge);
  });
}

void check_region_tag(Index tet, const CornersOfTet& p, const MeshToCheck& to_check, Findings& findings) {
  const Index region = to_check.mesh.tet_region[tet];
  const Tag tag = to_check.mesh.tet_tag[tet], expected = to_check.plc.regions[region].tag;
  // Some formats store only the region, which is then read as the tag, too.
  const bool unknown = to_check.mesh.features.empty() && tag == static_cast<Tag>(region);
  if (tag != expected && !unknown)
    findings.add(guarantee::region_tag, p.centre(), {tet},
                 "Tet {} at {} has tag {}, but its region {} has tag {}; correct the tag or the region.", tet,
                 At{p.centre()}, tag, region, expected);
}

}  // namespace

void check_tets(const MeshToCheck& to_check, CheckReport& report, Findings& findings) {
  assert(to_check.collar.size() == to_check.mesh.tets.size());
  const TetMesh& mesh = to_check.mesh;
  std::vector<long double> volumes(to_check.plc.regions.size(), 0);
  const ThinCells thin(to_check);
  AllMissedAngles missed;
  const auto see = [&](Index tet, const TetQuality& quality) {
    const CornersOfTet p = corners_of(mesh, tet);
    const bool is_thin =
        thin.claimed(tet) && quality.radius_edge > to_check.options.bounds.radius_edge * shape_slack;
    if (tet < to_check.first_part) {
      report.measures.add(tet, quality, mesh.tet_region[tet],
                          to_check.collar[tet] != 0 ? MeshMeasures::Kind::collar
                          : is_thin                 ? MeshMeasures::Kind::thin
                                                    : MeshMeasures::Kind::plain);
      check_orientation({"Tet", tet}, {p.a, p.b, p.c, p.d}, quality.volume, findings);
    } else {
      report.measures.region_volumes[mesh.tet_region[tet]] += quality.volume;
    }
    if (!to_check.has_layers())
      check_shape(tet, p, quality, to_check, thin, report, missed, findings);
    else if (mesh.layers.tet_layer[tet] == 0)
      note_angles(quality, report);
    check_region_tag(tet, p, to_check, findings);
    volumes[mesh.tet_region[tet]] += quality.volume;
  };
  // All threads measure; findings and sums are made in the order of the tets.
  std::vector<TetQuality> qualities(std::min(in_a_batch, mesh.tets.size()));
  for (std::size_t first = 0; first < mesh.tets.size(); first += in_a_batch) {
    const std::size_t count = std::min(in_a_batch, mesh.tets.size() - first);
    parallel_for_ranges(count, measured_at_once, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        qualities[i] = measure_tet(mesh, static_cast<Index>(first + i));
      }
    });
    for (std::size_t i = 0; i < count; ++i) see(static_cast<Index>(first + i), qualities[i]);
  }
  report_missed_angles(to_check, thin, missed, findings);
  report.region_volumes.assign(volumes.begin(), volumes.end());
}

}  // namespace collarmesh::checks
