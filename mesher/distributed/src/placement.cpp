// Moves the vertices of a refined mesh onto the shape. Decisions about a vertex depend on all tets around it,
// which may be on several ranks. They only use minima, maxima and sums of whole numbers, whose results do not
// depend on the order. So the mesh is the same on any number of ranks, bit by bit.
#include "placement.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "angles.h"
#include "calls.h"
#include "common/cells_at_vertices.h"
#include "common/sort_uniquely.h"
#include "delaunay/predicates.h"
#include "local_mesh.h"
#include "project/rules.h"
#include "second_order/places_on_features.h"
#include "shared_points.h"

namespace collarmesh::distributed {

namespace {

using projection::least_gain;
using projection::longest_way;
using projection::retries;

// The violation of the bounds on angles, in degrees, at which the score of a tet is 0.
constexpr double tolerated = 10;
// Least score of a tet that may stay, unless it was worse before the move.
constexpr double least_score = 0.2;
// The score of a flat tet; inverted tets have lower scores.
constexpr double flat_score = -100;
// The unit of penalties, which are whole multiples of it. Doubles add these without rounding.
constexpr double unit_of_penalty = 0x1p-16;
// The maximum number of sweeps that make room, and the lengths of steps that a vertex tries, relative to its
// shortest edge.
constexpr unsigned most_sweeps = 60;
constexpr std::array<double, 3> steps{0.3, 0.1, 0.03};
constexpr std::size_t places = 2 + 6 * steps.size();  // places that a vertex tries, including its own
// A vertex that found no better place is tried in this many sweeps, because each sweep uses other directions,
// and again once something around it changes.
constexpr std::uint8_t tries = 4;
// A displacement off a plane or a straight curve counts as none if it is shorter than this times the shortest
// edge at the vertex.
constexpr double no_way = 1e-6;

std::uint64_t mixed(std::uint64_t h) {  // the finalizer of MurmurHash3
  h ^= h >> 33U;
  h *= 0xff51afd7ed558ccdULL;
  h ^= h >> 33U;
  h *= 0xc4ceb9fe1a85ec53ULL;
  return h ^ (h >> 33U);
}

/// Returns three orthogonal directions for a sweep.
std::array<Vector, 3> frame_of(unsigned sweep) {
  if (sweep == 0) return {Vector{1, 0, 0}, Vector{0, 1, 0}, Vector{0, 0, 1}};
  const double s = sweep;
  const Vector a{std::cos(2.4 * s), std::sin(2.4 * s), std::cos(1.7 * s)},
      b{std::sin(s), std::cos(1.3 * s), 0.6};
  const Vector u = a / norm(a), w = cross(u, b) / norm(cross(u, b));
  return {u, cross(w, u), w};
}

class Placement {
 public:
  Placement(DM dm, const Shape& shape, const AngleBounds& wanted)
      : dm_(dm),
        communicator_(PetscObjectComm(reinterpret_cast<PetscObject>(dm))),
        shape_(shape),
        wanted_(wanted),
        on_features_(shape.plc, shape.exact),
        vertices_(dm, 0) {}

  LevelReport run() {
    agree(communicator_, [&] {
      mesh_.emplace(dm_, 1);
      begin();
      find_places();
    });
    share_places();
    for (std::size_t v = 0; v < mesh_->points.size(); ++v)
      if (has_way_[v]) mesh_->points[v] = place_of(v);
    // Tets beyond the bounds on angles. Some have no moved corner: division alone may give poorer angles than
    // those of the coarse tets.
    std::vector<Index> look_at;
    std::int64_t spoilt = 0;
    for (Index t = 0; t < mesh_->tets.size(); ++t) {
      if (score(t, mesh_->corners(t)) < 1) look_at.push_back(t);
      if (!acceptable(t)) ++spoilt;
    }
    for (;;) {
      look_at = relax(std::move(look_at));
      std::vector<Index> changed = draw_back(look_at);
      if (all_reduce(communicator_, std::int64_t{!changed.empty()}, MPI_MAX) == 0) break;
      look_at.insert(look_at.end(), changed.begin(), changed.end());
      sort_uniquely(look_at);
    }
    for (unsigned k = 0; k < retries && try_again(k); ++k) {
    }
    agree(communicator_, [&] { set_points(dm_, mesh_->points); });
    return report(spoilt);
  }

 private:
  void begin() {
    const std::size_t n = mesh_->points.size();
    tets_at_ = {mesh_->tets, n};
    origins_ = mesh_->points;
    back_.assign(n, 0);
    frozen_.assign(n, false);
    fresh_.assign(n, tries);
    has_way_.assign(n, false);
  }

