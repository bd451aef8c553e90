#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "collarmesh/tet_mesh.h"

namespace collarmesh::io {

/// Whatever belongs to a group, by the group's tag.
using Groups = std::map<Tag, std::vector<Index>>;

/// The nodes of the cells of each tag, numbered from 1, ascending.
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

/// The tags that there are, numbered from `first` in their order: for formats whose numbers are positive.
inline std::map<Tag, std::size_t> numbered_tags(const std::vector<Tag>& tags, std::size_t first = 1) {
  std::map<Tag, std::size_t> numbers;
  for (const Tag tag : tags) numbers.try_emplace(tag, 0);
  for (auto& [tag, number] : numbers) number = first++;
  return numbers;
}

}  // namespace collarmesh::io
