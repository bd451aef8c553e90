#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "collarmesh/tet_mesh.h"

namespace collarmesh::improvement {

/// A mesh' tets with their neighbours, ready for local changes, tied to the faces that must stay:
/// boundaries, interfaces and facets inside regions.
class TetComplex {
 public:
  struct Tet {
    std::array<Index, 4> corners;
    std::array<Index, 4> neighbours;  ///< across the face opposite each corner; none at a boundary
    std::array<Index, 4> faces;       ///< that face among the mesh' faces; none when it is not one
    Index region;
    std::uint32_t generation;
    bool alive, collar;
  };
  /// A face and what it is among the mesh' faces.
  struct Face {
    std::array<Index, 3> corners;
    Index face;
  };
  struct NewTet {
    std::array<Index, 4> corners;
    Index like;  ///< a tet of the cavity whose region and tags it takes
  };
  /// The tets around an edge ab in order: tet i has the corners a, b, link[i], link[i + 1] and positive
  /// volume. Closed: the last link vertex is followed by the first; open: at a boundary.
  struct Ring {
    std::vector<Index> tets, link;
    bool closed;
  };

  explicit TetComplex(TetMesh& mesh);

  Index size() const { return static_cast<Index>(tets_.size()); }
  const Tet& operator[](Index tet) const { return tets_[tet]; }
  TetMesh& mesh() { return mesh_; }
  const TetMesh& mesh() const { return mesh_; }
  std::array<Point, 4> corners(Index tet) const;
  bool on_curve(Index a, Index b) const;
  /// Is the edge ab one of a mesh' face?
  bool on_faces(Index a, Index b);

  /// Replace `found` by the tets around a vertex.
  void star(Index vertex, std::vector<Index>& found);
  /// A tet with these two corners; none when they are not joined.
  Index tet_at_edge(Index a, Index b);
  /// Replace `ring` by the ring of the edge ab of a tet.
  void ring(Index tet, Index a, Index b, Ring& ring) const;

  /// A vertex inside a region; in no tet yet.
  Index add_vertex(const Point& p);
  /// Replace tets by others that fill the same cavity, or less of it at a boundary; `kept` are those of the
  /// mesh' faces inside the cavity or on its border that change. Returns the new tets' indices until the next
  /// call.
  std::span<const Index> replace(std::span<const Index> old, std::span<const NewTet> created,
                                 std::span<const Face> kept);

  /// Write the tets back to the mesh.
  void store();

 private:
  struct OpenFace {
    std::array<Index, 3> key;  // sorted
    Index tet;
    unsigned corner;
    Index face;
  };

  void link_all();
  unsigned corner_across(Index tet, const std::array<Index, 3>& sorted_face) const;

  TetMesh& mesh_;
  std::vector<Tet> tets_;
  std::vector<Index> origin_;  // of every tet: one of the mesh it takes its tags from
  std::vector<Index> vertex_tet_;
  std::vector<std::uint32_t> stamps_;
  std::uint32_t stamp_ = 0;
  std::vector<std::uint64_t> curve_edges_;  // sorted
  std::vector<Index> free_;
  std::vector<Index> created_;
  std::vector<std::pair<Index, Index>> tags_;  // region and origin of the tets being made
  std::vector<OpenFace> open_;
  std::vector<Index> star_;
  Ring ring_;
};

/// The corners of a tet's face opposite a corner, seen counterclockwise from outside.
inline std::array<Index, 3> face_corners(const std::array<Index, 4>& tet, unsigned corner) {
  constexpr std::array<std::array<unsigned, 3>, 4> order{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
  return {tet[order[corner][0]], tet[order[corner][1]], tet[order[corner][2]]};
}

}  // namespace collarmesh::improvement
