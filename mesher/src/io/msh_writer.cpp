// Gmsh's format 4.1 as text (Gmsh's reference manual, "MSH file format"). Entities are the features: a volume
// per region, a surface per patch, a curve per curve, a point per vertex. All entities with one tag form a
// physical group. Cells are numbered in the order of their kinds, tets first; each $ElementData, such as
// "collar", covers all of them in the order of the file, as meshio needs it. In a partitioned mesh the cells
// and nodes of an entity are divided among its parts, one entity for each partition: otherwise Gmsh would
// lose data when it writes such a mesh again. $Periodic has a link for each point, curve and surface of the
// second groups of periodic faces.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/parallel_for.h"
#include "io/cell_nodes.h"
#include "io/cell_partitions.h"
#include "io/label_names.h"
#include "io/msh_entities.h"
#include "io/msh_format.h"
#include "io/msh_periodic.h"
#include "io/tet_mesh_formats.h"
#include "io/write_each.h"

namespace collarmesh::io {

namespace {

/// Writes an entity. `part` is text to write after its number.
void write_entity(FileWriter& out, const MshEntity& entity, std::size_t dimension,
                  const std::string& part = {}) {
  out << entity.number << ' ' << part << entity.box.min;
  if (dimension > 0) out << ' ' << entity.box.max;
  if (entity.physical == 0)
    out << " 0";
  else
    out << " 1 " << entity.physical;
  if (dimension > 0) {
    out << ' ' << entity.boundary.size();
    for (const int surface : entity.boundary) out << ' ' << surface;
  }
  out << '\n';
}

void write_entities(FileWriter& out, const MshEntities& entities) {
  out << "$Entities\n";
  for (std::size_t dimension = 0; dimension < 4; ++dimension)
    out << entities.of_dimension[dimension].size() << (dimension < 3 ? ' ' : '\n');
  for (std::size_t dimension = 0; dimension < 4; ++dimension)
    for (const MshEntity& entity : entities.of_dimension[dimension]) write_entity(out, entity, dimension);
  out << "$EndEntities\n";
}

/// Writes the parts of entities. In the file, partitions are numbered from 1.
void write_partition_entities(FileWriter& out, const MshParts& parts,
                              const std::vector<int>& ghost_entities) {
  out << "$PartitionedEntities\n" << parts.partitions << '\n' << ghost_entities.size() << '\n';
  for (std::size_t i = 0; i < ghost_entities.size(); ++i)
    out << ghost_entities[i] << ' ' << parts.numbers[i] + 1 << '\n';
  for (std::size_t dimension = 0; dimension < 4; ++dimension)
    out << parts.entities.of_dimension[dimension].size() << (dimension < 3 ? ' ' : '\n');
  for (std::size_t dimension = 0; dimension < 4; ++dimension)
    for (std::size_t e = 0; e < parts.entities.of_dimension[dimension].size(); ++e) {
      const MshParts::Part& part = parts.of_dimension[dimension][e];
      write_entity(out, parts.entities.of_dimension[dimension][e], dimension,
                   fmt::format("{} {} 1 {} ", dimension, part.parent, part.partition + 1));
    }
  out << "$EndPartitionedEntities\n";
}

/// Writes each tet that is a ghost, with the partitions in which it is one.
void write_ghost_elements(FileWriter& out, const TetMesh& mesh, const MshParts& parts) {
  std::vector<std::pair<Index, Index>> ghosts;  // a tet and the partition in which it is a ghost
  const std::vector<std::vector<Index>> tets = ghost_tets(mesh);
  for (std::size_t k = 0; k < tets.size(); ++k)
    for (const Index t : tets[k]) ghosts.emplace_back(t, parts.numbers[k]);
  std::sort(ghosts.begin(), ghosts.end());
  std::size_t count = 0;
  for (std::size_t i = 0; i < ghosts.size(); ++i)
    count += i == 0 || ghosts[i].first != ghosts[i - 1].first ? 1 : 0;
  out << "$GhostElements\n" << count << '\n';
  for (std::size_t i = 0, end = 0; i < ghosts.size(); i = end) {
    const Index t = ghosts[i].first;
    while (end < ghosts.size() && ghosts[end].first == t) ++end;
    out << std::size_t{t} + 1 << ' ' << mesh.tet_partition[t] + 1 << ' ' << end - i;
    for (std::size_t k = i; k < end; ++k) out << ' ' << ghosts[k].second + 1;
    out << '\n';
  }
  out << "$EndGhostElements\n";
}

/// The members (cells or points) of each entity of one dimension, in the order of the mesh.
struct EntityMembers {
  std::vector<Index> starts, members;

