// Sparse Voronoi Refinement: the work loop, destroy and force_insert (paper, Procedures 1 to 3;
// what differs from the paper and why is in doc/theory.md).
#include "refine/refinement.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace collarmesh {

namespace {

// The insertion of a centre is moved by a pseudo-random offset of this share of its ball's radius:
// exact centres of cospherical input make flat cells whose refinement never ends.
constexpr double cell_offset = 0.05;
constexpr double triangle_offset = 0.1;
// So many offsets are tried where they lead into a collar.
constexpr int most_offsets = 16, offsets_of_full_length = 8;
// What lies between two surfaces is as fine as they are: sizes spread from them when gaps were asked for.
constexpr double gradation_in_gaps = 0.25;
// Hierarchy nodes of a vertex are filtered again after so many insertions in its star: rarely on the
// surface, where they never run out. In a large star after as many as a share of its cells, because
// filtering visits all of them: a hub with n cells would cost n^2 while they are made.
constexpr std::size_t insertions_between_refreshes = 16;
constexpr std::size_t insertions_between_surface_refreshes = 48;
constexpr std::size_t cells_per_insertion = 4;
// No ball smaller than this share of the diagonal is destroyed: it ends what would never end.
constexpr double floor_per_diagonal = 1e-10;
// With its links, corner points and places in hierarchies.
constexpr std::size_t bytes_of_ball = 512;
// A cell whose volume is below this share of its longest edge cubed is flat.
constexpr double flat_volume = 1e-11;
// The share of the distance tolerance that refinement aims at: it looks at a few points of a face.
constexpr double distance_reserve = 0.75;
constexpr std::size_t steps_between_reports = 512;
// Of the set of pairs: a node and its place in the table.
constexpr std::size_t bytes_per_pair = 32;

// A box well away from the input; slightly different in each axis so that its corners are not
// cospherical with points of symmetric input.
Box surrounding_box(const Box& bounds) {
  const Vector sides = bounds.max - bounds.min;
  const double extent = std::max({sides.x, sides.y, sides.z});
  const Vector reach = 0.5 * sides + extent * Vector{0.87, 0.89, 0.91};
  Box box;
  box.add(bounds.centre() - reach);
  box.add(bounds.centre() + reach);
  return box;
}

Box framed(const Box& bounds, const Frame& frame) {
  Box box;
  box.add(frame.inside(bounds.min));
  box.add(frame.inside(bounds.max));
  return box;
}

std::vector<Point> framed(const std::vector<Point>& points, const Frame& frame) {
  std::vector<Point> moved;
  moved.reserve(points.size());
  for (const Point& p : points) moved.push_back(frame.inside(p));
  return moved;
}

}  // namespace

Refinement::Refinement(const Plc& plc, const MeshOptions& options, const Execution& execution)
    : plc_(plc),
      options_(options),
      execution_(execution),
      frame_(plc.bounds),
      points_(framed(plc.points, frame_)),
      patch_points_(plc),
      sizing_(plc, options, frame_),
      gradation_(options.gradation == 0 && options.elements_across_gap > 0 ? gradation_in_gaps
                                                                           : options.gradation),
      diagonal_(plc.bounds.diagonal()),
      distance_(distance_reserve *
                (options.distance > 0 ? options.distance : default_distance(options.size, diagonal_))),
      floor_(floor_per_diagonal * diagonal_),
      box_(surrounding_box(framed(plc.bounds, frame_))),
      paths_(plc, points_),
      mesh_(box_),
      walk_(mesh_),
      hierarchy_(points_, elements_of(plc)),
      queue_(squared_distance(box_.min, box_.max)),
      random_state_(options.seed),
      started_(std::chrono::steady_clock::now()) {
  start();
}