  // Finds the places of vertices. The owner of a vertex finds the place for all ranks that have the vertex.
  void find_places() {
    targets_ = origins_;
    for (std::size_t v = 0; v < mesh_->features.size(); ++v)
      if (vertices_.owned(v) && on_features_.has_places(mesh_->features[v]))
        targets_[v] = on_features_.place(mesh_->features[v], origins_[v]);
  }

  void share_places() {
    vertices_.take_owners(targets_);
    std::vector<PetscReal> shortest(origins_.size(), INFINITY);
    for (const auto& tet : mesh_->tets)
      for (unsigned i = 0; i < 4; ++i)
        for (unsigned j = i + 1; j < 4; ++j) {
          const double length = squared_distance(origins_[tet[i]], origins_[tet[j]]);
          shortest[tet[i]] = std::min(shortest[tet[i]], length);
          shortest[tet[j]] = std::min(shortest[tet[j]], length);
        }
    vertices_.combine(shortest, MPI_MIN);
    for (std::size_t v = 0; v < targets_.size(); ++v) {
      if (!std::isfinite(squared_norm(targets_[v]))) targets_[v] = origins_[v];
      const double way = squared_distance(targets_[v], origins_[v]);
      has_way_[v] = way > 0;
      if (is_flat(v) && way <= no_way * no_way * shortest[v]) {
        origins_[v] = mesh_->points[v] = targets_[v];
        has_way_[v] = false;
      }
      if (way > longest_way * longest_way * shortest[v]) back_[v] = shares.size() - 1;
    }
  }

  Point place_of(std::size_t v) const {
    const double share = shares[back_[v]];
    return share == 1 ? targets_[v] : origins_[v] + share * (targets_[v] - origins_[v]);
  }
  double way_of(std::size_t v) const {
    return has_way_[v] ? shares[back_[v]] * distance(targets_[v], origins_[v]) : 0;
  }

  bool is_flat(std::size_t v) const { return on_features_.is_flat(mesh_->features[v]); }
  /// Returns the place of a vertex after a displacement along its feature.
  Point displaced(Index v, const Vector& displacement) {
    const Point& p = mesh_->points[v];
    const auto& [dimension, feature] = mesh_->features[v];
    if (dimension == 3) return p + displacement;
    if (!is_flat(v)) return on_features_.place(mesh_->features[v], p + displacement);
    if (dimension == 2) {
      const Vector& normal = shape_.plc.patches[feature].normal;
      return p + displacement - dot(displacement, normal) * normal;
    }
    const std::vector<Index>& chain = shape_.plc.curves[feature].points;
    const Vector chord = shape_.plc.points[chain.back()] - shape_.plc.points[chain.front()];
    return p + dot(displacement, chord) / squared_norm(chord) * chord;
  }
  /// Returns whether a vertex may move. A vertex on a feature slides along the feature, but only after it has
  /// reached its place there.
  bool is_free(std::size_t v) const {
    if (frozen_[v]) return false;
    const auto& [dimension, feature] = mesh_->features[v];
    if (dimension == 3) return true;
    return feature != none && dimension > 0 && (is_flat(v) ? !has_way_[v] : back_[v] == 0);
  }

  double least(Index tet) const { return wanted_.least[mesh_->tet_collar[tet] != 0 ? 1 : 0]; }
  double most(Index tet) const { return wanted_.most[mesh_->tet_collar[tet] != 0 ? 1 : 0]; }

  /// Returns the score of a tet: 1 within the bounds on angles, 0 if it violates them by `tolerated`, linear
  /// between and below; at most `flat_score` for flat and inverted tets.
  double score(Index tet, const Corners& p) const {
    const double six = six_volume(p[0], p[1], p[2], p[3]);
    if (!(six > 0)) return flat_score + projection::score_of_inverted(p, six);
    const ExtremeAngles angles = extreme_angles(p);
    return 1 + std::min({0.0, angles.least - least(tet), most(tet) - angles.most}) / tolerated;
  }
  /// Returns the penalty of a tet: the fourth power of 1 minus its score, in units of `unit_of_penalty`,
  /// rounded to a whole number.
  double penalty(Index tet, const Corners& p) const {
    const double missing = 1 - score(tet, p);
    return std::nearbyint(missing * missing * missing * missing / unit_of_penalty);
  }

  bool acceptable(Index tet) const {
    const Corners p = mesh_->corners(tet);
    if (predicates::orientation(p[0], p[1], p[2], p[3]) <= 0) return false;
    const double now = score(tet, p);
    if (now >= least_score) return true;
    const auto& [a, b, c, d] = mesh_->tets[tet];
    return now >= score(tet, {origins_[a], origins_[b], origins_[c], origins_[d]});
  }

