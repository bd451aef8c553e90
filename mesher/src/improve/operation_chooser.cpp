#include "improve/operation_chooser.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/cell_shapes.h"

namespace collarmesh::remeshing::improvement {

namespace {

// All tets at an inserted vertex must have at least this share of the wanted quality.
constexpr double enough = 0.7;

}  // namespace

OperationChooser::OperationChooser(const EditableMesh& edited, const SliverRule& rule,
                                   const ImproveOptions& options, bool refill)
    : complex_(edited.complex),
      rule_(rule),
      thin_above_(options.thin_above > 0 ? options.thin_above : options.bounds.radius_edge),
      wanted_(std::sin(options.min_dihedral * std::numbers::pi / 180)),
      move_vertices_(options.move_vertices),
      keep_vertices_(options.keep_vertices),
      refill_(refill) {}

double OperationChooser::poor_quality(Index tet) const {
  if (!complex_[tet].alive || complex_[tet].collar) return INFINITY;
  if (rule_.surely_exceeds(wanted_, complex_.corners(tet))) return INFINITY;
  const double q = quality(tet);
  if (q >= wanted_ || rule_.is_as_forced(complex_.corners(tet), complex_[tet].corners)) return INFINITY;
  return q;
}

Change OperationChooser::propose(Operations& operations, Index tet) const {
  Change change;
  operations.remove_best_edge(tet, change);
  const auto& corners = complex_[tet].corners;
  const auto found = [&] { return !change.is_none(); };
  if (found() || !move_vertices_) return change;
  for (const Index v : corners)
    if (!stays(v)) operations.move_vertex(v, change);
  if (found() || !may_change_vertices(tet)) return change;
  operations.collapse_best_edge(tet, change);
  for (const auto& [i, j] : cell_shapes::corner_pairs)
    if (!found()) operations.split_edge(corners[i], corners[j], enough * wanted_, change);
  if (found() || !rule_.is_too_obtuse(quality(tet))) return change;
  // Reconnection helps flat tets, such as those between two prisms of a thin wall.
  if (refill_) operations.reconnect(tet, change);
  if (found()) return change;
  // A longer edge is better than a missed guarantee, so any length is allowed here.
  operations.collapse_best_edge(tet, change, Operations::Lengths::any);
  return change;
}

bool OperationChooser::may_change_vertices(Index tet) const {
  if (!keep_vertices_ || rule_.is_too_obtuse(quality(tet))) return true;
  std::vector<Index> star;
  for (const Index v : complex_[tet].corners) {
    complex_.star(v, star);
    if (std::ranges::any_of(star, [this](Index t) { return is_thin(t); })) return false;
  }
  return true;
}

void OperationChooser::set_stays(Index tet, bool stays) {
  stays_.resize(complex_.mesh().points.size(), false);
  for (const Index v : complex_[tet].corners) stays_[v] = stays;
}

}  // namespace collarmesh::remeshing::improvement