void Refinement::start() {
  vertices_.resize(mesh_.vertex_count());
  for (Index v = 0; v < mesh_.vertex_count(); ++v) expect_insertions(v, 0);
  if (!hierarchy_.empty()) {
    node_pool_.push_back(hierarchy_.root());
    for (MeshVertex& v : vertices_) v.node_count = 1;
  }
  labels_.resize(mesh_.cell_capacity());
  marks_.resize(mesh_.cell_capacity());
  if (gradation_ > 0) target_size_.resize(mesh_.vertex_count(), INFINITY);
  if (options_.vertex_ratio > 0) shortest_edge_.resize(mesh_.vertex_count(), INFINITY);
  for (Index cell = 0; cell < mesh_.cell_capacity(); ++cell) label_from_outside(cell);
  for (Index i = 0; i < plc_.vertices.size(); ++i) add_unresolved(points_[plc_.vertices[i].point], 0, i);
  prepare_collars();
  if (stop_ != MeshStatus::complete) return;
  prepare_curves();
  prepare_patches();
  for (Index cell = 0; cell < mesh_.cell_capacity(); ++cell) judge_cell(cell);
}

Index Refinement::add_unresolved(const Point& p, std::uint8_t dimension, Index feature, Index near) {
  const auto index = static_cast<Index>(unresolved_.size());
  unresolved_.push_back({p, dimension, feature});
  unresolved_[index].object =
      objects_.add(LocationObjects::Kind::point, index, p, 0, nearest_vertex(p, near));
  queue_point(index);
  return index;
}

Index Refinement::nearest_vertex(const Point& p, Index near) {
  if (mesh_.vertex_count() > 8) return walk_.nearest(p, near == none ? last_vertex() : near);
  Index nearest = 0;
  for (Index corner = 1; corner < 8; ++corner)
    if (squared_distance(p, mesh_.point(corner)) < squared_distance(p, mesh_.point(nearest)))
      nearest = corner;
  return nearest;
}

// The stamp of a queued point is the exponent of its ball, so that a stale entry is noticed.
void Refinement::queue_point(Index point) {
  const double r2 =
      squared_distance(unresolved_[point].point, mesh_.point(objects_[unresolved_[point].object].vertex));
  queue_.push(WorkQueue::unresolved_points, r2,
              {point, static_cast<std::uint32_t>(std::ilogb(std::max(r2, 1e-300)))});
}

MeshStatus Refinement::run() {
  WorkQueue::Item item;
  // Repairs of the collar surface come in many small rounds: let them settle before the rest is
  // looked at again.
  bool mending_collars = false;
  while (stop_ == MeshStatus::complete) {
    while (queue_.pop(item)) {
      if (observer_ && item.priority > WorkQueue::skinny_cells) observer_();
      if (!touched_creases_.empty() && item.priority > WorkQueue::encroached_subsegments)
        create_collars_on_touched_creases();
      process(item);
      if (++steps_ % steps_between_reports == 0 && stopped()) return stop_;
    }
    if (stopped()) return stop_;
    if (create_remaining_collars()) continue;
    if (mending_collars && check_collars()) continue;
    const bool collars_settled = std::exchange(mending_collars, false);
    if (check_surface() || check_gradation()) continue;
    if (!collars_settled && check_collars()) {
      mending_collars = true;
      continue;
    }
    rip_and_stitch();
    if (!check_surface_topology()) break;
  }
  if (stop_ != MeshStatus::complete) return stop_;
  if (relabel_flat_cells()) rip_and_stitch();
  if (!stitched_.open.empty())
    give_up(mesh_.point(stitched_.open[0]), "a collar could not be stitched to its surroundings",
            "try a smaller size or another seed");
  seconds_ = elapsed();
  return message_.empty() ? MeshStatus::complete : MeshStatus::guarantee_missed;
}

