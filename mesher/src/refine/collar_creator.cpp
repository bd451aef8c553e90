#include "refine/collar_creator.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "collarmesh/plc_builder.h"

namespace collarmesh {

void CollarCreator::start() {
  assert(points_.begin_with_vertices_of(domain_.plc));
  CollarOptions options;
  options.size = [this](const Feature& feature, const Point& p) { return target_size(feature, p); };
  options.tolerance = domain_.tolerance;
  options.seed = domain_.options.seed;
  options.stopped = stopped_;
  options.too_small = [this](const Point& p, double radius) { return domain_.at_floor(p, radius * radius); };
  options.outside = [this](const Point& p) { return domain_.frame.outside(p); };
  const std::vector<Crease> creases = find_creases(domain_.plc, domain_.options.bounds.crease_angle);
  if (creases.empty()) return;
  if (domain_.options.collar_creation == CollarCreation::in_pass) {
    collars_ = CollarSystem(domain_.plc, domain_.points, creases);
    placement_ =
        std::make_unique<CollarPlacement>(domain_.plc, domain_.points, gap_size(), options, collars_);
    return;
  }
  collars_ = CollarSystem(domain_.plc, domain_.points, creases, options);
  if (collars_.empty()) return;
  for (Index v = 0; v < mesh_.vertex_count(); ++v) collar_cells_.note_near(v);
  take_up_balls(none, {none, none}, BallReason::up_front);
}

// Returns the target edge length at p on a curve. At a vertex, returns the smallest one of its curves and
// patches.
double CollarCreator::target_size(const Feature& feature, const Point& p) const {
  const Sizing& sizing = sizes_.asked();
  if (feature.dimension == 1) return sizing.feature_size(1, feature.index, p);
  double size = sizing.default_size(p);
  for (const Index curve : domain_.plc.vertices[feature.index].curves)
    size = std::min(size, sizing.feature_size(1, curve, p));
  for (const Index patch : domain_.plc.vertices[feature.index].patches)
    size = std::min(size, sizing.feature_size(2, patch, p));
  return size;
}

GapExplorer& CollarCreator::gap_size() {
  if (!gap_) gap_ = std::make_unique<GapExplorer>(domain_, mesh_, nodes_);
  return *gap_;
}

void CollarCreator::cells_made(const ConflictZone& zone, Index vertex) {
  if (!placement_) return;
  for (const Index v : zone.vertices)
    if (mesh_.feature(v).dimension == 1) open_creases_.touch(mesh_.feature(v).index);
  create_if_isolated(vertex);
  for (const Index v : zone.vertices) create_if_isolated(v);
}

// Places a ball if the Voronoi cell of `at` contains exactly one vertex of the complex that is not in the
// mesh, and this is a crease vertex that is theta_0-medial and isolated (paper, appendix A).
void CollarCreator::create_if_isolated(Index at) {
  const Index only = points_.only_vertex_at(at);
  if (only == none || !waits_for_ball(only)) return;
  if (!points_.medial(only)) return;
  if (gap_size().isolated({0, only}, at)) create_at_vertex(only, at, BallReason::vertex_isolated);
}

// Places a vertex ball. Curves that end at the vertex then end at the ball's sphere.
void CollarCreator::create_at_vertex(Index vertex, Index near, BallReason reason) {
  assert(waits_for_ball(vertex));
  gap_size().start_near(near);
  placement_->place_at_vertex(vertex);
  for (const Index curve : domain_.plc.vertices[vertex].curves)
    for (const bool at_start : {true, false})
      if (domain_.plc.curves[curve].ends[at_start ? 0 : 1] == vertex) curves_.clip(curve, at_start, near);
  take_up_balls(near, {none, none}, reason);
}

// Places balls on isolated curves. Only the Voronoi cells of subsegments' ends are tested: a subsegment
// crosses no others, because its protective ball is empty.
void CollarCreator::create_on_isolated_curves() {
  while (open_creases_.any_touched()) {
    const Index curve = open_creases_.take_touched();
    if (curve == none) continue;
    if (open_creases_.chain(curve).unresolved == 0 && is_isolated(curve))
      create_on_curve(curve, BallReason::curve_isolated);
  }
}

// Returns whether a curve is isolated. Precondition: its chain is resolved.
bool CollarCreator::is_isolated(Index curve) {
  const OpenCreases::Chain& chain = open_creases_.chain(curve);
  assert(chain.unresolved == 0);
  std::vector<CollarBall> at_ends;
  for (const Index end : domain_.plc.curves[curve].ends)
    if (end != none) at_ends.push_back(collars_.balls()[collars_.ball_at_vertex(end)]);
  if (gap_size().witness_remains({1, curve}, at_ends)) return false;
  const auto isolated_at = [&](Index end) { return gap_size().isolated({1, curve}, end, at_ends); };
  std::size_t& isolated = isolated_[curve];
  for (; isolated < chain.links.size(); ++isolated) {
    const Subsegment* s = curves_.find(chain.links[isolated]);
    if (s != nullptr && !std::ranges::all_of(s->ends, isolated_at)) break;
  }
  return isolated == chain.links.size();
}

// Places a curve's balls instead of splitting its subsegment; in the paper's profile only if the curve is
// isolated.
bool CollarCreator::create_at_subsegment(Index subsegment) {
  const Index curve = curves_.curve_of(subsegment);
  if (!open_creases_.is_open(curve) || open_creases_.chain(curve).unresolved > 0) return false;
  if (domain_.is_papers() && !is_isolated(curve)) return false;
  create_on_curve(curve, domain_.is_papers() ? BallReason::curve_isolated : BallReason::curve_would_divide);
  return true;
}

bool CollarCreator::create_remaining() {
  std::vector<Index> curves = open_creases_.curves();
  std::ranges::sort(curves);
  for (const Index curve : curves) create_on_curve(curve, BallReason::curve_left);
  return !curves.empty();
}

void CollarCreator::create_on_curve(Index curve, BallReason reason) {
  assert(std::ranges::all_of(domain_.plc.curves[curve].ends, [this](Index end) {
    return end == none || collars_.ball_at_vertex(end) != none;
  }));
  const OpenCreases::Chain chain = open_creases_.close(curve);
  isolated_.erase(curve);
  // Only on closed curves are balls centred on mesh vertices. On other curves, such balls may keep the repair
  // of the collar surface from ending.
  std::vector<PlaceOnCurve> vertices;
  if (domain_.plc.curves[curve].closed) vertices = curves_.vertices_amid(curve);
  const Index at_chain = curves_.remove_chain(curve),
              near = at_chain == none ? mesh_.last_vertex() : at_chain;
  gap_size().start_near(near);
  placement_->place_on_curve(curve, vertices);
  take_up_balls(near, chain.ends, reason);
}

// Registers the balls placed last. `ends` are the unresolved points at the centres of the first and the last
// of these balls, if there are such points already.
void CollarCreator::take_up_balls(Index near, const std::array<Index, 2>& ends, BallReason reason) {
  const auto first = static_cast<Index>(ball_points_.size());
  const auto count = static_cast<Index>(collars_.balls().size());
  for (Index b = first; b < count; ++b) {
    const CollarBall& ball = collars_.balls()[b];
    Index point = ball.feature;
    if (ball.dimension == 1) {
      point = b == first ? ends[0] : b + 1 == count ? ends[1] : none;
      if (point == none) point = points_.add(ball.centre, {1, ball.feature}, near);
    }
    ball_points_.push_back(point);
    reasons_.push_back(reason);
    near = points_.vertex_near(point);
    if (placement_) find_inside(ball, near);
  }
  for (; corners_taken_up_ < collars_.corners().size(); ++corners_taken_up_) {
    const CornerPoint& corner = collars_.corners()[corners_taken_up_];
    const bool planar = corner.dimension == 2 && domain_.plc.patches[corner.feature].planar;
    points_.add(planar ? domain_.on_plane(corner.feature, corner.point) : corner.point,
                {corner.dimension, corner.feature}, near);
  }
  if (observer_)
    for (Index b = first; b < count; ++b) observer_(collars_.balls()[b]);
}

// Reports a new ball to the cells and restricted triangles that refinement ignores because of it.
void CollarCreator::find_inside(const CollarBall& ball, Index near) {
  const double squared = ball.radius * ball.radius * (1 + 1e-9);
  mesh_.visit_ball(ball.centre, mesh_.nearest_vertex(ball.centre, near), squared, [&](Index vertex) {
    collar_cells_.note_near(vertex);
    mesh_.incident_cells(vertex, scratch_);
    for (const Index cell : scratch_) {
      if (squared_distance(mesh_.circumcentre(cell), ball.centre) < ball.radius * ball.radius)
        collar_cells_.note_inside(cell);
      surface_.note_ball(cell, ball);
    }
  });
}

}  // namespace collarmesh
