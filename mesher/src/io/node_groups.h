#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "collarmesh/tet_mesh.h"
#include "common/sort_uniquely.h"
#include "io/cell_nodes.h"

namespace collarmesh::io {

/// Members of each group, by the group's tag.
using Groups = std::map<Tag, std::vector<Index>>;

/// Returns by tag the nodes of the cells of a dimension, ascending; nodes are numbered from 1.
inline Groups nodes_by_tag(const TetMesh& mesh, std::size_t dimension) {
  Groups groups;
  for_each_kind(mesh, dimension, [&](CellKind kind) {
    const std::vector<Tag>& tags = tags_of(mesh, kind);
    for (std::size_t i = 0; i < tags.size(); ++i)
      for (const Index v : nodes_of(kind)(mesh, i)) groups[tags[i]].push_back(v + 1);
  });
  for (auto& [tag, nodes] : groups) sort_uniquely(nodes);
  return groups;
}

/// Returns by tag the numbers of cells with volume, which count from `first` in the order of the kinds.
inline Groups volumes_by_tag(const TetMesh& mesh, std::size_t first) {
  Groups groups;
  for_each_kind(mesh, 3, [&](CellKind kind) {
    const std::vector<Tag>& tags = tags_of(mesh, kind);
    const std::size_t first_of_kind = first + count_before(mesh, kind);
    for (std::size_t i = 0; i < tags.size(); ++i)
      groups[tags[i]].push_back(static_cast<Index>(first_of_kind + i));
  });
  return groups;
}

/// Returns the tag of each region.
inline std::map<Index, Tag> tags_of_regions(const TetMesh& mesh) {
  std::map<Index, Tag> regions;
  for_each_kind(mesh, 3, [&](CellKind kind) {
    const std::vector<Index>& of_cells = features_of(mesh, kind);
    for (std::size_t i = 0; i < of_cells.size(); ++i)
      regions.try_emplace(of_cells[i], tags_of(mesh, kind)[i]);
  });
  return regions;
}

/// Returns a number for each tag, from `first` in ascending order of the tags: for formats whose numbers are
/// positive.
inline std::map<Tag, std::size_t> numbered_tags(const std::vector<Tag>& tags, std::size_t first = 1) {
  std::map<Tag, std::size_t> numbers;
  for (const Tag tag : tags) numbers.try_emplace(tag, 0);
  for (auto& [tag, number] : numbers) number = first++;
  return numbers;
}

/// Returns a positive number for each tag: the tag itself if all tags are positive numbers of 32 bits,
/// otherwise numbers from 1 in ascending order of the tags.
inline std::map<Tag, std::size_t> positive_numbers(const std::vector<Tag>& tags) {
  std::map<Tag, std::size_t> numbers = numbered_tags(tags);
  if (std::all_of(numbers.begin(), numbers.end(), [](const auto& each) {
        return each.first > 0 && each.first <= std::numeric_limits<std::int32_t>::max();
      }))
    for (auto& [tag, number] : numbers) number = static_cast<std::size_t>(tag);
  return numbers;
}

}  // namespace collarmesh::io