void Refinement::process(const WorkQueue::Item& item) {
  const auto [id, stamp] = item.entry;
  switch (item.priority) {
    case WorkQueue::encroached_subsegments:
      if (subsegments_[id].alive && subsegments_[id].stamp == stamp) destroy_subsegment(id);
      break;
    case WorkQueue::skinny_cells:
    case WorkQueue::large_cells:
      if (mesh_.alive(id) && mesh_.generation(id) == stamp) destroy_cell(item);
      break;
    case WorkQueue::ends_of_encroached_subsegments:
      if (unresolved_[id].vertex == none) insert_point(id);
      break;
    case WorkQueue::unresolved_points: resolve_point(item); break;
    case WorkQueue::unresolved_triangles:
    case WorkQueue::large_triangles:
      if (mesh_.alive(cell_of(id)) && mesh_.generation(cell_of(id)) == stamp) destroy_triangle(item);
      break;
    case WorkQueue::priority_count: break;
  }
}

void Refinement::destroy_cell(const WorkQueue::Item& item) {
  const Index cell = item.entry.id;
  if (labels_[cell].in_collar) return;
  const double r2 = mesh_.squared_radius(cell);
  const auto candidate = cell_candidate(cell);
  if (!candidate || !destroy(*candidate)) return;
  // It may have yielded or warped to something that left this cell alive.
  if (mesh_.alive(cell) && mesh_.generation(cell) == item.entry.stamp)
    queue_.push(item.priority, r2, item.entry);
}

void Refinement::destroy_triangle(const WorkQueue::Item& item) {
  const FaceId face = item.entry.id;
  if (!(labels_[cell_of(face)].marked >> corner_of(face) & 1U)) return;
  const RestrictedTriangle t = restricted(face);
  if (t.given_up || (t.in_collar && !t.surface_needs_it)) return;
  const auto candidate = triangle_candidate(face);
  if (!candidate || !destroy(*candidate)) {
    restricted(face).given_up = true;
    return;
  }
  if (mesh_.alive(cell_of(face)) && mesh_.generation(cell_of(face)) == item.entry.stamp &&
      (labels_[cell_of(face)].marked >> corner_of(face) & 1U))
    queue_.push(item.priority, t.squared_radius, item.entry);
}

void Refinement::resolve_point(const WorkQueue::Item& item) {
  const UnresolvedPoint& p = unresolved_[item.entry.id];
  if (p.vertex != none) return;
  const double r2 = squared_distance(p.point, mesh_.point(objects_[p.object].vertex));
  if (std::ilogb(std::max(r2, 1e-300)) < static_cast<int>(item.entry.stamp)) {
    queue_point(item.entry.id);  // the mesh has become finer here since: others are larger
    return;
  }
  insert_point(item.entry.id);
}

bool Refinement::insert_point(Index index) {
  UnresolvedPoint& p = unresolved_[index];
  const Index nearest = objects_[p.object].vertex;
  const Index cell = mesh_.conflicting_cell_around(nearest, p.point);
  if (cell == none) {
    // A vertex is there already: it takes over the feature.
    MeshVertex& v = vertices_[nearest];
    if (p.dimension < v.dimension) {
      v.dimension = p.dimension;
      v.feature = p.feature;
      if (collar_review_.started && v.near_collar) {
        mesh_.incident_cells(nearest, cells_scratch_);
        for (const Index around : cells_scratch_) touch(around);
      }
    }
    p.vertex = nearest;
    objects_.remove(p.object);
    if (waits_for_ball(index)) create_collar_at_vertex(index, nearest);
    point_resolved(index);
    return true;
  }
  objects_.remove(p.object);
  mesh_.find_conflict_zone(p.point, cell, zone_);
  p.vertex = mesh_.vertex_count();
  const Index vertex = force_insert(p.dimension, p.feature);
  if (waits_for_ball(index)) create_collar_at_vertex(index, vertex);
  point_resolved(index);
  return true;
}

