#include "repair/snapping.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <span>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "common/distances.h"
#include "facets/edges.h"
#include "repair/changes.h"
#include "repair/changing_triangles.h"
#include "repair/point_grid.h"
#include "repair/polygon_cutter.h"
#include "repair/twins.h"

namespace collarmesh::repairing {

namespace {

using namespace facets;

constexpr std::size_t most_rounds = 50, most_rounds_after_overlay = 12;
constexpr std::size_t most_places = 100;
constexpr std::size_t most_overlays = 10, few_crossings = 100;

// What has not been looked at yet, in `Origin::facet`, which means nothing else here.
constexpr Index unseen_by_corners = 1, unseen_by_overlay = 2, unseen = 3;

// Each round looks at the triangles that the one before has changed.
class Snapper {
 public:
  Snapper(Draft& draft, double distance_limit, SnapWhat what, Work& work, bool cancel)
      : cancel_(cancel),
        draft_(draft),
        limit_(distance_limit),
        what_(what),
        work_(work),
        triangles_(draft, distance_limit, work),
        grid_(draft.points, distance_limit),
        crossing_points_(draft.points, distance_limit) {}

  SnapReport run(const std::vector<bool>& known) {
    find_pinned_points();
    begin(known);
    if (!known.empty()) cancel_new_twins();
    // Corners alone are few after a cut: where they multiply triangles, these run along each other.
    most_triangles_ = triangles_.count() / (what_ == SnapWhat::corners ? 4 : 1) + triangles_.count() + 1000;
    if (Draft before = draft_; !snap_all_corners()) return keep_settled(before, 0, unseen_by_corners);
    if (what_ != SnapWhat::all) return finish();
    // Overlays make new corners. Where one makes many and more than half as many as the one before, where
    // corners come and go, and where there are too many overlays, the places are taken back that still
    // change.
    const Draft before = triangles_.compacted();
    const std::size_t done_before = done_.size();
    std::size_t crossings = none;
    for (std::size_t overlays = 0;; ++overlays) {
      if (!overlay()) return finish();
      const std::size_t count = crossing_.size() + inside_.size();
      cancel_new_twins();
      if (overlays == most_overlays || (count > few_crossings && 2 * count > crossings) ||
          !snap_all_corners(most_rounds_after_overlay) || !settled_)
        break;
      crossings = count;
    }
    return keep_settled(before, done_before, unseen);
  }

 private:
  struct OnEdge {
    double parameter;  // from the smaller end
    Index point;
  };

  // All but the triangles that are known are to be looked at, and the points that none of those has.
  void begin(const std::vector<bool>& known) {
    in_grid_.assign(draft_.points.size(), false);
    for (Index t = 0; t < triangles_.end(); ++t) {
      // Only borders can be near anything there.
      if (what_ == SnapWhat::borders && !has_border(t)) {
        draft_.origins[t].facet = 0;
        continue;
      }
      if (known.empty() || !known[t]) {
        draft_.origins[t].facet = unseen;
        for (auto& list : unseen_) list.push_back(t);
        if (!known.empty()) added_.push_back(t);
        continue;
      }
      draft_.origins[t].facet = 0;
      for (const Index p : draft_.triangles[t]) in_grid_[p] = true;
    }
    for (Index p = 0; p < draft_.points.size(); ++p)
      if (in_grid_[p])
        grid_.add(p);
      else
        touched_.push_back(p);
  }

  SnapReport finish() {
    draft_ = triangles_.compacted();
    for (const Done& done : done_) count(done);
    return std::move(report_);
  }

