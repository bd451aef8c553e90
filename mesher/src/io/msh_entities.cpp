#include "io/msh_entities.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <limits>
#include <unordered_map>
#include <utility>

#include "common/flat_table.h"
#include "common/group_names.h"
#include "common/note_last.h"
#include "common/parallel_for.h"
#include "common/sort_uniquely.h"
#include "io/cell_nodes.h"
#include "io/cell_partitions.h"

namespace collarmesh::io {

namespace {

/// The entities of one dimension, one for each pair of a feature and a tag. An entity has the number of its
/// feature if the feature is known and no other entity has that number.
class EntityTable {
 public:
  explicit EntityTable(std::vector<MshEntity>& entities) : entities_(entities) {}

  /// Finds or adds an entity. `number`: the number that the entity should get, that of its feature; 0 if the
  /// feature is unknown.
  Index find(Index number, Tag tag) {
    const std::pair key(number, tag);
    if (key == last_key_ && last_ != none) return last_;
    const auto [found, added] = by_key_.try_emplace(key, static_cast<Index>(entities_.size()));
    if (added) add(number, tag);
    last_key_ = key;
    return last_ = found->second;
  }

  /// Returns the entity with the number of a feature, whatever its tag. Adds one if there is none.
  Index find(Index number) {
    const auto found = by_number_.find(number);
    return found != by_number_.end() ? found->second : find(number, 0);
  }

  /// Numbers the entities that have no number yet. Returns whether there were any.
  bool number_the_rest() {
    int next = 1;
    for (const MshEntity& e : entities_) next = std::max(next, e.number + 1);
    bool any = false;
    for (MshEntity& e : entities_) {
      if (e.number != 0) continue;
      e.number = next++;
      any = true;
    }
    return any;
  }

 private:
  /// Adds an entity. It gets its number later (`number_the_rest`) if `number` is 0, taken, or so large that
  /// few larger ones are left.
  void add(Index number, Tag tag) {
    constexpr Index limit = std::numeric_limits<int>::max() / 2;
    MshEntity entity;
    entity.tag = tag;
    if (number != 0 && number < limit &&
        by_number_.try_emplace(number, static_cast<Index>(entities_.size())).second)
      entity.number = static_cast<int>(number);
    entities_.push_back(entity);
  }

  std::vector<MshEntity>& entities_;
  using Key = std::pair<Index, Tag>;
  struct KeyHash {
    std::size_t operator()(const Key& key) const {
      return hash_of(std::array<std::int64_t, 2>{key.first, key.second});
    }
  };