bool Refinement::destroy(Candidate candidate) {
  for (;;) {
    if (candidate.squared_radius < floor_ * floor_) {
      give_up(candidate.point,
              "the refinement did not end before edges became shorter than 1e-10 of the diagonal",
              advice_at_floor);
      return false;
    }
    mesh_.find_conflict_zone(candidate.point, candidate.start, zone_);
    if (const Index point = warp_target(candidate); point != none) {
      ++warps_;
      return insert_point(point);
    }
    if (const Index ball = encroached_ball(candidate); ball != none) {
      ++yields_;
      return destroy_ball(objects_[ball], candidate.point);
    }
    if (candidate.dimension == 3) {
      if (const FaceId face = encroached_triangle(candidate); face != no_face) {
        const auto lower = triangle_candidate(face);
        if (lower && lower->squared_radius >= floor_ * floor_) {
          ++yields_;
          candidate = *lower;
          continue;
        }
      }
    }
    if (candidate.across != none) note_pair(candidate.across, mesh_.vertex_count());
    force_insert(candidate.dimension, candidate.feature);
    return true;
  }
}

// The unresolved point of lowest containment dimension within theta r of the ball's centre. Those
// near enough are in a list of the zone's vertices.
Index Refinement::warp_target(const Candidate& candidate) const {
  Index best = none;
  double reach = options_.theta * options_.theta * candidate.squared_radius;
  std::uint8_t dimension = candidate.dimension;
  for (const Index v : zone_.vertices)
    for (Index o = objects_.first_at(v); o != none; o = objects_[o].next) {
      const auto& object = objects_[o];
      if (object.kind != LocationObjects::Kind::point) continue;
      const UnresolvedPoint& p = unresolved_[object.owner];
      const double d = squared_distance(p.point, candidate.ball_centre);
      if (p.dimension > dimension || (p.dimension == dimension && best == none) || d > reach) continue;
      if (p.dimension == dimension && best != none &&
          d >= squared_distance(unresolved_[best].point, candidate.ball_centre))
        continue;
      best = object.owner;
      dimension = p.dimension;
    }
  return best;
}

// The protective ball on a curve that the candidate lies deepest in.
Index Refinement::encroached_ball(const Candidate& candidate) const {
  if (candidate.dimension <= 1) return none;
  Index best = none;
  double deepest = 0;
  for (const Index v : zone_.vertices)
    for (Index o = objects_.first_at(v); o != none; o = objects_[o].next) {
      const auto& object = objects_[o];
      if (object.kind == LocationObjects::Kind::point) continue;
      const double depth = object.squared_radius - squared_distance(candidate.point, object.centre);
      if (depth < 0 || (best != none && depth <= deepest)) continue;
      best = o;
      deepest = depth;
    }
  return best;
}

// A curve's first subsegments guard it before their ends are in the mesh: what would encroach them
// brings the ends in, so that nothing comes too close to a curve that is not resolved yet.
bool Refinement::destroy_ball(LocationObjects::Object ball, const Point& intruder) {
  if (ball.kind == LocationObjects::Kind::subsegment) return destroy_subsegment(ball.owner);
  Index nearest = none;
  for (const Index end : pending_[ball.owner].points) {
    if (unresolved_[end].vertex != none) continue;
    if (nearest == none || squared_distance(intruder, unresolved_[end].point) <
                               squared_distance(intruder, unresolved_[nearest].point))
      nearest = end;
  }
  return insert_point(nearest);
}

// A surface gap ball lies in the union of its two cells' balls, so the marked faces of the zone are
// all that the candidate can encroach.
FaceId Refinement::encroached_triangle(const Candidate& candidate) const {
  FaceId best = no_face;
  double deepest = 0;
  for (const Index cell : zone_.cells)
    for (unsigned corner = 0, marked = labels_[cell].marked; marked != 0; ++corner, marked >>= 1) {
      if (!(marked & 1U)) continue;
      const RestrictedTriangle& t = restricted(face_id(cell, corner));
      const double depth = t.squared_radius - squared_distance(candidate.point, t.x);
      if (depth <= deepest || t.given_up || t.in_collar) continue;
      best = face_id(cell, corner);
      deepest = depth;
    }
  return best;
}

