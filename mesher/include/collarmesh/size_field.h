#pragma once

#include <atomic>
#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "collarmesh/plc.h"
#include "collarmesh/tet_mesh.h"

namespace collarmesh {

/// A function that returns the target edge length at a point, in input units; for `MeshOptions::size_field`.
using SizeField = std::function<double(const Point&)>;

/// A record of which sources of a size field made anything finer: those that somewhere asked for less than
/// the given size.
class SizeFieldUse {
 public:
  explicit SizeFieldUse(double size) : size_(size) {}

  /// Adds a source by its name in messages. Returns its number.
  std::size_t add(std::string source);
  /// Records that a source asks for this size somewhere. Several threads may call it at once.
  void note(std::size_t source, double asked) {
    if (asked < size_ && !used_[source].load(std::memory_order_relaxed))
      used_[source].store(true, std::memory_order_relaxed);
  }
  /// Returns the names of the sources that made nothing finer.
  std::vector<std::string> without_effect() const;
  double size() const { return size_; }

 private:
  double size_;
  std::vector<std::string> sources_;
  std::deque<std::atomic<bool>> used_;
};

/// Makes a size field from a JSON text: the smallest of the sizes of its sources. A source asks for `size`
/// inside it and up to the distance `within` from it (default 0); beyond, the size grows by `growth` (default
/// 0.3) per unit length.
///     {"size": 2, "sources": [
///       {"ball": {"centre": [0, 0, 0], "radius": 1}, "size": 0.1, "growth": 0.2},
///       {"box": {"min": [0, 0, 0], "max": [1, 1, 1]}, "size": 0.1},
///       {"box": {"corner": [0, 0, 0], "edges": [[1, 1, 0], [-1, 1, 0], [0, 0, 1]]}, "size": 0.1},
///       {"cylinder": {"from": [0, 0, 0], "to": [0, 0, 2], "radius": 1}, "size": 0.1},
///       {"curves": [3, 4], "size": 0.05},
///       {"patches": [2], "size": 0.05, "within": 0.5}]}
/// `size` outside the list holds everywhere; without it only the sources count. Curves and patches are named
/// by their tags. Lengths are in input units. The field keeps `use`, if there is one, and records in it the
/// sizes that each source asks for. Throws OptionError, with the place in the text, for a text that cannot be
/// used; ReadError for one that is nested too deeply.
SizeField size_field_from_json(const std::string& text, const Plc& plc,
                               const std::shared_ptr<SizeFieldUse>& use = nullptr);

/// Makes a size field that interpolates linearly in the tets of a background mesh; outside of it the value of
/// its nearest point counts. Throws OptionError unless there is one positive value per point.
SizeField size_field_on_mesh(const TetMesh& mesh, const std::vector<double>& values);

}  // namespace collarmesh
