#pragma once

#include "common/growing_array.h"
#include "common/large_pages.h"
#include "delaunay/triangulation.h"

namespace collarmesh {

/// A face whose dual edge meets the collar surface, usually between a cell inside the collars and one
/// outside, with the ball that the edge enters first and the point where it enters (paper, Definition 9).
struct CollarTriangle {
  FaceId face;               ///< seen from the cell outside
  std::uint32_t generation;  ///< generation of that cell
  Index ball;
  Point representation;
  bool several;             ///< the dual edge meets the collar surface more than once
  bool poor_alone = false;  ///< poor regardless of its neighbours
  bool poor = false;
  /// A smooth patch that is too far from the triangle between an edge of the face and the ball's centre; none
  /// if there is no such patch.
  Index bent_on = none;
  Point bent_at = {};  ///< a point on an edge of that triangle
};

/// Collar triangles by their faces. Records of a removed cell are reused for the next cell in its slot.
class CollarTriangles {
 public:
  /// Returns the record of a face; null if none was made since the cell was created.
  CollarTriangle* find(FaceId face, std::uint32_t generation) {
    for (Index at = first(cell_of(face)); at != none; at = triangles_[at].next)
      if (triangles_[at].face == face && triangles_[at].generation == generation) return &triangles_[at];
    return nullptr;
  }
  const CollarTriangle* find(FaceId face, std::uint32_t generation) const {
    return const_cast<CollarTriangles*>(this)->find(face, generation);
  }

  void insert_or_assign(const CollarTriangle& triangle) {
    const Index cell = cell_of(triangle.face);
    if (cell >= first_.size()) first_.resize(cell + 1, none);
    for (Index at = first_[cell]; at != none; at = triangles_[at].next) {
      Linked& known = triangles_[at];
      if (known.face != triangle.face && known.generation == triangle.generation) continue;
      static_cast<CollarTriangle&>(known) = triangle;
      return;
    }
    triangles_.push_back({triangle, first_[cell]});
    first_[cell] = static_cast<Index>(triangles_.size() - 1);
  }

  std::size_t bytes() const { return first_.bytes() + triangles_.capacity() * sizeof(Linked); }

 private:
  struct Linked : CollarTriangle {
    Index next;  // next record of the same cell
  };
  Index first(Index cell) const { return cell < first_.size() ? first_[cell] : none; }

  GrowingArray<Index> first_;  // by cell
  LargeVector<Linked> triangles_;
};

}  // namespace collarmesh