Index Refinement::force_insert(std::uint8_t dimension, Index feature) {
  const Index vertex = mesh_.insert(zone_);
  MeshVertex made;
  made.dimension = dimension;
  made.feature = feature;
  vertices_.push_back(made);
  expect_insertions(vertex, zone_.created.size());
  labels_.resize(mesh_.cell_capacity());
  marks_.resize(mesh_.cell_capacity());
  inherit_nodes(vertex);
  vertices_[vertex].near_collar = meets_collar(vertex);
  label_created_cells(vertex);
  find_collar_cells(vertex);
  grade_vertex(vertex);
  note_edges(vertex);
  mark_border_faces();
  relocate_objects(vertex);
  for (const Index cell : zone_.created) judge_cell(cell);
  if (placement_) look_for_isolated_creases(vertex);
  return vertex;
}

void Refinement::relocate_objects(Index vertex) {
  const Point p = mesh_.point(vertex);
  for (const Index neighbour : zone_.vertices)
    for (Index o = objects_.first_at(neighbour), next = none; o != none; o = next) {
      const auto& object = objects_[o];
      next = object.next;
      const double d = squared_distance(p, object.centre);
      const bool nearer = d < squared_distance(mesh_.point(neighbour), object.centre);
      if (d <= object.squared_radius) {
        if (object.kind == LocationObjects::Kind::subsegment)
          encroach(object.owner);
        else if (object.kind == LocationObjects::Kind::pending_subsegment)
          hurry_ends(pending_[object.owner]);
      }
      if (nearer) objects_.move(o, vertex);
    }
}

// A new vertex' Voronoi cell is cut out of its neighbours' cells: their nodes cover it.
void Refinement::inherit_nodes(Index vertex) {
  seeds_scratch_.clear();
  for (const Index neighbour : zone_.vertices) {
    const auto nodes = nodes_of(neighbour);
    if (nodes.empty()) continue;
    seeds_scratch_.insert(seeds_scratch_.end(), nodes.begin(), nodes.end());
    if (vertices_[neighbour].insertions_left > 0) --vertices_[neighbour].insertions_left;
  }
  if (seeds_scratch_.empty()) return;
  find_nodes(zone_.created);
  store_nodes(vertices_[vertex], nodes_scratch_);
  for (const Index neighbour : zone_.vertices)
    if (vertices_[neighbour].insertions_left == 0) refresh_nodes(neighbour);
}

void Refinement::expect_insertions(Index vertex, std::size_t star) {
  const std::size_t least =
      vertices_[vertex].dimension == 3 ? insertions_between_refreshes : insertions_between_surface_refreshes;
  vertices_[vertex].insertions_left = static_cast<std::uint16_t>(
      std::min<std::size_t>(std::max(least, star / cells_per_insertion), UINT16_MAX));
}

// The nodes that cover the triangles in the Voronoi cell of a vertex with these cells: the box of its
// corners, widened by the rounding of circumcentres.
void Refinement::find_nodes(const std::vector<Index>& cells) {
  Box box;
  double largest = 0;
  for (const Index cell : cells) {
    box.add(mesh_.circumcentre(cell));
    largest = std::max(largest, mesh_.squared_radius(cell));
  }
  const double radius = std::sqrt(largest), slack = 1e-9 * radius;
  box.min = box.min - Vector{slack, slack, slack};
  box.max = box.max + Vector{slack, slack, slack};
  hierarchy_.nodes_meeting(box, radius, seeds_scratch_, nodes_scratch_);
}

void Refinement::refresh_nodes(Index vertex) {
  mesh_.incident_cells(vertex, cells_scratch_);
  const auto nodes = nodes_of(vertex);
  seeds_scratch_.assign(nodes.begin(), nodes.end());
  find_nodes(cells_scratch_);
  store_nodes(vertices_[vertex], nodes_scratch_);
  expect_insertions(vertex, cells_scratch_.size());
}

