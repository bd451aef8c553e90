#pragma once

#include <array>
#include <map>
#include <vector>

#include "collarmesh/tet_mesh.h"
#include "io/cell_nodes.h"
#include "io/file_writer.h"

namespace collarmesh::io {

/// An entity of Gmsh: a point, curve, surface or volume with a number. Every cell and node of a mesh belongs
/// to an entity, and the entities of one dimension with one tag form a physical group.
struct MshEntity {
  int number = 0;  ///< positive, unique in its dimension
  Tag tag = 0;
  int physical = 0;  ///< number of the physical group; 0: none
  Box box;
  std::vector<int> boundary;  ///< a volume's surfaces, negative where they point inwards
};

/// Numbers of physical groups by dimension and tag.
using MshPhysicals = std::array<std::map<Tag, int>, 4>;
void write_physical_names(FileWriter& out, const TetMesh& mesh, const MshPhysicals& numbers);

struct MshEntities {
  std::array<std::vector<MshEntity>, 4> of_dimension;
  /// The entity (position in of_dimension) of every cell.
  PerKind<std::vector<Index>> of_cell;
  struct Place {
    std::uint8_t dimension = 3;
    Index entity = 0;
  };
  std::vector<Place> of_point;
  MshPhysicals physicals;
  bool numbers_are_features = false;
};

MshEntities find_entities(const TetMesh& mesh);

/// The entities of a partitioned mesh, divided into parts: one part for each pair of an entity and a
/// partition that has some of the entity's cells or points. Points belong to the lowest partition around
/// them.
struct MshParts {
  struct Part {
    int parent = 0;  ///< number of the whole entity
    Index partition = 0;
  };
  MshEntities entities;                           ///< physicals is empty
  std::array<std::vector<Part>, 4> of_dimension;  ///< by part, as in entities.of_dimension
  std::vector<Index> numbers;                     ///< numbers of the partitions that have tets, ascending
  std::size_t partitions = 0;                     ///< number of partitions, counting those without tets
};

MshParts divide_entities(const TetMesh& mesh, const MshEntities& whole);

}  // namespace collarmesh::io