  /// Groups the members. `entity_of(i)` returns the entity of cell or point i, for all i below `count`;
  /// `none` if it belongs to no entity.
  template <class EntityOf>
  EntityMembers(std::size_t entity_count, std::size_t count, const EntityOf& entity_of)
      : starts(entity_count + 1) {
    // Chunks of members are counted and placed in parallel: each has a range of its own in each entity's
    // members.
    constexpr std::size_t least_chunk = 16384, most_chunks = 64;
    const std::size_t chunk = std::max((count + most_chunks - 1) / most_chunks, least_chunk + entity_count);
    std::vector<std::vector<Index>> next((count + chunk - 1) / chunk);
    parallel_for_ranges(count, chunk, [&](std::size_t first, std::size_t last) {
      std::vector<Index> counts(entity_count, 0);
      for (std::size_t i = first; i < last; ++i)
        if (const Index e = entity_of(i); e != none) ++counts[e];
      next[first / chunk] = std::move(counts);
    });
    Index sum = 0;
    for (std::size_t e = 0; e < entity_count; starts[++e] = sum)
      for (std::vector<Index>& of_chunk : next) sum += std::exchange(of_chunk[e], sum);
    members.resize(sum);
    parallel_for_ranges(count, chunk, [&](std::size_t first, std::size_t last) {
      std::vector<Index>& places = next[first / chunk];
      for (std::size_t i = first; i < last; ++i)
        if (const Index e = entity_of(i); e != none) members[places[e]++] = static_cast<Index>(i);
    });
  }
  EntityMembers(std::size_t entity_count, std::span<const Index> of)
      : EntityMembers(entity_count, of.size(), [&](std::size_t i) { return of[i]; }) {}

  std::span<const Index> of(std::size_t entity) const {
    return {members.data() + starts[entity], members.data() + starts[entity + 1]};
  }
  std::size_t filled() const {
    std::size_t count = 0;
    for (std::size_t e = 0; e + 1 < starts.size(); ++e) count += starts[e] != starts[e + 1] ? 1 : 0;
    return count;
  }
};

std::vector<EntityMembers> group_points(const MshEntities& entities) {
  std::vector<EntityMembers> result;
  for (std::size_t dimension = 0; dimension < 4; ++dimension)
    result.emplace_back(entities.of_dimension[dimension].size(), entities.of_point.size(),
                        [&](std::size_t v) {
                          const MshEntities::Place& place = entities.of_point[v];
                          return place.dimension == dimension ? place.entity : none;
                        });
  return result;
}

void write_nodes(FileWriter& out, const TetMesh& mesh, const MshEntities& entities) {
  const std::vector<EntityMembers> groups = group_points(entities);
  std::size_t blocks = 0;
  for (const EntityMembers& g : groups) blocks += g.filled();
  const std::size_t n = mesh.points.size();
  out << "$Nodes\n" << blocks << ' ' << n << ' ' << (n > 0 ? 1 : 0) << ' ' << n << '\n';
  for (std::size_t dimension = 0; dimension < 4; ++dimension)
    for (std::size_t e = 0; e < entities.of_dimension[dimension].size(); ++e) {
      const std::span<const Index> members = groups[dimension].of(e);
      if (members.empty()) continue;
      out << dimension << ' ' << entities.of_dimension[dimension][e].number << " 0 " << members.size()
          << '\n';
      write_each(out, members.size(),
                 [&](TextBuffer& text, std::size_t i) { text << std::size_t{members[i]} + 1 << '\n'; });
      write_each(out, members.size(),
                 [&](TextBuffer& text, std::size_t i) { text << mesh.points[members[i]] << '\n'; });
    }
  out << "$EndNodes\n";
}

/// Writes the cells of a kind, numbered from `first_number`.
void write_cells(FileWriter& out, const TetMesh& mesh, CellKind kind, const std::vector<MshEntity>& entities,
                 const EntityMembers& groups, std::size_t first_number) {
  const GmshType& type = gmsh_type(kind, mesh.order());
  for (std::size_t e = 0; e < entities.size(); ++e) {
    const std::span<const Index> members = groups.of(e);
    if (members.empty()) continue;
    out << type.dimension() << ' ' << entities[e].number << ' ' << type.number << ' ' << members.size()
        << '\n';
    write_each(out, members.size(), [&](TextBuffer& text, std::size_t i) {
      text << first_number + members[i];
      for (const Index v : nodes_of(kind)(mesh, members[i]).in_order(type.node_order()))
        text << ' ' << std::size_t{v} + 1;
      text << '\n';
    });
  }
}

/// The cells of each kind by entity, and the number of the first cell of each kind.
struct CellGroups {
  std::vector<EntityMembers> of_kind;
  std::array<std::size_t, cell_kinds> first;
  std::size_t count, filled = 0;