  bool on_course(const std::array<Index, 2>& edge) const {
    const auto& [a, b] = edge;
    return projection::on_course(origins_[b] - origins_[a], mesh_->points[b] - mesh_->points[a]);
  }

  /// Moves vertices, inside regions and along their features, to places where the tets around them have
  /// smaller penalties. Returns the given tets and those around moved vertices.
  std::vector<Index> relax(std::vector<Index> tets) {
    for (unsigned sweep = 0; sweep < most_sweeps; ++sweep) {
      const std::vector<Index> movers = independent_vertices(tets, sweep);
      if (all_reduce(communicator_, std::int64_t{!movers.empty()}, MPI_MAX) == 0) break;
      const std::vector<Index> moved = move(movers, frame_of(sweep));
      std::vector<PetscInt> touched(mesh_->points.size(), 0);
      for (const Index v : moved)
        for (const Index t : tets_at_[v]) {
          tets.push_back(t);
          for (const Index w : mesh_->tets[t]) touched[w] = 1;
        }
      vertices_.combine(touched, MPI_MAX);
      for (const Index v : movers) --fresh_[v];
      for (std::size_t v = 0; v < touched.size(); ++v)
        if (touched[v] > 0) fresh_[v] = tries;
      sort_uniquely(tets);
    }
    return tets;
  }

  std::uint64_t priority(Index vertex, unsigned sweep) const {
    const Point& p = origins_[vertex];
    std::uint64_t h = sweep;
    for (std::size_t axis = 0; axis < 3; ++axis) h = mixed(h ^ std::bit_cast<std::uint64_t>(p[axis] + 0.0));
    return h;
  }

  /// Returns vertices of tets beyond the bounds on angles that are free and have tries left; no two of one
  /// tet.
  std::vector<Index> independent_vertices(const std::vector<Index>& tets, unsigned sweep) const {
    std::vector<PetscInt> wishes(mesh_->points.size(), 0);
    for (const Index t : tets) {
      if (score(t, mesh_->corners(t)) >= 1) continue;
      for (const Index v : mesh_->tets[t])
        if (is_free(v) && fresh_[v] != 0) wishes[v] = 1;
    }
    vertices_.combine(wishes, MPI_MAX);
    return independent(wishes, sweep);
  }

  /// Returns the vertices marked in `wishes`, but only one of two that share a tet: the one with the greater
  /// hash of the sweep and of its place before this level. All ranks that have a vertex decide alike if they
  /// have the same wishes.
  std::vector<Index> independent(const std::vector<PetscInt>& wishes, unsigned sweep) const {
    std::vector<Index> vertices;
    std::vector<PetscInt> yields(mesh_->points.size(), 0);
    for (Index v = 0; v < wishes.size(); ++v) {
      if (wishes[v] == 0) continue;
      vertices.push_back(v);
      const std::uint64_t own = priority(v, sweep);
      for (const Index t : tets_at_[v])
        for (const Index w : mesh_->tets[t])
          if (w != v && wishes[w] != 0 && priority(w, sweep) >= own) yields[v] = 1;
    }
    vertices_.combine(yields, MPI_MAX);
    std::erase_if(vertices, [&](Index v) { return yields[v] != 0; });
    return vertices;
  }

  /// Combines the values of these vertices (`width` values for each) over the ranks that have them.
  void combine(const std::vector<Index>& vertices, std::vector<PetscReal>& values, MPI_Op operation,
               std::size_t width) const {
    const std::vector<std::size_t>& shared = vertices_.shared();
    std::vector<PetscReal> of_shared(shared.size() * width, 0);
    const auto for_each_shared = [&](const auto& visit) {  // both lists are ascending
      std::size_t i = 0;
      for (std::size_t k = 0; k < shared.size(); ++k) {
        while (i < vertices.size() && vertices[i] < shared[k]) ++i;
        if (i < vertices.size() && vertices[i] == shared[k])
          for (std::size_t c = 0; c < width; ++c) visit(of_shared[k * width + c], values[i * width + c]);
      }
    };
    for_each_shared([](PetscReal& there, const PetscReal& here) { there = here; });
    vertices_.combine_shared(of_shared, operation, width);
    for_each_shared([](const PetscReal& there, PetscReal& here) { here = there; });
  }

