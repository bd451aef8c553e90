#include "refine/curve_chains.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "common/distances.h"
#include "refine/sagitta.h"

namespace collarmesh {

namespace {

// A curve gets inner seeds if its length exceeds its chord by this factor, because the ball of a single
// subsegment might not cover it.
constexpr double seeded_length_per_chord = 1.2;
// A subsegment is split at most this share of its ball's radius away from the ball's centre.
constexpr double subsegment_offset = 0.1;
// When a ball cuts off the end of a curve, the first subsegment beyond the ball gets at least this length, in
// radii of the ball, unless it ends at a mesh vertex or at the other end of the chain.
constexpr double least_clipped_length = 0.3;

}  // namespace

void CurveChains::start() {
  assert(points_.begin_with_vertices_of(domain_.plc));
  chain_ends_.assign(domain_.plc.curves.size(), {none, none});
  for (Index c = 0; c < domain_.plc.curves.size(); ++c) add_chain(c);
}

void CurveChains::add_chain(Index c) {
  if (collars_.is_crease_curve(c)) {
    if (domain_.options.collar_creation != CollarCreation::in_pass) return;  // its collar covers it
    open_creases_.open(c);
  }
  const std::vector<End> ends = first_ends(c);
  Index previous = none;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    const Index next = add(c, {ends[i], ends[i + 1]}, none);
    link(c, previous, next);
    open_creases_.note_unresolved(c);
    previous = next;
  }
  const bool closed = domain_.plc.curves[c].closed;
  link(c, previous, closed ? chain_ends_[c][0] : none);
  if (!closed) open_creases_.note_unresolved(c);
}

// Returns the unresolved points of a new chain: the curve's end vertices, or the points where the curve
// leaves their balls, and seeds between them.
std::vector<CurveChains::End> CurveChains::first_ends(Index c) {
  const Plc::Curve& curve = domain_.plc.curves[c];
  const auto seed = [&](double parameter) {
    return End{none, points_.add(domain_.paths.point(c, parameter), {1, c}), parameter};
  };
  std::array<End, 2> ends{End{none, curve.ends[0], 0}, End{none, curve.ends[1], domain_.paths.length(c)}};
  for (const unsigned side : {0U, 1U}) {
    if (curve.closed) continue;
    const Index ball = collars_.ball_at_vertex(curve.ends[side]);
    if (ball == none) continue;
    ends[side] = seed(leaving_parameter(c, collars_.balls()[ball], side == 0));
    clipped_ends_.push_back({c, ball, ends[side].point});
  }
  if (curve.closed) {
    ends[0] = seed(0);
    ends[1].point = ends[0].point;
  }
  const double from = ends[0].parameter, length = ends[1].parameter - from;
  const double chord = distance(points_[ends[0].point].point, points_[ends[1].point].point);
  if (length <= seeded_length_per_chord * chord) return {ends[0], ends[1]};
  const End first = seed(from + length / 3), second = seed(from + length * 2 / 3);
  return {ends[0], first, second, ends[1]};
}

// Returns the parameter at which a curve leaves the ball at one of its ends, by bisection: the ball meets the
// curve in one arc.
double CurveChains::leaving_parameter(Index c, const CollarBall& ball, bool at_start) const {
  const double length = domain_.paths.length(c);
  double inside = at_start ? 0 : length, outside = length / 2;
  for (int step = 0; step < 200; ++step) {
    const double middle = 0.5 * (inside + outside);
    if (middle == inside || middle == outside) break;
    (distance(domain_.paths.point(c, middle), ball.centre) < ball.radius ? inside : outside) = middle;
  }
  return outside;
}

void CurveChains::point_resolved(Index point) {
  if (point < domain_.plc.vertices.size()) {
    for (const Index c : domain_.plc.vertices[point].curves)
      for (const unsigned side : {0U, 1U}) {
        const Index piece = chain_ends_[c][side];
        if (piece == none || subsegments_[piece].points[side] != point) continue;
        resolve_end(piece, side);
        if (open_creases_.note_resolved(c)) chain_resolved(c, piece);
      }
    return;
  }
  const Index piece = point < piece_at_.size() ? piece_at_[point] : none;
  if (piece == none) return;
  const unsigned side = subsegments_[piece].points[0] == point ? 0 : 1;
  const Index other = subsegments_[piece].neighbours[side];
  resolve_end(piece, side);
  if (other != none) resolve_end(other, 1 - side);
  const Index curve = subsegments_[piece].piece.curve;
  if (!points_[point].dormant && open_creases_.note_resolved(curve)) chain_resolved(curve, piece);
}

