#include "adapt/mesh_sides.h"

#include <fmt/format.h>

#include <algorithm>

#include "collarmesh/error.h"
#include "common/disjoint_sets.h"
#include "common/sorted.h"
#include "common/tet_sides.h"

namespace collarmesh::remeshing::adapting {

namespace {

/// A side of a tet, or a listed face.
struct Use {
  Triangle key;  // sorted corners
  Index tet;     // none: a listed face
  Index place;   // the opposite corner, or the number of the face

  friend bool operator<(const Use& a, const Use& b) {
    return a.key != b.key ? a.key < b.key : a.tet != b.tet ? a.tet < b.tet : a.place < b.place;
  }
};

std::vector<Use> uses_of(const TetMesh& mesh) {
  std::vector<Use> uses;
  uses.reserve(4 * mesh.tets.size() + mesh.faces.size());
  for (Index t = 0; t < mesh.tets.size(); ++t)
    for (unsigned corner = 0; corner < 4; ++corner)
      uses.push_back({sorted(side_corners(mesh.tets[t], corner)), t, corner});
  for (Index f = 0; f < mesh.faces.size(); ++f) uses.push_back({sorted(mesh.faces[f]), none, f});
  std::ranges::sort(uses);
  return uses;
}

[[noreturn]] void refuse(const TetMesh& mesh, const std::vector<Index>& given, Triangle corners,
                         const std::string& wrong) {
  const Point at = (mesh.points[corners[0]] + mesh.points[corners[1]] + mesh.points[corners[2]]) / 3;
  for (Index& v : corners) v = given[v];
  const std::string message =
      fmt::format("The triangle of the nodes {}, {} and {} at ({:.9g}, {:.9g}, {:.9g}) {}", corners[0],
                  corners[1], corners[2], at.x, at.y, at.z, wrong);
  throw PlcError(message, {{PlcFault::Kind::intersection, message, {corners.begin(), corners.end()}, at}});
}

/// Returns whether the mesh lists every side of its tets as a face, as some programs do. Then being listed
/// says nothing about a face inside a region.
bool lists_every_side(const std::vector<Use>& uses) {
  for (std::size_t i = 0, j = 0; i < uses.size(); i = j) {
    for (j = i; j < uses.size() && uses[j].key == uses[i].key;) ++j;
    if (uses[j - 1].tet != none) return false;
  }
  return true;
}

}  // namespace

MeshSides::MeshSides(const TetMesh& mesh, const std::vector<Index>& given) {
  const std::vector<Use> uses = uses_of(mesh);
  const bool every_side = lists_every_side(uses);
  DisjointSets connected(mesh.tets.size());
  for (std::size_t i = 0, j = 0; i < uses.size(); i = j) {
    for (j = i; j < uses.size() && uses[j].key == uses[i].key;) ++j;
    const auto tets = static_cast<std::size_t>(std::find_if(uses.begin() + static_cast<std::ptrdiff_t>(i),
                                                            uses.begin() + static_cast<std::ptrdiff_t>(j),
                                                            [](const Use& use) { return use.tet == none; }) -
                                               (uses.begin() + static_cast<std::ptrdiff_t>(i)));
    if (tets == 0)
      refuse(mesh, given, uses[i].key,
             "is listed as a face but is no side of a tetrahedron; remove it from the file.");
    if (tets > 2)
      refuse(mesh, given, uses[i].key,
             fmt::format("is a side of {} tetrahedra; remove those that overlap others.", tets));
    const bool listed = i + tets < j;
    const bool counts = listed && !(every_side && mesh.face_tag[uses[i + tets].place] == 0);
    const Index first = uses[i].tet, second = tets == 2 ? uses[i + 1].tet : none;
    if (!counts && second != none && mesh.tet_region[first] == mesh.tet_region[second])
      connected.unite(first, second);
    else
      sides.push_back({side_corners(mesh.tets[first], uses[i].place), first, second,
                       listed ? uses[i + tets].place : none});
  }
  std::ranges::sort(sides, [](const MeshSide& a, const MeshSide& b) {
    return a.behind != b.behind ? a.behind < b.behind : sorted(a.corners) < sorted(b.corners);
  });
  component.resize(mesh.tets.size());
  for (Index t = 0; t < mesh.tets.size(); ++t) component[t] = connected.find(t);
}

}  // namespace collarmesh::remeshing::adapting
