#include "report/shown_mesh.h"

#include <algorithm>
#include <array>
#include <limits>

#include "common/layer_tets.h"
#include "common/sort_uniquely.h"

namespace collarmesh::report {

namespace {

/// Returns which tets have a face among the mesh's faces.
std::vector<bool> tets_at_faces(const TetMesh& mesh) {
  std::vector<std::array<Index, 3>> faces(mesh.faces);
  for (auto& face : faces) std::sort(face.begin(), face.end());
  std::sort(faces.begin(), faces.end());
  std::vector<bool> on_face(mesh.points.size(), false);
  for (const auto& face : faces)
    for (const Index p : face) on_face[p] = true;
  std::vector<bool> found(mesh.tets.size(), false);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for (std::size_t apex = 0; apex < 4 && !found[t]; ++apex) {
      std::array<Index, 3> face;
      for (std::size_t i = 0, k = 0; i < 4; ++i)
        if (i != apex) face[k++] = mesh.tets[t][i];
      if (!std::all_of(face.begin(), face.end(), [&](Index p) { return on_face[p]; })) continue;
      std::sort(face.begin(), face.end());
      found[t] = std::binary_search(faces.begin(), faces.end(), face);
    }
  return found;
}

bool meets_middle_plane(const TetMesh& mesh, const std::array<Index, 4>& tet, const Point& centre) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto [low, high] = std::minmax({mesh.points[tet[0]][axis], mesh.points[tet[1]][axis],
                                          mesh.points[tet[2]][axis], mesh.points[tet[3]][axis]});
    if (low <= centre[axis] && centre[axis] <= high) return true;
  }
  return false;
}

/// Adds a point and gives it a number, unless it has one.
void add_point(const TetMesh& mesh, Index p, std::vector<std::uint32_t>& point_number, ShownMesh& shown) {
  if (point_number[p] != none) return;
  point_number[p] = static_cast<std::uint32_t>(shown.points.size() / 3);
  for (std::size_t axis = 0; axis < 3; ++axis)
    shown.points.push_back(static_cast<float>(mesh.points[p][axis] - shown.centre[axis]));
}

/// Adds all faces; they lie on patches. Precondition: all their points have numbers.
void add_faces(const TetMesh& mesh, const std::vector<std::uint32_t>& point_number, ShownMesh& shown) {
  shown.face_tags = mesh.face_tag;
  sort_uniquely(shown.face_tags);
  shown.faces.reserve(4 * mesh.faces.size());
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    for (const Index p : mesh.faces[f]) shown.faces.push_back(point_number[p]);
    const auto tag = std::lower_bound(shown.face_tags.begin(), shown.face_tags.end(), mesh.face_tag[f]);
    shown.faces.push_back(static_cast<std::uint32_t>(tag - shown.face_tags.begin()));
  }
}

}  // namespace

ShownMesh shown_mesh(const TetMesh& mesh, const std::vector<WorstTet>& worst, std::size_t most) {
  if (!mesh.layers.prisms.empty() || !mesh.layers.pyramids.empty())
    return shown_mesh(tets_of_layers(mesh), worst, most);  // the page draws tets
  ShownMesh shown;
  Box box;
  for (const Point& p : mesh.points) box.add(p);
  if (mesh.tets.empty() && mesh.faces.empty()) return shown;
  shown.centre = 0.5 * (box.min + box.max);
  shown.complete = mesh.tets.size() <= most;
  std::vector<bool> is_shown(mesh.tets.size(), true);
  if (!shown.complete) {
    is_shown = tets_at_faces(mesh);
    for (std::size_t t = 0; t < mesh.tets.size(); ++t)
      if (meets_middle_plane(mesh, mesh.tets[t], shown.centre)) is_shown[t] = true;
    for (const WorstTet& w : worst) is_shown[w.tet] = true;
  }
  std::vector<std::uint32_t> point_number(mesh.points.size(), none);
  std::vector<Index> tet_number(mesh.tets.size(), none);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (!is_shown[t]) continue;
    tet_number[t] = static_cast<Index>(shown.marks.size());
    for (const Index p : mesh.tets[t]) {
      add_point(mesh, p, point_number, shown);
      shown.tets.push_back(point_number[p]);
    }
    constexpr Index largest = std::numeric_limits<std::uint16_t>::max();
    shown.region.push_back(static_cast<std::uint16_t>(std::min(largest, mesh.tet_region[t])));
    const bool collar = !mesh.tet_collar.empty() && mesh.tet_collar[t] != 0,
               thin = !mesh.tet_thin.empty() && mesh.tet_thin[t] != 0;
    const unsigned layer = mesh.layers.tet_layer.empty() ? 0 : mesh.layers.tet_layer[t];
    const unsigned of_layer = layer == 0 ? 0 : layer % 2 == 1 ? 8 : 16;
    shown.marks.push_back(static_cast<std::uint8_t>((collar ? 1 : 0) + (thin ? 2 : 0) + of_layer));
  }
  if (mesh.tets.empty())
    for (const auto& face : mesh.faces)
      for (const Index p : face) add_point(mesh, p, point_number, shown);
  add_faces(mesh, point_number, shown);
  for (const WorstTet& w : worst) {
    Point centre{0, 0, 0};
    for (const Point& p : w.corners) centre = centre + 0.25 * (p - Point{0, 0, 0});
    shown.worst.push_back({tet_number[w.tet], w.smallest, w.largest, centre});
  }
  return shown;
}

}  // namespace collarmesh::report