  // Take back what was done since then where triangles are still to be looked at by these.
  SnapReport keep_settled(const Draft& before, std::size_t done_before, Index by) {
    const Draft after = triangles_.compacted();
    const Changes changes(before, after);
    std::vector<bool> changing(changes.places(), false), kept_at(after.points.size(), true);
    for (Index t = 0; t < after.triangles.size(); ++t)
      if (const Index place = changes.place_of_come()[t]; place != none && (after.origins[t].facet & by) != 0)
        changing[place] = true;
    const auto mark = [&](const Draft& draft, const std::vector<Index>& place) {
      for (Index t = 0; t < place.size(); ++t)
        if (place[t] != none)
          for (const Index p : draft.triangles[t]) kept_at[p] = !changing[place[t]];
    };
    mark(before, changes.place_of_gone());
    mark(after, changes.place_of_come());
    for (std::size_t i = 0; i < done_.size(); ++i)
      if (i < done_before || kept_at[done_[i].point]) count(done_[i]);
    std::vector<Index> place;
    draft_ = changes.without(changing, place);
    return std::move(report_);
  }

  // Until nothing is near or many rounds are over; false where triangles grow and grow.
  bool snap_all_corners(std::size_t rounds = most_rounds) {
    settled_ = false;
    for (std::size_t round = 0; round < rounds; ++round) {
      const bool merged = merge_points(), snapped = snap_corners();
      if (grows_) return false;
      settled_ = !merged && !snapped;
      if (settled_) return true;
      cancel_new_twins();
      if (triangles_.count() > most_triangles_) return false;
    }
    return true;
  }

  const Point& at(Index p) const { return draft_.points[p]; }

  // A change to be told.
  struct Done {
    enum class What { merged, cut_edge, cut_triangle, more } what;
    Index point;
    double moved;
  };

  void count(const Done& done) {
    if (done.what == Done::What::merged) ++report_.merged_points;
    if (done.what == Done::What::cut_edge) ++report_.cut_edges;
    if (done.what == Done::What::cut_triangle) ++report_.cut_triangles;
    report_.largest_distance = std::max(report_.largest_distance, done.moved);
    if (report_.places.size() < most_places) report_.places.push_back(at(done.point));
  }

  // --- Triangles that come and go ---

  void put(const facets::Corners& corners, Origin origin) {
    origin.facet = unseen;
    const Index t = triangles_.add(corners, origin);
    for (auto& list : unseen_) list.push_back(t);
    added_.push_back(t);
    touched_.insert(touched_.end(), corners.begin(), corners.end());
  }

  void take(Index t) {
    triangles_.remove(t);
    touched_.insert(touched_.end(), draft_.triangles[t].begin(), draft_.triangles[t].end());
  }

  // Those that are still there and were not looked at, in order; they count as looked at from now on.
  std::vector<Index> take_unseen(Index flag) {
    std::vector<Index>& list = unseen_[flag == unseen_by_corners ? 0 : 1];
    std::erase_if(list,
                  [&](Index t) { return !triangles_.alive(t) || (draft_.origins[t].facet & flag) == 0; });
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    for (const Index t : list) draft_.origins[t].facet &= ~flag;
    return std::exchange(list, {});
  }

  // To be looked at again in the next round.
  void defer(Index t) {
    draft_.origins[t].facet |= unseen_by_corners;
    unseen_[0].push_back(t);
  }

  // Only triangles that were added can have become twins.
  void cancel_new_twins() {
    if (!cancel_) return;
    for (const Index t : std::exchange(added_, {})) {
      if (!triangles_.alive(t)) continue;
      const facets::Corners& corners = draft_.triangles[t];
      const Index soup = draft_.origins[t].soup;
      std::vector<Twin> twins;
      triangles_.for_each_at(corners[0], [&](Index side) {
        const facets::Corners& c = draft_.triangles[side / 3];
        if (draft_.origins[side / 3].soup == soup && std::find(c.begin(), c.end(), corners[1]) != c.end() &&
            std::find(c.begin(), c.end(), corners[2]) != c.end())
          twins.push_back({is_odd(c), side / 3});
      });
      for (const Index twin : cancelled_among(std::move(twins), draft_.soup_is_complex[soup])) {
        take(twin);
        ++report_.cancelled_triangles;
      }
    }
  }

  // --- Points that become one ---

