#include "refine/surface_nodes.h"

#include <algorithm>
#include <cmath>

#include "common/segments.h"

namespace collarmesh {

namespace {

// The nodes of a vertex are filtered again after the first of these numbers of insertions in its star. If the
// vertex lies on a feature, the second, larger number applies, because insertions there go on until the end.
// Filtering visits all cells of the star, so in a large star it waits for one insertion for each
// `cells_per_insertion` cells: otherwise a hub with n cells would cost n^2.
constexpr std::size_t insertions_between_refreshes = 16;
constexpr std::size_t insertions_between_surface_refreshes = 48;
constexpr std::size_t cells_per_insertion = 4;
constexpr std::size_t nodes_per_chunk = std::size_t{1} << 14;

// Returns the corners of the elements of a complex: first its triangles, then, as degenerate triangles,
// features on no patch: the segments of curves and single vertices.
std::vector<std::array<Index, 3>> elements_of(const Plc& plc) {
  std::vector<std::array<Index, 3>> elements;
  elements.reserve(plc.triangles.size());
  for (const Plc::Triangle& t : plc.triangles) elements.push_back(t.points);
  for (const Plc::Curve& curve : plc.curves)
    if (curve.patches.empty())
      visit_segments(curve, [&](Index a, Index b) { elements.push_back({a, b, b}); });
  for (const Plc::Vertex& vertex : plc.vertices)
    if (vertex.patches.empty() && vertex.curves.empty())
      elements.push_back({vertex.point, vertex.point, vertex.point});
  return elements;
}

}  // namespace

Index* SurfaceNodes::Workspace::reserve(std::size_t count) {
  if (left_ < count) {
    left_ = std::max(count, nodes_per_chunk);
    chunks_.push_back(std::make_unique_for_overwrite<Index[]>(left_));
    end_ = chunks_.back().get() + left_;
  }
  Index* const reserved = end_ - left_;
  left_ -= count;
  reserved_ += count;
  return reserved;
}

SurfaceNodes::SurfaceNodes(const Domain& domain, const RefinedMesh& mesh)
    : domain_(domain), mesh_(mesh), hierarchy_(domain.points, elements_of(domain.plc)) {
  lists_.resize(mesh_.vertex_count());
  for (Index v = 0; v < mesh_.vertex_count(); ++v) expect_insertions(v, 0);
  if (hierarchy_.empty()) return;
  std::vector<Index> patch_of(hierarchy_.triangle_count(), static_cast<Index>(domain_.plc.patches.size()));
  for (Index t = 0; t < domain_.plc.triangles.size(); ++t) patch_of[t] = domain_.plc.triangles[t].patch;
  patch_below_ = hierarchy_.common_labels(patch_of);
  for (List& list : lists_) {
    list.nodes = workspace_.reserve(1);
    list.nodes[0] = hierarchy_.root();
    list.count = 1;
  }
}

std::span<const Index> SurfaceNodes::fewest(FaceId face) const {
  const auto v = mesh_.face_vertices(face);
  std::span<const Index> best = at(v[0]);
  for (const Index vertex : {v[1], v[2]})
    if (lists_[vertex].count < best.size()) best = at(vertex);
  return best;
}

void SurfaceNodes::crossings_of_dual_edge(FaceId face,
                                          std::vector<TriangleHierarchy::Crossing>& found) const {
  hierarchy_.crossings(mesh_.circumcentre(cell_of(face)), mesh_.circumcentre(cell_of(mesh_.opposite(face))),
                       fewest(face), found);
}

// Finds the nearest triangle of a patch. Other patches may be nearer everywhere, such as a sheet that faces
// this one, so nodes that contain only one other patch are skipped.
Index SurfaceNodes::nearest_triangle(const Point& p, Index patch, double& within_squared) const {
  const Plc& plc = domain_.plc;
  Index nearest = none;
  within_squared = hierarchy_.squared_distance_to(
      p, within_squared, &nearest,
      [&](Index node) { return patch_below_[node] != none && patch_below_[node] != patch; },
      [&](Index triangle) {
        return triangle < plc.triangles.size() && plc.triangles[triangle].patch == patch;
      });
  return nearest;
}

void SurfaceNodes::cells_made(const ConflictZone& zone, Index vertex) {
  lists_.push_back({});
  cells_made(zone, vertex, workspace_,
             [&](Index v, std::vector<Index>& cells) { mesh_.incident_cells(v, cells); });
}

void SurfaceNodes::fit_mesh() { lists_.extend(mesh_.vertex_count()); }

void SurfaceNodes::cells_made(const ConflictZone& zone, Index vertex, const Triangulation::Block& block,
                              Workspace& workspace) {
  lists_[vertex] = {};
  cells_made(zone, vertex, workspace,
             [&](Index v, std::vector<Index>& cells) { block.incident_cells(v, cells); });
}

// Finds the nodes of a new vertex, and filters those of its neighbours where that is due. The Voronoi cell of
// the vertex is cut out of its neighbours' cells, so their nodes cover it.
template <class IncidentCells>
void SurfaceNodes::cells_made(const ConflictZone& zone, Index vertex, Workspace& w,
                              const IncidentCells& incident_cells) {
  expect_insertions(vertex, zone.created.size());
  w.seeds_.clear();
  for (const Index neighbour : zone.vertices) {
    const auto nodes = at(neighbour);
    if (nodes.empty()) continue;
    w.seeds_.insert(w.seeds_.end(), nodes.begin(), nodes.end());
    if (lists_[neighbour].insertions_left > 0) --lists_[neighbour].insertions_left;
  }
  if (w.seeds_.empty()) return;
  find(zone.created, w);
  store(lists_[vertex], w);
  for (const Index neighbour : zone.vertices) {
    if (lists_[neighbour].insertions_left > 0) continue;
    incident_cells(neighbour, w.cells_);
    const auto nodes = at(neighbour);
    w.seeds_.assign(nodes.begin(), nodes.end());
    find(w.cells_, w);
    store(lists_[neighbour], w);
    expect_insertions(neighbour, w.cells_.size());
  }
}

void SurfaceNodes::expect_insertions(Index vertex, std::size_t star) {
  const std::size_t least = mesh_.feature(vertex).dimension == 3 ? insertions_between_refreshes
                                                                 : insertions_between_surface_refreshes;
  lists_[vertex].insertions_left = static_cast<std::uint16_t>(
      std::min<std::size_t>(std::max(least, star / cells_per_insertion), UINT16_MAX));
}

// Finds nodes that cover the elements in the Voronoi cell of the vertex at which these cells meet: the nodes
// that meet the box around the cells' circumcentres, widened because of rounding. The result is in found_.
// Precondition: seeds_ cover these elements.
void SurfaceNodes::find(const std::vector<Index>& cells, Workspace& w) const {
  Box box;
  double largest = 0;
  for (const Index cell : cells) {
    box.add(mesh_.circumcentre(cell));
    largest = std::max(largest, mesh_.squared_radius(cell));
  }
  const double radius = std::sqrt(largest), slack = 1e-9 * radius;
  box.min = box.min - Vector{slack, slack, slack};
  box.max = box.max + Vector{slack, slack, slack};
  hierarchy_.nodes_meeting(box, radius, w.seeds_, w.marks_, w.found_);
}

void SurfaceNodes::store(List& list, Workspace& w) {
  if (w.found_.size() > list.count) list.nodes = w.reserve(w.found_.size());
  std::copy(w.found_.begin(), w.found_.end(), list.nodes);
  list.count = static_cast<Index>(w.found_.size());
}

}  // namespace collarmesh
