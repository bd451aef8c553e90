#include "remesh/polyhedron_filling.h"

#include <algorithm>

#include "common/sort_uniquely.h"
#include "common/tet_sides.h"

namespace collarmesh::remeshing {

namespace {

using Triangle = std::array<Index, 3>;
using Tet = std::array<Index, 4>;

// Rotates the triangle's corners so that the one with the smallest index comes first; its orientation stays.
Triangle begun_with_smallest(Triangle t) {
  std::rotate(t.begin(), std::ranges::min_element(t), t.end());
  return t;
}

Triangle turned(const Triangle& t) { return {t[0], t[2], t[1]}; }

class Filling {
 public:
  Filling(std::span<const Triangle> hull, double above, const FillingQuality& quality, std::size_t most_steps)
      : quality_(quality), above_(above), steps_left_(most_steps) {
    for (const Triangle& t : hull) {
      front_.push_back(begun_with_smallest(t));
      vertices_.insert(vertices_.end(), t.begin(), t.end());
    }
    sort_uniquely(vertices_);
  }

  std::vector<Tet> best() {
    go_on(INFINITY);
    return std::move(best_);
  }

 private:
  // Puts a tet on a triangle of the front in every possible way, and fills the rest each time. `worst`: worst
  // quality of the tets so far.
  void go_on(double worst) {
    if (front_.empty()) {
      best_ = tets_;
      above_ = worst;
      return;
    }
    const Triangle base = front_.back();
    for (const Index apex : vertices_) {
      if (std::ranges::find(base, apex) != base.end()) continue;
      if (steps_left_ == 0 || worst <= above_) return;
      --steps_left_;
      const Tet tet{base[0], base[1], base[2], apex};
      const double quality = quality_(tet, above_);
      if (quality <= above_) continue;
      std::vector<Triangle> before = front_;
      if (advance(tet)) {
        tets_.push_back(tet);
        go_on(std::min(worst, quality));
        tets_.pop_back();
      }
      front_ = std::move(before);
    }
  }

  // Moves the front past a tet. Returns false if a triangle would be in the front twice.
  bool advance(const Tet& tet) {
    for (unsigned corner = 0; corner < 4; ++corner) {
      const Triangle below = begun_with_smallest(turned(side_corners(tet, corner)));
      if (const auto at = std::ranges::find(front_, below); at != front_.end()) {
        front_.erase(at);
        continue;
      }
      const Triangle beyond = turned(below);
      if (std::ranges::find(front_, beyond) != front_.end()) return false;
      front_.push_back(beyond);
    }
    return true;
  }

  const FillingQuality& quality_;
  double above_;
  std::size_t steps_left_;
  std::vector<Index> vertices_;
  std::vector<Triangle> front_;  // the space above these triangles is still to be filled
  std::vector<Tet> tets_, best_;
};

}  // namespace

std::vector<Tet> fill_polyhedron(std::span<const Triangle> hull, double above, const FillingQuality& quality,
                                 std::size_t most_steps) {
  return Filling(hull, above, quality, most_steps).best();
}

}  // namespace collarmesh::remeshing
