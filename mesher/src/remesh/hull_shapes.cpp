#include "remesh/hull_shapes.h"

#include <algorithm>

namespace collarmesh::remeshing {

namespace {

// Returns the smaller of two numbers, or of vectors of numbers entry by entry.
template <class Numbers>
Numbers smaller(const Numbers& a, const Numbers& b) {
  return a < b ? a : b;
}
template <class Numbers>
Numbers larger(const Numbers& a, const Numbers& b) {
  return a > b ? a : b;
}
template <class Numbers>
Numbers signed_squares(const Numbers& product, const Numbers& x, const Numbers& y) {
  return -(product * x) * ((product < 0 ? -product : product) * y);  // this order keeps products in range at
                                                                     // any scale
}

}  // namespace

HullShapes::TwoVectors HullShapes::minus(const TwoVectors& a, const TwoVectors& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

HullShapes::TwoVectors HullShapes::cross(const TwoVectors& a, const TwoVectors& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

HullShapes::Two HullShapes::dot(const TwoVectors& a, const TwoVectors& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

// Returns the signed squared cosine of the largest angle of faces with these squared sides; 1 for a face
// without an obtuse angle.
HullShapes::Two HullShapes::least_cosine(const Two& x, const Two& y, const Two& z) {
  const Two least_xy = smaller(x, y), most_xy = larger(x, y);
  const Two longest = larger(most_xy, z), middle = larger(least_xy, smaller(most_xy, z)),
            shortest = smaller(least_xy, z);
  const Two excess = shortest + middle - longest;
  const Two one{1, 1};
  return excess < 0 ? -0.25 * (excess * excess) / (shortest * middle) : one;
}

void HullShapes::assign(std::span<const std::array<Index, 3>> faces, const std::vector<Point>& points) {
  pairs_.resize((faces.size() + at_once - 1) / at_once);
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    Pair& pair = pairs_[k];
    for (std::size_t lane = 0; lane < at_once; ++lane) {
      const auto& face = faces[std::min(at_once * k + lane, faces.size() - 1)];
      for (unsigned i = 0; i < 3; ++i) {
        const Point& p = points[face[i]];
        pair.corners[i].x[lane] = p.x;
        pair.corners[i].y[lane] = p.y;
        pair.corners[i].z[lane] = p.z;
      }
    }
    const auto& [b, c, d] = pair.corners;
    pair.normal = cross(minus(c, b), minus(d, b));
    pair.inverse_squared_normal = 1 / dot(pair.normal, pair.normal);
    const auto squared = [](const TwoVectors& v) { return dot(v, v); };
    pair.squared_sides = {squared(minus(d, c)), squared(minus(d, b)), squared(minus(c, b))};
    pair.least_cosine = least_cosine(pair.squared_sides[0], pair.squared_sides[1], pair.squared_sides[2]);
  }
}

std::array<ExtremeCosines, HullShapes::at_once> HullShapes::extreme_cosines(std::size_t pair,
                                                                            const Point& apex) const {
  const Pair& hull = pairs_[pair];
  const TwoVectors a{{apex.x, apex.x}, {apex.y, apex.y}, {apex.z, apex.z}};
  const TwoVectors b = minus(hull.corners[0], a), c = minus(hull.corners[1], a),
                   d = minus(hull.corners[2], a);
  const TwoVectors &n_a = hull.normal, n_b = cross(d, c), n_c = cross(b, d), n_d = cross(c, b);
  const Two six_volumes = -dot(n_d, d);
  const Two &i_a = hull.inverse_squared_normal, i_b = 1 / dot(n_b, n_b), i_c = 1 / dot(n_c, n_c),
            i_d = 1 / dot(n_d, n_d);
  const Two cd = signed_squares(dot(n_c, n_d), i_c, i_d), bd = signed_squares(dot(n_b, n_d), i_b, i_d),
            bc = signed_squares(dot(n_b, n_c), i_b, i_c), ad = signed_squares(dot(n_a, n_d), i_a, i_d),
            ac = signed_squares(dot(n_a, n_c), i_a, i_c), ab = signed_squares(dot(n_a, n_b), i_a, i_b);
  const Two greatest = larger(larger(larger(cd, bd), larger(bc, ad)), larger(ac, ab));
  const Two least = smaller(smaller(smaller(cd, bd), smaller(bc, ad)), smaller(ac, ab));
  const Two bb = dot(b, b), cc = dot(c, c), dd = dot(d, d);
  const auto& [cd_side, bd_side, bc_side] = hull.squared_sides;
  const Two of_faces = smaller(smaller(least_cosine(bb, cc, bc_side), least_cosine(bb, dd, bd_side)),
                               smaller(least_cosine(cc, dd, cd_side), hull.least_cosine));
  const Two largest_angles = smaller(least, of_faces);
  std::array<ExtremeCosines, at_once> cosines;
  for (std::size_t lane = 0; lane < at_once; ++lane)
    cosines[lane] = {std::min(1.0, greatest[lane]), std::max(-1.0, largest_angles[lane]),
                     six_volumes[lane] > 0};
  return cosines;
}

}  // namespace collarmesh::remeshing
