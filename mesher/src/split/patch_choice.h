#pragma once

#include <array>
#include <set>

#include "collarmesh/split.h"

namespace collarmesh::splitting {

/// A patch or triangle that may be split: its tag and the regions on its sides.
struct Candidate {
  Tag tag = 0;
  std::array<Index, 2> regions{0, 0};

  bool is_internal() const { return regions[0] != 0 && regions[1] != 0; }
  bool is_interface() const { return is_internal() && regions[0] != regions[1]; }
};

/// The internal patches that the options name.
class PatchChoice {
 public:
  /// Finds the patches. Throws OptionError for a name that no internal patch has.
  PatchChoice(const SplitOptions& options, const TagNames& names, const std::vector<Candidate>& all);

  bool contains(const Candidate& candidate) const {
    return (keep_apart_ && candidate.is_interface()) ||
           (candidate.is_internal() && tags_.contains(candidate.tag));
  }

 private:
  bool keep_apart_;
  std::set<Tag> tags_;
};

}  // namespace collarmesh::splitting
