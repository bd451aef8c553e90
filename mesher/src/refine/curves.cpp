// Curves: chains of subsegments with protective balls.
#include <algorithm>

#include "refine/refinement.h"

namespace collarmesh {

namespace {

// A curve that is this much longer than its chord gets inner seeds: its first ball would miss it.
constexpr double seeded_length_per_chord = 1.2;
// Subsegments are split at most this share of their radius off the centre.
constexpr double subsegment_offset = 0.1;
// An arc may leave its chord by this share of the chord: about 60 degrees of turning.
constexpr double largest_sagitta_per_chord = 0.15;

}  // namespace

void Refinement::prepare_curves() {
  for (Index c = 0; c < plc_.curves.size(); ++c) add_curve_chain(c);
}

void Refinement::add_curve_chain(Index c) {
  const Plc::Curve& curve = plc_.curves[c];
  if (collars_.is_crease_curve(c)) {
    if (!placement_) return;  // covered by balls
    open_creases_[c] = {};
  }
  double from = 0, to = paths_.length(c);
  const auto seed = [&](double parameter) { return add_unresolved(paths_.point(c, parameter), 1, c); };
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
  const double chord = distance(unresolved_[first].point, unresolved_[last].point);
  chain.push_back({first, from});
  if (length > seeded_length_per_chord * chord)
    for (const double share : {1.0 / 3, 2.0 / 3})
      chain.push_back({seed(from + share * length), from + share * length});
  chain.push_back({last, to});
  for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
    const auto index = static_cast<Index>(pending_.size());
    pending_.push_back({c, {chain[i].first, chain[i + 1].first}, {chain[i].second, chain[i + 1].second}});
    PendingSubsegment& p = pending_.back();
    for (const Index point : p.points) unresolved_[point].pending.push_back(index);
    guard(index, none);
    if (const auto crease = open_creases_.find(c); crease != open_creases_.end()) ++crease->second.pending;
  }
}

void Refinement::guard(Index index, Index near) {
  PendingSubsegment& p = pending_[index];
  const Point a = unresolved_[p.points[0]].point, b = unresolved_[p.points[1]].point;
  const Point centre =
      paths_.point(p.curve, bisecting_parameter(p.curve, a, b, p.parameters[0], p.parameters[1]));
  p.object = objects_.add(LocationObjects::Kind::pending_subsegment, index, centre,
                          squared_distance(centre, a), nearest_vertex(centre, near));
}

// Where a curve leaves the ball at one of its ends: bisection, the ball meets it in one arc.
double Refinement::leaving_parameter(Index c, const CollarBall& ball, bool at_start) const {
  const double length = paths_.length(c);
  double inside = at_start ? 0 : length, outside = length / 2;
  for (int step = 0; step < 200; ++step) {
    const double middle = 0.5 * (inside + outside);
    if (middle == inside || middle == outside) break;
    (distance(paths_.point(c, middle), ball.centre) < ball.radius ? inside : outside) = middle;
  }
  return outside;
}

// A point has become a mesh vertex: first subsegments that waited for it may start.
void Refinement::point_resolved(Index point) {
  const std::vector<Index> waiting = std::move(unresolved_[point].pending);
  for (const Index index : waiting) {
    PendingSubsegment& p = pending_[index];
    if (--p.missing > 0) continue;
    objects_.remove(p.object);
    if (const auto crease = open_creases_.find(p.curve); crease != open_creases_.end())
      --crease->second.pending;
    const std::array<Index, 2> ends{unresolved_[p.points[0]].vertex, unresolved_[p.points[1]].vertex};
    add_subsegment(p.curve, ends, p.parameters, ends[0]);
  }
}

// A mesh vertex lies in the ball of a first subsegment: its ends come next, before skinny cells.
void Refinement::hurry_ends(const PendingSubsegment& pending) {
  for (const Index end : pending.points)
    if (unresolved_[end].object != none && unresolved_[end].vertex == none)
      queue_.push(WorkQueue::ends_of_encroached_subsegments, objects_[pending.object].squared_radius,
                  {end, 0});
}

// Where the curve between two parameters meets the bisector plane of a and b: bisection on the sign
// of |xa| - |xb| over the polyline's points, then linear on one segment.
double Refinement::bisecting_parameter(Index c, const Point& a, const Point& b, double from,
                                       double to) const {
  const auto nearer_to_a = [&](const Point& p) { return squared_distance(p, b) - squared_distance(p, a); };
  const auto& lengths = paths_.lengths(c);
  auto first =
      static_cast<std::size_t>(std::upper_bound(lengths.begin(), lengths.end(), from) - lengths.begin());
  auto last =
      static_cast<std::size_t>(std::lower_bound(lengths.begin(), lengths.end(), to) - lengths.begin());
  double low = from, high = to;
  while (first < last) {
    const std::size_t middle = (first + last) / 2;
    if (nearer_to_a(paths_.point(c, lengths[middle])) > 0) {
      low = lengths[middle];
      first = middle + 1;
    } else {
      high = lengths[middle];
      last = middle;
    }
  }
  const double at_low = nearer_to_a(paths_.point(c, low));
  const double at_high = nearer_to_a(paths_.point(c, high));
  return at_low > at_high ? low + (high - low) * std::clamp(at_low / (at_low - at_high), 0.0, 1.0)
                          : 0.5 * (low + high);
}