// Requests the balls of a crease whose chain was split and is resolved: queues a piece, because an attempt to
// split it creates the balls. In the paper's profile, only reports that the crease may have become isolated:
// the balls must wait until it is.
void CurveChains::chain_resolved(Index curve, Index piece) {
  if (domain_.is_papers())
    open_creases_.touch(curve);
  else
    encroach(piece);
}

void CurveChains::resolve_end(Index subsegment, unsigned side) {
  Chained& s = subsegments_[subsegment];
  s.piece.ends[side] = points_[s.points[side]].vertex;
  s.points[side] = none;
  if (s.piece.resolved()) judge(subsegment);
}

// Returns the parameter at which the curve between two parameters meets the bisector plane of a and b. Finds
// the segment by bisection over the polyline's points x, by the sign of |xb| - |xa|, then interpolates
// linearly.
double CurveChains::bisecting_parameter(Index c, const Point& a, const Point& b, double from,
                                        double to) const {
  const auto nearer_to_a = [&](const Point& p) { return squared_distance(p, b) - squared_distance(p, a); };
  const auto& lengths = domain_.paths.lengths(c);
  auto first = static_cast<std::size_t>(std::ranges::upper_bound(lengths, from) - lengths.begin());
  auto last = static_cast<std::size_t>(std::ranges::lower_bound(lengths, to) - lengths.begin());
  double low = from, high = to;
  while (first < last) {
    const std::size_t middle = (first + last) / 2;
    if (nearer_to_a(domain_.paths.point(c, lengths[middle])) > 0) {
      low = lengths[middle];
      first = middle + 1;
    } else {
      high = lengths[middle];
      last = middle;
    }
  }
  const double at_low = nearer_to_a(domain_.paths.point(c, low));
  const double at_high = nearer_to_a(domain_.paths.point(c, high));
  return at_low > at_high ? low + (high - low) * std::clamp(at_low / (at_low - at_high), 0.0, 1.0)
                          : 0.5 * (low + high);
}

Index CurveChains::add(Index curve, const std::array<End, 2>& ends, Index near) {
  Index index;
  if (free_subsegments_.empty()) {
    index = static_cast<Index>(subsegments_.size());
    subsegments_.push_back({});
  } else {
    index = free_subsegments_.back();
    free_subsegments_.pop_back();
  }
  Chained& s = subsegments_[index];
  s.points = {ends[0].point, ends[1].point};
  s.neighbours = {none, none};
  s.alive = true;
  s.piece = {curve, {ends[0].vertex, ends[1].vertex}, {ends[0].parameter, ends[1].parameter}, {}, 0, 0};
  const Point a = place(s, 0), b = place(s, 1);
  s.piece.centre_parameter = bisecting_parameter(curve, a, b, ends[0].parameter, ends[1].parameter);
  s.piece.centre = domain_.frame.rounded(domain_.paths.point(curve, s.piece.centre_parameter));
  s.piece.squared_radius = std::max(squared_distance(s.piece.centre, a), squared_distance(s.piece.centre, b));
  s.ball =
      balls_.add(index, s.piece.centre, s.piece.squared_radius, mesh_.nearest_vertex(s.piece.centre, near));
  for (const Index point : s.points) note_piece(point, index);
  open_creases_.note_link(curve, {index, s.stamp});
  judge(index);
  return index;
}

// Records a piece that ends at an unresolved point. The pieces that end at a vertex of the complex are found
// through its curves.
void CurveChains::note_piece(Index point, Index subsegment) {
  if (point == none || point < domain_.plc.vertices.size()) return;
  if (point >= piece_at_.size()) piece_at_.resize(points_.size(), none);
  piece_at_[point] = subsegment;
}

// Links two pieces; `none` stands for the end of a curve.
void CurveChains::link(Index curve, Index before, Index after) {
  (before == none ? chain_ends_[curve][0] : subsegments_[before].neighbours[1]) = after;
  (after == none ? chain_ends_[curve][1] : subsegments_[after].neighbours[0]) = before;
}

void CurveChains::remove(Index subsegment) {
  Chained& s = subsegments_[subsegment];
  if (s.ball != none) balls_.remove(s.ball);
  for (const Index point : s.points) note_piece(point, none);
  s.alive = false;
  ++s.stamp;
  free_subsegments_.push_back(subsegment);
}

