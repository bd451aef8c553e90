#pragma once

#include <petscdmplex.h>

#include <cstddef>
#include <span>
#include <vector>

#include "calls.h"
#include "collarmesh/geometry.h"

namespace collarmesh::distributed {

/// The points of one depth of a DMPlex (0 vertices, 1 edges, 2 faces, 3 tets), numbered from 0 on each rank,
/// and which of them are shared: several ranks have them. Combines their values by minima, maxima or sums of
/// integers, whose results do not depend on the order.
class SharedPoints {
 public:
  SharedPoints(DM dm, PetscInt depth);
  ~SharedPoints();
  SharedPoints(const SharedPoints&) = delete;
  SharedPoints& operator=(const SharedPoints&) = delete;

  PetscInt first() const { return first_; }  ///< number of the first point in the DMPlex
  std::size_t size() const { return owned_.size(); }
  /// Returns whether this rank owns a point; each point has one owner.
  bool owned(std::size_t i) const { return owned_[i]; }
  /// Returns the number of points that this rank owns.
  std::size_t owned_count() const;
  /// Returns the shared points, ascending.
  const std::vector<std::size_t>& shared() const { return shared_; }

  /// Combines the values of each shared point over the ranks that have it, `width` values for each point. All
  /// these ranks get the result. T: PetscInt or PetscReal. With MPI_REPLACE all get the owner's values.
  template <class T>
  void combine(std::vector<T>& values, MPI_Op operation, std::size_t width = 1) const;

  /// Combines values that are given for the points in `shared()` only, in that order.
  template <class T>
  void combine_shared(std::vector<T>& values, MPI_Op operation, std::size_t width = 1) const;

  /// Gives each shared point the place that its owner has for it.
  void take_owners(std::span<Point> places) const;

 private:
  MPI_Comm communicator_;
  PetscInt first_ = 0;
  std::vector<bool> owned_;
  std::vector<std::size_t> shared_;
  PetscSF forest_ = nullptr;  // connects the copies of the points in shared_
};

}  // namespace collarmesh::distributed
