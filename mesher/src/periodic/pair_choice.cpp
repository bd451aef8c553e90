#include "periodic/pair_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <set>
#include <string_view>

#include "collarmesh/error.h"
#include "common/named_tags.h"
#include "common/sort_uniquely.h"

namespace collarmesh::periodicity {

namespace {

constexpr double at_end = 1e-9;  // relative to the diagonal; patches this near to the end of the shape are at
                                 // the end

constexpr std::string_view grammar =
    "a pair is x, y, z, FIRST=SECOND or FIRST=SECOND:MOTION, where MOTION is translation,DX,DY,DZ or "
    "rotation,AXIS,DEGREES or rotation,PX,PY,PZ,DX,DY,DZ,DEGREES";

[[noreturn]] void refuse(const std::string& text, const std::string& why) {
  throw OptionError(fmt::format("periodic '{}': {}", text, why));
}

std::vector<std::string> divided(std::string_view text, char separator) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    parts.emplace_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

class PairReader {
 public:
  PairReader(const std::string& text, const Plc& plc) : text_(text), plc_(plc) {}

  PatchPair read() {
    PatchPair pair;
    pair.text = text_;
    if (text_ == "x" || text_ == "y" || text_ == "z") {
      read_axis(static_cast<std::size_t>(text_[0] - 'x'), pair);
    } else {
      const std::size_t equals = text_.find('='), colon = text_.find(':', equals);
      if (equals == std::string::npos) refuse(text_, std::string(grammar));
      pair.first = group(text_.substr(0, equals));
      pair.second = group(text_.substr(equals + 1, colon == std::string::npos ? colon : colon - equals - 1));
      pair.motion = motion(colon == std::string::npos ? "translation" : text_.substr(colon + 1), pair);
    }
    for (const auto* patches : {&pair.first, &pair.second})
      for (const Index patch : *patches) require_usable(patch);
    return pair;
  }

 private:
  void read_axis(std::size_t axis, PatchPair& pair) const {
    const double low = plc_.bounds.min[axis], high = plc_.bounds.max[axis];
    pair.first = patches_at(axis, low);
    pair.second = patches_at(axis, high);
    if (pair.first.empty() || pair.second.empty())
      refuse(text_, fmt::format("no planar patch lies at the {} end of the shape, {} = {:.9g}; name two "
                                "patches (FIRST=SECOND) of {}",
                                pair.first.empty() ? "low" : "high", text_, pair.first.empty() ? low : high,
                                list_of_patches(plc_)));
    Vector by{0, 0, 0};
    by[axis] = high - low;
    pair.motion = translation(by);
  }

  std::vector<Index> patches_at(std::size_t axis, double place) const {
    const double tolerance = std::max(plc_.planar_tolerance, at_end * plc_.bounds.diagonal());
    std::vector<Index> found;
    for (Index patch = 0; patch < plc_.patches.size(); ++patch) {
      const Box box = box_of({patch});
      if (std::fabs(box.min[axis] - place) <= tolerance && std::fabs(box.max[axis] - place) <= tolerance)
        found.push_back(patch);
    }
    return found;
  }

  Box box_of(const std::vector<Index>& patches) const {
    Box box;
    for (const Index patch : patches) {
      const Plc::Patch& of = plc_.patches[patch];
      for (Index t = of.first_triangle; t < of.first_triangle + of.triangle_count; ++t)
        for (const Index point : plc_.triangles[t].points) box.add(plc_.points[point]);
    }
    return box;
  }

  std::vector<Index> group(const std::string& names) const {
    std::vector<Index> patches;
    for (const std::string& name : divided(names, ',')) {
      const std::set<Tag> tags = tags_named(name, 2, plc_.names);
      const std::size_t before = patches.size();
      for (Index patch = 0; patch < plc_.patches.size(); ++patch)
        if (tags.contains(plc_.patches[patch].tag)) patches.push_back(patch);
      if (patches.size() == before)
        refuse(text_,
               fmt::format("no patch is called '{}'; the patches are {}", name, list_of_patches(plc_)));
    }
    sort_uniquely(patches);
    return patches;
  }

  Motion motion(const std::string& description, const PatchPair& pair) const {
    std::vector<std::string> words = divided(description, ',');
    const std::string kind = words.front();
    words.erase(words.begin());
    if (kind == "translation" && words.empty())
      return translation(box_of(pair.second).centre() - box_of(pair.first).centre());
    if (kind == "rotation" && words.size() == 2 && words[0].size() == 1 && words[0][0] >= 'x' &&
        words[0][0] <= 'z') {
      Vector axis{0, 0, 0};
      axis[static_cast<std::size_t>(words[0][0] - 'x')] = 1;
      return rotation({}, axis, number(words[1]));
    }
    std::vector<double> values;
    values.reserve(words.size());
    for (const std::string& word : words) values.push_back(number(word));
    if (kind == "translation" && values.size() == 3) return translation({values[0], values[1], values[2]});
    if (kind == "rotation" && values.size() == 7) {
      const Vector direction{values[3], values[4], values[5]};
      if (norm(direction) == 0) refuse(text_, "the direction of the axis is 0 0 0; give another");
      return rotation({values[0], values[1], values[2]}, direction, values[6]);
    }
    refuse(text_, std::string(grammar));
  }

  double number(const std::string& word) const {
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value))
      refuse(text_, fmt::format("'{}' is no number; {}", word, grammar));
    return value;
  }

  void require_usable(Index patch) const {
    const Plc::Patch& of = plc_.patches[patch];
    if (!of.planar) refuse(text_, fmt::format("patch {} is not planar; choose planar patches", of.tag));
    if ((of.regions[0] == 0) == (of.regions[1] == 0))
      refuse(text_,
             fmt::format("patch {} is not on the boundary; choose patches with material on one side only",
                         of.tag));
  }

  const std::string& text_;
  const Plc& plc_;
};

}  // namespace

std::vector<PatchPair> choose_pairs(const PeriodicOptions& options, const Plc& plc) {
  constexpr std::size_t most_pairs = 32;
  std::vector<PatchPair> pairs;
  std::set<Index> used;
  if (options.pairs.size() > most_pairs)
    refuse(options.pairs[most_pairs],
           fmt::format("more than {} pairs; put those with the same motion into one: A,C=B,D", most_pairs));
  for (const std::string& text : options.pairs) {
    pairs.push_back(PairReader(text, plc).read());
    for (const auto* patches : {&pairs.back().first, &pairs.back().second})
      for (const Index patch : *patches)
        if (!used.insert(patch).second)
          refuse(text,
                 fmt::format("patch {} is in two groups; each patch can be in one", plc.patches[patch].tag));
  }
  return pairs;
}

}  // namespace collarmesh::periodicity
