#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <utility>

#include "collarmesh/geometry.h"

namespace collarmesh {

/// The names of tags from a file or user, by dimension: 0 vertices, 1 curves, 2 patches, 3 regions. Tags
/// without a name are called by their number.
class TagNames {
 public:
  /// Returns the name of a tag, or null if it has none.
  const std::string* find(std::size_t dimension, Tag tag) const {
    const auto found = names_[dimension].find(tag);
    return found == names_[dimension].end() ? nullptr : &found->second;
  }
  void set(std::size_t dimension, Tag tag, std::string name) {
    names_[dimension].insert_or_assign(tag, std::move(name));
  }
  const std::map<Tag, std::string>& of(std::size_t dimension) const { return names_[dimension]; }
  bool empty() const {
    for (const auto& names : names_)
      if (!names.empty()) return false;
    return true;
  }
  /// Adds names from `others` for tags without one.
  void add(const TagNames& others) {
    for (std::size_t d = 0; d < names_.size(); ++d)
      names_[d].insert(others.names_[d].begin(), others.names_[d].end());
  }

 private:
  std::array<std::map<Tag, std::string>, 4> names_;
};

}  // namespace collarmesh