// Queues a subsegment if it must be split.
void CurveChains::judge(Index subsegment) {
  const Chained& s = subsegments_[subsegment];
  if (holds(s, balls_[s.ball].vertex) || turns_too_far(s))
    encroach(subsegment);
  else if (s.piece.resolved() && too_coarse(s))
    queue(WorkQueue::coarse_subsegments, subsegment);
}

// Returns whether a vertex encroaches a subsegment. The subsegment's ends do not encroach it, nor do vertices
// at the places of its ends.
bool CurveChains::holds(const Chained& s, Index vertex) const {
  return squared_distance(mesh_.point(vertex), s.piece.centre) <= s.piece.squared_radius &&
         !is_end(s, vertex);
}

bool CurveChains::is_end(const Chained& s, Index vertex) const {
  for (const unsigned side : {0U, 1U}) {
    if (s.piece.ends[side] == vertex) return true;
    if (s.points[side] != none && points_[s.points[side]].point == mesh_.point(vertex)) return true;
  }
  return false;
}

void CurveChains::encroach(Index subsegment) { queue(WorkQueue::encroached_subsegments, subsegment); }

void CurveChains::queue(WorkQueue::Priority priority, Index subsegment) {
  const Chained& s = subsegments_[subsegment];
  queue_.push(priority, s.piece.squared_radius, {subsegment, s.stamp});
}

bool CurveChains::too_coarse(const Chained& chained) const {
  const Subsegment& s = chained.piece;
  if (collars_.is_crease_curve(s.curve)) return false;  // a crease's subsegment only waits for its balls
  const Point a = place(chained, 0), b = place(chained, 1);
  const double size = sizes_.asked().curve_size(s.curve, domain_.paths.segment(s.curve, s.parameters[0]),
                                                domain_.paths.segment(s.curve, s.parameters[1]), s.centre);
  const double length =
      Sizing::subsegment_length(std::min(size, sizes_.graded(s.ends, 0.5 * distance(a, b))));
  return squared_distance(a, b) > length * length || leaves_chord(chained, tolerance_of(s));
}

// Returns the smallest tolerance on the subsegment's part of the curve.
double CurveChains::tolerance_of(const Subsegment& s) const {
  if (!domain_.tolerance.varies()) return domain_.tolerance.largest();
  const CurvePaths& paths = domain_.paths;
  const std::size_t count = paths.lengths(s.curve).size() - 1;
  const std::size_t last = paths.segment(s.curve, s.parameters[1]);
  double least = domain_.tolerance.largest();
  for (std::size_t i = paths.segment(s.curve, s.parameters[0]);; i = (i + 1) % count) {
    const auto [a, b] = paths.segment_ends(s.curve, i);
    least = std::min(least, domain_.tolerance.at_segment(a, b));
    if (i == last) return least;
  }
}

// Returns whether the subsegment's part of the curve turns so far that its ball may not contain all of that
// part. Always false on creases.
bool CurveChains::turns_too_far(const Chained& s) const {
  if (collars_.is_crease_curve(s.piece.curve)) return false;
  return leaves_chord(s, largest_sagitta * distance(place(s, 0), place(s, 1)));
}

// Returns whether the subsegment's part of the curve deviates from its chord by more than `sagitta`.
bool CurveChains::leaves_chord(const Chained& chained, double sagitta) const {
  const Subsegment& s = chained.piece;
  if (domain_.plc.curves[s.curve].straight) return false;
  const Point a = place(chained, 0), b = place(chained, 1);
  const auto leaves = [&](const Point& p) {
    return squared_distance_to_segment(p, a, b) > sagitta * sagitta;
  };
  const auto& lengths = domain_.paths.lengths(s.curve);
  const auto first = std::ranges::upper_bound(lengths, s.parameters[0]);
  const auto last = std::lower_bound(first, lengths.end(), s.parameters[1]);
  return leaves(s.centre) || std::any_of(first, last, [&](double parameter) {
           return leaves(domain_.paths.point(s.curve, parameter));
         });
}

void CurveChains::judge_all() {
  for (Index s = 0; s < subsegments_.size(); ++s)
    if (subsegments_[s].alive && subsegments_[s].piece.resolved() && too_coarse(subsegments_[s]))
      queue(WorkQueue::coarse_subsegments, s);
}