  CellGroups(const TetMesh& mesh, const MshEntities& entities) {
    for (const CellKind kind : all_cell_kinds) {
      of_kind.emplace_back(entities.of_dimension[shape_of(kind).dimension].size(), entities.of_cell[kind]);
      first[static_cast<std::size_t>(kind)] = count_before(mesh, kind) + 1;
      filled += of_kind.back().filled();
    }
    count = count_of_all(mesh);
  }
};

void write_elements(FileWriter& out, const TetMesh& mesh, const MshEntities& entities,
                    const CellGroups& groups) {
  out << "$Elements\n"
      << groups.filled << ' ' << groups.count << ' ' << (groups.count > 0 ? 1 : 0) << ' ' << groups.count
      << '\n';
  for (std::size_t k = 0; k < cell_kinds; ++k)
    write_cells(out, mesh, all_cell_kinds[k], entities.of_dimension[shape_of(all_cell_kinds[k]).dimension],
                groups.of_kind[k], groups.first[k]);
  out << "$EndElements\n";
}

/// Writes data whose value for each cell is `value_of(kind, cell)`.
template <class ValueOf>
void write_data(FileWriter& out, std::string_view name, const CellGroups& groups, const ValueOf& value_of) {
  out << "$ElementData\n1\n\"" << name << "\"\n1\n0\n3\n0\n1\n" << groups.count << '\n';
  for (std::size_t k = 0; k < cell_kinds; ++k) {
    const std::vector<Index>& members = groups.of_kind[k].members;
    write_each(out, members.size(), [&](TextBuffer& text, std::size_t i) {
      text << groups.first[k] + members[i] << ' ' << value_of(all_cell_kinds[k], members[i]) << '\n';
    });
  }
  out << "$EndElementData\n";
}

/// Returns a function that gives the values of tets, and 0 for other cells.
template <class T>
auto of_tets(const std::vector<T>& values) {
  return [&values](CellKind kind, Index i) { return kind == CellKind::tet ? values[i] : T{0}; };
}

/// Returns for each partition the number of a new volume, which Gmsh fills with the ghosts of the partition.
std::vector<int> ghost_volumes(const MshParts& parts) {
  int number = 0;
  for (const MshEntity& volume : parts.entities.of_dimension[3]) number = std::max(number, volume.number);
  std::vector<int> numbers;
  for (std::size_t i = 0; i < parts.numbers.size(); ++i) numbers.push_back(++number);
  return numbers;
}

void write(const std::string& path, const TetMesh& mesh, bool with_ghosts) {
  FileWriter out(path);
  const MshEntities entities = find_entities(mesh);
  std::optional<MshParts> parts;
  if (!mesh.tet_partition.empty()) parts = divide_entities(mesh, entities);
  const MshEntities& holders = parts ? parts->entities : entities;  // the entities of cells
  const CellGroups groups(mesh, holders);
  out << "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Comments\nWritten by collarmesh.\n";
  if (entities.numbers_are_features) out << msh_numbers_are_features << '\n';
  out << "$EndComments\n";
  write_physical_names(out, mesh, entities.physicals);
  write_entities(out, entities);
  if (parts) write_partition_entities(out, *parts, with_ghosts ? ghost_volumes(*parts) : std::vector<int>());
  write_nodes(out, mesh, holders);
  write_elements(out, mesh, holders, groups);
  write_msh_links(out, find_msh_links(mesh, entities), 4);
  if (parts && with_ghosts) write_ghost_elements(out, mesh, *parts);
  if (!mesh.tets.empty()) {
    write_data(out, "collar", groups, of_tets(mesh.tet_collar));
    write_data(out, "crease", groups, of_tets(mesh.tet_crease));
  }
  if (!mesh.tet_thin.empty()) write_data(out, "thin", groups, of_tets(mesh.tet_thin));
  if (!mesh.layers.empty())
    write_data(out, "layer", groups, [&](CellKind kind, Index i) { return layer_of(mesh, kind, i); });
  out.commit();
}

}  // namespace

void write_msh(const std::string& path, const TetMesh& mesh) { write(path, mesh, false); }
void write_msh_with_ghost_cells(const std::string& path, const TetMesh& mesh) { write(path, mesh, true); }

}  // namespace collarmesh::io
