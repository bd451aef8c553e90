#include "io/complete_mesh.h"

#include <algorithm>
#include <array>
#include <unordered_map>
#include <utility>

#include "collarmesh/error.h"
#include "common/edge_key.h"
#include "common/tet_sides.h"
#include "io/face_finder.h"

namespace collarmesh::io {

namespace {

void turn_tet(TetMesh& mesh, std::size_t tet) {
  std::swap(mesh.tets[tet][2], mesh.tets[tet][3]);
  if (mesh.order() == 1) return;
  auto& [ab, bc, ca, ad, bd, cd] = mesh.tet_mid_nodes[tet];
  std::swap(bc, bd);
  std::swap(ca, ad);
}

/// Reverses all tets if most are negative, because programs differ in the order of a tet's corners. Tets
/// whose orientation differs from the others are inverted, and stay.
void orient_tets(TetMesh& mesh) {
  std::size_t negative = 0, positive = 0;
  for (const auto& [a, b, c, d] : mesh.tets) {
    const double volume = six_volume(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]);
    if (volume < 0) ++negative;
    if (volume > 0) ++positive;
  }
  if (negative <= positive) return;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) turn_tet(mesh, t);
}

void turn_face(TetMesh& mesh, std::size_t face) {
  std::swap(mesh.faces[face][1], mesh.faces[face][2]);
  if (mesh.order() == 2) std::swap(mesh.face_mid_nodes[face][0], mesh.face_mid_nodes[face][2]);
}

/// The mid-edge nodes of the tets by the ends of their edge.
class MidNodes {
 public:
  MidNodes(const std::string& path, const TetMesh& mesh) : path_(path) {
    constexpr std::array<std::array<std::size_t, 2>, 6> ends{
        {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};
    for (std::size_t t = 0; t < mesh.tets.size(); ++t)
      for (std::size_t e = 0; e < ends.size(); ++e)
        nodes_.emplace(edge_key(mesh.tets[t][ends[e][0]], mesh.tets[t][ends[e][1]]),
                       mesh.tet_mid_nodes[t][e]);
  }
  Index find(Index a, Index b) const {
    const auto found = nodes_.find(edge_key(a, b));
    if (found == nodes_.end())
      throw ReadError(path_ +
                      ": a triangle or line of first order is no face or edge of a tetrahedron of second "
                      "order; save all cells with one order");
    return found->second;
  }

 private:
  const std::string& path_;
  std::unordered_map<std::uint64_t, Index> nodes_;
};

void complete_mid_nodes(const std::string& path, TetMesh& mesh) {
  const bool faces = mesh.face_mid_nodes.size() == mesh.faces.size(),
             edges = mesh.edge_mid_nodes.size() == mesh.edges.size();
  if ((!mesh.tet_mid_nodes.empty() && mesh.tet_mid_nodes.size() != mesh.tets.size()) ||
      (!mesh.face_mid_nodes.empty() && (!faces || mesh.order() == 1)) ||
      (!mesh.edge_mid_nodes.empty() && (!edges || mesh.order() == 1)))
    throw ReadError(path + ": cells of first and second order are mixed; save them with one order");
  if (mesh.order() == 1 || (faces && edges)) return;
  const MidNodes nodes(path, mesh);
  if (!faces)
    for (const auto& [a, b, c] : mesh.faces)
      mesh.face_mid_nodes.push_back({nodes.find(a, b), nodes.find(b, c), nodes.find(c, a)});
  if (!edges)
    for (const auto& [a, b] : mesh.edges) mesh.edge_mid_nodes.push_back(nodes.find(a, b));
}

void number_regions(TetMesh& mesh) {
  mesh.tet_region.clear();
  mesh.face_regions.clear();
  std::vector<Tag> tags(mesh.tet_tag);
  std::sort(tags.begin(), tags.end());
  tags.erase(std::unique(tags.begin(), tags.end()), tags.end());
  for (const Tag tag : mesh.tet_tag)
    mesh.tet_region.push_back(
        static_cast<Index>(std::lower_bound(tags.begin(), tags.end(), tag) - tags.begin() + 1));
}

/// Returns whether regions are numbered from 1; every format has 9 digits for them.
bool has_region_numbers(const TetMesh& mesh) {
  constexpr Index largest = 999'999'999;
  return !mesh.tet_region.empty() && std::all_of(mesh.tet_region.begin(), mesh.tet_region.end(),
                                                 [](Index r) { return r >= 1 && r <= largest; });
}

void find_face_regions(TetMesh& mesh) {
  mesh.face_regions.assign(mesh.faces.size(), {0, 0});
  FaceFinder finder(mesh.faces);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for (const auto& [i, j, k] : opposite_places) {
      const FaceFinder::Triangle outward{mesh.tets[t][i], mesh.tets[t][j], mesh.tets[t][k]};
      const Index face = finder.find(outward);
      if (face == none) continue;
      const bool behind = FaceFinder::alike(mesh.faces[face], outward);
      mesh.face_regions[face][behind ? 0 : 1] = mesh.tet_region[t];
    }
  if (mesh.is_surface()) return;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    if (mesh.face_regions[f][0] == 0) {
      std::swap(mesh.face_regions[f][0], mesh.face_regions[f][1]);
      turn_face(mesh, f);
    }
}

}  // namespace

void complete_mesh(const std::string& path, TetMesh& mesh) {
  complete_mid_nodes(path, mesh);
  orient_tets(mesh);
  mesh.tet_tag.resize(mesh.tets.size(), 0);
  mesh.tet_collar.resize(mesh.tets.size(), 0);
  mesh.tet_crease.resize(mesh.tets.size(), 0);
  if (mesh.tet_partition.size() != mesh.tets.size()) mesh.tet_partition.clear();
  if (!has_region_numbers(mesh)) number_regions(mesh);
  mesh.face_tag.resize(mesh.faces.size(), 0);
  mesh.face_patch.resize(mesh.faces.size(), none);
  mesh.edge_tag.resize(mesh.edges.size(), 0);
  mesh.edge_curve.resize(mesh.edges.size(), none);
  if (mesh.tets.empty())
    mesh.face_regions.assign(mesh.faces.size(), {0, 0});  // the mesh of a surface stays
                                                          // as it is
  if (mesh.face_regions.empty()) find_face_regions(mesh);
}

}  // namespace collarmesh::io
