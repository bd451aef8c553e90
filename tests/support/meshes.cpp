#include "support/meshes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "collarmesh/plc_builder.h"
#include "support/shapes.h"

namespace collarmesh::testing {

namespace {

constexpr double near = 1e-9;

double distance_to_segment(const Point& p, const Point& a, const Point& b) {
  const double t = std::clamp(dot(p - a, b - a) / squared_distance(a, b), 0.0, 1.0);
  return distance(p, a + t * (b - a));
}

bool is_on_triangle(const Point& p, const Point& a, const Point& b, const Point& c) {
  const Vector n = cross(b - a, c - a);
  const double slack = near * squared_norm(n);
  return std::fabs(dot(p - a, n)) <= near * norm(n) && dot(cross(b - a, p - a), n) >= -slack &&
         dot(cross(c - b, p - b), n) >= -slack && dot(cross(a - c, p - c), n) >= -slack;
}

using Corners = std::array<Index, 3>;

// Adds the faces, edges and features of a mesh whose points lie exactly on the features of a complex, by
// brute force. Precondition: triangles and edges whose corners all lie on a patch or curve lie on it, too.
class FeatureMaker {
 public:
  FeatureMaker(TetMesh& mesh, const Plc& plc) : mesh_(mesh), plc_(plc) {}

  void run() {
    for (const Point& p : mesh_.points) {
      curves_.push_back(curves_at(p));
      patches_.push_back(patches_at(p));
    }
    add_faces();
    add_edges();
    for (Index i = 0; i < mesh_.points.size(); ++i) mesh_.features.push_back(feature_of(i));
    for (const Index region : mesh_.tet_region) mesh_.tet_tag.push_back(plc_.regions[region].tag);
    mesh_.tet_collar.assign(mesh_.tets.size(), 0);
    mesh_.tet_crease.assign(mesh_.tets.size(), 0);
  }

 private:
  std::vector<Index> curves_at(const Point& p) const {
    std::vector<Index> found;
    for (Index c = 0; c < plc_.curves.size(); ++c) {
      const auto& points = plc_.curves[c].points;
      bool on = false;
      for (std::size_t i = plc_.curves[c].closed ? 0 : 1; i < points.size() && !on; ++i)
        on = distance_to_segment(p, plc_.points[points[i == 0 ? points.size() - 1 : i - 1]],
                                 plc_.points[points[i]]) < near;
      if (on) found.push_back(c);
    }
    return found;
  }

  std::vector<Index> patches_at(const Point& p) const {
    std::set<Index> found;
    for (const Plc::Triangle& t : plc_.triangles)
      if (is_on_triangle(p, plc_.points[t.points[0]], plc_.points[t.points[1]], plc_.points[t.points[2]]))
        found.insert(t.patch);
    return {found.begin(), found.end()};
  }

  TetMesh::VertexFeature feature_of(Index i) const {
    for (Index v = 0; v < plc_.vertices.size(); ++v)
      if (distance(mesh_.points[i], plc_.points[plc_.vertices[v].point]) < near) return {0, v};
    if (!curves_[i].empty()) return {1, curves_[i][0]};
    if (!patches_[i].empty()) return {2, patches_[i][0]};
    return {};
  }

  void add_faces() {
    struct Side {
      Corners corners;  // counterclockwise as seen from outside the tet
      Index region;
    };
    std::map<Corners, std::vector<Side>> sides;
    for (Index t = 0; t < mesh_.tets.size(); ++t) {
      const auto& [a, b, c, d] = mesh_.tets[t];
      for (const Corners& side : {Corners{b, c, d}, Corners{a, d, c}, Corners{a, b, d}, Corners{a, c, b}}) {
        if (patch_of(side) == none) continue;
        Corners key = side;
        std::sort(key.begin(), key.end());
        sides[key].push_back({side, mesh_.tet_region[t]});
      }
    }
    for (const auto& [key, pair] : sides) {
      const Index other = pair.size() == 2 ? pair[1].region : 0;
      add_face(pair[0].corners, {pair[0].region, other});
    }
  }

