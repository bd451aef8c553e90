#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "collarmesh/tet_mesh.h"

namespace collarmesh::io {

/// Members of each group, by the group's tag.
using Groups = std::map<Tag, std::vector<Index>>;

/// Returns the nodes of the cells of each tag, numbered from 1, ascending.
template <class Cells>
Groups nodes_by_tag(const TetMesh& mesh, const Cells& nodes_of, const std::vector<Tag>& tags) {
  Groups groups;
  for (std::size_t i = 0; i < tags.size(); ++i)
    for (const Index v : nodes_of(mesh, i)) groups[tags[i]].push_back(v + 1);
  for (auto& [tag, nodes] : groups) {
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  }
  return groups;
}

/// Numbers the tags from `first`, in their order: for formats whose numbers are positive.
inline std::map<Tag, std::size_t> numbered_tags(const std::vector<Tag>& tags, std::size_t first = 1) {
  std::map<Tag, std::size_t> numbers;
  for (const Tag tag : tags) numbers.try_emplace(tag, 0);
  for (auto& [tag, number] : numbers) number = first++;
  return numbers;
}

/// Returns the tags themselves if all are positive numbers of 32 bits, otherwise numbers as above.
inline std::map<Tag, std::size_t> positive_numbers(const std::vector<Tag>& tags) {
  std::map<Tag, std::size_t> numbers = numbered_tags(tags);
  if (std::all_of(numbers.begin(), numbers.end(), [](const auto& each) {
        return each.first > 0 && each.first <= std::numeric_limits<std::int32_t>::max();
      }))
    for (auto& [tag, number] : numbers) number = static_cast<std::size_t>(tag);
  return numbers;
}

}  // namespace collarmesh::io
