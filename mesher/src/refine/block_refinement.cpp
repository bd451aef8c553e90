#include "refine/block_refinement.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <limits>

#include "common/parallel_for.h"
#include "common/split_mix.h"
#include "common/thread_limit.h"

namespace collarmesh {

namespace {

// A round needs a mesh with at least this many vertices. In smaller ones, too many vertices lie near the
// borders of blocks or on curves.
constexpr std::size_t least_vertices = 4096;
// A round costs some time for every vertex of the mesh, so it needs at least `least_entries` queue entries,
// and at least one for every `vertices_per_entry` vertices.
constexpr std::size_t least_entries = 2048, vertices_per_entry = 64;
// A round was not worthwhile if it took more than `entries_per_insertion` entries for each vertex that it
// inserted. The next round then waits until the mesh has grown by one vertex for each `vertices_per_wait`
// vertices.
constexpr std::size_t entries_per_insertion = 48, vertices_per_wait = 32;
constexpr std::size_t vertices_per_block = 4000, most_blocks = 256, samples_per_block = 64;
constexpr std::size_t most_insertions_of_a_round = std::size_t{1} << 18;
// A random share of a sample's points, between these two, lies below each cut.
constexpr double first_share = 0.4, last_share = 0.6;

bool of_cells(WorkQueue::Priority priority) {
  return priority == WorkQueue::skinny_cells || priority == WorkQueue::large_cells;
}

bool of_triangles(WorkQueue::Priority priority) {
  return priority == WorkQueue::unresolved_triangles || priority == WorkQueue::large_triangles;
}

// Returns the seed of the random offsets for the cell or triangle with this centre. It does not depend on the
// thread.
std::uint64_t seed_at(const Point& centre, std::uint64_t seed) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    seed = mixed(seed + split_mix_step + std::bit_cast<std::uint64_t>(centre[axis]));
  return seed;
}

}  // namespace

BlockRefinement::BlockRefinement(const Domain& domain, RefinedMesh& mesh, SurfaceNodes& nodes,
                                 const CollarSystem& collars, CollarCells& collar_cells,
                                 RestrictedSurface& surface, const GradedSizes& sizes,
                                 const UnresolvedPoints& points, const CurveChains& curves,
                                 const TriangleQuality& triangles, const CellQuality& cells, WorkQueue& queue)
    : domain_(domain),
      mesh_(mesh),
      nodes_(nodes),
      collars_(collars),
      collar_cells_(collar_cells),
      surface_(surface),
      points_(points),
      curves_(curves),
      triangles_(triangles),
      cells_(cells),
      queue_(queue),
      next_round_(least_vertices) {
  // There are no rounds in the paper's profile, with data at vertices (sizes or shortest edges), or with a
  // size field, because the caller's function need not be thread-safe.
  if (sizes.asked().has_field() || sizes.any_at_vertices() || domain_.options.vertex_ratio > 0 ||
      domain_.is_papers())
    next_round_ = std::numeric_limits<std::size_t>::max();
}

BlockRefinement::Worker::Worker(const Domain& domain)
    : queue(squared_distance(domain.box.min, domain.box.max)) {}

BlockRefinement::Worker& BlockRefinement::take_worker() {
  const std::scoped_lock lock(of_workers_);
  if (idle_workers_.empty()) return *workers_.emplace_back(std::make_unique<Worker>(domain_));
  Worker& worker = *idle_workers_.back();
  idle_workers_.pop_back();
  return worker;
}

void BlockRefinement::give_back(Worker& worker) {
  const std::scoped_lock lock(of_workers_);
  idle_workers_.push_back(&worker);
}

bool BlockRefinement::is_due() {
  const std::size_t vertices = mesh_.vertex_count();
  if (vertices < next_round_) return false;
  priority_ = queue_.first_priority();
  if (!of_cells(priority_) && !of_triangles(priority_)) return false;
  bucket_ = queue_.first_bucket(priority_);
  if (queue_.count(priority_, bucket_) < std::max(least_entries, vertices / vertices_per_entry)) return false;
  return most_insertions() >= least_entries;
}

