#include "refine/curve_chains.h"

#include <algorithm>
#include <cmath>

namespace collarmesh {

namespace {

// A curve that is this much longer than its chord gets inner seeds: its first ball would miss it.
constexpr double seeded_length_per_chord = 1.2;
// Subsegments are split at most this share of their radius off the centre.
constexpr double subsegment_offset = 0.1;
// An arc may leave its chord by this share of the chord: about 60 degrees of turning.
constexpr double largest_sagitta_per_chord = 0.15;

}  // namespace

void CurveChains::start() {
  for (Index c = 0; c < domain_.plc.curves.size(); ++c) add_chain(c);
}

void CurveChains::add_chain(Index c) {
  const Plc::Curve& curve = domain_.plc.curves[c];
  if (collars_.is_crease_curve(c)) {
    if (domain_.options.collar_creation != CollarCreation::in_pass) return;  // covered by balls
    open_creases_.open(c);
  }
  double from = 0, to = domain_.paths.length(c);
  const auto seed = [&](double parameter) { return points_.add(domain_.paths.point(c, parameter), {1, c}); };
  // Clipped where it leaves a vertex ball.
  std::array<Index, 2> ends = curve.ends;
  for (const bool at_start : {true, false}) {
    if (curve.closed) continue;
    const Index ball = collars_.ball_at_vertex(curve.ends[at_start ? 0 : 1]);
    if (ball == none) continue;
    double& parameter = at_start ? from : to;
    parameter = leaving_parameter(c, collars_.balls()[ball], at_start);
    ends[at_start ? 0 : 1] = seed(parameter);
    clipped_ends_.push_back({c, ball, ends[at_start ? 0 : 1]});
  }
  std::vector<std::pair<Index, double>> chain;
  const Index first = curve.closed ? seed(0) : ends[0];
  const Index last = curve.closed ? first : ends[1];
  const double length = to - from;
  const double chord = distance(points_[first].point, points_[last].point);
  chain.push_back({first, from});
  if (length > seeded_length_per_chord * chord)
    for (const double share : {1.0 / 3, 2.0 / 3})
      chain.push_back({seed(from + share * length), from + share * length});
  chain.push_back({last, to});
  for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
    const auto index = static_cast<Index>(pending_.size());
    pending_.push_back({c, {chain[i].first, chain[i + 1].first}, {chain[i].second, chain[i + 1].second}});
    for (const Index point : pending_.back().points) waiting_for(point).push_back(index);
    guard(index, none);
    open_creases_.note_pending(c);
  }
}

std::vector<Index>& CurveChains::waiting_for(Index point) {
  if (point >= waiting_.size()) waiting_.resize(point + 1);
  return waiting_[point];
}

void CurveChains::guard(Index index, Index near) {
  Pending& p = pending_[index];
  const Point a = points_[p.points[0]].point, b = points_[p.points[1]].point;
  const Point centre =
      domain_.paths.point(p.curve, bisecting_parameter(p.curve, a, b, p.parameters[0], p.parameters[1]));
  p.ball = balls_.add(LocationObjects::Kind::pending_subsegment, index, centre, squared_distance(centre, a),
                      mesh_.nearest_vertex(centre, near));
}

// Where a curve leaves the ball at one of its ends: bisection, the ball meets it in one arc.
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
  const std::vector<Index> waiting = std::move(waiting_for(point));
  for (const Index index : waiting) {
    Pending& p = pending_[index];
    if (--p.missing > 0) continue;
    balls_.remove(p.ball);
    open_creases_.note_started(p.curve);
    const std::array<Index, 2> ends{points_[p.points[0]].vertex, points_[p.points[1]].vertex};
    add_subsegment(p.curve, ends, p.parameters, ends[0]);
  }
}

// A mesh vertex lies in the ball of a first subsegment: its ends come next, before skinny cells.
void CurveChains::hurry_ends(const Pending& pending) {
  for (const Index end : pending.points)
    if (!points_.resolved(end))
      queue_.push(WorkQueue::ends_of_encroached_subsegments, balls_[pending.ball].squared_radius, {end, 0});
}