  std::unordered_map<Key, Index, KeyHash> by_key_;
  std::unordered_map<Index, Index> by_number_;
  Key last_key_;
  Index last_ = none;
};

Index number_of(Index feature) { return feature == none ? 0 : feature + 1; }

using Tables = std::array<EntityTable, 4>;

constexpr std::size_t cells_at_once = 16384;

std::size_t ranges_of(std::size_t count) { return (count + cells_at_once - 1) / cells_at_once; }

/// Assigns cells to entities. Adds missing entities to `table` in the order of their first cells.
void assign_cells(const TetMesh& mesh, CellKind kind, EntityTable& table, std::vector<Index>& of_cell) {
  using Key = std::pair<Index, Tag>;
  const bool volumes = shape_of(kind).dimension == 3;
  const std::vector<Index>& features = features_of(mesh, kind);
  const std::vector<Tag>& tags = tags_of(mesh, kind);
  struct Run {
    Key key;
    std::size_t first;
    Index entity = none;
  };
  std::vector<std::vector<Run>> runs(ranges_of(tags.size()));
  parallel_for_ranges(tags.size(), cells_at_once, [&](std::size_t first, std::size_t last) {
    std::vector<Run>& found = runs[first / cells_at_once];
    for (std::size_t i = first; i < last; ++i)
      if (const Key key(volumes ? features[i] : number_of(features[i]), tags[i]);
          found.empty() || found.back().key != key)
        found.push_back({key, i});
  });
  for (std::vector<Run>& of_range : runs)
    for (Run& run : of_range) run.entity = table.find(run.key.first, run.key.second);
  of_cell.resize(tags.size());
  parallel_for_ranges(tags.size(), cells_at_once, [&](std::size_t first, std::size_t last) {
    const std::vector<Run>& found = runs[first / cells_at_once];
    for (std::size_t r = 0; r < found.size(); ++r)
      std::fill(
          of_cell.begin() + static_cast<std::ptrdiff_t>(found[r].first),
          of_cell.begin() + static_cast<std::ptrdiff_t>(r + 1 < found.size() ? found[r + 1].first : last),
          found[r].entity);
  });
}

/// Assigns each node of the cells of a kind to the entity of the last cell that has it. Leaves out the first
/// `from` nodes of each cell.
void place_nodes(const TetMesh& mesh, CellKind kind, std::size_t from, MshEntities& result) {
  const auto dimension = static_cast<std::uint8_t>(shape_of(kind).dimension);
  for (std::size_t i = 0; i < count_of(mesh, kind); ++i) {
    const CellNodes nodes = nodes_of(kind)(mesh, i);
    for (std::size_t k = from; k < nodes.size(); ++k)
      result.of_point[nodes[k]] = {dimension, result.of_cell[kind][i]};
  }
}

/// Assigns the corners of all tets in the same way as `place_nodes`, in parallel.
void place_corners_of_tets(const TetMesh& mesh, MshEntities& result) {
  const bool alone = tbb::this_task_arena::max_concurrency() == 1;
  std::vector<Index> last_tet(mesh.points.size(), none);
  parallel_for_ranges(mesh.tets.size(), cells_at_once, [&](std::size_t first, std::size_t last) {
    for (std::size_t t = first; t < last; ++t)
      for (const Index v : mesh.tets[t]) note_last(last_tet[v], static_cast<Index>(t), alone);
  });
  parallel_for_ranges(mesh.points.size(), cells_at_once, [&](std::size_t first, std::size_t last) {
    for (std::size_t v = first; v < last; ++v)
      if (last_tet[v] != none) result.of_point[v] = {3, result.of_cell[CellKind::tet][last_tet[v]]};
  });
}

/// Assigns points to entities: by their features where known, otherwise by the cells that have them.
void place_points(const TetMesh& mesh, Tables& tables, MshEntities& result) {
  if (mesh.tets.empty()) tables[3].find(1);
  result.of_point.resize(mesh.points.size());
  place_corners_of_tets(mesh, result);
  if (mesh.order() == 2) place_nodes(mesh, CellKind::tet, shape_of(CellKind::tet).corners, result);
  for (const CellKind kind : all_cell_kinds)
    if (kind != CellKind::tet) place_nodes(mesh, kind, 0, result);
  for (std::size_t v = 0; v < mesh.features.size(); ++v) {
    const auto [dimension, feature] = mesh.features[v];
    if (dimension < 3 && feature != none)
      result.of_point[v] = {dimension, tables[dimension].find(number_of(feature))};
  }
}

void find_boxes_of_cells(const TetMesh& mesh, CellKind kind, MshEntities& result) {
  struct Run {
    Index entity;
    Box box;
  };
  const std::vector<Index>& entities = result.of_cell[kind];
  std::vector<std::vector<Run>> runs(ranges_of(entities.size()));
  const CellShape shape = shape_of(kind);
  parallel_for_ranges(entities.size(), cells_at_once, [&](std::size_t first, std::size_t last) {
    std::vector<Run>& found = runs[first / cells_at_once];
    for (std::size_t i = first; i < last; ++i) {
      if (found.empty() || found.back().entity != entities[i]) found.push_back({entities[i], {}});
      const CellNodes nodes = nodes_of(kind)(mesh, i);
      for (std::size_t k = 0; k < shape.corners; ++k) found.back().box.add(mesh.points[nodes[k]]);
    }
  });
  for (const std::vector<Run>& of_range : runs)
    for (const Run& run : of_range) result.of_dimension[shape.dimension][run.entity].box.add(run.box);
}

void find_boxes(const TetMesh& mesh, MshEntities& result) {
  for (const CellKind kind : all_cell_kinds) find_boxes_of_cells(mesh, kind, result);
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    const MshEntities::Place& place = result.of_point[v];
    result.of_dimension[place.dimension][place.entity].box.add(mesh.points[v]);
  }
}

void find_boundaries(const TetMesh& mesh, MshEntities& result) {
  std::vector<std::pair<Index, int>> pairs;  // region and surface; negative: its normal points inwards
  const auto add = [&](Index region, int surface) {
    if (region != 0 && (pairs.empty() || pairs.back() != std::pair(region, surface)))
      pairs.emplace_back(region, surface);
  };
  for_each_kind(mesh, 2, [&](CellKind kind) {
    for (std::size_t i = 0; i < count_of(mesh, kind); ++i) {
      const int surface = result.of_dimension[2][result.of_cell[kind][i]].number;
      add(regions_beside(mesh, kind)[i][0], surface);
      add(regions_beside(mesh, kind)[i][1], -surface);
    }
  });
  sort_uniquely(pairs);
  for (MshEntity& volume : result.of_dimension[3]) {
    const auto region = static_cast<Index>(volume.number);
    for (auto at =
             std::lower_bound(pairs.begin(), pairs.end(), std::pair(region, std::numeric_limits<int>::min()));
         at != pairs.end() && at->first == region; ++at)
      volume.boundary.push_back(at->second);
  }
}

/// Numbers the physical groups. A tag that Gmsh accepts is its own number; other tags get free numbers, above
/// all tags if possible.
std::map<Tag, int> number_tags(const std::vector<MshEntity>& entities) {
  constexpr Tag limit = std::numeric_limits<int>::max();
  std::map<Tag, int> numbers;
  Tag next = 1;
  for (const MshEntity& e : entities)
    if (e.tag > 0 && e.tag < limit) {
      numbers.emplace(e.tag, static_cast<int>(e.tag));
      next = std::max(next, e.tag + 1);
    }
  if (next + static_cast<Tag>(entities.size()) > limit) next = 1;
  for (const MshEntity& e : entities)
    if (!numbers.contains(e.tag)) {
      while (numbers.contains(next)) ++next;
      numbers.emplace(e.tag, static_cast<int>(next++));
    }
  return numbers;
}

void find_physicals(MshEntities& result) {
  for (std::size_t dimension = 1; dimension <= 3; ++dimension) {
    result.physicals[dimension] = number_tags(result.of_dimension[dimension]);
    for (MshEntity& e : result.of_dimension[dimension]) e.physical = result.physicals[dimension].at(e.tag);
  }
}

/// A divider of entities into parts. It orders parts by entity and partition; their numbers follow those of
/// the entities.
class Divider {
 public:
  Divider(const TetMesh& mesh, const MshEntities& whole, MshParts& result)
      : mesh_(mesh), whole_(whole), points_(partitions_of_points(mesh)), result_(result) {
    result.entities.of_point.resize(mesh.points.size());
  }

