#include "refine/extract.h"

#include <utility>

#include "refine/memory_order.h"

namespace collarmesh {

namespace {

class Extraction {
 public:
  explicit Extraction(const Refined& refined)
      : refined_(refined), plc_(refined.domain.plc), number_(refined.mesh.vertex_count(), none) {}

  TetMesh run() {
    reserve();
    add_cells();
    add_stitched();
    add_balls();
    for (const FaceId face : refined_.surface.marked_faces()) add_face(face);
    refined_.curves.visit([&](Index, const Subsegment& s) { add_edge(s.ends, s.curve); });
    forget_features_off_the_surface();
    mesh_.names = plc_.names;
    order_in_memory(mesh_);
    return std::move(mesh_);
  }

 private:
  // A little more than there will be.
  void reserve() {
    const std::size_t tets = refined_.mesh.cell_count() + refined_.stitched.tets.size();
    mesh_.points.reserve(refined_.mesh.vertex_count());
    mesh_.features.reserve(refined_.mesh.vertex_count());
    mesh_.tets.reserve(tets);
    mesh_.tet_region.reserve(tets);
    mesh_.tet_tag.reserve(tets);
    mesh_.tet_collar.reserve(tets);
    mesh_.tet_crease.reserve(tets);
    mesh_.tet_thin.reserve(tets);
  }

  Index vertex(Index v) {
    if (number_[v] != none) return number_[v];
    number_[v] = static_cast<Index>(mesh_.points.size());
    mesh_.points.push_back(refined_.domain.frame.outside(refined_.mesh.point(v)));
    const Feature& f = refined_.mesh.feature(v);
    mesh_.features.push_back({f.dimension, f.dimension == 3 ? none : f.index});
    return number_[v];
  }

  void add_tet(const std::array<Index, 4>& v, Index region, std::uint8_t collar, Tag crease) {
    mesh_.tets.push_back({vertex(v[0]), vertex(v[1]), vertex(v[2]), vertex(v[3])});
    mesh_.tet_region.push_back(region);
    mesh_.tet_tag.push_back(plc_.regions[region].tag);
    mesh_.tet_collar.push_back(collar);
    mesh_.tet_crease.push_back(crease);
    mesh_.tet_thin.push_back(0);
  }

  void add_face(const std::array<Index, 3>& v, const std::array<Index, 2>& regions, Index patch) {
    mesh_.faces.push_back({vertex(v[0]), vertex(v[1]), vertex(v[2])});
    mesh_.face_regions.push_back(regions);
    mesh_.face_patch.push_back(patch);
    mesh_.face_tag.push_back(plc_.patches[patch].tag);
  }

  // An edge of no tet is none of the mesh.
  void add_edge(const std::array<Index, 2>& ends, Index curve) {
    if (number_[ends[0]] == none || number_[ends[1]] == none) return;
    mesh_.edges.push_back({number_[ends[0]], number_[ends[1]]});
    mesh_.edge_curve.push_back(curve);
    mesh_.edge_tag.push_back(plc_.curves[curve].tag);
  }

  void add_cells() {
    for (Index cell = 0; cell < refined_.mesh.cell_capacity(); ++cell)
      if (refined_.mesh.alive(cell) && refined_.surface.region(cell) != 0 &&
          !refined_.collar_cells.inside(cell))
        add_tet(refined_.mesh.corners(cell), refined_.surface.region(cell), 0, 0);
  }

  void add_stitched() {
    for (const auto& tet : refined_.stitched.tets) add_tet(tet.corners, tet.region, tet.collar, tet.crease);
    for (const auto& face : refined_.stitched.faces) add_face(face.corners, face.regions, face.patch);
    for (const auto& edge : refined_.stitched.edges) add_edge(edge.corners, edge.curve);
  }

  void add_balls() {
    const auto& balls = refined_.collars.balls();
    for (Index ball = 0; ball < balls.size(); ++ball)
      if (const Index v = refined_.creator.vertex_of(ball); v != none && number_[v] != none)
        mesh_.collar_balls.push_back({number_[v], balls[ball].radius, mesh_.points[number_[v]]});
  }

  // Oriented so that the normal points from the first region to the second: as the patch is, except
  // that a boundary's solid comes first.
  void add_face(FaceId face) {
    const RefinedMesh& mesh = refined_.mesh;
    const Index cell = cell_of(face), beyond = cell_of(mesh.opposite(face));
    if (refined_.collar_cells.inside(cell) || refined_.collar_cells.inside(beyond)) return;
    const RestrictedTriangle& t = refined_.surface.triangle(face);
    const Index patch = refined_.surface.patch(face);
    // face_vertices is counterclockwise from outside its cell: the normal leaves that cell.
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

  // The middle of a triangle may lie in the plane of its patch, but beside the patch.
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
  std::vector<Index> number_;  // in the result, by mesh vertex; none if no tet has it
};

}  // namespace

TetMesh extract(const Refined& refined) { return Extraction(refined).run(); }

}  // namespace collarmesh