  void add_face(Corners corners, std::array<Index, 2> regions) {
    const Index patch = patch_of(corners);
    const Plc::Patch& p = plc_.patches[patch];
    const Vector normal = cross(mesh_.points[corners[1]] - mesh_.points[corners[0]],
                                mesh_.points[corners[2]] - mesh_.points[corners[0]]);
    if (regions[0] == regions[1] ? dot(normal, p.normal) < 0 : regions != p.regions) {
      std::swap(corners[1], corners[2]);
      std::swap(regions[0], regions[1]);
    }
    mesh_.faces.push_back(corners);
    mesh_.face_regions.push_back(regions);
    mesh_.face_patch.push_back(patch);
    mesh_.face_tag.push_back(p.tag);
  }

  Index patch_of(const Corners& face) const {
    for (const Index p : patches_[face[0]])
      if (std::count(patches_[face[1]].begin(), patches_[face[1]].end(), p) != 0 &&
          std::count(patches_[face[2]].begin(), patches_[face[2]].end(), p) != 0)
        return p;
    return none;
  }

  void add_edges() {
    std::set<std::array<Index, 2>> edges;
    for (const Corners& f : mesh_.faces)
      for (unsigned i = 0; i < 3; ++i)
        edges.insert({std::min(f[i], f[(i + 1) % 3]), std::max(f[i], f[(i + 1) % 3])});
    for (const auto& edge : edges)
      for (const Index c : curves_[edge[0]])
        if (std::count(curves_[edge[1]].begin(), curves_[edge[1]].end(), c) != 0) {
          mesh_.edges.push_back(edge);
          mesh_.edge_curve.push_back(c);
          mesh_.edge_tag.push_back(plc_.curves[c].tag);
        }
  }