  void find_pinned_points() {
    pinned_.assign(draft_.points.size(), false);
    for (const Segment& s : draft_.segments) pinned_[s.a] = pinned_[s.b] = true;
    for (const Index p : draft_.loose_points) pinned_[p] = true;
  }

  bool takes_part(Index p) const {
    if (what_ != SnapWhat::borders) return triangles_.uses(p) || (p < pinned_.size() && pinned_[p]);
    bool border = false;
    triangles_.for_each_at(p, [&](Index side) {
      for (const Index k : {1U, 2U})
        border = border || is_border(edge_key(p, draft_.triangles[side / 3][(side % 3 + k) % 3]));
    });
    return border;
  }
  bool has_border(Index t) const {
    const facets::Corners& c = draft_.triangles[t];
    return is_border(edge_key(c[0], c[1])) || is_border(edge_key(c[1], c[2])) ||
           is_border(edge_key(c[2], c[0]));
  }
  bool is_border(const Edge& edge) const { return triangles_.sides(edge).size() == 1; }

  bool before(Index p, Index q) const {
    const Point &a = at(p), &b = at(q);
    return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z != b.z ? a.z < b.z : p < q;
  }

  // Those that were compared before are apart from each other: new ones are compared with them and among
  // themselves, in an order that does not depend on that of the input.
  bool merge_points() {
    std::vector<Index> order = points_to_compare();
    std::vector<std::pair<Index, Index>> merged;  // what, into what
    for (const Index p : order) {
      const Index near = grid_.nearest(at(p), [&](Index q) { return in_grid_[q]; });
      if (near == none) {
        in_grid_[p] = true;
        grid_.add(p);
        continue;
      }
      merged.emplace_back(p, near);
      done_.push_back({Done::What::merged, p, distance(at(p), at(near))});
    }
    if (merged.empty()) return false;
    rename(merged);
    return true;
  }

  // New points and the old ones near them; these leave the grid.
  std::vector<Index> points_to_compare() {
    in_grid_.resize(draft_.points.size(), false);
    std::vector<Index> order;
    std::sort(touched_.begin(), touched_.end());
    touched_.erase(std::unique(touched_.begin(), touched_.end()), touched_.end());
    work_.spend(touched_.size());
    for (const Index p : touched_) {
      const bool takes = takes_part(p);
      if (takes && !in_grid_[p]) order.push_back(p);
      if (!takes) in_grid_[p] = false;
    }
    touched_.clear();
    for (std::size_t i = 0, fresh = order.size(); i < fresh; ++i)
      grid_.for_each_near(at(order[i]), [&](Index q) {
        if (!in_grid_[q]) return;
        in_grid_[q] = false;
        order.push_back(q);
      });
    std::sort(order.begin(), order.end(), [&](Index p, Index q) { return before(p, q); });
    return order;
  }

  void rename(const std::vector<std::pair<Index, Index>>& merged) {
    std::map<Index, Index> name(merged.begin(), merged.end());
    const auto renamed = [&](Index p) {
      const auto found = name.find(p);
      return found == name.end() ? p : found->second;
    };
    std::vector<Index> changed;
    for (const auto& [p, into] : merged) {
      triangles_.for_each_at(p, [&](Index side) { changed.push_back(side / 3); });
      if (p >= pinned_.size() || !pinned_[p]) continue;
      pinned_.resize(std::max<std::size_t>(pinned_.size(), into + 1), false);
      pinned_[into] = true;
    }
    std::sort(changed.begin(), changed.end());
    changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
    for (const Index t : changed) {
      const facets::Corners before = draft_.triangles[t];
      const facets::Corners corners{renamed(before[0]), renamed(before[1]), renamed(before[2])};
      const Origin origin = draft_.origins[t];
      take(t);
      if (corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0])
        put(corners, origin);
    }
    for (Segment& s : draft_.segments) s = {renamed(s.a), renamed(s.b), s.tag, s.soup};
    std::erase_if(draft_.segments, [](const Segment& s) { return s.a == s.b; });
    for (Index& p : draft_.loose_points) p = renamed(p);
  }