void Refinement::store_nodes(MeshVertex& vertex, const std::vector<Index>& nodes) {
  if (nodes.size() > vertex.node_count) {
    vertex.first_node = static_cast<Index>(node_pool_.size());
    node_pool_.insert(node_pool_.end(), nodes.begin(), nodes.end());
  } else {
    std::copy(nodes.begin(), nodes.end(), node_pool_.begin() + vertex.first_node);
  }
  vertex.node_count = static_cast<Index>(nodes.size());
}

double Refinement::shortest_squared_edge(Index cell) const {
  const auto& v = mesh_.corners(cell);
  const Point &a = mesh_.point(v[0]), &b = mesh_.point(v[1]), &c = mesh_.point(v[2]), &d = mesh_.point(v[3]);
  return std::min({squared_distance(a, b), squared_distance(a, c), squared_distance(a, d),
                   squared_distance(b, c), squared_distance(b, d), squared_distance(c, d)});
}

void Refinement::judge_cell(Index cell) {
  if (labels_[cell].in_collar) return;
  const Index region = labels_[cell].region;
  const double r2 = mesh_.squared_radius(cell);
  const Point& centre = mesh_.circumcentre(cell);
  const double bound =
      region == 0 ? std::max(options_.exterior_radius_edge, options_.radius_edge) : options_.radius_edge;
  const bool skinny =
      r2 > bound * bound * shortest_squared_edge(cell) && !(region == 0 && fills_gap(cell, bound));
  if (skinny || (region != 0 && flat(cell))) {
    if (inside_box(centre)) queue_.push(WorkQueue::skinny_cells, r2, {cell, mesh_.generation(cell)});
    return;
  }
  if (region == 0) return;
  const auto& v = mesh_.corners(cell);
  const double size = sizing_.cell_radius(region, centre, graded_size(v, std::sqrt(r2)));
  if (r2 > size * size || uneven_at_vertex(cell))
    queue_.push(WorkQueue::large_cells, r2, {cell, mesh_.generation(cell)});
}

// Cocircular input makes cells whose volume is noise although their radius-edge ratio is not. Those
// on one patch are seen to when the queue is empty.
bool Refinement::flat(Index cell) const {
  const auto& v = mesh_.corners(cell);
  const Point &a = mesh_.point(v[0]), &b = mesh_.point(v[1]), &c = mesh_.point(v[2]), &d = mesh_.point(v[3]);
  const double longest = std::max({squared_distance(a, b), squared_distance(a, c), squared_distance(a, d)});
  const double volume = six_volume(a, b, c, d);
  return volume * volume < flat_volume * flat_volume * longest * longest * longest && !spans_patch(v);
}

// The paper's stronger quality measure (section 1.2): a circumradius against the shortest edge at a
// vertex.
bool Refinement::uneven_at_vertex(Index cell) const {
  if (options_.vertex_ratio == 0) return false;
  const auto& v = mesh_.corners(cell);
  double shortest = INFINITY;
  for (const Index vertex : v) shortest = std::min(shortest, shortest_edge_[vertex]);
  const double bound = options_.vertex_ratio * shortest;
  return mesh_.squared_radius(cell) > bound * bound;
}

// The nearest neighbour of a vertex is always joined to it, so the shortest edge at a vertex only
// ever shrinks. Where it did, older cells may have become uneven.
void Refinement::note_edges(Index vertex) {
  if (options_.vertex_ratio == 0) return;
  shortest_edge_.resize(mesh_.vertex_count(), INFINITY);
  for (const Index neighbour : zone_.vertices) {
    const double length = distance(mesh_.point(vertex), mesh_.point(neighbour));
    shortest_edge_[vertex] = std::min(shortest_edge_[vertex], length);
    if (length >= shortest_edge_[neighbour]) continue;
    shortest_edge_[neighbour] = length;
    mesh_.incident_cells(neighbour, cells_scratch_);
    for (const Index cell : cells_scratch_)
      if (labels_[cell].region != 0 && uneven_at_vertex(cell))
        queue_.push(WorkQueue::large_cells, mesh_.squared_radius(cell), {cell, mesh_.generation(cell)});
  }
}