  TetMesh& mesh_;
  const Plc& plc_;
  std::vector<std::vector<Index>> curves_, patches_;  // by point
};

// Returns a grid of n * n * layers cubes with edges 1 / n, each cut into the six tets around its diagonal.
TetMesh kuhn_mesh(Index n, Index layers) {
  TetMesh mesh;
  for (Index z = 0; z <= layers; ++z)
    for (Index y = 0; y <= n; ++y)
      for (Index x = 0; x <= n; ++x) mesh.points.push_back({double(x) / n, double(y) / n, double(z) / n});
  const std::array<Index, 3> step{1, n + 1, (n + 1) * (n + 1)};
  constexpr std::array<std::array<unsigned, 3>, 6> orders{
      {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {1, 0, 2}, {0, 2, 1}, {2, 1, 0}}};
  for (Index z = 0; z < layers; ++z)
    for (Index y = 0; y < n; ++y)
      for (Index x = 0; x < n; ++x)
        for (std::size_t i = 0; i < orders.size(); ++i) {
          const Index a = x * step[0] + y * step[1] + z * step[2];
          Index b = a + step[orders[i][0]], c = b + step[orders[i][1]];
          if (i >= 3) std::swap(b, c);  // odd permutations have the opposite orientation
          mesh.tets.push_back({a, b, c, a + step[0] + step[1] + step[2]});
          mesh.tet_region.push_back(1);
        }
  return mesh;
}

// Makes the tets between a point and the triangles of a closed surface, oriented outwards.
TetMesh star_mesh(const PolygonSoup& surface, const Point& apex) {
  TetMesh mesh;
  mesh.points = surface.points;
  mesh.points.push_back(apex);
  for (Index f = 0; f < surface.facet_count(); ++f) {
    const auto corners = surface.polygon(f);
    mesh.tets.push_back({corners[0], corners[2], corners[1], static_cast<Index>(mesh.points.size() - 1)});
    mesh.tet_region.push_back(1);
  }
  return mesh;
}

MeshedComplex with_features(TetMesh mesh, const PolygonSoup& soup) {
  MeshedComplex result{build_plc({&soup, 1}), std::move(mesh)};
  FeatureMaker(result.mesh, result.plc).run();
  return result;
}

}  // namespace

MeshedComplex meshed_box(Index n) { return with_features(kuhn_mesh(n, n), box()); }

MeshedComplex meshed_two_boxes(Index n) {
  const PolygonSoup soup = two_boxes();
  const Plc plc = build_plc({&soup, 1});
  TetMesh mesh = kuhn_mesh(n, 2 * n);
  const Index below = plc.regions[1].tag == 10 ? 1 : 2;
  for (Index t = 0; t < mesh.tets.size(); ++t)
    mesh.tet_region[t] = t < mesh.tets.size() / 2 ? below : 3 - below;
  return with_features(std::move(mesh), soup);
}

MeshedComplex meshed_box_with_facet(Index n) {
  return with_features(kuhn_mesh(n, n), box_with_dangling_facet(0.5));
}

MeshedComplex meshed_ball(unsigned frequency, unsigned finer) {
  return with_features(star_mesh(icosphere(1, frequency), {0, 0, 0}), icosphere(1, frequency * finer));
}

MeshedComplex meshed_cylinder(unsigned segments, unsigned finer) {
  return with_features(star_mesh(cylinder(1, 1, segments), {0, 0, 0.5}), cylinder(1, 1, segments * finer));
}

MeshedComplex meshed_cylinder_with_ears(unsigned segments, unsigned finer) {
  PolygonSoup surface;
  for (const double z : {0.0, 1.0})
    for (unsigned i = 0; i < segments; ++i) {
      const double angle = 2 * std::numbers::pi * i / segments;
      surface.points.push_back({std::cos(angle), std::sin(angle), z});
    }
  for (Index i = 0; i < segments; ++i) {
    const Index next = (i + 1) % segments;
    surface.add_facet(std::array<Index, 3>{i, next, segments + next});
    surface.add_facet(std::array<Index, 3>{i, segments + next, segments + i});
    if (i == 0 || next == 0) continue;
    surface.add_facet(std::array<Index, 3>{0, next, i});
    surface.add_facet(std::array<Index, 3>{segments, segments + i, segments + next});
  }
  MeshedComplex made = with_features(star_mesh(surface, {0, 0, 0.5}), cylinder(1, 1, segments * finer));
  const Plc& plc = made.plc;
  TetMesh& mesh = made.mesh;
  // All corners of a cap lie on its circle, so that chords look like edges of the circle, and caps like the
  // side.
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    const auto& [a, b, c] = mesh.faces[f];
    if (mesh.points[a].z != mesh.points[b].z || mesh.points[a].z != mesh.points[c].z) continue;
    for (Index p = 0; p < plc.patches.size(); ++p)
      if (plc.patches[p].planar && std::fabs(plc.patches[p].origin.z - mesh.points[a].z) < near)
        mesh.face_patch[f] = p;
  }
  std::erase_if(mesh.edges, [&](const std::array<Index, 2>& edge) {
    const Point middle = 0.5 * (mesh.points[edge[0]] + mesh.points[edge[1]]);
    return std::hypot(middle.x, middle.y) < std::cos(std::numbers::pi / segments) - near;
  });
  mesh.edge_curve.clear();
  for (const auto& edge : mesh.edges)
    for (Index c = 0; c < plc.curves.size(); ++c)
      if (std::fabs(plc.points[plc.curves[c].points[0]].z - mesh.points[edge[0]].z) < near)
        mesh.edge_curve.push_back(c);
  mesh.edge_tag.assign(mesh.edges.size(), plc.curves[0].tag);
  return made;
}

TetMesh without_features(TetMesh mesh) {
  mesh.features.clear();
  std::fill(mesh.face_patch.begin(), mesh.face_patch.end(), none);
  std::fill(mesh.edge_curve.begin(), mesh.edge_curve.end(), none);
  return mesh;
}

}  // namespace collarmesh::testing