// Returns the largest permitted number of insertions of a round: the budget of vertices limits it, and rounds
// must be short because the caller can only cancel between them.
std::size_t BlockRefinement::most_insertions() const {
  const std::size_t wanted = domain_.options.max_vertices, vertices = mesh_.vertex_count();
  if (wanted == 0) return most_insertions_of_a_round;
  return wanted > vertices ? std::min(most_insertions_of_a_round, wanted - vertices) : 0;
}

void BlockRefinement::round() {
  assert(queue_.count(priority_, bucket_) >= least_entries);
  const std::size_t before = mesh_.vertex_count();
  const std::vector<WorkQueue::Entry> taken = queue_.take(priority_, bucket_);
  ThreadLimit(domain_.options.threads).run([&] {
    divide_vertices();
    const auto entries = deal(taken);
    const std::vector<Index> room = room_for(entries);
    auto blocks = mesh_.divide(room, owners_);
    std::vector<RestrictedSurface::Workspace> surfaces(blocks.size());
    if (!collars_.empty()) collar_cells_.fit_mesh();
    nodes_.fit_mesh();
    surface_.divide(records_for(room), surfaces);
    std::vector<std::vector<Waiting>> waiting(blocks.size());
    parallel_for(blocks.size(), [&](std::size_t i) {
      if (entries[i].empty()) return;
      Worker& worker = take_worker();
      refine({blocks[i], surfaces[i]}, entries[i], worker, waiting[i]);
      give_back(worker);
    });
    nodes_.renumber(mesh_.join(blocks));
    surface_.join(surfaces);
    for (const auto& of_block : waiting)
      for (const auto& [priority, bucket, entry] : of_block) queue_.put(priority, bucket, entry);
  });
  ++rounds_;
  const std::size_t after = mesh_.vertex_count(), inserted = after - before;
  inserted_ += inserted;
  if (inserted * entries_per_insertion < taken.size()) next_round_ = after + after / vertices_per_wait;
}

LargestZone BlockRefinement::largest_zone() const {
  LargestZone largest;
  for (const auto& worker : workers_) largest.add(worker->largest);
  return largest;
}

std::size_t BlockRefinement::yields() const {
  std::size_t sum = 0;
  for (const auto& worker : workers_) sum += worker->yields;
  return sum;
}

std::size_t BlockRefinement::bytes() const {
  std::size_t sum = 0;
  for (const auto& worker : workers_) sum += worker->nodes.bytes();
  return sum;
}

std::size_t BlockRefinement::block_count() const { return cuts_.size() + 1; }

// Assigns vertices to blocks by a kd-tree of a sample of them. The cuts change from round to round, so that
// vertices between blocks in one round lie inside a block in the next.
void BlockRefinement::divide_vertices() {
  const std::size_t vertices = mesh_.vertex_count();
  const std::size_t blocks =
      std::bit_floor(std::clamp<std::size_t>(vertices / vertices_per_block, 2, most_blocks));
  const std::size_t step = std::max<std::size_t>(1, vertices / (blocks * samples_per_block));
  std::vector<Point> sample;
  for (std::size_t v = 0; v < vertices; v += step) sample.push_back(mesh_.point(static_cast<Index>(v)));
  cuts_.resize(blocks - 1);
  cut(0, sample);
  owners_.resize(vertices);
  parallel_for_in_chunks(vertices, [&](std::size_t i) {
    const auto v = static_cast<Index>(i);
    owners_[v] = may_belong_to_block(v) ? block_at(mesh_.point(v)) : Triangulation::no_owner;
  });
}

void BlockRefinement::cut(std::size_t node, std::span<Point> sample) {
  if (node >= cuts_.size()) return;
  Box box;
  for (const Point& p : sample) box.add(p);
  const Vector extent = box.max - box.min;
  const std::size_t axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  const double any = unit(mixed(rounds_ * most_blocks + node + 1));
  const double share = first_share + (last_share - first_share) * any;
  const auto place = static_cast<std::ptrdiff_t>(share * static_cast<double>(sample.size()));
  std::nth_element(sample.begin(), sample.begin() + place, sample.end(),
                   [axis](const Point& p, const Point& q) { return p[axis] < q[axis]; });
  cuts_[node] = {axis, sample[static_cast<std::size_t>(place)][axis]};
  cut(2 * node + 1, sample.first(static_cast<std::size_t>(place)));
  cut(2 * node + 2, sample.subspan(static_cast<std::size_t>(place)));
}