std::optional<Refinement::Candidate> Refinement::cell_candidate(Index cell) {
  const double r2 = mesh_.squared_radius(cell);
  const Point& centre = mesh_.circumcentre(cell);
  Point p = frame_.rounded(centre + offset_outside_collars(centre, cell_offset * std::sqrt(r2 / 3), {}));
  if (!inside_box(p)) p = frame_.rounded(centre);
  if (!inside_box(p) || !mesh_.in_conflict(cell, p)) return std::nullopt;
  return Candidate{p, r2, centre, 3, none, cell};
}

std::optional<Refinement::Candidate> Refinement::triangle_candidate(FaceId face) {
  if (auto candidate = candidate_across_gap(face)) return candidate;
  const RestrictedTriangle& t = restricted(face);
  const Index patch = patch_of(t);
  Point p = t.x;
  if (plc_.patches[patch].planar && t.resolved_vertices) {
    const auto v = mesh_.face_vertices(face);
    const Vector n = cross(mesh_.point(v[1]) - mesh_.point(v[0]), mesh_.point(v[2]) - mesh_.point(v[0]));
    if (squared_norm(n) > 0)
      p = p + offset_outside_collars(p, triangle_offset * std::sqrt(t.squared_radius / 3), n);
  }
  if (plc_.patches[patch].planar) p = on_plane(patch, p);
  p = frame_.rounded(p);
  const FaceId other = mesh_.opposite(face);
  Index start = none;
  if (mesh_.in_conflict(cell_of(face), p))
    start = cell_of(face);
  else if (other != no_face && mesh_.in_conflict(cell_of(other), p))
    start = cell_of(other);
  else
    start = mesh_.conflicting_cell_around(mesh_.face_vertices(face)[0], p);
  if (start == none) return std::nullopt;
  return Candidate{p, t.squared_radius, t.x, 2, patch, start};
}

// A random vector of this length at most, orthogonal to the normal if there is one, that does not lead into a
// collar. Between two sheets exact centres often lie on a third one.
Vector Refinement::offset_outside_collars(const Point& from, double length, const Vector& normal) {
  const double nn = squared_norm(normal);
  for (int k = 0; k < most_offsets; ++k) {
    const Vector any = (k < offsets_of_full_length ? length : length *= 0.5) * random_in_cube();
    const Vector offset = nn > 0 ? any - (dot(any, normal) / nn) * normal : any;
    if (collars_.ball_containing(from + offset) == none) return offset;
  }
  return {};
}

// Needle triangles of a facet that is planar within a tolerance only have normals of their own.
Point Refinement::on_plane(Index patch, const Point& p) const {
  const Plc::Patch& plane = plc_.patches[patch];
  return p - dot(p - frame_.inside(plane.origin), plane.normal) * plane.normal;
}

bool Refinement::inside_box(const Point& p) const {
  return p.x > box_.min.x && p.x < box_.max.x && p.y > box_.min.y && p.y < box_.max.y && p.z > box_.min.z &&
         p.z < box_.max.z;
}

// splitmix64 (Steele, Lea, Flood: Fast splittable pseudorandom number generators, 2014).
Vector Refinement::random_in_cube() {
  const auto next = [this] {
    std::uint64_t z = (random_state_ += 0x9e3779b97f4a7c15ULL);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-52 - 1;
  };
  const double x = next(), y = next();
  return {x, y, next()};
}