Index CurveChains::encroached(const ConflictZone& zone, const Candidate& candidate) const {
  if (candidate.feature.dimension <= 1) return none;
  Index best = none;
  double deepest = 0;
  for (const Index v : zone.vertices)
    balls_.visit_at(v, [&](Index, const LocationObjects::Object& ball) {
      const double depth = ball.squared_radius - squared_distance(candidate.point, ball.centre);
      if (depth < 0 || (best != none && depth <= deepest)) return;
      best = ball.owner;
      deepest = depth;
    });
  return best;
}

Index CurveChains::end_to_resolve(Index subsegment, const Candidate& candidate) const {
  const Chained& s = subsegments_[subsegment];
  Index nearest = none;
  for (const Index end : s.points) {
    if (end == none || points_[end].dormant || !points_.medial(end)) continue;
    if (nearest == none || squared_distance(candidate.point, points_[end].point) <
                               squared_distance(candidate.point, points_[nearest].point))
      nearest = end;
  }
  return nearest;
}

std::optional<CurveChains::Split> CurveChains::split_of(Index subsegment) {
  const Chained& chained = subsegments_[subsegment];
  assert(chained.alive);
  const Subsegment& s = chained.piece;
  if (domain_.at_floor(s.centre, s.squared_radius)) {
    outcome_.give_up(s.centre,
                     fmt::format("a curve could not be resolved with edges longer than {:.2g}",
                                 domain_.floor_at(s.centre)),
                     Outcome::advice_at_floor);
    return std::nullopt;
  }
  const Index nearest = balls_[chained.ball].vertex;
  const auto across = is_end(chained, nearest) ? std::nullopt
                                               : facing_sheets_.parameter_across(
                                                     s, place(chained, 1) - place(chained, 0), nearest);
  // Split a little beside the centre: otherwise vertices of symmetric curves would be cocircular.
  const double parameter =
      across ? *across
             : s.centre_parameter + subsegment_offset * std::sqrt(s.squared_radius) * random_.in_cube().x;
  const Point p = domain_.frame.rounded(domain_.paths.point(s.curve, parameter));
  const Index around = mesh_.nearest_vertex(p, nearest);
  const Index cell = mesh_.conflicting_cell_around(around, p);
  const Candidate candidate{p,    s.squared_radius,       across ? p : s.centre, {1, s.curve},
                            cell, across ? nearest : none};
  return Split{candidate, {subsegment, chained.stamp}, parameter, around};
}

bool CurveChains::can_join(const Split& split) const {
  return !is_end(subsegments_[split.link.subsegment], split.vertex);
}

void CurveChains::split_ahead(const Split& split) {
  assert(split.candidate.start != none && is_there(split.link));
  UnresolvedPoints::Unresolved point{split.candidate.point, split.candidate.feature};
  point.across = split.candidate.across;
  const Index curve = split.candidate.feature.index;
  if (domain_.is_papers())
    open_creases_.note_unresolved(curve);
  else
    point.dormant = open_creases_.is_open(curve);
  cut(split.link.subsegment, {none, points_.add(point, split.vertex), split.parameter}, split.vertex);
}

void CurveChains::drop_ball(const Split& split) {
  Chained& s = subsegments_[split.link.subsegment];
  balls_.remove(s.ball);
  s.ball = none;
}

// Splits a subsegment at a vertex. If inserting the vertex has created a ball at an end of the curve, another
// piece has taken the place of the subsegment.
void CurveChains::split_at(const Split& split, Index vertex) {
  assert(vertex < mesh_.vertex_count());
  Index piece = split.link.subsegment;
  if (!is_there(split.link)) {
    const auto has_place = [&](Index s) {
      const auto& [from, to] = subsegments_[s].piece.parameters;
      return from < split.parameter && split.parameter < to;
    };
    const auto& ends = chain_ends_[split.candidate.feature.index];
    const auto found = std::ranges::find_if(ends, [&](Index s) { return s != none && has_place(s); });
    if (found == ends.end()) return;
    piece = *found;
  }
  cut(piece, {vertex, none, split.parameter}, vertex);
}

void CurveChains::cut(Index subsegment, const End& middle, Index near) {
  const Chained whole = subsegments_[subsegment];
  const Index curve = whole.piece.curve;
  remove(subsegment);
  const Index first = add(curve, {end_of(whole, 0), middle}, near);
  const Index second = add(curve, {middle, end_of(whole, 1)}, near);
  if (chain_ends_[curve][0] == subsegment) chain_ends_[curve][0] = first;
  link(curve, whole.neighbours[0], first);
  link(curve, first, second);
  link(curve, second, whole.neighbours[1]);
  open_creases_.note_split(curve);
}

