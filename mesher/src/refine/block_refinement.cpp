#include "refine/block_refinement.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "common/parallel_for.h"
#include "thread_limit.h"

namespace collarmesh {

namespace {

// In smaller meshes too many vertices lie beside the blocks' borders, or the surface.
constexpr std::size_t least_vertices = 16384;
// A round costs some time for every vertex of the mesh.
constexpr std::size_t least_entries = 2048, vertices_per_entry = 64;
// A round that destroys less than this share of what it took is not worth its while: the next one waits until
// the mesh has grown by a share.
constexpr std::size_t entries_per_insertion = 48, vertices_per_wait = 32;
constexpr std::size_t vertices_per_block = 4000, most_blocks = 256, samples_per_block = 64;
constexpr std::size_t most_insertions_of_a_round = std::size_t{1} << 18;
// Where blocks are cut: shares of a sample.
constexpr double first_share = 0.4, last_share = 0.6;

std::uint64_t mixed(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

// The same for the same cell, whoever destroys it.
std::uint64_t seed_at(const Point& centre, std::uint64_t seed) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    seed = mixed(seed + 0x9e3779b97f4a7c15ULL + std::bit_cast<std::uint64_t>(centre[axis]));
  return seed;
}

}  // namespace

BlockRefinement::BlockRefinement(const Domain& domain, RefinedMesh& mesh, SurfaceNodes& nodes,
                                 const CollarSystem& collars, CollarCells& collar_cells,
                                 RestrictedSurface& surface, const GradedSizes& sizes,
                                 const UnresolvedPoints& points, const CurveChains& curves,
                                 const CellQuality& cells, WorkQueue& queue)
    : domain_(domain),
      mesh_(mesh),
      nodes_(nodes),
      collars_(collars),
      collar_cells_(collar_cells),
      surface_(surface),
      points_(points),
      curves_(curves),
      cells_(cells),
      queue_(queue),
      next_round_(least_vertices),
      workers_([&domain] {
        return Worker{WorkQueue(squared_distance(domain.box.min, domain.box.max)), {}, {}};
      }) {
  // Callers' functions need not bear several threads; what is kept at vertices is not kept by blocks.
  if (sizes.asked().has_field() || sizes.any_at_vertices() || domain_.options.vertex_ratio > 0)
    next_round_ = std::numeric_limits<std::size_t>::max();
}

bool BlockRefinement::due() {
  const std::size_t vertices = mesh_.vertex_count();
  if (vertices < next_round_) return false;
  priority_ = queue_.first_priority();
  if (priority_ != WorkQueue::skinny_cells && priority_ != WorkQueue::large_cells) return false;
  bucket_ = queue_.first_bucket(priority_);
  if (queue_.count(priority_, bucket_) < std::max(least_entries, vertices / vertices_per_entry)) return false;
  return most_insertions() >= least_entries;
}

// The caller may cancel between rounds, and wants no more vertices than these.
std::size_t BlockRefinement::most_insertions() const {
  const std::size_t wanted = domain_.options.max_vertices, vertices = mesh_.vertex_count();
  if (wanted == 0) return most_insertions_of_a_round;
  return wanted > vertices ? std::min(most_insertions_of_a_round, wanted - vertices) : 0;
}

void BlockRefinement::round() {
  const std::size_t before = mesh_.vertex_count();
  const std::vector<WorkQueue::Entry> taken = queue_.take(priority_, bucket_);
  ThreadLimit(domain_.options.threads).run([&] {
    divide_vertices();
    const auto entries = deal(taken);
    auto blocks = mesh_.divide(room_for(entries), owners_);
    if (!collars_.empty()) collar_cells_.fit_mesh();
    surface_.fit_mesh();
    std::vector<std::vector<Waiting>> waiting(blocks.size());
    parallel_for(blocks.size(), [&](std::size_t i) {
      if (!entries[i].empty()) refine(blocks[i], entries[i], workers_.local(), waiting[i]);
    });
    mesh_.join(blocks);
    for (const auto& of_block : waiting)
      for (const auto& [priority, bucket, entry] : of_block) queue_.put(priority, bucket, entry);
  });
  nodes_.quiet_vertices_made();
  ++rounds_;
  const std::size_t after = mesh_.vertex_count(), inserted = after - before;
  inserted_ += inserted;
  if (inserted * entries_per_insertion < taken.size()) next_round_ = after + after / vertices_per_wait;
}

LargestZone BlockRefinement::largest_zone() const {
  LargestZone largest;
  for (const Worker& worker : workers_) largest.add(worker.largest);
  return largest;
}

std::size_t BlockRefinement::block_count() const { return cuts_.size() + 1; }

// A kd-tree of a sample of the vertices. Where it is cut changes from round to round: what lies between
// blocks in one of them lies inside one in the next.
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
  constexpr std::size_t at_once = 4096;
  parallel_for_ranges(vertices, at_once, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const auto v = static_cast<Index>(i);
      owners_[v] = quiet(v) ? block_at(mesh_.point(v)) : Triangulation::no_owner;
    }
  });
}