  /// Returns the sum of the penalties that the tets around a vertex have if it is at `place`; if the sum is
  /// at least `enough`, maybe only a part of it that is at least `enough`, too.
  double penalty_around(Index vertex, const Point& place, double enough) const {
    double sum = 0;
    for (const Index t : tets_at_[vertex]) {
      Corners p = mesh_->corners(t);
      for (unsigned i = 0; i < 4; ++i)
        if (mesh_->tets[t][i] == vertex) p[i] = place;
      sum += penalty(t, p);
      if (sum >= enough) break;
    }
    return sum;
  }

  std::vector<Index> move(const std::vector<Index>& movers, const std::array<Vector, 3>& frame) {
    // The facts about a vertex: its shortest edge, then the box of its neighbours, with the upper corner
    // negated.
    constexpr std::size_t facts = 7;
    std::vector<PetscReal> known(facts * movers.size(), INFINITY), before, after(places * movers.size());
    for (std::size_t i = 0; i < movers.size(); ++i) {
      PetscReal* own = &known[facts * i];
      const Index v = movers[i];
      before.push_back(penalty_around(v, mesh_->points[v], INFINITY));
      for (const Index t : tets_at_[v])
        for (const Index w : mesh_->tets[t]) {
          if (w == v) continue;
          const Point& p = mesh_->points[w];
          own[0] = std::min(own[0], distance(p, mesh_->points[v]));
          for (std::size_t axis = 0; axis < 3; ++axis) {
            own[1 + axis] = std::min(own[1 + axis], p[axis]);
            own[4 + axis] = std::min(own[4 + axis], -p[axis]);
          }
        }
    }
    combine(movers, known, MPI_MIN, facts);
    combine(movers, before, MPI_SUM, 1);
    std::vector<PetscReal> tried;
    tried.reserve(3 * places * movers.size());
    agree(communicator_, [&] {
      for (std::size_t i = 0; i < movers.size(); ++i) {
        if (vertices_.owned(movers[i]))
          for (const Point& p : places_of(movers[i], &known[facts * i], frame))
            tried.insert(tried.end(), {p.x, p.y, p.z});
        tried.resize(3 * places * (i + 1), 0);
      }
    });
    combine(movers, tried, MPI_REPLACE, 3 * places);
    const auto place = [&](std::size_t i, std::size_t k) {
      const PetscReal* at = &tried[3 * (places * i + k)];
      return Point{at[0], at[1], at[2]};
    };
    for (std::size_t i = 0; i < movers.size(); ++i)
      for (std::size_t k = 0; k < places; ++k)
        after[places * i + k] = penalty_around(movers[i], place(i, k), before[i]);
    combine(movers, after, MPI_SUM, places);
    std::vector<Index> moved;
    for (std::size_t i = 0; i < movers.size(); ++i) {
      const auto first = after.begin() + static_cast<std::ptrdiff_t>(places * i);
      const auto best = std::min_element(first, first + static_cast<std::ptrdiff_t>(places));
      if (!(*best < (1 - least_gain) * before[i])) continue;
      const Index v = movers[i];
      mesh_->points[v] = place(i, static_cast<std::size_t>(best - first));
      if (has_way_[v]) targets_[v] = mesh_->points[v];
      moved.push_back(v);
      if (vertices_.owned(v)) ++moves_;
    }
    return moved;
  }

  std::array<Point, places> places_of(Index vertex, const PetscReal* known,
                                      const std::array<Vector, 3>& frame) {
    const Point& p = mesh_->points[vertex];
    const Point centre{0.5 * (known[1] - known[4]), 0.5 * (known[2] - known[5]), 0.5 * (known[3] - known[6])};
    std::array<Point, places> tried{displaced(vertex, centre - p), displaced(vertex, 0.5 * (centre - p))};
    std::size_t k = 2;
    for (const double step : steps)
      for (const Vector& direction : frame)
        for (const double sign : {1.0, -1.0})
          tried[k++] = displaced(vertex, sign * step * known[0] * direction);
    return tried;
  }