std::uint16_t BlockRefinement::block_at(const Point& p) const {
  std::size_t node = 0;
  while (node < cuts_.size()) node = 2 * node + (p[cuts_[node].axis] < cuts_[node].place ? 1 : 2);
  return static_cast<std::uint16_t>(node - cuts_.size());
}

bool BlockRefinement::may_belong_to_block(Index vertex) const {
  return mesh_.feature(vertex).dimension >= 2 && !points_.any_at(vertex) && !curves_.any_at(vertex) &&
         !collar_cells_.near(vertex);
}

// Deals the entries to blocks: an entry goes to a block if all vertices of its cell, or of the two cells at
// its triangle, belong to the block. Puts the others back into the queue if they are still due.
std::vector<std::vector<WorkQueue::Entry>> BlockRefinement::deal(const std::vector<WorkQueue::Entry>& taken) {
  constexpr std::uint16_t gone = Triangulation::no_owner - 1;
  std::vector<std::uint16_t> owner(taken.size());
  // Smaller chunks than usual, because there may be only a few thousand entries, which all threads should
  // share.
  constexpr std::size_t at_once = 1024;
  parallel_for_ranges(taken.size(), at_once, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      constexpr std::size_t ahead = 16;
      if (i + ahead < last)
        mesh_.prefetch(of_cells(priority_) ? taken[i + ahead].id : cell_of(taken[i + ahead].id));
      owner[i] = is_due({priority_, taken[i]}) ? owner_of(taken[i]) : gone;
    }
  });
  std::vector<std::vector<WorkQueue::Entry>> entries(block_count());
  for (std::size_t i = 0; i < taken.size(); ++i)
    if (owner[i] == Triangulation::no_owner)
      queue_.put(priority_, bucket_, taken[i]);
    else if (owner[i] != gone)
      entries[owner[i]].push_back(taken[i]);
  return entries;
}

std::uint16_t BlockRefinement::owner_of(const std::array<Index, 4>& vertices) const {
  const std::uint16_t owner = owners_[vertices[0]];
  return std::all_of(vertices.begin() + 1, vertices.end(), [&](Index v) { return owners_[v] == owner; })
             ? owner
             : Triangulation::no_owner;
}

std::uint16_t BlockRefinement::owner_of(const WorkQueue::Entry& entry) const {
  if (of_cells(priority_)) return owner_of(mesh_.corners(entry.id));
  const std::uint16_t owner = owner_of(mesh_.corners(cell_of(entry.id)));
  const FaceId other = mesh_.opposite(entry.id);
  return other != no_face && owner_of(mesh_.corners(cell_of(other))) == owner ? owner
                                                                              : Triangulation::no_owner;
}

// Returns for each block the number of insertions that it gets memory for: a share of its entries, because
// most insertions destroy several queued cells.
std::vector<Index> BlockRefinement::room_for(
    const std::vector<std::vector<WorkQueue::Entry>>& entries) const {
  constexpr std::size_t entries_per_room = 5, least_room = 64;
  const std::size_t most = most_insertions() / entries.size();
  std::vector<Index> room;
  for (const auto& of_block : entries) {
    const std::size_t wanted = of_block.empty() ? 0 : of_block.size() / entries_per_room + least_room;
    room.push_back(static_cast<Index>(std::min(wanted, most)));
  }
  return room;
}

// Returns the number of records of restricted triangles that each block may need. A vertex on the surface
// makes two triangles more than it destroys; other vertices make hardly any.
std::vector<std::size_t> BlockRefinement::records_for(std::span<const Index> room) const {
  constexpr std::size_t of_a_zone = 512, insertions_per_record = 4;
  std::vector<std::size_t> records;
  for (const Index insertions : room)
    records.push_back(insertions == 0           ? 0
                      : of_triangles(priority_) ? of_a_zone + 2 * insertions
                                                : of_a_zone + insertions / insertions_per_record);
  return records;
}

