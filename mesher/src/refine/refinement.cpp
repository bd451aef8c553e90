// Sparse Voronoi Refinement: the work loop, destroy and force_insert (paper, Procedures 1 to 3; doc/theory.md
// lists the differences from the paper and the reasons).
#include "refine/refinement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <utility>

#include "common/thread_limit.h"
#include "refine/aspect_ratios.h"

namespace collarmesh {

namespace {

constexpr std::size_t steps_between_stops = 512;
// Bytes of a future ball, with its links, corner points and places in hierarchies.
constexpr std::size_t bytes_of_ball = 512;

}  // namespace

Refinement::Refinement(const Plc& plc, const MeshOptions& options, const Execution& execution)
    : domain_(plc, options),
      outcome_(domain_.frame),
      budget_(domain_.options, execution, outcome_),
      queue_(squared_distance(domain_.box.min, domain_.box.max)),
      random_(options.seed, collars_),
      mesh_(plc, domain_.box),
      nodes_(domain_, mesh_),
      collar_cells_(mesh_, collars_),
      surface_(domain_, mesh_, nodes_, collar_cells_),
      sizes_(domain_, mesh_, surface_),
      facing_sheets_(domain_, mesh_, nodes_, collars_, surface_),
      points_(mesh_, options.theta, queue_),
      curves_(domain_, mesh_, collars_, points_, open_creases_, sizes_, facing_sheets_, random_, outcome_,
              queue_),
      triangles_(domain_, mesh_, nodes_, surface_, sizes_, facing_sheets_, random_, queue_),
      cells_(domain_, mesh_, collar_cells_, surface_, sizes_, facing_sheets_, random_, queue_),
      collar_creator_(domain_, mesh_, nodes_, sizes_, collars_, collar_cells_, surface_, points_, curves_,
                      open_creases_,
                      [this](std::size_t planned_vertices) { return stopped(planned_vertices); }),
      blocks_(domain_, mesh_, nodes_, collars_, collar_cells_, surface_, sizes_, points_, curves_, triangles_,
              cells_, queue_),
      collar_surface_(domain_, mesh_, nodes_, collars_, collar_cells_, surface_, collar_creator_),
      collar_review_(mesh_, collars_, collar_cells_, surface_, collar_creator_, collar_surface_, queue_,
                     [this] { return stopped(); }),
      surface_check_(domain_, mesh_, nodes_, collars_, collar_cells_, surface_, triangles_, points_, curves_,
                     outcome_),
      stitching_(domain_, mesh_, nodes_, collars_, surface_, points_, curves_, collar_creator_,
                 collar_surface_),
      topology_(domain_, mesh_, collar_cells_, surface_, curves_, stitching_, triangles_, surface_check_) {
  if (domain_.options.count_work) counter_.emplace(plc, mesh_);
  start();
}

void Refinement::start() {
  for (Index i = 0; i < domain_.plc.vertices.size(); ++i)
    points_.add(domain_.points[domain_.plc.vertices[i].point], {0, i});
  collar_creator_.start();
  if (outcome_.stopped()) return;
  curves_.start();
  surface_check_.seed_closed_patches();
  cells_.judge_all();
}

MeshStatus Refinement::run() {
  const auto by_all_threads = [this](const auto& look) {
    bool found = false;
    ThreadLimit(domain_.options.threads).run([&] { found = look(); });
    return found;
  };
  WorkQueue::Item item;
  // Whether the collar surface is being repaired. This takes many small steps, so let it settle before
  // everything else is checked again.
  bool mending_collars = false;
  // Only the first pass refines blocks: they do not report to the collar surface, which later passes use.
  bool first_pass = true;
  if (trace_) trace_->record("box");
  while (!outcome_.stopped()) {
    for (;;) {
      if (first_pass && blocks_.is_due()) {
        if (observer_ && queue_.first_priority() > WorkQueue::skinny_cells) observer_();
        blocks_.round();
        if (counter_) counter_->note_round(blocks_.largest_zone());
        if (stopped()) return outcome_.status();
      }
      if (!queue_.pop(item)) break;
      if (observer_ && item.priority > WorkQueue::skinny_cells) observer_();
      if (item.priority > WorkQueue::encroached_subsegments) collar_creator_.create_on_isolated_curves();
      process(item);
      if (trace_ && trace_->is_due()) trace_->record("refine", working_on_);
      if (++steps_ % steps_between_stops == 0 && stopped()) return outcome_.status();
    }
    first_pass = false;
    if (stopped()) return outcome_.status();
    if (collar_creator_.create_remaining()) continue;
    if (mending_collars && check_collars()) continue;
    const bool collars_settled = std::exchange(mending_collars, false);
    if (by_all_threads([&] { return surface_check_.check() || check_gradation(); })) continue;
    if (!collars_settled && check_collars()) {
      mending_collars = true;
      continue;
    }
    assert(outcome_.given_up() || points_.all_resolved());
    stitching_.stitch();
    if (outcome_.given_up()) break;
    if (by_all_threads([&] { return topology_.check(); }) || bound_narrow_cells()) continue;
    break;
  }
  if (outcome_.stopped()) return outcome_.status();
  if (by_all_threads([&] { return surface_check_.relabel_flat_cells(); })) stitching_.stitch();
  if (const auto& open = stitching_.result().open; !open.empty())
    outcome_.give_up(mesh_.point(open[0]), "a collar could not be stitched to its surroundings",
                     "try a smaller size or another seed");
  if (trace_) trace_->record("rip");
  seconds_ = budget_.elapsed();
  return outcome_.given_up() ? MeshStatus::guarantee_missed : MeshStatus::complete;
}

void Refinement::process(const WorkQueue::Item& item) {
  const auto [id, stamp] = item.entry;
  working_on_ = item.priority;
  switch (item.priority) {
    case WorkQueue::encroached_subsegments:
      if (curves_.is_due(item.entry)) split_ahead(id);
      break;
    case WorkQueue::coarse_subsegments:
      if (curves_.is_due(item.entry)) destroy_subsegment(id, true);
      break;
    case WorkQueue::unresolved_points:
      if (points_.is_due(id, stamp)) resolve_point(id);
      break;
    case WorkQueue::skinny_cells:
    case WorkQueue::large_cells:
      if (cells_.is_due(item)) destroy_cell(item);
      break;
    case WorkQueue::unresolved_triangles:
    case WorkQueue::large_triangles:
      if (triangles_.is_due(item.entry)) destroy_triangle(item);
      break;
    case WorkQueue::exposed_crease_vertices:
    case WorkQueue::poor_collar_triangles:
      if (const auto candidate = collar_review_.candidate(item)) destroy(*candidate);
      break;
    case WorkQueue::priority_count: break;
  }
}

void Refinement::destroy_cell(const WorkQueue::Item& item) {
  const auto candidate = cells_.candidate(item.entry.id);
  // The candidate may have yielded or warped to another point, whose insertion did not destroy this cell.
  if (candidate && destroy(*candidate)) cells_.queue_again(item, candidate->squared_radius);
}

void Refinement::destroy_triangle(const WorkQueue::Item& item) {
  const auto candidate = triangles_.candidate(item.entry.id);
  if (candidate && destroy(*candidate))
    triangles_.queue_again(item, candidate->squared_radius);
  else
    triangles_.give_up(item.entry.id);
}

bool Refinement::destroy(Candidate candidate) {
  for (;;) {
    if (at_floor(candidate)) {
      outcome_.give_up(candidate.point,
                       fmt::format("the refinement did not end before edges became shorter than {:.2g}",
                                   domain_.floor_at(candidate.point)),
                       Outcome::advice_at_floor);
      return false;
    }
    mesh_.find_conflict_zone(candidate.point, candidate.start, zone_);
    if (const Index point = points_.warp_target(zone_, candidate); point != none) {
      ++warps_;
      insert_point(point);
      return true;
    }
    if (const Index subsegment = curves_.encroached(zone_, candidate); subsegment != none) {
      ++yields_;
      return yield_to(subsegment, candidate);
    }
    if (const FaceId face = triangles_.encroached(zone_, candidate); face != no_face)
      if (const auto lower = triangles_.candidate(face); lower && !at_floor(*lower)) {
        ++yields_;
        candidate = *lower;
        continue;
      }
    if (candidate.across != none) facing_sheets_.note_pair(candidate.across, mesh_.vertex_count());
    force_insert(candidate.feature);
    return true;
  }
}

// Yields to a subsegment. The subsegment's ball is empty, so its middle or a medial end is as good a place
// for a vertex as the candidate's.
bool Refinement::yield_to(Index subsegment, const Candidate& candidate) {
  if (const Index end = curves_.end_to_resolve(subsegment, candidate); end != none) {
    insert_point(end);
    return true;
  }
  return destroy_subsegment(subsegment, false);
}

bool Refinement::destroy_subsegment(Index subsegment, bool queue_again) {
  if (collar_creator_.create_at_subsegment(subsegment)) return true;
  const auto split = curves_.split_of(subsegment);
  if (!split) return false;
  const Candidate& candidate = split->candidate;
  if (candidate.start == none) return join(*split);
  mesh_.find_conflict_zone(candidate.point, candidate.start, zone_);
  if (const Index point = points_.warp_target(zone_, candidate); point != none) {
    ++warps_;
    insert_point(point);
    if (queue_again) curves_.queue_again(*split);
    return true;
  }
  if (candidate.across != none) facing_sheets_.note_pair(candidate.across, mesh_.vertex_count());
  curves_.drop_ball(*split);
  curves_.split_at(*split, force_insert(candidate.feature));
  return true;
}

// Splits a subsegment by an unresolved point, because a vertex is in its ball; the point is inserted later.
void Refinement::split_ahead(Index subsegment) {
  if (collar_creator_.create_at_subsegment(subsegment)) return;
  const auto split = curves_.split_of(subsegment);
  if (!split) return;
  if (split->candidate.start == none)
    join(*split);
  else
    curves_.split_ahead(*split);
}

// Splits a subsegment by a vertex that is already at the place of the split. Returns false if the vertex is
// an end of the subsegment.
bool Refinement::join(const CurveChains::Split& split) {
  if (!curves_.can_join(split)) return false;
  mesh_.lower_feature(split.vertex, split.candidate.feature);
  collar_review_.vertex_joined_feature(split.vertex);
  curves_.split_at(split, split.vertex);
  return true;
}

// Resolves an unresolved point. The paper inserts no point that is not medial (section 3.1): it destroys the
// balls around the point until one of them warps to it or the point is medial.
void Refinement::resolve_point(Index index) {
  if (!domain_.is_papers() || points_.medial(index)) return insert_point(index);
  const Point& p = points_[index].point;
  const Index cell = mesh_.conflicting_cell_around(points_.vertex_near(index), p);
  if (cell == none) return insert_point(index);
  mesh_.find_conflict_zone(p, cell, zone_);
  Index largest = none;
  for (const Index c : zone_.cells)
    if (domain_.in_box(mesh_.circumcentre(c)) &&
        (largest == none || mesh_.squared_radius(c) > mesh_.squared_radius(largest)))
      largest = c;
  const auto candidate = largest == none ? std::nullopt : cells_.candidate(largest);
  if (!candidate) return insert_point(index);
  if (destroy(*candidate)) points_.queue_again(index);
}

void Refinement::insert_point(Index index) {
  const UnresolvedPoints::Unresolved p = points_[index];
  Index vertex = points_.vertex_near(index);
  if (distance(p.point, mesh_.point(vertex)) < p.apart && mesh_.on_patch(vertex, p.feature.index))
    return points_.resolve(index, vertex);
  const Index cell = mesh_.conflicting_cell_around(vertex, p.point);
  if (cell == none) {  // the place has a vertex already, which gets the feature
    mesh_.lower_feature(vertex, p.feature);
    collar_review_.vertex_joined_feature(vertex);
    points_.resolve(index, vertex);
  } else {
    mesh_.find_conflict_zone(p.point, cell, zone_);
    points_.resolve(index, mesh_.vertex_count());
    if (p.across != none) facing_sheets_.note_pair(p.across, mesh_.vertex_count());
    vertex = force_insert(p.feature);
  }
  if (collar_creator_.waits_for_ball(index))
    collar_creator_.create_at_vertex(index, vertex, BallReason::vertex_inserted);
  curves_.point_resolved(index);
}

Index Refinement::force_insert(const Feature& feature) {
  assert(!zone_.cells.empty() && mesh_.in_conflict(zone_.cells.front(), zone_.point));
  const bool early = counter_ && too_early();
  surface_.cells_vanish(zone_);
  const Index vertex = mesh_.insert(zone_, feature);
  if (counter_) counter_->note_insertion(zone_, early);
  // Parts that represent the mesh:
  nodes_.cells_made(zone_, vertex);
  collar_cells_.cells_made(zone_, vertex);
  surface_.cells_made(zone_, vertex);
  sizes_.cells_made(zone_, vertex);
  // Parts that queue work:
  points_.cells_made(zone_, vertex);
  curves_.cells_made(zone_, vertex);
  triangles_.cells_made(zone_);
  cells_.cells_made(zone_, vertex);
  collar_surface_.cells_made(zone_);
  collar_review_.cells_made(zone_);
  collar_creator_.cells_made(zone_, vertex);
  return vertex;
}

// Returns whether this insertion serves another purpose than destroying skinny cells, while a skinny cell
// waits.
bool Refinement::too_early() {
  return working_on_ != WorkQueue::skinny_cells &&
         queue_.any_due(WorkQueue::skinny_cells, [&](const WorkQueue::Entry& entry) {
           return cells_.is_due({WorkQueue::skinny_cells, entry});
         });
}

bool Refinement::check_gradation() {
  if (outcome_.given_up() || !sizes_.spread()) return false;
  const std::size_t before = queue_.pushed();
  curves_.judge_all();
  triangles_.judge_all();
  cells_.judge_all();
  return queue_.pushed() > before;
}

bool Refinement::bound_narrow_cells() {
  constexpr std::size_t times = 2, more = 300;
  if (domain_.options.narrow_cells != NarrowCells::bounded_if_cheap || !cells_.bound_narrow_cells())
    return false;
  most_with_narrow_cells_ = times * mesh_.vertex_count() + more;
  return true;
}

bool Refinement::check_collars() { return !outcome_.given_up() && collar_review_.check(); }

bool Refinement::stopped(std::size_t planned_vertices) {
  if (most_with_narrow_cells_ > 0 && mesh_.vertex_count() > most_with_narrow_cells_)
    outcome_.stop(MeshStatus::budget_hit, mesh_.point(mesh_.last_vertex()),
                  "narrow places take too many vertices", "leave the radius-edge ratio unbounded in them");
  const bool spent = outcome_.stopped() || is_budget_spent(planned_vertices);
  narrow_cells_are_dear_ =
      most_with_narrow_cells_ > 0 && outcome_.status() == MeshStatus::budget_hit && !budget_.is_out_of_time();
  return spent;
}

bool Refinement::is_budget_spent(std::size_t planned_vertices) {
  return budget_.spent({.vertices = mesh_.vertex_count(),
                        .cells = mesh_.cell_count(),
                        .bytes = bytes() + planned_vertices * bytes_of_ball,
                        .planned_vertices = planned_vertices,
                        .last_vertex = mesh_.point(mesh_.last_vertex()),
                        .expected_cells = sizes_.asked().expected_cells()});
}

std::size_t Refinement::bytes() const {
  return queue_.bytes() + mesh_.bytes() + nodes_.bytes() + surface_.bytes() + collar_cells_.bytes() +
         facing_sheets_.bytes() + points_.bytes() + curves_.bytes() + cells_.bytes() +
         collar_review_.bytes() + blocks_.bytes();
}

Extracted Refinement::extract() const { return collarmesh::extract(refined()); }

Refined Refinement::refined() const {
  return {domain_,  mesh_,   nodes_,          collars_,           collar_cells_,
          surface_, curves_, collar_creator_, stitching_.result()};
}

MeshStatistics Refinement::statistics() const {
  MeshStatistics s;
  s.vertices_inserted = mesh_.vertex_count();
  s.vertices_in_blocks = blocks_.inserted();
  s.cells = mesh_.cell_count();
  s.exact_predicates = mesh_.triangulation().exact_decisions();
  s.warps = warps_;
  s.yields = yields_ + blocks_.yields();
  s.peak_bytes = std::max(budget_.peak_bytes(), bytes());
  s.seconds = seconds_ > 0 ? seconds_ : budget_.elapsed();
  if (domain_.options.count_work) s.counts = work_counts();
  return s;
}

WorkCounts Refinement::work_counts() const {
  WorkCounts counts;
  counts.located = points_.objects().added() + curves_.balls().added();
  counts.relocated = points_.objects().moved() + curves_.balls().moved();
  counts.looks = points_.objects().looks() + curves_.balls().looks();
  if (const GapExplorer* gaps = collar_creator_.gap_explorer()) {
    counts.gap_queries = gaps->queries();
    counts.gap_cells = gaps->explored();
    counts.gap_interviews = gaps->interviews();
  }
  counter_->fill(counts);
  AspectRatios aspects;
  ThreadLimit(domain_.options.threads).run([&] {
    aspects = aspect_ratios(
        mesh_, [&](Index cell) { return surface_.region(cell) != 0 && !collar_cells_.inside(cell); });
  });
  counts.smallest_aspect = aspects.smallest;
  counts.largest_aspect = aspects.largest;
  counts.ripped_out = ripped_out();
  return counts;
}

// Returns how many vertices of cells in collars belong neither to a cell in a region outside the collars nor
// to a stitched tet.
std::size_t Refinement::ripped_out() const {
  enum : std::uint8_t { elsewhere, ripped, kept };
  std::vector<std::uint8_t> where(mesh_.vertex_count(), elsewhere);
  for (Index cell = 0; cell < mesh_.cell_capacity(); ++cell) {
    if (!mesh_.alive(cell)) continue;
    const bool inside = collar_cells_.inside(cell);
    if (!inside && surface_.region(cell) == 0) continue;
    for (const Index v : mesh_.corners(cell))
      where[v] = std::max<std::uint8_t>(where[v], inside ? ripped : kept);
  }
  for (const auto& tet : stitching_.result().tets)
    for (const Index v : tet.corners) where[v] = kept;
  return static_cast<std::size_t>(std::ranges::count(where, ripped));
}

}  // namespace collarmesh