void CurveChains::queue_again(const Split& split) {
  if (is_there(split.link)) queue(WorkQueue::coarse_subsegments, split.link.subsegment);
}

void CurveChains::cells_made(const ConflictZone& zone, Index vertex) {
  assert(vertex < mesh_.vertex_count());
  const Point p = mesh_.point(vertex);
  for (const Index neighbour : zone.vertices)
    balls_.visit_at(neighbour, [&](Index o, const LocationObjects::Object& ball) {
      if (holds(subsegments_[ball.owner], vertex)) encroach(ball.owner);
      if (squared_distance(p, ball.centre) < squared_distance(mesh_.point(neighbour), ball.centre))
        balls_.move(o, vertex);
    });
}

Index CurveChains::remove_chain(Index curve) {
  const Index first = chain_ends_[curve][0];
  Index near = none;
  for (Index s = first, next = none; s != none; s = next == first ? none : next) {
    next = subsegments_[s].neighbours[1];
    if (const Index ball = subsegments_[s].ball; ball != none) near = balls_[ball].vertex;
    const Index point = subsegments_[s].points[1];
    if (next != none && point != none && !points_.resolved(point)) withdraw(point, curve);
    remove(s);
  }
  chain_ends_[curve] = {none, none};
  return near;
}

std::vector<PlaceOnCurve> CurveChains::vertices_amid(Index curve) const {
  std::vector<PlaceOnCurve> vertices;
  const Index first = chain_ends_[curve][0];
  if (first == none) return vertices;
  for (Index s = first, next = none;; s = next) {
    next = subsegments_[s].neighbours[1];
    if (next == none || next == first) return vertices;
    const End end = end_of(subsegments_[s], 1);
    if (end.vertex != none) vertices.push_back({end.parameter, mesh_.point(end.vertex)});
  }
}

void CurveChains::withdraw(Index point, Index curve) {
  points_.withdraw(point);
  if (!points_[point].dormant) open_creases_.note_resolved(curve);  // the crease no longer waits for it
}

void CurveChains::clip(Index c, bool at_start, Index near) {
  const unsigned side = at_start ? 0 : 1;
  const Index vertex = domain_.plc.curves[c].ends[side], ball = collars_.ball_at_vertex(vertex);
  const Index first = chain_ends_[c][side];
  if (first == none || subsegments_[first].points[side] != vertex) return;
  const CollarBall& b = collars_.balls()[ball];
  const double end = at_start ? 0 : domain_.paths.length(c);
  double parameter = at_start ? b.radius : end - b.radius;
  const bool is_open = open_creases_.is_open(c);
  if (!is_open) parameter = leaving_parameter(c, b, at_start);
  const Index point = points_.add(domain_.paths.point(c, parameter), {1, c}, near);
  if (is_open)
    open_creases_.note_end(c, side, point);
  else
    clipped_ends_.push_back({c, ball, point});
  cut_off(first, side, {none, point, parameter}, near);
}

// Cuts a chain at a new end on this side: removes the part between the old end and the new one, and
// unresolved points close to the new one.
void CurveChains::cut_off(Index first, unsigned side, const End& end, Index near) {
  const Index curve = subsegments_[first].piece.curve;
  const double from = subsegments_[first].piece.parameters[side];
  const double least = least_clipped_length * std::fabs(end.parameter - from);
  Index piece = first;
  for (;;) {
    const Chained& s = subsegments_[piece];
    const Index next = s.neighbours[1 - side];
    const double beyond = (s.piece.parameters[1 - side] - end.parameter) * (side == 0 ? 1 : -1);
    const bool movable = s.points[1 - side] != none && !points_.resolved(s.points[1 - side]);
    if (next == none || beyond > (movable ? least : 0)) break;
    if (movable) withdraw(s.points[1 - side], curve);
    remove(piece);
    piece = next;
  }
  const Chained rest = subsegments_[piece];
  remove(piece);
  std::array<End, 2> ends{end, end};
  ends[1 - side] = end_of(rest, 1 - side);
  const Index cut = add(curve, ends, near);
  const Index next = rest.neighbours[1 - side];
  side == 0 ? (link(curve, none, cut), link(curve, cut, next))
            : (link(curve, next, cut), link(curve, cut, none));
}

std::size_t CurveChains::bytes() const { return balls_.bytes() + subsegments_.bytes(); }

}  // namespace collarmesh