  // --- Corners near edges ---

  void clear() {
    on_edge_.clear();
    inside_.clear();
    crossing_.clear();
    along_.clear();
  }

  bool may_snap(const Edge& edge) const { return what_ != SnapWhat::borders || is_border(edge); }

  // A corner near an edge that it is no end of.
  struct NearEdge {
    double length, distance;  // of the edge, and to it
    Edge edge;
    OnEdge corner;

    friend bool operator<(const NearEdge& a, const NearEdge& b) {
      return std::tie(b.length, a.distance, a.edge, a.corner.point) <
             std::tie(a.length, b.distance, b.edge, b.corner.point);
    }
  };

  // An edge while those are chosen that are cut in this round.
  struct EdgeState {
    std::vector<Index> sides;
    bool deferred = false;  // its triangles are looked at again
  };

  // Edges get the corners near them, the longest first.
  bool snap_corners() {
    clear();
    const std::size_t done_before = done_.size();
    const std::vector<Index> looked_at = take_unseen(unseen_by_corners);
    std::vector<NearEdge> found;
    triangles_.for_each_corner_near_edge(looked_at,
                                         [&](Index p, const Edge& edge) { find_near_edge(p, edge, found); });
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end(),
                            [](const NearEdge& a, const NearEdge& b) {
                              return a.edge == b.edge && a.corner.point == b.corner.point;
                            }),
                found.end());
    std::map<Edge, EdgeState> states;
    for (const NearEdge& near : found) {
      const auto [at, added] = states.try_emplace(near.edge);
      EdgeState& state = at->second;
      if (added) state.sides = triangles_.sides(near.edge);
      work_.spend(state.sides.size());
      if (!has_room(near)) {
        if (!std::exchange(state.deferred, true))
          for (const Index side : state.sides) defer(side / 3);
        continue;
      }
      if (may_cut(near, state.sides)) add_on_edge(near.edge, near.corner, near.distance);
    }
    if (on_edge_.empty()) return false;
    if (pieces() > most_triangles_) {
      grows_ = true;
      done_.resize(done_before);
      for (const auto& [edge, points] : on_edge_)
        for (const Index side : triangles_.sides(edge)) defer(side / 3);
      return false;
    }
    apply();
    return true;
  }

  // How many triangles cutting the edges would make.
  std::size_t pieces() const {
    std::size_t count = 0;
    for (const auto& [edge, points] : on_edge_) count += points.size() * triangles_.sides(edge).size();
    return count;
  }

  // Edges that arise are shorter than the one that is cut, or it is cut for the first time since the last
  // overlay: so it ends.
  bool may_cut(const NearEdge& near, std::span<const Index> sides) {
    const bool shorter = std::all_of(sides.begin(), sides.end(), [&](Index side) {
      const Index opposite = apex(draft_.triangles, side);
      return opposite == near.corner.point || distance(at(opposite), at(near.corner.point)) < near.length;
    });
    return shorter || cut_before_.insert(near.edge).second;
  }

  // Is it away from the other corners that the edge gets?
  bool has_room(const NearEdge& near) const {
    const auto found = on_edge_.find(near.edge);
    if (found == on_edge_.end()) return true;
    const double length = distance(at(near.edge[0]), at(near.edge[1]));
    return std::all_of(found->second.begin(), found->second.end(), [&](const OnEdge& o) {
      return std::fabs(o.parameter - near.corner.parameter) * length > 2 * limit_;
    });
  }

  void find_near_edge(Index p, const Edge& edge, std::vector<NearEdge>& found) const {
    const Vector along = at(edge[1]) - at(edge[0]), to = at(p) - at(edge[0]);
    const double ll = squared_norm(along), d1 = dot(to, along);
    if (!(d1 > 0 && d1 < ll)) return;
    if (squared_norm(cross(along, to)) > beyond_plane * beyond_plane * limit_ * limit_ * ll) return;
    const double parameter = parameter_on_segment(at(p), at(edge[0]), at(edge[1]));
    const double d = distance(at(p), at(edge[0]) + parameter * along);
    if (d > limit_ || !(parameter > 0 && parameter < 1) || !may_snap(edge) || !triangles_.uses(p)) return;
    if (triangles_.sides(edge).empty()) return;  // it is gone
    found.push_back({std::sqrt(ll), d, edge, {parameter, p}});
  }

  // --- Triangles that run along each other ---

  // They get each other's corners and edges.
  bool overlay() {
    clear();
    cut_before_.clear();
    first_of_overlay_ = static_cast<Index>(draft_.points.size());
    std::vector<std::pair<Index, Index>> pairs;
    triangles_.for_each_near_pair(take_unseen(unseen_by_overlay),
                                  [&](Index s, Index t) { pairs.emplace_back(s, t); });
    std::sort(pairs.begin(), pairs.end());
    for (const auto& [s, t] : pairs) {
      find_near_corners(s, t);
      find_near_corners(t, s);
      find_crossings(s, t);
    }
    if (on_edge_.empty() && inside_.empty()) return false;
    find_crossings_inside();
    apply();
    return true;
  }

  // Where edges of two other triangles cross each other on a third one, that gets the crossing, too.
  void find_crossings_inside() {
    for (auto& [t, edges] : along_) {
      std::sort(edges.begin(), edges.end());
      edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
      std::set<Index> on_sides;
      for (unsigned i = 0; i < 3; ++i) {
        const std::vector<Index> points = chain(draft_.triangles[t][i], draft_.triangles[t][(i + 1) % 3]);
        on_sides.insert(points.begin(), points.end());
      }
      for (const Edge& edge : edges) {
        const auto found = on_edge_.find(edge);
        if (found == on_edge_.end()) continue;
        for (const OnEdge& crossing : found->second) {
          const auto inside = inside_.find(t);
          work_.spend(1 + (inside == inside_.end() ? 0 : inside->second.size()));
          if (on_sides.count(crossing.point) == 0) consider_inside(t, crossing.point);
        }
      }
    }
  }

  // Those corners of s that t does not have.
  void find_near_corners(Index s, Index t) {
    const facets::Corners& corners = draft_.triangles[t];
    for (unsigned k = 0; k < 3; ++k) {
      const Index p = draft_.triangles[s][k];
      if (std::find(corners.begin(), corners.end(), p) != corners.end() || !consider_inside(t, p)) continue;
      along_[t].push_back(edge_key(p, draft_.triangles[s][(k + 1) % 3]));
      along_[t].push_back(edge_key(p, draft_.triangles[s][(k + 2) % 3]));
    }
  }

  void add_on_edge(const Edge& key, const OnEdge& point, double moved) {
    auto& points = on_edge_[key];
    if (std::any_of(points.begin(), points.end(), [&](const OnEdge& o) { return o.point == point.point; }))
      return;
    done_.push_back({points.empty() ? Done::What::cut_edge : Done::What::more, point.point, moved});
    points.push_back(point);
  }

  bool consider_inside(Index t, Index p) {
    const Point &a = draft_.corner(t, 0), &b = draft_.corner(t, 1), &c = draft_.corner(t, 2), &q = at(p);
    const Vector n = cross(b - a, c - a);
    const double nn = squared_norm(n);
    if (!(nn > 0)) return false;
    const double height = std::fabs(dot(q - a, n)) / std::sqrt(nn);
    if (height > limit_) return false;
    if (dot(cross(b - a, q - a), n) <= 0 || dot(cross(c - b, q - b), n) <= 0 ||
        dot(cross(a - c, q - c), n) <= 0)
      return false;
    auto& points = inside_[t];
    if (std::find(points.begin(), points.end(), p) != points.end()) return true;
    done_.push_back({points.empty() ? Done::What::cut_triangle : Done::What::more, p, height});
    points.push_back(p);
    return true;
  }

  // Does the edge keep its distance from the plane of a triangle?
  bool beyond(const Edge& edge, Index t) const {
    const Vector& normal = triangles_.normal(t);
    const Point& origin = draft_.corner(t, 0);
    const double a = dot(normal, at(edge[0]) - origin), b = dot(normal, at(edge[1]) - origin);
    const double reach = beyond_plane * limit_;
    return std::min(a, b) > reach || std::max(a, b) < -reach;
  }

  void find_crossings(Index s, Index t) {
    for (unsigned i = 0; i < 3; ++i) {
      const Edge e = edge_key(draft_.triangles[s][i], draft_.triangles[s][(i + 1) % 3]);
      if (beyond(e, t)) continue;
      for (unsigned j = 0; j < 3; ++j) {
        const Edge f = edge_key(draft_.triangles[t][j], draft_.triangles[t][(j + 1) % 3]);
        if (!consider_crossing(e, f)) continue;
        along_[s].push_back(f);
        along_[t].push_back(e);
      }
    }
  }

  // Two edges that pass each other closely, away from their ends: a new point in between.
  bool consider_crossing(const Edge& e, const Edge& f) {
    if (e[0] == f[0] || e[0] == f[1] || e[1] == f[0] || e[1] == f[1]) return false;
    const Point &p = at(e[0]), &r = at(f[0]);
    const Vector u = at(e[1]) - p, v = at(f[1]) - r, w = p - r;
    const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), uw = dot(u, w), vw = dot(v, w);
    const double determinant = uu * vv - uv * uv;
    if (!(determinant > 1e-12 * uu * vv)) return false;  // parallel: their ends are near
    const double a = (uv * vw - vv * uw) / determinant, b = (uu * vw - uv * uw) / determinant;
    if (!(a > 0 && a < 1 && b > 0 && b < 1)) return false;
    const Point on_e = p + a * u, on_f = r + b * v;
    const double d = distance(on_e, on_f);
    if (d > limit_) return false;
    for (const auto& [end, on] : {std::pair{e[0], on_f}, {e[1], on_f}, {f[0], on_e}, {f[1], on_e}})
      if (distance(at(end), on) <= limit_) return false;  // that end is near
    const auto key = e < f ? std::pair{e, f} : std::pair{f, e};
    if (crossing_.count(key) > 0) return true;
    if (!crossed_before_.insert(key).second) return false;
    crossing_.insert(key);
    const Index point = crossing_at(on_e, on_f);
    for (const Edge& edge : {e, f}) {
      const double parameter = parameter_on_segment(at(point), at(edge[0]), at(edge[1]));
      const Point foot = at(edge[0]) + parameter * (at(edge[1]) - at(edge[0]));
      add_on_edge(edge, {parameter, point}, distance(at(point), foot));
    }
    return true;
  }

  // Where more than two edges meet, all get one point.
  Index crossing_at(const Point& on_e, const Point& on_f) {
    const Point p = 0.5 * (on_e + on_f);
    const Index known = crossing_points_.nearest(p, [&](Index q) {
      return q >= first_of_overlay_ && distance(at(q), on_e) <= limit_ && distance(at(q), on_f) <= limit_;
    });
    if (known != none) return known;
    const auto added = static_cast<Index>(draft_.points.size());
    draft_.points.push_back(p);
    draft_.point_tags.push_back(0);
    crossing_points_.add(added);
    return added;
  }

  // --- Cutting ---

  void apply() {
    std::vector<Index> affected;
    for (auto& [edge, points] : on_edge_) {
      std::sort(points.begin(), points.end(), [](const OnEdge& a, const OnEdge& b) {
        return a.parameter != b.parameter ? a.parameter < b.parameter : a.point < b.point;
      });
      for (const Index side : triangles_.sides(edge)) affected.push_back(side / 3);
    }
    for (const auto& [t, points] : inside_) affected.push_back(t);
    std::sort(affected.begin(), affected.end());
    affected.erase(std::unique(affected.begin(), affected.end()), affected.end());
    work_.spend(affected.size());
    for (const Index t : affected) {
      const facets::Corners corners = draft_.triangles[t];
      const Origin origin = draft_.origins[t];
      take(t);
      cut(t, corners, origin);
    }
    cut_segments();
  }

  void cut_segments() {
    if (on_edge_.empty()) return;
    std::vector<Segment> segments;
    segments.reserve(draft_.segments.size());
    for (const Segment& s : draft_.segments) {
      const std::vector<Index> points = chain(s.a, s.b);
      for (std::size_t i = 0; i + 1 < points.size(); ++i)
        if (points[i] != points[i + 1]) segments.push_back({points[i], points[i + 1], s.tag, s.soup});
    }
    draft_.segments = std::move(segments);
  }

  void cut(Index t, const facets::Corners& corners, const Origin& origin) {
    PolygonCuts cuts;
    for (unsigned i = 0; i < 3; ++i) {
      const std::vector<Index> points = chain(corners[i], corners[(i + 1) % 3]);
      cuts.border.insert(cuts.border.end(), points.begin(), points.end() - 1);
    }
    if (const auto found = inside_.find(t); found != inside_.end()) cuts.inside = found->second;
    std::vector<Index> sorted = cuts.border;
    std::sort(sorted.begin(), sorted.end());
    const bool simple = std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end();
    // A plain step cuts from the opposite corner; a triangulation might take the old edge again.
    const bool plain = cuts.inside.empty() && along_.empty();
    if (simple && !plain) {
      const Vector normal = cross(at(corners[1]) - at(corners[0]), at(corners[2]) - at(corners[0]));
      cuts.edges = constraints(t, corners);
      if (const auto pieces = cut_polygon(draft_.points, normal, cuts)) {
        for (const facets::Corners& piece : *pieces) put(piece, origin);
        return;
      }
    }
    std::vector<facets::Corners> pieces{corners};
    for (const Index p : cuts.inside) insert(p, pieces);
    for (const facets::Corners& piece : pieces) add_cut(piece, origin);
  }

  // The pieces of other triangles' edges that run along a triangle, inside it.
  std::vector<Edge> constraints(Index t, const facets::Corners& corners) const {
    std::vector<Edge> result;
    const auto found = along_.find(t);
    if (found == along_.end()) return result;
    std::map<Index, unsigned> sides;  // by point: bits of the sides it is on, 8 inside
    for (unsigned i = 0; i < 3; ++i) {
      const std::vector<Index> points = chain(corners[i], corners[(i + 1) % 3]);
      for (const Index p : points) sides[p] |= 1U << i;
    }
    if (const auto inside = inside_.find(t); inside != inside_.end())
      for (const Index p : inside->second) sides[p] |= 8U;
    std::set<Edge> seen;
    for (const Edge& edge : found->second) {
      if (!seen.insert(edge).second) continue;
      const std::vector<Index> points = chain(edge[0], edge[1]);
      for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        const auto a = sides.find(points[i]), b = sides.find(points[i + 1]);
        if (a == sides.end() || b == sides.end() || (a->second & b->second & 7U) != 0) continue;
        result.push_back({points[i], points[i + 1]});
      }
    }
    return result;
  }

  // A corner for the piece that it is in, seen along its normal.
  void insert(Index p, std::vector<facets::Corners>& pieces) const {
    std::size_t best = 0;
    double depth = -INFINITY;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      const auto& [a, b, c] = pieces[i];
      if (a == p || b == p || c == p) return;
      const Vector n = cross(at(b) - at(a), at(c) - at(a));
      const double nn = squared_norm(n);
      if (!(nn > 0)) continue;
      const double least =
          std::min({dot(cross(at(b) - at(a), at(p) - at(a)), n), dot(cross(at(c) - at(b), at(p) - at(b)), n),
                    dot(cross(at(a) - at(c), at(p) - at(c)), n)}) /
          nn;
      if (least <= depth) continue;
      depth = least;
      best = i;
    }
    const facets::Corners t = pieces[best];
    pieces[best] = {t[0], t[1], p};
    pieces.push_back({t[1], t[2], p});
    pieces.push_back({t[2], t[0], p});
  }

  // From a to b, both included.
  std::vector<Index> chain(Index a, Index b) const {
    std::vector<Index> points{a};
    if (const auto found = on_edge_.find(edge_key(a, b)); found != on_edge_.end()) {
      for (const OnEdge& o : found->second) points.push_back(o.point);
      if (a > b) std::reverse(points.begin() + 1, points.end());
    }
    points.push_back(b);
    return points;
  }

  // Each step fans the apex opposite one cut side.
  void add_cut(const facets::Corners& triangle, const Origin& origin) {
    std::vector<std::pair<facets::Corners, unsigned>> stack{{triangle, 0}};  // and which sides are done
    while (!stack.empty()) {
      const auto [t, done] = stack.back();
      stack.pop_back();
      bool cut = false;
      for (unsigned i = 0; i < 3 && !cut; ++i) {
        if ((done >> i & 1U) != 0) continue;
        const std::vector<Index> points = chain(t[i], t[(i + 1) % 3]);
        if (points.size() == 2) continue;
        cut = true;
        const Index apex = t[(i + 2) % 3];
        for (std::size_t k = 0; k + 1 < points.size(); ++k) {
          // Side 0 is a piece of an edge that is cut already; sides 1 and 2 are whole edges at the ends only.
          const bool first = k == 0, last = k + 2 == points.size();
          const unsigned side_after = done >> ((i + 1) % 3) & 1U, side_before = done >> ((i + 2) % 3) & 1U;
          const unsigned flags = 1U | (last ? side_after : 1U) << 1U | (first ? side_before : 1U) << 2U;
          stack.push_back({{points[k], points[k + 1], apex}, flags});
        }
      }
      if (!cut && t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) put(t, origin);
    }
  }

  // Rounding of heights over a plane, in which only edges of the triangle there are near.
  static constexpr double beyond_plane = 1 + 1e-9;

  bool cancel_;  // twins
  Draft& draft_;
  double limit_;
  SnapWhat what_;
  Work& work_;
  SnapReport report_;
  std::vector<Done> done_;
  std::size_t most_triangles_ = 0;
  bool grows_ = false;    // beyond that
  bool settled_ = false;  // nothing more is merged or cut
  ChangingTriangles triangles_;
  std::array<std::vector<Index>, 2> unseen_;  // triangles, by corners and by overlay; some are gone
  std::vector<Index> added_;                  // triangles that may have become twins
  std::vector<Index> touched_;                // corners of triangles that came or went
  std::vector<bool> pinned_;                  // by point: of a segment or loose
  std::vector<bool> in_grid_;                 // by point: apart from all others there
  PointGrid grid_, crossing_points_;
  Index first_of_overlay_ = 0;  // of the points that it makes
  std::set<Edge> cut_before_;
  std::map<Edge, std::vector<OnEdge>> on_edge_;
  std::map<Index, std::vector<Index>> inside_;  // by triangle
  std::map<Index, std::vector<Edge>> along_;    // by triangle: edges that come near it
  std::set<std::pair<Edge, Edge>> crossing_, crossed_before_;
};

}  // namespace

SnapReport snap_near_features(Draft& draft, double distance, SnapWhat what, Work* work,
                              const std::vector<bool>& known, bool cancel) {
  Work any;
  const std::size_t twins = known.empty() && cancel ? cancel_twins(draft) : 0;
  SnapReport report;
  if (distance > 0) report = Snapper(draft, distance, what, work != nullptr ? *work : any, cancel).run(known);
  report.cancelled_triangles += twins;
  return report;
}

}  // namespace collarmesh::repairing