  /// Moves vertices back a step. In each tet that cannot stay, these are the vertices with the longest
  /// displacement onto features or, if no vertex has one left, those that moved to make room; on each edge of
  /// a curve that is not `on_course`, the end with the longest displacement. Returns the tets around them.
  std::vector<Index> draw_back(const std::vector<Index>& tets) {
    std::vector<PetscInt> marks(mesh_->points.size(), 0);
    const auto mark = [&](const auto& corners) {
      return mark_longest(
          corners, [this](Index v) { return way_of(v); }, marks);
    };
    for (const Index t : tets) {
      if (acceptable(t) || mark(mesh_->tets[t])) continue;
      for (const Index v : mesh_->tets[t])
        if (!has_way_[v] && mesh_->points[v] != origins_[v]) marks[v] = 1;
    }
    for (const auto& edge : mesh_->edges)
      if (!on_course(edge)) mark(edge);
    vertices_.combine(marks, MPI_MAX);
    std::vector<Index> around;
    std::vector<PetscInt> touched(mesh_->points.size(), 0);
    for (std::size_t v = 0; v < marks.size(); ++v) {
      if (marks[v] == 0) continue;
      frozen_[v] = true;
      if (!has_way_[v]) {
        mesh_->points[v] = origins_[v];
      } else {
        ++back_[v];
        mesh_->points[v] = place_of(v);
      }
      for (const Index t : tets_at_[static_cast<Index>(v)]) {
        around.push_back(t);
        for (const Index w : mesh_->tets[t]) touched[w] = 1;
      }
    }
    vertices_.combine(touched, MPI_MAX);
    for (std::size_t v = 0; v < touched.size(); ++v)
      if (touched[v] > 0) fresh_[v] = tries;
    sort_uniquely(around);
    return around;
  }

  /// Moves vertices that were drawn back towards their places once more, if their tets now permit it. Returns
  /// whether any vertex moved.
  bool try_again(unsigned sweep) {
    std::vector<PetscInt> wishes(mesh_->points.size(), 0);
    for (std::size_t v = 0; v < wishes.size(); ++v) wishes[v] = has_way_[v] && back_[v] > 0 ? 1 : 0;
    const std::vector<Index> vertices = independent(wishes, sweep);
    const CellsAtVertices curve_edges_at(mesh_->edges, mesh_->points.size());
    constexpr std::size_t width = shares.size() - 1;
    std::vector<PetscReal> fits(width * vertices.size(), 0);
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const Index v = vertices[i];
      const std::uint8_t back = back_[v];
      for (back_[v] = 0; back_[v] < back; ++back_[v]) {
        mesh_->points[v] = place_of(v);
        const auto tets = tets_at_[v];
        const auto edges = curve_edges_at[v];
        fits[width * i + back_[v]] =
            std::all_of(tets.begin(), tets.end(), [&](Index t) { return acceptable(t); }) &&
                    std::all_of(edges.begin(), edges.end(),
                                [&](Index e) { return on_course(mesh_->edges[e]); })
                ? 1
                : 0;
      }
      mesh_->points[v] = place_of(v);
    }
    combine(vertices, fits, MPI_MIN, width);
    std::int64_t any = 0;
    for (std::size_t i = 0; i < vertices.size(); ++i)
      for (std::uint8_t back = 0; back < back_[vertices[i]]; ++back)
        if (fits[width * i + back] > 0) {
          back_[vertices[i]] = back;
          mesh_->points[vertices[i]] = place_of(vertices[i]);
          any = 1;
        }
    return all_reduce(communicator_, any, MPI_MAX) > 0;
  }

  LevelReport report(std::int64_t spoilt) const {
    LevelReport r;
    r.tets = static_cast<std::int64_t>(mesh_->tets.size());
    r.spoilt = spoilt;
    r.made_room = moves_;
    for (std::size_t v = 0; v < mesh_->features.size(); ++v) {
      if (!vertices_.owned(v) || !has_way_[v]) continue;
      ++r.on_features;
      if (back_[v] == 0) continue;
      ++r.drawn_back;
      r.farthest_off = std::max(r.farthest_off, (1 - shares[back_[v]]) * distance(targets_[v], origins_[v]));
    }
    for (std::int64_t* sum : {&r.tets, &r.on_features, &r.spoilt, &r.made_room, &r.drawn_back})
      *sum = all_reduce(communicator_, *sum, MPI_SUM);
    r.farthest_off = all_reduce(communicator_, r.farthest_off, MPI_MAX);
    return r;
  }

  DM dm_;
  MPI_Comm communicator_;
  const Shape& shape_;
  const AngleBounds& wanted_;
  second_order::PlacesOnFeatures on_features_;
  SharedPoints vertices_;
  std::optional<LocalMesh> mesh_;
  CellsAtVertices tets_at_;
  std::vector<Point> origins_, targets_;
  std::vector<std::uint8_t> back_;  // by vertex: its index in shares
  std::vector<bool> has_way_, frozen_;
  std::vector<std::uint8_t> fresh_;  // by vertex: number of tries left unless something around it changes
  std::int64_t moves_ = 0;
};

}  // namespace

LevelReport place(DM dm, const Shape& shape, const AngleBounds& wanted) {
  return Placement(dm, shape, wanted).run();
}

}  // namespace collarmesh::distributed