void BlockRefinement::cut(std::size_t node, std::span<Point> sample) {
  if (node >= cuts_.size()) return;
  Box box;
  for (const Point& p : sample) box.add(p);
  const Vector extent = box.max - box.min;
  const std::size_t axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  const double any = static_cast<double>(mixed(rounds_ * most_blocks + node + 1) >> 11) * 0x1p-53;
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

bool BlockRefinement::quiet(Index vertex) const {
  return mesh_.feature(vertex).dimension == 3 && !nodes_.any_at(vertex) && !points_.any_at(vertex) &&
         !curves_.any_at(vertex) && !collar_cells_.near(vertex);
}

// The entries of each block: those of cells whose vertices all are its own. The others go back.
std::vector<std::vector<WorkQueue::Entry>> BlockRefinement::deal(const std::vector<WorkQueue::Entry>& taken) {
  constexpr std::uint16_t gone = Triangulation::no_owner - 1;
  std::vector<std::uint16_t> owner(taken.size());
  constexpr std::size_t at_once = 1024;
  parallel_for_ranges(taken.size(), at_once, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      constexpr std::size_t ahead = 16;
      if (i + ahead < last) mesh_.prefetch(taken[i + ahead].id);
      owner[i] = cells_.due(taken[i]) ? owner_of(taken[i].id) : gone;
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

std::uint16_t BlockRefinement::owner_of(Index cell) const {
  const auto& v = mesh_.corners(cell);
  const std::uint16_t owner = owners_[v[0]];
  return owners_[v[1]] == owner && owners_[v[2]] == owner && owners_[v[3]] == owner ? owner
                                                                                    : Triangulation::no_owner;
}

// Most insertions destroy several cells that are in the queue.
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

void BlockRefinement::refine(Triangulation::Block& block, const std::vector<WorkQueue::Entry>& entries,
                             Worker& worker, std::vector<Waiting>& waiting) const {
  WorkQueue& queue = worker.queue;
  for (const WorkQueue::Entry& entry : entries) queue.put(priority_, bucket_, entry);
  const auto any_left = [&] {
    return queue.first_bucket(WorkQueue::skinny_cells) < WorkQueue::bucket_count ||
           (priority_ == WorkQueue::large_cells && queue.first_bucket(WorkQueue::large_cells) <= bucket_);
  };
  WorkQueue::Item item;
  while (any_left() && queue.pop(item)) {
    const auto [priority, entry] = item;
    if (cells_.due(entry) && !destroy(entry.id, block, worker))
      waiting.push_back({priority, queue.bucket_of(mesh_.squared_radius(entry.id)), entry});
  }
  for (const auto priority : {WorkQueue::skinny_cells, WorkQueue::large_cells})
    for (unsigned b = queue.first_bucket(priority); b < WorkQueue::bucket_count;
         b = queue.first_bucket(priority))
      for (const WorkQueue::Entry& entry : queue.take(priority, b)) waiting.push_back({priority, b, entry});
}

// As the loop does where no candidate warps or yields. False when the cell has to wait.
bool BlockRefinement::destroy(Index cell, Triangulation::Block& block, Worker& worker) const {
  RandomOffsets random(seed_at(mesh_.circumcentre(cell), domain_.options.seed), collars_);
  const auto candidate = cells_.candidate(cell, random);
  if (!candidate) return true;
  ConflictZone& zone = worker.zone;
  if (candidate->squared_radius < domain_.floor * domain_.floor ||
      !block.find_conflict_zone(candidate->point, cell, zone))
    return false;
  const Index region = surface_.region(cell);
  block.insert(zone);
  worker.largest.add(zone);
  for (const Index created : zone.created) {
    surface_.quiet_cell_made(created, region);
    collar_cells_.quiet_cell_made(created);
    cells_.judge(created, worker.queue);
  }
  return true;
}

}  // namespace collarmesh
