#include "refine/extract.h"

#include <algorithm>
#include <atomic>
#include <utility>

#include "common/found_in_ranges.h"
#include "common/groups.h"
#include "common/large_pages.h"
#include "common/parallel_for.h"
#include "common/resize_by_all_threads.h"
#include "common/spatial_order.h"
#include "common/thread_limit.h"

namespace collarmesh {

namespace {

/// Returns the order of tets or faces by the smallest of their point numbers (`least_points`); those with
/// equal numbers keep their order.
std::vector<Index> order_by_least_point(const std::vector<Index>& least_points, std::size_t points) {
  return order_by_group(points, least_points.size(), [&](std::size_t i) { return least_points[i]; });
}

template <class T>
void permute(std::vector<T>& values, const std::vector<Index>& order) {
  std::vector<T> permuted(values.size());
  parallel_for_in_chunks(values.size(), [&](std::size_t i) { permuted[i] = values[order[i]]; });
  values = std::move(permuted);
}

class Extraction {
 public:
  explicit Extraction(const Refined& refined)
      : refined_(refined), plc_(refined.domain.plc), number_(refined.mesh.vertex_count(), none) {}

  Extracted run() {
    find_tets();
    add_points();
    add_tets();
    add_balls();
    for (const auto& face : refined_.stitched.faces) add_face(face.corners, face.regions, face.patch);
    for (const FaceId face : refined_.surface.marked_faces()) add_face(face);
    order_faces();
    for (const auto& edge : refined_.stitched.edges) add_edge(edge.corners, edge.curve);
    refined_.curves.visit([&](Index, const Subsegment& s) { add_edge(s.ends, s.curve); });
    forget_features_off_the_surface();
    mesh_.names = plc_.names;
    return {std::move(mesh_), std::move(neighbours_)};
  }

 private:
  // Finds the cells that become tets, and the vertices of all tets. Stitched tets come after the cells.
  void find_tets() {
    std::vector<std::uint8_t> used(refined_.mesh.vertex_count(), 0);
    const auto use = [&](const std::array<Index, 4>& corners) {
      for (const Index v : corners) std::atomic_ref(used[v]).store(1, std::memory_order_relaxed);
    };
    const std::size_t capacity = refined_.mesh.cell_capacity();
    cells_ = found_in_ranges<Index>(capacity, [&](std::size_t i, std::vector<Index>& found) {
      const auto cell = static_cast<Index>(i);
      if (!refined_.mesh.alive(cell) || refined_.surface.region(cell) == 0 ||
          refined_.collar_cells.inside(cell))
        return;
      found.push_back(cell);
      use(refined_.mesh.corners(cell));
    });
    for (const auto& tet : refined_.stitched.tets) use(tet.corners);
    vertices_ = found_in_ranges<Index>(used.size(), [&](std::size_t v, std::vector<Index>& found) {
      if (used[v] != 0) found.push_back(static_cast<Index>(v));
    });
  }

  const std::array<Index, 4>& corners(Index tet) const {
    return tet < cells_.size() ? refined_.mesh.corners(cells_[tet])
                               : refined_.stitched.tets[tet - cells_.size()].corners;
  }

  // Adds points in the order of a space-filling curve, so that near points are near in memory.
  void add_points() {
    std::vector<Point> places;
    resize_by_all_threads(vertices_.size(), places);
    parallel_for_in_chunks(places.size(), [&](std::size_t i) {
      places[i] = refined_.domain.frame.outside(refined_.mesh.point(vertices_[i]));
    });
    const std::vector<SpatialKey> order = spatial_order_by_all_threads(places);
    resize_by_all_threads(places.size(), mesh_.points, mesh_.features);
    parallel_for_in_chunks(places.size(), [&](std::size_t i) {
      const Index v = vertices_[order[i].item];
      number_[v] = static_cast<Index>(i);
      mesh_.points[i] = places[order[i].item];
      const Feature& f = refined_.mesh.feature(v);
      mesh_.features[i] = {f.dimension, f.dimension == 3 ? none : f.index};
    });
  }

  // Adds tets in the order of their smallest point numbers.
  void add_tets() {
    const std::size_t count = cells_.size() + refined_.stitched.tets.size();
    std::vector<Index> least;
    resize_by_all_threads(count, least);
    parallel_for_in_chunks(count, [&](std::size_t t) {
      const auto& v = corners(static_cast<Index>(t));
      least[t] = std::min({number_[v[0]], number_[v[1]], number_[v[2]], number_[v[3]]});
    });
    const std::vector<Index> order = order_by_least_point(least, mesh_.points.size());
    const LargeBlock<Index> tet_of_cell(refined_.mesh.cell_capacity());
    parallel_for_in_chunks(refined_.mesh.cell_capacity(),
                           [&](std::size_t cell) { tet_of_cell[cell] = none; });
    resize_by_all_threads(count, mesh_.tets, mesh_.tet_region, mesh_.tet_tag, mesh_.tet_collar,
                          mesh_.tet_crease, mesh_.tet_thin, neighbours_);
    parallel_for_in_chunks(count, [&](std::size_t t) {
      if (order[t] < cells_.size()) tet_of_cell[cells_[order[t]]] = static_cast<Index>(t);
    });
    parallel_for_in_chunks(count, [&](std::size_t t) {
      constexpr std::size_t ahead = 16;
      if (t + ahead < count && order[t + ahead] < cells_.size())
        refined_.mesh.prefetch(cells_[order[t + ahead]]);
      const auto& v = corners(order[t]);
      mesh_.tets[t] = {number_[v[0]], number_[v[1]], number_[v[2]], number_[v[3]]};
      if (order[t] < cells_.size())
        set_cell(t, cells_[order[t]], tet_of_cell);
      else
        set_stitched(t, refined_.stitched.tets[order[t] - cells_.size()]);
    });
  }