void BlockRefinement::refine(Block block, const std::vector<WorkQueue::Entry>& entries, Worker& worker,
                             std::vector<Waiting>& waiting) {
  WorkQueue& queue = worker.queue;
  for (const WorkQueue::Entry& entry : entries) queue.put(priority_, bucket_, entry);
  WorkQueue::Item item;
  while (any_left(queue) && queue.pop(item)) {
    if (!is_due(item)) continue;
    const double radius = squared_radius(item);
    const Fate fate = destroy(item, block, worker);
    if (fate == Fate::waits)
      waiting.push_back({item.priority, queue.bucket_of(radius), item.entry});
    else if (fate == Fate::destroyed && is_due(item))  // another vertex was inserted, and the item remains
      queue.push(item.priority, radius, item.entry);
  }
  for (WorkQueue::Priority priority = queue.first_priority(); priority < WorkQueue::priority_count;
       priority = queue.first_priority()) {
    const unsigned bucket = queue.first_bucket(priority);
    for (const WorkQueue::Entry& entry : queue.take(priority, bucket))
      waiting.push_back({priority, bucket, entry});
  }
}

// Returns whether the round should go on: whether the block's queue has skinny cells, entries of priorities
// before the round's, or entries of the round's priority whose balls are in the round's bucket or larger.
bool BlockRefinement::any_left(WorkQueue& queue) const {
  const WorkQueue::Priority priority = queue.first_priority();
  if (priority == WorkQueue::skinny_cells) return true;
  return priority < priority_ || (priority == priority_ && queue.first_bucket(priority) <= bucket_);
}

bool BlockRefinement::is_due(const WorkQueue::Item& item) const {
  return of_cells(item.priority) ? cells_.is_due(item) : triangles_.is_due(item.entry);
}

double BlockRefinement::squared_radius(const WorkQueue::Item& item) const {
  return of_cells(item.priority) ? mesh_.squared_radius(item.entry.id)
                                 : surface_.triangle(item.entry.id).squared_radius;
}

std::optional<Candidate> BlockRefinement::candidate(const WorkQueue::Item& item,
                                                    RandomOffsets& random) const {
  return of_cells(item.priority) ? cells_.candidate(item.entry.id, random)
                                 : triangles_.candidate_beside(item.entry.id, random);
}

// Destroys the ball of an item as the loop does. Here no candidate warps or encroaches a subsegment, because
// no unresolved point and no centre of a protective ball lies in the Voronoi cells of a block's vertices.
BlockRefinement::Fate BlockRefinement::destroy(const WorkQueue::Item& item, Block block, Worker& worker) {
  const Point& centre =
      of_cells(item.priority) ? mesh_.circumcentre(item.entry.id) : surface_.triangle(item.entry.id).x;
  RandomOffsets random(seed_at(centre, domain_.options.seed), collars_);
  std::optional<Candidate> next = candidate(item, random);
  if (!next) return of_cells(item.priority) ? Fate::stays : Fate::waits;
  for (std::size_t yields = 0;; ++yields) {
    if (next->squared_radius < domain_.floor * domain_.floor ||
        !block.mesh.find_conflict_zone(next->point, next->start, worker.zone))
      return Fate::waits;
    const FaceId face = triangles_.encroached(worker.zone, *next);
    if (face == no_face) {
      if (!insert(*next, block, worker)) return Fate::waits;
      worker.yields += yields;
      return Fate::destroyed;
    }
    next = triangles_.candidate_beside(face, random);
    if (!next) return Fate::waits;
  }
}

// Inserts a candidate. Returns false if the block has too few records for it. If no vertex of the zone has
// nodes (SurfaceNodes), the new cells get the region of the old ones.
bool BlockRefinement::insert(const Candidate& candidate, Block block, Worker& worker) {
  ConflictZone& zone = worker.zone;
  const bool quiet = std::ranges::none_of(zone.vertices, [&](Index v) { return nodes_.any_at(v); });
  const Index region = surface_.region(zone.cells[0]);
  if (!quiet) {
    if (!surface_.has_room(zone, block.surface)) return false;
    surface_.cells_vanish(zone, block.surface);
  }
  const Index vertex = mesh_.insert(block.mesh, zone, candidate.feature);
  worker.largest.add(zone);
  nodes_.cells_made(zone, vertex, block.mesh, worker.nodes);
  for (const Index created : zone.created) collar_cells_.quiet_cell_made(created);
  if (quiet) {
    for (const Index created : zone.created) surface_.quiet_cell_made(created, region);
  } else {
    surface_.cells_made(zone, vertex, block.surface);
    triangles_.cells_made(zone, worker.queue);
  }
  for (const Index created : zone.created) cells_.judge(created, worker.queue);
  return true;
}

}  // namespace collarmesh
