#pragma once

#include <array>
#include <cassert>
#include <cstdint>
#include <span>
#include <vector>

#include "collarmesh/geometry.h"
#include "common/tet_sides.h"

namespace collarmesh::constrained {

/// Tetrahedra that fill a box around some points. Changes keep the box filled; predicates are exact. The
/// box's corners are the last eight of the initial points. A face of a tetrahedron may carry the number of a
/// facet, which it keeps until `set_facet` changes it; `replace` must not remove such a face.
class Tetrahedra {
 public:
  using Corners = std::array<Index, 4>;

  /// A face of a tetrahedron, given by the opposite corner.
  struct Face {
    Index tet = none;
    unsigned corner = 0;
  };

  /// The tetrahedra around an edge ab, in order: tetrahedron i has the corners a, b, link[i] and link[i + 1];
  /// the last one has link[0] in place of link[i + 1].
  struct Ring {
    std::vector<Index> tets, link;
  };

  /// Makes the Delaunay tetrahedra of the points, which must be distinct. Cost: near linear.
  explicit Tetrahedra(const std::vector<Point>& points);

  std::size_t size() const { return tets_.size(); }
  std::size_t point_count() const { return points_.size(); }
  const Point& point(Index vertex) const { return points_[vertex]; }
  bool alive(Index tet) const { return tets_[tet].alive; }
  const Corners& corners(Index tet) const { return tets_[tet].corners; }
  /// Returns the tetrahedron beyond a face; none at the box's surface.
  Index beyond(const Face& face) const { return tets_[face.tet].neighbours[face.corner].tet; }
  Face opposite(const Face& face) const { return tets_[face.tet].neighbours[face.corner]; }
  Index facet(const Face& face) const { return tets_[face.tet].facets[face.corner]; }
  /// Sets the facet of a face, on both sides.
  void set_facet(const Face& face, Index facet);

  int orientation(Index a, Index b, Index c, Index d) const;

  /// Returns a tetrahedron with these corners; none if no edge joins them.
  Index tet_at(Index a, Index b) const;
  /// Returns the face with these corners; its tet is none if there is no such face.
  Face face_of(Index a, Index b, Index c) const;
  /// Finds the tetrahedra at a vertex.
  void star(Index vertex, std::vector<Index>& tets) const {
    find_star(vertex, tets, [](Index) { return false; });
  }
  /// Finds the ring of an edge of a tetrahedron. Returns false at the box's surface, where the ring is not
  /// closed.
  bool ring(Index tet, Index a, Index b, Ring& ring) const;

  /// Adds a point that is not a corner yet. Returns its number.
  Index add_point(const Point& p);
  /// Removes the last point, which must not be a corner.
  void drop_point() {
    assert(tet_at_.back() == none);
    points_.pop_back(), tet_at_.pop_back();
  }
  /// Replaces tetrahedra by others that fill the same space. Faces on the border of that space stay.
  void replace(std::span<const Index> old, std::span<const Corners> created);

  /// Returns a mark for `undo_to`. It is valid until `keep` is called.
  std::size_t mark() const { return journal_.size(); }
  /// Undoes all changes since the mark.
  void undo_to(std::size_t mark);
  /// Makes all changes permanent.
  void keep();

  /// Returns whether these tetrahedra are positively oriented, and agree with each neighbour about the
  /// triangle between the two and the facet that it carries.
  bool consistent(std::span<const Index> tets) const;
  /// Returns all tetrahedra.
  std::vector<Index> all() const;

 private:
  struct Tet {
    Corners corners;
    std::array<Face, 4> neighbours;
    std::array<Index, 4> facets{none, none, none, none};
    bool alive = true;
  };
  struct Side {
    std::array<Index, 3> corners;  // sorted
    Face face;                     // the face to link to
    Index facet;
    bool border;
  };
  struct Step {
    std::vector<Index> old, created;
  };

  /// Finds tetrahedra at a vertex until `enough` returns true.
  template <class Enough>
  void find_star(Index vertex, std::vector<Index>& tets, const Enough& enough) const {
    tets.clear();
    if (tet_at_[vertex] == none) return;
    if (marks_.size() < tets_.size()) marks_.resize(2 * tets_.size(), 0);
    ++stamp_;
    tets.push_back(tet_at_[vertex]);
    marks_[tets[0]] = stamp_;
    for (std::size_t i = 0; i < tets.size(); ++i) {
      if (enough(tets[i])) return;
      const Tet& t = tets_[tets[i]];
      for (unsigned k = 0; k < 4; ++k) {
        const Index next = t.neighbours[k].tet;
        if (t.corners[k] == vertex || next == none || marks_[next] == stamp_) continue;
        marks_[next] = stamp_;
        tets.push_back(next);
      }
    }
  }
  bool has(Index tet, Index vertex) const {
    const Corners& v = tets_[tet].corners;
    return v[0] == vertex || v[1] == vertex || v[2] == vertex || v[3] == vertex;
  }
  Index new_tet(const Corners& corners);
  void attach(Index tet);

  std::vector<Point> points_;
  std::vector<Tet> tets_;
  std::vector<Index> tet_at_;  // by vertex: a tetrahedron with this corner, or none
  std::vector<Index> free_;
  std::vector<Step> journal_;
  std::vector<Side> sides_;
  mutable std::vector<std::uint32_t> marks_;  // marks of visited tets
  mutable std::uint32_t stamp_ = 0;
  mutable std::vector<Index> star_;
};

}  // namespace collarmesh::constrained
