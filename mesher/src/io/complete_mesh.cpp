#include "io/complete_mesh.h"

#include <algorithm>
#include <array>
#include <utility>

namespace collarmesh::io {

namespace {

using Triangle = std::array<Index, 3>;

/// Seen from outside a positive tet, its faces run counterclockwise.
constexpr std::array<std::array<std::size_t, 3>, 4> outward_faces{
    {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

void orient_tets(TetMesh& mesh) {
  for (auto& [a, b, c, d] : mesh.tets)
    if (six_volume(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]) < 0) std::swap(c, d);
}

void number_regions(TetMesh& mesh) {
  std::vector<Tag> tags(mesh.tet_tag);
  std::sort(tags.begin(), tags.end());
  tags.erase(std::unique(tags.begin(), tags.end()), tags.end());
  for (const Tag tag : mesh.tet_tag)
    mesh.tet_region.push_back(
        static_cast<Index>(std::lower_bound(tags.begin(), tags.end(), tag) - tags.begin() + 1));
}

/// The smallest corner first, the cyclic order kept.
Triangle rotated(Triangle t) {
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return t;
}
Triangle reversed(const Triangle& t) { return {t[0], t[2], t[1]}; }

/// Finds the faces of a mesh by their corners in either direction.
class FaceFinder {
 public:
  explicit FaceFinder(const std::vector<Triangle>& faces) : slots_(64, none) {
    while (slots_.size() < 2 * faces.size()) slots_.resize(2 * slots_.size(), none);
    for (const Triangle& face : faces) {
      const Triangle turned = rotated(face);
      keys_.push_back(turned[1] < turned[2] ? turned : reversed(turned));
      slot(keys_.back()) = static_cast<Index>(keys_.size() - 1);
    }
  }
  /// Precondition: `corners` is rotated.
  Index find(const Triangle& corners) { return slot(corners[1] < corners[2] ? corners : reversed(corners)); }

 private:
  Index& slot(const Triangle& key) {
    const std::size_t mask = slots_.size() - 1;
    std::uint64_t h = key[0];
    h = (h * 0x9e3779b97f4a7c15ULL) ^ key[1];
    h = (h * 0x9e3779b97f4a7c15ULL) ^ key[2];
    h *= 0x9e3779b97f4a7c15ULL;
    std::size_t i = (h ^ (h >> 31)) & mask;
    while (slots_[i] != none && keys_[slots_[i]] != key) i = (i + 1) & mask;
    return slots_[i];
  }

  std::vector<Triangle> keys_;
  std::vector<Index> slots_;
};

void find_face_regions(TetMesh& mesh) {
  mesh.face_regions.assign(mesh.faces.size(), {0, 0});
  FaceFinder finder(mesh.faces);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for (const auto& [i, j, k] : outward_faces) {
      const Triangle outward = rotated({mesh.tets[t][i], mesh.tets[t][j], mesh.tets[t][k]});
      const Index face = finder.find(outward);
      if (face == none) continue;
      const bool behind = rotated(mesh.faces[face]) == outward;
      mesh.face_regions[face][behind ? 0 : 1] = mesh.tet_region[t];
    }
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    if (mesh.face_regions[f][0] == 0) {
      std::swap(mesh.face_regions[f][0], mesh.face_regions[f][1]);
      std::swap(mesh.faces[f][1], mesh.faces[f][2]);
    }
}

}  // namespace

void complete_mesh(TetMesh& mesh) {
  orient_tets(mesh);
  mesh.tet_tag.resize(mesh.tets.size(), 0);
  mesh.tet_collar.resize(mesh.tets.size(), 0);
  if (mesh.tet_region.empty()) number_regions(mesh);
  mesh.face_tag.resize(mesh.faces.size(), 0);
  mesh.face_patch.resize(mesh.faces.size(), none);
  mesh.edge_tag.resize(mesh.edges.size(), 0);
  mesh.edge_curve.resize(mesh.edges.size(), none);
  if (mesh.face_regions.empty()) find_face_regions(mesh);
}

}  // namespace collarmesh::io