void Refinement::give_up(const Point& where, const std::string& what, const std::string& next) {
  if (!message_.empty()) return;
  where_ = where;
  const Point p = frame_.outside(where);
  message_ = fmt::format("{} near ({:.9g}, {:.9g}, {:.9g}); {}", what, p.x, p.y, p.z, next);
}

// The place is the vertex inserted last: a refinement that does not end stays where it is.
void Refinement::stop_here(MeshStatus status, const std::string& what, const std::string& next) {
  stop_ = status;
  message_.clear();
  give_up(mesh_.point(last_vertex()),
          fmt::format("{} at {} vertices and {} cells, {:.1f} MB, after {:.2f} s; the last vertex is", what,
                      mesh_.vertex_count(), mesh_.cell_count(), static_cast<double>(peak_bytes_) / 1e6,
                      elapsed()),
          next);
}

double Refinement::elapsed() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count();
}

std::size_t Refinement::bytes() const {
  return mesh_.bytes() + hierarchy_.bytes() + objects_.bytes() + queue_.bytes() + labels_.bytes() +
         marks_.bytes() + vertices_.capacity() * sizeof(MeshVertex) +
         restricted_.capacity() * sizeof(RestrictedTriangle) + node_pool_.capacity() * sizeof(Index) +
         unresolved_.capacity() * sizeof(UnresolvedPoint) + subsegments_.capacity() * sizeof(Subsegment) +
         collar_review_.triangles.bytes() + pairs_.size() * bytes_per_pair + planned_balls_ * bytes_of_ball;
}

bool Refinement::stopped() {
  constexpr const char* more =
      "raise {} or size; if this is far more than expected, look at the input there, or wrap it (repair "
      "wrap)";
  peak_bytes_ = std::max(peak_bytes_, bytes());
  if (execution_.cancelled() || !report_progress())
    stop_here(MeshStatus::cancelled, "the refinement was stopped", "start it again");
  else if (options_.max_vertices > 0 && mesh_.vertex_count() + planned_balls_ > options_.max_vertices)
    stop_here(MeshStatus::budget_hit,
              fmt::format("the budget of {} vertices is spent", options_.max_vertices),
              fmt::format(more, "max-vertices"));
  else if (options_.max_memory > 0 && peak_bytes_ > options_.max_memory)
    stop_here(MeshStatus::budget_hit,
              fmt::format("the memory budget of {} bytes is spent", options_.max_memory),
              fmt::format(more, "max-memory"));
  else if (options_.time_limit > 0 && elapsed() > options_.time_limit)
    stop_here(MeshStatus::budget_hit, fmt::format("the time limit of {} s is reached", options_.time_limit),
              fmt::format(more, "time-limit"));
  return stop_ != MeshStatus::complete;
}

bool Refinement::report_progress() {
  if (!execution_.progress) return true;
  const double now = elapsed();
  if (now - reported_ < 0.1) return true;
  reported_ = now;
  const double share = mesh_.cell_count() / sizing_.expected_cells();
  fraction_ = std::max(fraction_, std::min(0.98, share));
  return execution_.progress({"refine", fraction_, mesh_.vertex_count(), mesh_.cell_count()});
}

GapExplorer& Refinement::gap_size() {
  if (!gap_)
    gap_ = std::make_unique<GapExplorer>(plc_, points_, mesh_, hierarchy_,
                                         [this](Index vertex) { return nodes_of(vertex); });
  return *gap_;
}

MeshStatistics Refinement::statistics() const {
  MeshStatistics s;
  s.vertices_inserted = mesh_.vertex_count();
  s.cells = mesh_.cell_count();
  s.exact_predicates = mesh_.exact_decisions();
  s.warps = warps_;
  s.yields = yields_;
  s.peak_bytes = std::max(peak_bytes_, bytes());
  s.seconds = seconds_ > 0 ? seconds_ : elapsed();
  return s;
}

}  // namespace collarmesh