  template <class Cells>
  void divide(std::uint8_t dimension, const Cells& cells, const std::vector<Index>& whole_of_cell,
              const std::vector<Index>& partitions, std::vector<Index>& part_of_cell) {
    std::map<std::pair<Index, Index>, Index> parts;
    for (std::size_t i = 0; i < cells.size(); ++i) parts.try_emplace({whole_of_cell[i], partitions[i]}, 0);
    for (std::size_t v = 0; v < points_.size(); ++v)
      if (whole_.of_point[v].dimension == dimension)
        parts.try_emplace({whole_.of_point[v].entity, points_[v]}, 0);
    add(dimension, parts);
    std::vector<MshEntity>& entities = result_.entities.of_dimension[dimension];
    for (std::size_t i = 0; i < cells.size(); ++i) {
      part_of_cell.push_back(parts.at({whole_of_cell[i], partitions[i]}));
      for (const Index v : cells[i]) entities[part_of_cell.back()].box.add(mesh_.points[v]);
    }
    for (std::size_t v = 0; v < points_.size(); ++v)
      if (whole_.of_point[v].dimension == dimension) {
        const Index part = parts.at({whole_.of_point[v].entity, points_[v]});
        result_.entities.of_point[v] = {dimension, part};
        entities[part].box.add(mesh_.points[v]);
      }
  }

