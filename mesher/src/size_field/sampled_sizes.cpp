// Samples a function, which takes many places at once, on nested grids.
#include "collarmesh/sampled_sizes.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace collarmesh {

namespace {

constexpr double coarsest = 1.0 / 64;  // size of cells, relative to the box's longest side
constexpr unsigned finer_cells = 8;    // cells along each side of a cell that gets its own grid
constexpr double finest = 1e-12;       // cells this short are not divided; relative to the box's longest side

using Counts = std::array<unsigned, 3>;

/// The nodes of a grid of cells, with a size at each node.
class Grid {
 public:
  Grid(const Point& low, const Point& high, const Counts& cells) : low_(low), high_(high), cells_(cells) {
    finer_ = std::vector<std::atomic<Grid*>>(std::size_t{cells[0]} * cells[1] * cells[2]);
  }

  std::vector<Point> nodes() const {
    std::vector<Point> nodes;
    for (unsigned i = 0; i <= cells_[0]; ++i)
      for (unsigned j = 0; j <= cells_[1]; ++j)
        for (unsigned k = 0; k <= cells_[2]; ++k) nodes.push_back(node(i, j, k));
    return nodes;
  }
  void set_sizes(std::vector<double> sizes) { sizes_ = std::move(sizes); }

  /// A cell: the indices of its lowest corner, and the coordinates of a point in it, from 0 to 1.
  struct Cell {
    Counts at;
    std::array<double, 3> shares;
  };

  Cell cell_of(const Point& p) const {
    Cell cell;
    for (int axis = 0; axis < 3; ++axis) {
      const double extent = coordinate(high_, axis) - coordinate(low_, axis);
      const double place = extent > 0 ? (coordinate(p, axis) - coordinate(low_, axis)) / extent : 0;
      const double along = std::clamp(place, 0.0, 1.0) * cells_[axis];
      cell.at[axis] = std::min(static_cast<unsigned>(along), cells_[axis] - 1);
      cell.shares[axis] = along - cell.at[axis];
    }
    return cell;
  }

  std::array<double, 8> corners_of(const Cell& cell) const {
    std::array<double, 8> sizes;
    for (unsigned corner = 0; corner < 8; ++corner)
      sizes[corner] = sizes_[number(cell.at[0] + (corner & 1), cell.at[1] + (corner >> 1 & 1),
                                    cell.at[2] + (corner >> 2))];
    return sizes;
  }

  double longest_side() const {
    double longest = 0;
    for (int axis = 0; axis < 3; ++axis)
      longest = std::max(longest, (coordinate(high_, axis) - coordinate(low_, axis)) / cells_[axis]);
    return longest;
  }

  std::atomic<Grid*>& finer(const Cell& cell) {
    return finer_[(std::size_t{cell.at[0]} * cells_[1] + cell.at[1]) * cells_[2] + cell.at[2]];
  }

  /// Makes a grid in a cell, without sizes.
  std::unique_ptr<Grid> make_finer(const Cell& cell) const {
    return std::make_unique<Grid>(node(cell.at[0], cell.at[1], cell.at[2]),
                                  node(cell.at[0] + 1, cell.at[1] + 1, cell.at[2] + 1),
                                  Counts{finer_cells, finer_cells, finer_cells});
  }

 private:
  static double coordinate(const Point& p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

  double place(int axis, unsigned i) const {
    const double share = static_cast<double>(i) / cells_[axis];
    return (1 - share) * coordinate(low_, axis) + share * coordinate(high_, axis);
  }
  Point node(unsigned i, unsigned j, unsigned k) const { return {place(0, i), place(1, j), place(2, k)}; }

  std::size_t number(unsigned i, unsigned j, unsigned k) const {
    return (std::size_t{i} * (cells_[1] + 1) + j) * (cells_[2] + 1) + k;
  }

  Point low_, high_;
  Counts cells_;
  std::vector<double> sizes_;
  std::vector<std::atomic<Grid*>> finer_;
};

class SampledSizes {
 public:
  SampledSizes(SizesAt sizes, const Box& box) : sizes_(std::move(sizes)) {
    const Point extent = box.max - box.min;
    longest_ = std::max({extent.x, extent.y, extent.z});
    const auto cells = [&](double side) {
      return std::max(1U, static_cast<unsigned>(std::ceil(side / (coarsest * longest_) - 1e-9)));
    };
    grids_.push_back(
        std::make_unique<Grid>(box.min, box.max, Counts{cells(extent.x), cells(extent.y), cells(extent.z)}));
    root_ = grids_.back().get();
    root_->set_sizes(sizes_(root_->nodes()));
  }

  double at(const Point& p) {
    Grid* grid = root_;
    for (;;) {
      const Grid::Cell cell = grid->cell_of(p);
      const std::array<double, 8> corners = grid->corners_of(cell);
      const double side = grid->longest_side();
      if (side <= *std::ranges::min_element(corners) || side <= finest * longest_)
        return between(corners, cell.shares);
      grid = &finer(*grid, cell);
    }
  }

 private:
  /// Returns the grid in a cell; the first thread that needs it makes it.
  Grid& finer(Grid& grid, const Grid::Cell& cell) {
    std::atomic<Grid*>& place = grid.finer(cell);
    if (Grid* const there = place.load(std::memory_order_acquire)) return *there;
    const std::lock_guard lock(mutex_);
    if (Grid* const there = place.load(std::memory_order_relaxed)) return *there;
    std::unique_ptr<Grid> made = grid.make_finer(cell);
    made->set_sizes(sizes_(made->nodes()));
    grids_.push_back(std::move(made));
    place.store(grids_.back().get(), std::memory_order_release);
    return *grids_.back();
  }

  /// Interpolates linearly along each axis. If some sizes are finite, infinite ones count as the largest
  /// finite one.
  static double between(const std::array<double, 8>& corners, const std::array<double, 3>& shares) {
    double largest = 0;
    for (const double size : corners)
      if (std::isfinite(size)) largest = std::max(largest, size);
    if (largest == 0) return INFINITY;
    double between = 0;
    for (unsigned corner = 0; corner < 8; ++corner) {
      double weight = 1;
      for (unsigned axis = 0; axis < 3; ++axis)
        weight *= (corner >> axis & 1) != 0 ? shares[axis] : 1 - shares[axis];
      between += weight * std::min(corners[corner], largest);
    }
    return between;
  }

  SizesAt sizes_;
  double longest_ = 0;
  Grid* root_ = nullptr;
  std::mutex mutex_;
  std::vector<std::unique_ptr<Grid>> grids_;
};

}  // namespace

SizeField sampled_sizes(SizesAt sizes, const Box& box) {
  const auto sampled = std::make_shared<SampledSizes>(std::move(sizes), box);
  return [sampled](const Point& p) { return sampled->at(p); };
}

}  // namespace collarmesh
