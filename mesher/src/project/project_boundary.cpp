// Boundary vertices onto exact geometry: all at once, then back where that spoils a tet.
#include "collarmesh/project_boundary.h"

#include <algorithm>
#include <cmath>

#include "delaunay/predicates.h"

namespace collarmesh {

namespace {

class BoundaryProjection {
 public:
  BoundaryProjection(TetMesh& mesh, const Plc& plc, const ExactGeometry& exact, const ProjectOptions& options,
                     const Execution& execution)
      : mesh_(mesh),
        exact_(exact),
        options_(options),
        execution_(execution),
        reach_(options.reach > 0 ? options.reach : default_reach * plc.bounds.diagonal()),
        slot_of_(mesh.points.size(), none) {}

  ProjectReport run() {
    find_targets();
    if (execution_.cancelled()) return report_;
    find_tets();
    for (Move& move : moves_) put(move, true);
    while (undo_spoilt_tets()) {
    }
    for (int pass = 0; pass < retries && retry(); ++pass) {
    }
    shrink_balls();
    finish();
    return report_;
  }

 private:
  static constexpr double default_reach = 1e-3;
  static constexpr int retries = 3;

  struct Move {
    Index point;
    Point from, to;
    bool done = false;
  };

  void find_targets() {
    for (Index p = 0; p < mesh_.features.size(); ++p) {
      const auto [dimension, feature] = mesh_.features[p];
      if ((dimension != 1 && dimension != 2) || feature == none) continue;
      if (p % 1024 == 0 && execution_.cancelled()) return;
      const std::optional<Point> target = exact_(dimension, feature, mesh_.points[p]);
      if (!target) continue;
      ++report_.vertices;
      const double off = distance(*target, mesh_.points[p]);
      if (!(off <= reach_)) {
        add_exception(p, off);
      } else if (off > 0) {
        slot_of_[p] = static_cast<Index>(moves_.size());
        moves_.push_back({p, mesh_.points[p], *target});
      }
    }
  }

  // The tets at each vertex that moves.
  void find_tets() {
    first_.assign(moves_.size() + 1, 0);
    for_each_use([&](Index slot, Index) { ++first_[slot + 1]; });
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    tets_.resize(first_.back());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for_each_use([&](Index slot, Index tet) { tets_[next[slot]++] = tet; });
    for (Index t = 0; t < mesh_.tets.size(); ++t)
      if (moves_at(t)) pending_.push_back(t);
  }

  template <class Visit>
  void for_each_use(const Visit& visit) const {
    for (Index t = 0; t < mesh_.tets.size(); ++t)
      for (const Index p : mesh_.tets[t])
        if (slot_of_[p] != none) visit(slot_of_[p], t);
  }

  bool moves_at(Index tet) const {
    const auto& t = mesh_.tets[tet];
    return std::any_of(t.begin(), t.end(), [&](Index p) { return slot_of_[p] != none; });
  }

  void put(Move& move, bool done) {
    move.done = done;
    mesh_.points[move.point] = done ? move.to : move.from;
  }

  TetQuality quality(Index tet, bool before) const {
    std::array<Point, 4> corners;
    for (unsigned i = 0; i < 4; ++i) {
      const Index p = mesh_.tets[tet][i];
      corners[i] = before && slot_of_[p] != none ? moves_[slot_of_[p]].from : mesh_.points[p];
    }
    return measure(corners[0], corners[1], corners[2], corners[3]);
  }

  // A tet that missed its bound before may do so, but not by more.
  bool good(Index tet) const {
    const auto& [a, b, c, d] = mesh_.tets[tet];
    const auto& points = mesh_.points;
    if (predicates::orientation(points[a], points[b], points[c], points[d]) <= 0) return false;
    const TetQuality now = quality(tet, false);
    if (mesh_.tet_collar[tet] != 0)
      return now.max_dihedral <= options_.collar_angle || now.max_dihedral <= quality(tet, true).max_dihedral;
    return now.radius_edge <= options_.radius_edge || now.radius_edge <= quality(tet, true).radius_edge;
  }

  // Judges the pending tets; those around what went back are pending then. False: nothing went back.
  bool undo_spoilt_tets() {
    std::vector<Index> spoilt;
    for (const Index t : pending_)
      if (!good(t)) spoilt.push_back(t);
    pending_.clear();
    for (const Index t : spoilt)
      for (const Index p : mesh_.tets[t])
        if (slot_of_[p] != none && moves_[slot_of_[p]].done) undo(slot_of_[p]);
    std::sort(pending_.begin(), pending_.end());
    pending_.erase(std::unique(pending_.begin(), pending_.end()), pending_.end());
    return !pending_.empty();
  }

  void undo(Index slot) {
    put(moves_[slot], false);
    pending_.insert(pending_.end(), tets_.begin() + static_cast<std::ptrdiff_t>(first_[slot]),
                    tets_.begin() + static_cast<std::ptrdiff_t>(first_[slot + 1]));
  }

  // One by one, what went back may go now. True: something did.
  bool retry() {
    bool any = false;
    for (Index slot = 0; slot < moves_.size(); ++slot) {
      if (moves_[slot].done) continue;
      put(moves_[slot], true);
      const bool fits = std::all_of(tets_.begin() + static_cast<std::ptrdiff_t>(first_[slot]),
                                    tets_.begin() + static_cast<std::ptrdiff_t>(first_[slot + 1]),
                                    [&](Index t) { return good(t); });
      if (fits)
        any = true;
      else
        put(moves_[slot], false);
    }
    return any;
  }

  void finish() {
    for (const Move& move : moves_) {
      const double off = distance(move.from, move.to);
      if (move.done)
        report_.largest_move = std::max(report_.largest_move, off);
      else if (off > options_.tolerance)
        add_exception(move.point, off);
      else
        report_.largest_distance = std::max(report_.largest_distance, off);
    }
  }

  // Balls whose centres moved: the part that surely lies in the former one keeps its distances.
  void shrink_balls() {
    for (TetMesh::CollarBall& ball : mesh_.collar_balls) {
      const Index slot = slot_of_[ball.point];
      if (slot != none && moves_[slot].done) ball.radius -= distance(moves_[slot].from, moves_[slot].to);
    }
  }

  void add_exception(Index p, double off) {
    report_.largest_distance = std::max(report_.largest_distance, off);
    report_.exceptions.push_back(
        {p, mesh_.features[p].dimension, mesh_.features[p].feature, mesh_.points[p], off});
  }

  TetMesh& mesh_;
  const ExactGeometry& exact_;
  const ProjectOptions& options_;
  const Execution& execution_;
  double reach_;
  std::vector<Index> slot_of_;  // in moves_, by point
  std::vector<Move> moves_;
  std::vector<std::size_t> first_;  // in tets_, by slot
  std::vector<Index> tets_;
  std::vector<Index> pending_;
  ProjectReport report_;
};

}  // namespace

ProjectReport project_boundary(TetMesh& mesh, const Plc& plc, const ExactGeometry& exact,
                               const ProjectOptions& options, const Execution& execution) {
  return BoundaryProjection(mesh, plc, exact, options, execution).run();
}

}  // namespace collarmesh
