#include "remesh/thin_shape.h"

#include "collarmesh/plc_builder.h"
#include "common/parallel_for.h"

namespace collarmesh::remeshing {

namespace {

constexpr double radians = std::numbers::pi / 180;

// A little below the value of the certificate, because normals turn when vertices move.
constexpr double least_cosine = ForcedEdges::least_cosine_of_sides - 0.02;

/// Returns the largest narrowness at which ForcedEdges::smallest_angle, times `share`, may have a sine below
/// `least`.
double narrowness_of_sine(double least, double share) {
  constexpr double margin = 1e-6;
  const double angle = 2 * std::asin(least) / share;
  return angle < 0.5 * std::numbers::pi ? std::tan(angle) * (1 + margin) : INFINITY;
}

double sine_above(double degrees) { return std::sin((degrees + 2 * ThinShape::rounding) * radians); }

// Returns true only for tets within the bound, and for most of them; much faster than `measure`. Because the
// radius is at least half the longest edge, the relative error of its square is at most some units of 2^-53
// times longest^3 / (six times the volume), which is below 1e-9 here.
bool well_within(const Corners& p, double radius_edge) {
  constexpr double margin = 1e-6, least_volume = 1e-4;
  const Circumsphere sphere = circumsphere(p);
  return sphere.squared_radius <= (1 - margin) * radius_edge * radius_edge * sphere.shortest_squared_edge &&
         sphere.six_volume >
             least_volume * sphere.longest_squared_edge * std::sqrt(sphere.longest_squared_edge);
}

}  // namespace

std::shared_ptr<const ForcedEdges> forced_edges_of(const Plc& plc, const TetMesh& mesh, bool lower_bounds) {
  if (!lower_bounds || mesh.features.size() != mesh.points.size()) return nullptr;
  return std::make_shared<const ForcedEdges>(plc, mesh.features, mesh.points, mesh.faces, mesh.face_patch,
                                             least_cosine);
}

ThinShape::ThinShape(const Plc& plc, const TetMesh& mesh, double smallest_angle, double reserve,
                     std::shared_ptr<const ForcedEdges> forced, double tets_across)
    : smallest_(smallest_angle * (1 + reserve)),
      sine_(sine_above(smallest_)),
      cosine_(
          signed_square(std::cos((180 - (180 - largest_angle) * (1 + reserve) - 2 * rounding) * radians))),
      sine_of_largest_(sine(cosine_)),
      inverse_squared_sine_of_largest_(1 / squared_sine(cosine_)),
      share_((1 + reserve) / tets_across),
      deep_narrowness_(narrowness_of_sine(deep, share_)),
      forced_(std::move(forced)) {
  if (empty()) return;
  std::vector<double> of_vertex(plc.vertices.size(), smallest_), of_curve(plc.curves.size(), smallest_);
  bool any = false;
  for (const Crease& crease : find_creases(plc, 2 * tets_across * smallest_angle)) {
    any = true;
    const auto lower = [&](double& bound) { bound = std::min(bound, 0.5 * crease.angle * share_); };
    if (crease.vertex != none) lower(of_vertex[crease.vertex]);
    if (crease.curve == none) continue;
    lower(of_curve[crease.curve]);
    for (const Index end : plc.curves[crease.curve].ends)
      if (end != none) lower(of_vertex[end]);
  }
  if (!any) return;
  sine_at_vertex_.assign(mesh.points.size(), sine_);
  for (Index v = 0; v < mesh.features.size(); ++v) {
    const auto& [dimension, feature] = mesh.features[v];
    if (feature == none) continue;
    if (dimension == 0) sine_at_vertex_[v] = sine_above(of_vertex[feature]);
    if (dimension == 1) sine_at_vertex_[v] = sine_above(of_curve[feature]);
  }
}

double ThinShape::forced_sine(MeasuredTet& tet) const {
  if (!forced_) return 1;
  const double narrowness = tet.narrowness(*forced_);
  return narrowness < 1 ? sine_above(share_ * ForcedEdges::smallest_angle(narrowness)) : 1;
}

double ThinShape::deep_forced_sine(MeasuredTet& tet) const {
  if (!forced_) return 1;
  const double narrowness = tet.narrowness(*forced_);
  if (narrowness >= std::min(1.0, deep_narrowness_)) return 1;
  const double sine = sine_above(share_ * ForcedEdges::smallest_angle(narrowness));
  return sine < deep ? sine : 1;
}

void mark_thin_tets(TetMesh& mesh, double radius_edge) {
  mesh.tet_thin.assign(mesh.tets.size(), 0);
  parallel_for_in_chunks(mesh.tets.size(), [&](std::size_t t) {
    if (mesh.tet_collar[t] != 0) return;
    const auto& v = mesh.tets[t];
    const Corners p{mesh.points[v[0]], mesh.points[v[1]], mesh.points[v[2]], mesh.points[v[3]]};
    if (!well_within(p, radius_edge) && measure(p[0], p[1], p[2], p[3]).radius_edge > radius_edge)
      mesh.tet_thin[t] = 1;
  });
}

}  // namespace collarmesh::remeshing