 private:
  /// Adds an entity for each part, and stores its index in `parts`.
  void add(std::size_t dimension, std::map<std::pair<Index, Index>, Index>& parts) {
    int number = 0;
    for (const MshEntity& entity : whole_.of_dimension[dimension]) number = std::max(number, entity.number);
    std::vector<MshEntity>& entities = result_.entities.of_dimension[dimension];
    for (auto& [key, part] : parts) {
      const MshEntity& parent = whole_.of_dimension[dimension][key.first];
      part = static_cast<Index>(entities.size());
      MshEntity entity;
      entity.number = ++number;
      entity.tag = parent.tag;
      entity.physical = parent.physical;
      entities.push_back(entity);
      result_.of_dimension[dimension].push_back({parent.number, key.second});
    }
  }

  const TetMesh& mesh_;
  const MshEntities& whole_;
  std::vector<Index> points_;  // partitions of the points
  MshParts& result_;
};

}  // namespace

void write_physical_names(FileWriter& out, const TetMesh& mesh, const MshPhysicals& physicals) {
  std::size_t count = 0;
  for (const auto& numbers : physicals) count += numbers.size();
  out << "$PhysicalNames\n" << count << '\n';
  for (std::size_t dimension = 0; dimension < 4; ++dimension)
    for (const auto& [tag, number] : physicals[dimension])
      out << dimension << ' ' << number << " \"" << group_name(mesh, dimension, tag, "-") << "\"\n";
  out << "$EndPhysicalNames\n";
}

MshParts divide_entities(const TetMesh& mesh, const MshEntities& whole) {
  MshParts result;
  result.numbers = partition_numbers(mesh);
  result.partitions = std::size_t{result.numbers.back()} + 1;
  MshEntities& parts = result.entities;
  Divider divider(mesh, whole, result);
  const auto divide = [&](CellKind kind, const auto& cells, const std::vector<Index>& partitions) {
    divider.divide(static_cast<std::uint8_t>(shape_of(kind).dimension), cells, whole.of_cell[kind],
                   partitions, parts.of_cell[kind]);
  };
  divide(CellKind::tet, mesh.tets, mesh.tet_partition);
  divide(CellKind::triangle, mesh.faces, partitions_of_faces(mesh));
  divide(CellKind::edge, mesh.edges, partitions_of_edges(mesh));
  std::vector<Index> no_cells;
  divider.divide(0, std::vector<std::array<Index, 1>>(), {}, {}, no_cells);
  return result;
}

MshEntities find_entities(const TetMesh& mesh) {
  MshEntities result;
  auto& lists = result.of_dimension;
  Tables tables{EntityTable(lists[0]), EntityTable(lists[1]), EntityTable(lists[2]), EntityTable(lists[3])};
  for (const CellKind kind : all_cell_kinds)
    assign_cells(mesh, kind, tables[shape_of(kind).dimension], result.of_cell[kind]);
  place_points(mesh, tables, result);
  result.numbers_are_features = !mesh.features.empty();
  for (EntityTable& table : tables)
    if (table.number_the_rest()) result.numbers_are_features = false;
  find_boxes(mesh, result);
  find_boundaries(mesh, result);
  find_physicals(result);
  return result;
}

}  // namespace collarmesh::io