  void set_cell(std::size_t tet, Index cell, const LargeBlock<Index>& tet_of_cell) {
    set_labels(tet, refined_.surface.region(cell), 0, 0);
    for (unsigned corner = 0; corner < 4; ++corner) {
      const FaceId beyond = refined_.mesh.opposite(face_id(cell, corner));
      neighbours_[tet][corner] = beyond == no_face ? none : tet_of_cell[cell_of(beyond)];
    }
  }

  void set_stitched(std::size_t tet, const Stitched::Tet& stitched) {
    set_labels(tet, stitched.region, stitched.collar, stitched.crease);
    neighbours_[tet] = {none, none, none, none};
  }

  void set_labels(std::size_t tet, Index region, std::uint8_t collar, Tag crease) {
    mesh_.tet_region[tet] = region;
    mesh_.tet_tag[tet] = plc_.regions[region].tag;
    mesh_.tet_collar[tet] = collar;
    mesh_.tet_crease[tet] = crease;
  }

  void add_face(const std::array<Index, 3>& v, const std::array<Index, 2>& regions, Index patch) {
    mesh_.faces.push_back({number_[v[0]], number_[v[1]], number_[v[2]]});
    mesh_.face_regions.push_back(regions);
    mesh_.face_patch.push_back(patch);
    mesh_.face_tag.push_back(plc_.patches[patch].tag);
  }

  // Adds an edge if both of its ends belong to tets.
  void add_edge(const std::array<Index, 2>& ends, Index curve) {
    if (number_[ends[0]] == none || number_[ends[1]] == none) return;
    mesh_.edges.push_back({number_[ends[0]], number_[ends[1]]});
    mesh_.edge_curve.push_back(curve);
    mesh_.edge_tag.push_back(plc_.curves[curve].tag);
  }

  void add_balls() {
    const auto& balls = refined_.collars.balls();
    for (Index ball = 0; ball < balls.size(); ++ball)
      if (const Index v = refined_.creator.vertex_of(ball); v != none && number_[v] != none)
        mesh_.collar_balls.push_back({number_[v], balls[ball].radius, mesh_.points[number_[v]]});
  }

  // Adds a face, oriented so that the normal points from the first region to the second. The regions are in
  // the patch's order, except that the inner region comes first at the boundary of the domain. A face
  // with the same region on both sides has the patch's normal.
  void add_face(FaceId face) {
    const RefinedMesh& mesh = refined_.mesh;
    const Index cell = cell_of(face), beyond = cell_of(mesh.opposite(face));
    if (refined_.collar_cells.inside(cell) || refined_.collar_cells.inside(beyond)) return;
    const RestrictedTriangle& t = refined_.surface.triangle(face);
    const Index patch = refined_.surface.patch(face);
    // face_vertices is counterclockwise as seen from outside its cell, so the normal points out of that cell.
    auto v = mesh.face_vertices(face);
    std::array<Index, 2> regions{refined_.surface.region(cell), refined_.surface.region(beyond)};
    if (regions[0] == 0 && regions[1] == 0) return;
    bool reversed = regions[0] == 0;
    if (regions[0] == regions[1]) {
      const auto corners = refined_.nodes.hierarchy().corners(t.triangle);
      const Vector n = cross(corners[1] - corners[0], corners[2] - corners[0]);
      const Vector m = cross(mesh.point(v[1]) - mesh.point(v[0]), mesh.point(v[2]) - mesh.point(v[0]));
      reversed = dot(n, m) < 0;
    } else if (regions[0] != 0 && regions[1] != 0) {
      reversed = regions[0] != plc_.patches[patch].regions[0];
    }
    if (reversed) {
      std::swap(v[1], v[2]);
      std::swap(regions[0], regions[1]);
    }
    add_face(v, regions, patch);
  }

  // Orders faces by their smallest point numbers, like tets.
  void order_faces() {
    std::vector<Index> least;
    least.reserve(mesh_.faces.size());
    for (const auto& face : mesh_.faces) least.push_back(std::min({face[0], face[1], face[2]}));
    const std::vector<Index> order = order_by_least_point(least, mesh_.points.size());
    permute(mesh_.faces, order);
    permute(mesh_.face_regions, order);
    permute(mesh_.face_patch, order);
    permute(mesh_.face_tag, order);
  }

  // Removes the feature of vertices that belong to no face although their feature is a patch. They lie in the
  // plane of the patch, but possibly beyond its border.
  void forget_features_off_the_surface() {
    std::vector<bool> on_surface(mesh_.points.size(), false);
    for (const auto& face : mesh_.faces)
      for (const Index v : face) on_surface[v] = true;
    for (Index v = 0; v < mesh_.features.size(); ++v)
      if (mesh_.features[v].dimension == 2 && !on_surface[v]) mesh_.features[v] = {3, none};
  }

  const Refined& refined_;
  const Plc& plc_;
  TetMesh mesh_;
  KnownNeighbours neighbours_;
  std::vector<Index> number_;    // index in the result, by mesh vertex; none if no tet has it
  std::vector<Index> vertices_;  // vertices of tets
  std::vector<Index> cells_;     // cells that become tets
};

}  // namespace

Extracted extract(const Refined& refined) {
  Extracted extracted;
  ThreadLimit(refined.domain.options.threads).run([&] { extracted = Extraction(refined).run(); });
  return extracted;
}

}  // namespace collarmesh