// Where the curve between two parameters meets the bisector plane of a and b: bisection on the sign
// of |xa| - |xb| over the polyline's points, then linear on one segment.
double CurveChains::bisecting_parameter(Index c, const Point& a, const Point& b, double from,
                                        double to) const {
  const auto nearer_to_a = [&](const Point& p) { return squared_distance(p, b) - squared_distance(p, a); };
  const auto& lengths = domain_.paths.lengths(c);
  auto first =
      static_cast<std::size_t>(std::upper_bound(lengths.begin(), lengths.end(), from) - lengths.begin());
  auto last =
      static_cast<std::size_t>(std::lower_bound(lengths.begin(), lengths.end(), to) - lengths.begin());
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

void CurveChains::add_subsegment(Index curve, std::array<Index, 2> ends, std::array<double, 2> parameters,
                                 Index nearby) {
  Index index;
  std::uint32_t stamp = 0;
  if (free_subsegments_.empty()) {
    index = static_cast<Index>(subsegments_.size());
    subsegments_.push_back({});
  } else {
    index = free_subsegments_.back();
    free_subsegments_.pop_back();
    stamp = subsegments_[index].stamp;
  }
  Subsegment s{curve, ends, parameters, {}, 0, 0};
  const Point a = mesh_.point(ends[0]), b = mesh_.point(ends[1]);
  s.centre_parameter = bisecting_parameter(curve, a, b, parameters[0], parameters[1]);
  s.centre = domain_.frame.rounded(domain_.paths.point(curve, s.centre_parameter));
  s.squared_radius = std::max(squared_distance(s.centre, a), squared_distance(s.centre, b));
  const Index nearest = mesh_.nearest_vertex(s.centre, nearby);
  const Index ball =
      balls_.add(LocationObjects::Kind::subsegment, index, s.centre, s.squared_radius, nearest);
  subsegments_[index] = {s, ball, stamp, true};
  open_creases_.note_link(curve, {index, stamp});
  const bool empty = nearest == ends[0] || nearest == ends[1] ||
                     squared_distance(s.centre, mesh_.point(nearest)) > s.squared_radius;
  if (!empty || turns_too_far(s))
    encroach(index);
  else if (too_coarse(s))
    queue(WorkQueue::coarse_subsegments, index);
}

void CurveChains::remove_subsegment(Index subsegment) {
  Chained& s = subsegments_[subsegment];
  balls_.remove(s.ball);
  s.alive = false;
  ++s.stamp;
  free_subsegments_.push_back(subsegment);
}

void CurveChains::encroach(Index subsegment) { queue(WorkQueue::encroached_subsegments, subsegment); }

void CurveChains::queue(WorkQueue::Priority priority, Index subsegment) {
  const Chained& s = subsegments_[subsegment];
  queue_.push(priority, s.piece.squared_radius, {subsegment, s.stamp});
}

bool CurveChains::too_coarse(const Subsegment& s) const {
  if (collars_.is_crease_curve(s.curve)) return false;  // it only waits for its balls
  const Point a = mesh_.point(s.ends[0]), b = mesh_.point(s.ends[1]);
  const double size = sizes_.asked().curve_size(s.curve, domain_.paths.segment(s.curve, s.parameters[0]),
                                                domain_.paths.segment(s.curve, s.parameters[1]), s.centre);
  const double length =
      Sizing::subsegment_length(std::min(size, sizes_.graded(s.ends, 0.5 * distance(a, b))));
  return squared_distance(a, b) > length * length || leaves_chord(s, domain_.distance);
}

// Its ball may not hold all of it.
bool CurveChains::turns_too_far(const Subsegment& s) const {
  if (collars_.is_crease_curve(s.curve)) return false;
  return leaves_chord(s,
                      largest_sagitta_per_chord * distance(mesh_.point(s.ends[0]), mesh_.point(s.ends[1])));
}

// By more than this?
bool CurveChains::leaves_chord(const Subsegment& s, double sagitta) const {
  if (domain_.plc.curves[s.curve].straight) return false;
  const Point a = mesh_.point(s.ends[0]), b = mesh_.point(s.ends[1]);
  const double chord = squared_distance(a, b);
  const auto leaves = [&](const Point& p) {
    const double t = chord > 0 ? std::clamp(dot(p - a, b - a) / chord, 0.0, 1.0) : 0.0;
    return squared_distance(p, a + t * (b - a)) > sagitta * sagitta;
  };
  const auto& lengths = domain_.paths.lengths(s.curve);
  const auto first = std::upper_bound(lengths.begin(), lengths.end(), s.parameters[0]);
  const auto last = std::lower_bound(first, lengths.end(), s.parameters[1]);
  return leaves(s.centre) || std::any_of(first, last, [&](double parameter) {
           return leaves(domain_.paths.point(s.curve, parameter));
         });
}

void CurveChains::judge_all() {
  for (Index s = 0; s < subsegments_.size(); ++s)
    if (subsegments_[s].alive && too_coarse(subsegments_[s].piece)) queue(WorkQueue::coarse_subsegments, s);
}

Index CurveChains::encroached(const ConflictZone& zone, const Candidate& candidate) const {
  if (candidate.feature.dimension <= 1) return none;
  Index best = none;
  double deepest = 0;
  for (const Index v : zone.vertices)
    for (Index o = balls_.first_at(v); o != none; o = balls_[o].next) {
      const double depth = balls_[o].squared_radius - squared_distance(candidate.point, balls_[o].centre);
      if (depth < 0 || (best != none && depth <= deepest)) continue;
      best = o;
      deepest = depth;
    }
  return best;
}

Index CurveChains::subsegment_of(Index ball) const {
  return balls_[ball].kind == LocationObjects::Kind::subsegment ? balls_[ball].owner : none;
}

Index CurveChains::end_to_resolve(Index ball, const Point& intruder) const {
  Index nearest = none;
  for (const Index end : pending_[balls_[ball].owner].points) {
    if (points_.resolved(end)) continue;
    if (nearest == none ||
        squared_distance(intruder, points_[end].point) < squared_distance(intruder, points_[nearest].point))
      nearest = end;
  }
  return nearest;
}

std::optional<CurveChains::Split> CurveChains::split_of(Index subsegment) {
  const Chained& chained = subsegments_[subsegment];
  const Subsegment& s = chained.piece;
  if (s.squared_radius < domain_.floor * domain_.floor) {
    outcome_.give_up(s.centre, "a curve could not be resolved with edges longer than 1e-10 of the diagonal",
                     Outcome::advice_at_floor);
    return std::nullopt;
  }
  const Index nearest = balls_[chained.ball].vertex;
  const auto across = facing_sheets_.parameter_across(s, nearest);
  // A little off the centre: halves of symmetric curves would be cocircular.
  const double parameter =
      across ? *across
             : s.centre_parameter + subsegment_offset * std::sqrt(s.squared_radius) * random_.in_cube().x;
  const Point p = domain_.frame.rounded(domain_.paths.point(s.curve, parameter));
  const Index around = mesh_.nearest_vertex(p, nearest);
  const Index cell = mesh_.conflicting_cell_around(around, p);
  const Candidate candidate{p,    s.squared_radius,       across ? p : s.centre, {1, s.curve},
                            cell, across ? nearest : none};
  return Split{candidate, {subsegment, chained.stamp}, s, parameter, around};
}

bool CurveChains::can_join(const Split& split) const {
  return split.vertex != split.piece.ends[0] && split.vertex != split.piece.ends[1];
}

void CurveChains::remove(const Split& split) { remove_subsegment(split.link.subsegment); }

void CurveChains::add_pieces(const Split& split, Index vertex) {
  const Subsegment& s = split.piece;
  add_subsegment(s.curve, {s.ends[0], vertex}, {s.parameters[0], split.parameter}, vertex);
  add_subsegment(s.curve, {vertex, s.ends[1]}, {split.parameter, s.parameters[1]}, vertex);
}

void CurveChains::queue_again(const Split& split, WorkQueue::Priority priority) {
  if (is_there(split.link)) queue(priority, split.link.subsegment);
}

void CurveChains::cells_made(const ConflictZone& zone, Index vertex) {
  const Point p = mesh_.point(vertex);
  for (const Index neighbour : zone.vertices)
    for (Index o = balls_.first_at(neighbour), next = none; o != none; o = next) {
      const auto& ball = balls_[o];
      next = ball.next;
      const double d = squared_distance(p, ball.centre);
      const bool nearer = d < squared_distance(mesh_.point(neighbour), ball.centre);
      if (d <= ball.squared_radius) {
        if (ball.kind == LocationObjects::Kind::subsegment)
          encroach(ball.owner);
        else
          hurry_ends(pending_[ball.owner]);
      }
      if (nearer) balls_.move(o, vertex);
    }
}

void CurveChains::clip(Index c, bool at_start, Index near) {
  const unsigned side = at_start ? 0 : 1;
  const Index vertex = domain_.plc.curves[c].ends[side], ball = collars_.ball_at_vertex(vertex);
  const CollarBall& b = collars_.balls()[ball];
  const double end = at_start ? 0 : domain_.paths.length(c);
  auto& waiting = waiting_for(vertex);
  const auto found = std::find_if(waiting.begin(), waiting.end(), [&](Index index) {
    const Pending& p = pending_[index];
    return p.curve == c && p.points[side] == vertex && p.parameters[side] == end;
  });
  if (found == waiting.end()) return;
  const Index index = *found;
  waiting.erase(found);
  const bool is_open = open_creases_.is_open(c);
  double parameter = at_start ? b.radius : end - b.radius;
  if (!is_open) parameter = leaving_parameter(c, b, at_start);
  const Index point = points_.add(domain_.paths.point(c, parameter), {1, c}, near);
  if (is_open)
    open_creases_.note_end(c, side, point);
  else
    clipped_ends_.push_back({c, ball, point});
  Pending& p = pending_[index];
  p.points[side] = point;
  p.parameters[side] = parameter;
  waiting_for(point).push_back(index);
  balls_.remove(p.ball);
  guard(index, near);
  const LocationObjects::Object& guarding = balls_[p.ball];
  if (squared_distance(mesh_.point(guarding.vertex), guarding.centre) <= guarding.squared_radius)
    hurry_ends(p);
}

std::size_t CurveChains::bytes() const { return balls_.bytes() + subsegments_.bytes(); }

}  // namespace collarmesh
