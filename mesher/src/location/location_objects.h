#pragma once

#include <cassert>
#include <vector>

#include "collarmesh/geometry.h"
#include "common/growing_array.h"

namespace collarmesh {

/// The objects that are not in the mesh yet but must be found from it: unresolved points (radius 0) and the
/// protective balls of subsegments. Each is kept at the mesh vertex whose Voronoi cell contains its centre,
/// that is, at its nearest vertex.
class LocationObjects {
 public:
  struct Object {
    Point centre;
    double squared_radius;
    Index vertex;          ///< nearest mesh vertex
    Index previous, next;  ///< in that vertex's list
    Index owner;           ///< index of the point or subsegment, given when it was added
  };

  const Object& operator[](Index object) const { return objects_[object]; }
  /// Returns the first object at a mesh vertex, or none. `next` leads to the others.
  Index first_at(Index vertex) const { return vertex < first_.size() ? first_[vertex] : none; }

  /// Visits all objects at a mesh vertex with their numbers. The visitor may move or remove the object that
  /// it visits, but no other one.
  template <class Visit>
  void visit_at(Index vertex, const Visit& visit) const {
    for (Index o = first_at(vertex), next = none; o != none; o = next) {
      next = objects_[o].next;
      ++looks_;
      visit(o, objects_[o]);
    }
  }

  Index add(Index owner, const Point& centre, double squared_radius, Index vertex) {
    Index object;
    if (free_.empty()) {
      object = static_cast<Index>(objects_.size());
      objects_.push_back({});
    } else {
      object = free_.back();
      free_.pop_back();
    }
    objects_[object] = {centre, squared_radius, none, none, none, owner};
    attach(object, vertex);
    ++added_;
    return object;
  }

  void remove(Index object) {
    detach(object);
    free_.push_back(object);
  }

  void move(Index object, Index vertex) {
    ++moved_;
    detach(object);
    attach(object, vertex);
  }

  /// Return the numbers of objects added, of moves to other vertices, and of visits so far.
  std::size_t added() const { return added_; }
  std::size_t moved() const { return moved_; }
  std::size_t looks() const { return looks_; }

  std::size_t bytes() const { return objects_.bytes() + first_.bytes(); }

 private:
  void attach(Index object, Index vertex) {
    if (vertex >= first_.size()) first_.resize(vertex + 1, none);
    Object& o = objects_[object];
    o.vertex = vertex;
    o.previous = none;
    o.next = first_[vertex];
    if (o.next != none) objects_[o.next].previous = object;
    first_[vertex] = object;
  }

  void detach(Index object) {
    const Object& o = objects_[object];
    assert((o.previous == none ? first_[o.vertex] : objects_[o.previous].next) == object);
    assert(o.next == none || objects_[o.next].previous == object);
    if (o.previous != none)
      objects_[o.previous].next = o.next;
    else
      first_[o.vertex] = o.next;
    if (o.next != none) objects_[o.next].previous = o.previous;
  }

  GrowingArray<Object> objects_;
  std::vector<Index> free_;
  GrowingArray<Index> first_;
  std::size_t added_ = 0, moved_ = 0;
  mutable std::size_t looks_ = 0;
};

}  // namespace collarmesh