Index Refinement::add_subsegment(Index curve, std::array<Index, 2> ends, std::array<double, 2> parameters,
                                 Index nearby) {
  Index index;
  std::uint32_t stamp = 0;
  if (free_subsegments_.empty()) {
    index = static_cast<Index>(subsegments_.size());
    subsegments_.emplace_back();
  } else {
    index = free_subsegments_.back();
    free_subsegments_.pop_back();
    stamp = subsegments_[index].stamp;
  }
  Subsegment& s = subsegments_[index];
  const Point a = mesh_.point(ends[0]), b = mesh_.point(ends[1]);
  s = {curve, ends, parameters, {}, 0, 0, none, stamp, true};
  s.centre_parameter = bisecting_parameter(curve, a, b, parameters[0], parameters[1]);
  s.centre = frame_.rounded(paths_.point(curve, s.centre_parameter));
  s.squared_radius = std::max(squared_distance(s.centre, a), squared_distance(s.centre, b));
  const Index nearest = walk_.nearest(s.centre, nearby);
  s.object = objects_.add(LocationObjects::Kind::subsegment, index, s.centre, s.squared_radius, nearest);
  if (const auto crease = open_creases_.find(curve); crease != open_creases_.end()) {
    crease->second.subsegments.push_back({index, stamp});
    touch_crease(curve);
  }
  const bool empty = nearest == ends[0] || nearest == ends[1] ||
                     squared_distance(s.centre, mesh_.point(nearest)) > s.squared_radius;
  if (!empty || too_coarse(s)) encroach(index);
  return index;
}

void Refinement::encroach(Index subsegment) {
  const Subsegment& s = subsegments_[subsegment];
  queue_.push(WorkQueue::encroached_subsegments, s.squared_radius, {subsegment, s.stamp});
}

bool Refinement::too_coarse(const Subsegment& s) const {
  if (collars_.is_crease_curve(s.curve)) return false;  // it only waits for its balls
  const Point a = mesh_.point(s.ends[0]), b = mesh_.point(s.ends[1]);
  const double size = sizing_.curve_size(s.curve, paths_.segment(s.curve, s.parameters[0]),
                                         paths_.segment(s.curve, s.parameters[1]), s.centre);
  const double length = Sizing::subsegment_length(std::min(size, graded_size(s.ends, 0.5 * distance(a, b))));
  const double chord = squared_distance(a, b);
  if (chord > length * length) return true;
  if (plc_.curves[s.curve].straight) return false;
  const double sagitta = std::min(distance_, largest_sagitta_per_chord * std::sqrt(chord));
  const auto leaves_chord = [&](const Point& p) {
    const double t = chord > 0 ? std::clamp(dot(p - a, b - a) / chord, 0.0, 1.0) : 0.0;
    return squared_distance(p, a + t * (b - a)) > sagitta * sagitta;
  };
  const auto& lengths = paths_.lengths(s.curve);
  const auto first = std::upper_bound(lengths.begin(), lengths.end(), s.parameters[0]);
  const auto last = std::lower_bound(first, lengths.end(), s.parameters[1]);
  return leaves_chord(s.centre) || std::any_of(first, last, [&](double parameter) {
           return leaves_chord(paths_.point(s.curve, parameter));
         });
}

bool Refinement::destroy_subsegment(Index index) {
  const Subsegment s = subsegments_[index];
  if (s.squared_radius < floor_ * floor_) {
    give_up(s.centre, "a curve could not be resolved with edges longer than 1e-10 of the diagonal",
            advice_at_floor);
    return false;
  }
  const Index nearest = objects_[s.object].vertex;
  const auto across = parameter_across_gap(s, nearest);
  // A little off the centre: halves of symmetric curves would be cocircular.
  const double parameter =
      across ? *across
             : s.centre_parameter + subsegment_offset * std::sqrt(s.squared_radius) * random_in_cube().x;
  const Point p = frame_.rounded(paths_.point(s.curve, parameter));
  const Index around = walk_.nearest(p, nearest);
  const Index cell = mesh_.conflicting_cell_around(around, p);
  Index vertex = around;
  if (cell == none) {
    // A vertex is there already: it joins the curve.
    if (around == s.ends[0] || around == s.ends[1]) return false;
    if (vertices_[around].dimension > 1) {
      vertices_[around].dimension = 1;
      vertices_[around].feature = s.curve;
    }
    remove_subsegment(index);
  } else {
    mesh_.find_conflict_zone(p, cell, zone_);
    const Candidate candidate{p, s.squared_radius, across ? p : s.centre, 1, s.curve, cell};
    if (const Index point = warp_target(candidate); point != none) {
      ++warps_;
      insert_point(point);
      if (subsegments_[index].alive && subsegments_[index].stamp == s.stamp) encroach(index);
      return true;
    }
    remove_subsegment(index);
    if (across) note_pair(nearest, mesh_.vertex_count());
    vertex = force_insert(1, s.curve);
  }
  add_subsegment(s.curve, {s.ends[0], vertex}, {s.parameters[0], parameter}, vertex);
  add_subsegment(s.curve, {vertex, s.ends[1]}, {parameter, s.parameters[1]}, vertex);
  return true;
}

void Refinement::remove_subsegment(Index subsegment) {
  Subsegment& s = subsegments_[subsegment];
  objects_.remove(s.object);
  s.alive = false;
  ++s.stamp;
  free_subsegments_.push_back(subsegment);
}

}  // namespace collarmesh
