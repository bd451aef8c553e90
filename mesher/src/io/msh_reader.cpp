// Reads Gmsh's formats 4.1 and 2 (text and binary) and 4.0 (text): tetrahedra, prisms, pyramids, triangles,
// quadrangles and lines of first and second order. A cell's tag is its physical group or, without one, its
// entity. Skips ghost elements and the elements that Gmsh adds between partitions.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <optional>
#include <string_view>
#include <vector>

#include "collarmesh/error.h"
#include "common/sort_uniquely.h"
#include "io/cell_nodes.h"
#include "io/complete_mesh.h"
#include "io/file_bytes.h"
#include "io/label_names.h"
#include "io/msh_format.h"
#include "io/msh_sections.h"
#include "io/tet_mesh_formats.h"

namespace collarmesh::io {

namespace {

struct Node {
  std::uint64_t number = 0;
  Point point;
  std::uint8_t dimension = 3;
  int entity = 0;
};

struct Cell {
  std::uint64_t number = 0;
  CellKind kind = CellKind::tet;
  CellNodes nodes;  ///< positions in Contents::nodes
  int entity = 0;
  Tag tag = 0;
  Index partition = none;
};

/// A part of an entity, in one partition or between several; only the first partition is stored.
struct PartitionEntity {
  std::size_t parent_dimension = 0;
  int parent = 0;
  Index partition = none;
};

/// A surface whose mesh is the moved mesh of another surface, its master.
struct SurfaceLink {
  int entity = 0, master = 0;
  TetMesh::Motion motion;
  std::vector<std::array<std::uint64_t, 2>> nodes;  ///< numbers of a node of the master and of its image
};

struct Contents {
  std::vector<Node> nodes;                               ///< in the order of their numbers
  bool dense = false;                                    ///< the numbers are 1, 2, ...
  std::array<std::vector<Cell>, 4> cells;                ///< by dimension
  std::array<std::map<int, Tag>, 4> physical_of_entity;  ///< its first physical group
  std::array<std::map<int, PartitionEntity>, 4> partition_entities;
  std::array<std::map<Tag, Tag>, 4> tag_of_physical;  ///< the tag of a group, if the group's name determines
                                                      ///< it
  /// Data of cells by name: cell number and value.
  std::map<std::string, std::vector<std::pair<std::uint64_t, double>>, std::less<>> data{
      {"collar", {}}, {"crease", {}}, {"thin", {}}, {"layer", {}}};
  TagNames names;  ///< names of tags, where given
  std::vector<SurfaceLink> links;
  bool numbers_are_features = false;
};

Tag tag_of_physical(const Contents& contents, std::size_t dimension, Tag physical) {
  const auto named = contents.tag_of_physical[dimension].find(physical);
  return named != contents.tag_of_physical[dimension].end() ? named->second : physical;
}

/// Returns the entity that this one is a part of, or itself.
int whole_entity(const Contents& contents, std::size_t dimension, int entity) {
  const auto part = contents.partition_entities[dimension].find(entity);
  return part == contents.partition_entities[dimension].end() ? entity : part->second.parent;
}

Tag tag_of_entity(const Contents& contents, std::size_t dimension, int entity) {
  entity = whole_entity(contents, dimension, entity);
  const auto found = contents.physical_of_entity[dimension].find(entity);
  return found == contents.physical_of_entity[dimension].end()
             ? entity
             : tag_of_physical(contents, dimension, found->second);
}

template <class Item>
void sort_by_number(std::vector<Item>& items) {
  const auto less = [](const Item& a, const Item& b) { return a.number < b.number; };
  if (!std::is_sorted(items.begin(), items.end(), less)) std::stable_sort(items.begin(), items.end(), less);
}

template <class Values>
void sort_nodes(Values& values, Contents& contents) {
  std::vector<Node>& nodes = contents.nodes;
  // Cells refer to nodes by their positions, which sorting changes.
  for (const std::vector<Cell>& cells : contents.cells)
    if (!cells.empty()) values.fail("the nodes come after elements; save all nodes first");
  sort_by_number(nodes);
  const auto twice = std::adjacent_find(nodes.begin(), nodes.end(),
                                        [](const Node& a, const Node& b) { return a.number == b.number; });
  if (twice != nodes.end()) values.fail(fmt::format("two nodes have the number {}", twice->number));
  contents.dense = !nodes.empty() && nodes.front().number == 1 && nodes.back().number == nodes.size();
}

/// Returns the position of the node with this number; `none` if no node has it.
Index find_node(const Contents& contents, std::uint64_t number) {
  const std::vector<Node>& nodes = contents.nodes;
  if (contents.dense) return number - 1 < nodes.size() ? static_cast<Index>(number - 1) : none;
  const auto found = std::ranges::lower_bound(nodes, number, {}, &Node::number);
  return found != nodes.end() && found->number == number ? static_cast<Index>(found - nodes.begin()) : none;
}

template <class Values>
Index read_corner(Values& values, const Contents& contents) {
  const std::uint64_t number = values.number("a node of an element");
  const Index node = find_node(contents, number);
  if (node == none)
    values.fail(fmt::format("an element has the node {}, but no node has that number", number));
  return node;
}

template <class Values>
CellNodes read_cell_nodes(Values& values, const Contents& contents, const GmshType& type) {
  CellNodes nodes;
  for (std::size_t k = 0; k < type.nodes(); ++k) nodes.add(read_corner(values, contents));
  return nodes.from_order(type.node_order());
}

template <class Values>
std::size_t read_dimension(Values& values) {
  const int dimension = values.integer("the dimension of an entity");
  if (dimension < 0 || dimension > 3)
    values.fail(fmt::format("the dimension of an entity is {}, but must be from 0 to 3", dimension));
  return static_cast<std::size_t>(dimension);
}

/// Returns the type of elements that has this number; null if they are points, which are skipped.
template <class Values>
const GmshType* find_type(Values& values, int number) {
  if (number == gmsh_point) return nullptr;
  for (const GmshType& type : gmsh_types)
    if (type.number == number) return &type;
  values.fail(
      fmt::format("elements of type {} are not supported, only tetrahedra (4, 11), prisms (6, 18), pyramids "
                  "(7, 19), triangles (2, 9), quadrangles (3, 16) and lines (1, 8)",
                  number));
}

void read_physical_names(MshText values, Contents& contents) {
  const Index n = values.count("the number of physical names", 3);
  for (Index i = 0; i < n; ++i) {
    const std::size_t dimension = read_dimension(values);
    const int physical = values.integer("the number of a physical group");
    std::string_view name = values.text().rest_of_line();
    if (name.size() >= 2) name = name.substr(1, name.size() - 2);  // the quotes
    const auto tag = tag_of_group_name(dimension, name);
    if (tag) contents.tag_of_physical[dimension][physical] = *tag;
    if (!name.empty() && is_given_name(dimension, name))
      contents.names.set(dimension, tag.value_or(physical), std::string(name));
  }
}

/// Reads the box, the physical groups and the boundary of an entity. Returns its first group, if there is
/// one. `point_numbers`: how many numbers give the place of a point: 3 coordinates or, in version 4.0, the 6
/// of a box.
template <class Values>
std::optional<Tag> read_rest_of_entity(Values& values, std::size_t dimension, int point_numbers) {
  for (int k = 0; k < (dimension == 0 ? point_numbers : 6); ++k) values.real("the box of an entity");
  std::optional<Tag> first;
  const Index physicals = values.count("the number of physical groups", 1);
  for (Index k = 0; k < physicals; ++k) {
    const Tag physical = std::abs(Tag{values.integer("a physical group")});
    if (!first) first = physical;
  }
  const Index boundary = dimension == 0 ? 0 : values.count("the number of bounding entities", 1);
  for (Index k = 0; k < boundary; ++k) values.integer("a bounding entity");
  return first;
}

template <class Values>
void read_partition_entities(Values values, int point_numbers, Contents& contents) {
  values.number("the number of partitions");
  const Index ghosts = values.count("the number of ghost entities", 2);
  for (Index i = 0; i < ghosts; ++i) {
    values.integer("a ghost entity");
    values.integer("the partition of a ghost entity");
  }
  std::array<Index, 4> counts;
  for (Index& count : counts) count = values.count("the number of partition entities", 6);
  for (std::size_t dimension = 0; dimension < 4; ++dimension)
    for (Index i = 0; i < counts[dimension]; ++i) {
      const int number = values.integer("the number of a partition entity");
      PartitionEntity entity;
      entity.parent_dimension = read_dimension(values);
      entity.parent = values.integer("the number of a parent entity");
      const Index partitions = values.count("the number of partitions of an entity", 1);
      for (Index k = 0; k < partitions; ++k) {
        const int partition = values.integer("a partition");
        if (partition < 1)
          values.fail(fmt::format("a partition has the number {}; partitions are counted from 1", partition));
        if (k == 0) entity.partition = static_cast<Index>(partition) - 1;
      }
      read_rest_of_entity(values, dimension, point_numbers);
      contents.partition_entities[dimension].insert_or_assign(number, entity);
    }
}

template <class Values>
void read_entities(Values values, int point_numbers, Contents& contents) {
  std::array<Index, 4> counts;
  for (Index& count : counts) count = values.count("the number of entities", 4);
  for (std::size_t dimension = 0; dimension < 4; ++dimension)
    for (Index i = 0; i < counts[dimension]; ++i) {
      const int number = values.integer("the number of an entity");
      if (const std::optional<Tag> physical = read_rest_of_entity(values, dimension, point_numbers))
        contents.physical_of_entity[dimension].try_emplace(number, *physical);
    }
}

struct EntityOfBlock {
  std::size_t dimension;
  int number;
};
/// Reads the entity of a block. In version 4.0 its number comes before its dimension.
template <class Values>
EntityOfBlock read_entity_of_block(Values& values, bool is_version_40) {
  const int first = is_version_40 ? values.integer("the number of an entity") : 0;
  const std::size_t dimension = read_dimension(values);
  return {dimension, is_version_40 ? first : values.integer("the number of an entity")};
}

/// Reads nodes. In version 4.0 each node's number is followed by its coordinates; in 4.1 all numbers of a
/// block come before the coordinates.
template <class Values>
void read_nodes(Values values, bool is_version_40, Contents& contents) {
  const Index blocks = values.count("the number of blocks", 4);
  const Index total = values.count("the number of nodes", 4);
  if (!is_version_40) {
    values.number("the smallest number of a node");
    values.number("the largest number of a node");
  }
  contents.nodes.reserve(total);
  for (Index b = 0; b < blocks; ++b) {
    const EntityOfBlock entity_of_block = read_entity_of_block(values, is_version_40);
    const int entity = whole_entity(contents, entity_of_block.dimension, entity_of_block.number);
    const int parametric = values.integer("the flag for parametric nodes");
    const Index n = values.count("the number of nodes of a block", 4);
    const auto read_place = [&](Node& node) {
      node.point = values.point("a coordinate of a node");
      for (std::size_t k = 0; parametric != 0 && k < entity_of_block.dimension; ++k)
        values.real("a parameter of a node");
    };
    const std::size_t first = contents.nodes.size();
    for (Index i = 0; i < n; ++i) {
      contents.nodes.push_back({values.number("the number of a node"),
                                {},
                                static_cast<std::uint8_t>(entity_of_block.dimension),
                                entity});
      if (is_version_40) read_place(contents.nodes.back());
    }
    if (!is_version_40)
      for (std::size_t i = first; i < contents.nodes.size(); ++i) read_place(contents.nodes[i]);
  }
  if (contents.nodes.size() != total)
    values.fail(fmt::format("expected {} nodes, found {}", total, contents.nodes.size()));
  sort_nodes(values, contents);
}

/// Skips an element that is a point.
template <class Values>
void read_point(Values& values, const Contents& contents) {
  values.number("the number of an element");
  read_corner(values, contents);
}

template <class Values>
void read_cells_of_block(Values& values, const GmshType* type, int entity, Tag tag, Index count,
                         Contents& contents) {
  if (type == nullptr) {
    for (Index i = 0; i < count; ++i) read_point(values, contents);
    return;
  }
  Cell cell;
  cell.kind = type->kind;
  cell.entity = entity;
  cell.tag = tag;
  bool between_partitions = false;  // whether Gmsh added the elements between partitions; they are not
                                    // part of the mesh
  const auto& parts = contents.partition_entities[type->dimension()];
  if (const auto part = parts.find(entity); part != parts.end()) {
    cell.entity = part->second.parent;
    cell.partition = part->second.partition;
    between_partitions = part->second.parent_dimension != type->dimension();
  }
  for (Index i = 0; i < count; ++i) {
    cell.number = values.number("the number of an element");
    cell.nodes = read_cell_nodes(values, contents, *type);
    if (!between_partitions) contents.cells[type->dimension()].push_back(cell);
  }
}

template <class Values>
void read_elements(Values values, bool is_version_40, Contents& contents) {
  const Index blocks = values.count("the number of blocks", 4);
  const Index total = values.count("the number of elements", 2);
  if (!is_version_40) {
    values.number("the smallest number of an element");
    values.number("the largest number of an element");
  }
  std::size_t found = 0;
  for (Index b = 0; b < blocks; ++b) {
    const EntityOfBlock entity_of_block = read_entity_of_block(values, is_version_40);
    const GmshType* type = find_type(values, values.integer("the type of elements"));
    const Index n = values.count("the number of elements of a block", 2);
    found += n;
    read_cells_of_block(values, type, entity_of_block.number,
                        tag_of_entity(contents, entity_of_block.dimension, entity_of_block.number), n,
                        contents);
  }
  if (!is_version_40 && found != total)
    values.fail(fmt::format("expected {} elements, found {}", total, found));
}

/// Reads links. Keeps the links of surfaces that have a matrix.
template <class Values>
void read_periodic(Values values, Contents& contents) {
  constexpr Index matrix = 16;
  const Index count = values.count("the number of links", 5);
  for (Index i = 0; i < count; ++i) {
    const std::size_t dimension = read_dimension(values);
    SurfaceLink link;
    link.entity = values.integer("the number of an entity");
    link.master = values.integer("the number of its master");
    const Index numbers = values.count("the number of values of a matrix", 1);
    for (Index k = 0; k < numbers; ++k) {
      const double value = values.real("a value of a matrix");
      if (k / 4 < 3 && k % 4 == 3)
        link.motion.shift[k / 4] = value;
      else if (k / 4 < 3)
        link.motion.rows[k / 4][k % 4] = value;
    }
    const Index nodes = values.count("the number of nodes of a link", 2);
    for (Index k = 0; k < nodes; ++k) {
      const std::uint64_t node = values.number("a node of a link");
      link.nodes.push_back({values.number("a node of a link"), node});
    }
    if (dimension == 2 && numbers == matrix) contents.links.push_back(std::move(link));
  }
}

// Version 2. Its counts are text even in binary files.

template <class Values>
void read_nodes_2(Values values, Contents& contents) {
  const Index n = values.count("the number of nodes", 4);
  contents.nodes.reserve(n);
  for (Index i = 0; i < n; ++i) {
    Node node;
    node.number = values.number("the number of a node");
    node.point = values.point("a coordinate of a node");
    contents.nodes.push_back(node);
  }
  sort_nodes(values, contents);
}

/// Reads the rest of an element: its tags (physical group, entity, partitions), then its nodes.
template <class Values>
void read_element_2(Values& values, const GmshType* type, std::uint64_t number, int tags,
                    Contents& contents) {
  Cell cell;
  cell.number = number;
  Tag physical = 0;
  for (int k = 0; k < tags; ++k) {
    const int tag = values.integer("a tag of an element");
    if (k == 0) physical = std::abs(Tag{tag});
    if (k == 1) cell.entity = tag;
    if (k == 3 && tag > 0) cell.partition = static_cast<Index>(tag) - 1;  // k == 2: the number of partitions
  }
  if (type == nullptr) {
    read_corner(values, contents);
    return;
  }
  cell.kind = type->kind;
  cell.nodes = read_cell_nodes(values, contents, *type);
  cell.tag = physical != 0 ? tag_of_physical(contents, type->dimension(), physical) : cell.entity;
  contents.cells[type->dimension()].push_back(cell);
}

void read_elements_2(MshText values, Contents& contents) {
  const Index n = values.count("the number of elements", 4);
  for (Index i = 0; i < n; ++i) {
    const std::uint64_t number = values.number("the number of an element");
    const GmshType* type = find_type(values, values.integer("the type of an element"));
    const auto tags = static_cast<int>(values.count("the number of tags", 1));
    read_element_2(values, type, number, tags, contents);
  }
}

/// Reads elements, which come in blocks of one type.
void read_elements_2(MshBinary2 values, Contents& contents) {
  const Index n = values.count("the number of elements", 4);
  for (Index i = 0; i < n;) {
    const GmshType* type = find_type(values, values.integer("the type of elements"));
    const int of_block = values.integer("the number of elements of a block"),
              tags = values.integer("the number of tags");
    if (of_block < 1 || static_cast<Index>(of_block) > n - i || tags < 0)
      values.fail(
          fmt::format("a block has {} elements with {} tags each, but must have from 1 to {} elements, and "
                      "at least 0 tags",
                      of_block, tags, n - i));
    for (int k = 0; k < of_block; ++k, ++i)
      read_element_2(values, type, values.number("the number of an element"), tags, contents);
  }
}

/// The head of $NodeData and $ElementData before the values; text even in binary files.
struct DataHead {
  std::string name;
  int components = 1, count = 0;
  std::size_t lines = 3;  ///< number of lines that the head takes
};

DataHead read_data_head(MshText& values) {
  DataHead head;
  const Index strings = values.count("the number of texts", 1);
  if (strings > 0) values.text().skip_line();
  for (Index i = 0; i < strings; ++i) {
    const std::string text(values.text().rest_of_line());
    if (i == 0) head.name = text.size() > 1 && text.front() == '"' ? text.substr(1, text.size() - 2) : text;
  }
  const Index reals = values.count("the number of reals", 1);
  for (Index i = 0; i < reals; ++i) values.real("a real");
  const Index integers = values.count("the number of integers", 1);
  for (Index i = 0; i < integers; ++i) {
    const int value = values.integer("an integer");
    if (i == 1) head.components = value;
    if (i == 2) head.count = value;
  }
  head.lines += std::size_t{strings} + reals + integers;
  return head;
}

void read_data(MshText values, Contents& contents) {
  const DataHead head = read_data_head(values);
  const auto data = contents.data.find(head.name);
  if (data == contents.data.end()) return;
  if (head.components != 1)
    values.fail(fmt::format("{} has {} components, but has to have 1", head.name, head.components));
  for (int i = 0; i < head.count; ++i) {
    const std::uint64_t number = values.number("the number of an element");
    data->second.emplace_back(number, values.real("a value for an element"));
  }
}

struct MshFormat {
  double version = 0;
  bool binary = false;
  std::endian order = std::endian::little;
};

MshFormat read_format(const std::string& path, const MshSection& section) {
  MshText values(path, section);
  if (section.name != "MeshFormat") values.fail("expected $MeshFormat first");
  MshFormat format;
  format.version = values.real("the version");
  format.binary = values.integer("0 for text or 1 for binary") != 0;
  const int size = values.integer("the size of numbers");
  const bool known = format.version == 4.1 || (format.version >= 2 && format.version < 3) ||
                     (format.version == 4.0 && !format.binary);
  if (!known)
    values.fail(fmt::format("version {}{} is not supported, only 4.1, 4 as text and 2; let Gmsh convert it",
                            format.version, format.binary ? " (binary)" : ""));
  if (size != 8) values.fail(fmt::format("numbers of {} bytes are not supported, only of 8", size));
  if (!format.binary) return format;
  const std::size_t one = std::min(section.body.find('\n') + 1, section.body.size());
  if (ByteReader(path, section.body.substr(one), format.order, section.first_byte + one)
          .get<std::int32_t>("the number 1") != 1)
    format.order = std::endian::big;
  return format;
}

/// Calls `read` with a reader of the values of a section, text or binary as the format says.
template <class Binary, class Read>
void with_values(const std::string& path, const MshSection& section, const MshFormat& format, Read read) {
  if (format.binary)
    read(Binary(path, section, format.order));
  else
    read(MshText(path, section));
}

void read_section(const std::string& path, const MshSection& section, const MshFormat& format,
                  Contents& contents) {
  const bool is_version_40 = format.version == 4.0;
  const int point_numbers = is_version_40 ? 6 : 3;
  const auto with_any = [&](auto read) { with_values<MshBinary>(path, section, format, read); };
  const auto with_version_2 = [&](auto read) { with_values<MshBinary2>(path, section, format, read); };
  if (section.name == "PhysicalNames")
    read_physical_names(MshText(path, section), contents);
  else if (section.name == "Comments")
    contents.numbers_are_features = section.body.find(msh_numbers_are_features) != std::string_view::npos;
  else if (section.name == "Entities" && format.version >= 4)
    with_any([&](auto values) { read_entities(values, point_numbers, contents); });
  else if (section.name == "PartitionedEntities" && format.version >= 4)
    with_any([&](auto values) { read_partition_entities(values, point_numbers, contents); });
  else if (section.name == "Nodes" && format.version < 4)
    with_version_2([&](auto values) { read_nodes_2(values, contents); });
  else if (section.name == "Nodes")
    with_any([&](auto values) { read_nodes(values, is_version_40, contents); });
  else if (section.name == "Elements" && format.version < 4)
    with_version_2([&](auto values) { read_elements_2(values, contents); });
  else if (section.name == "Elements")
    with_any([&](auto values) { read_elements(values, is_version_40, contents); });
  else if (section.name == "Periodic" && format.version > 4)
    with_any([&](auto values) { read_periodic(values, contents); });
  else if (section.name == "ElementData" && !format.binary)
    read_data(MshText(path, section), contents);
}

void add_cells(const std::vector<Cell>& cells, TetMesh& mesh) {
  for (const Cell& cell : cells) {
    add_cell(cell.kind, cell.nodes, mesh);
    tags_of(mesh, cell.kind).push_back(cell.tag);
  }
}

Index feature_of(int entity) { return static_cast<Index>(entity) - 1; }

/// Adds partitions if all cells with volume are tets and each has a partition.
void add_partitions(const std::vector<Cell>& volumes, TetMesh& mesh) {
  for (const Cell& cell : volumes) {
    if (cell.partition == none || cell.kind != CellKind::tet) {
      mesh.tet_partition.clear();
      return;
    }
    mesh.tet_partition.push_back(cell.partition);
  }
}

void add_features(const Contents& contents, TetMesh& mesh) {
  for (std::size_t dimension = 1; dimension <= 3; ++dimension)
    for (const Cell& cell : contents.cells[dimension])
      features_of(mesh, cell.kind)
          .push_back(dimension == 3 ? static_cast<Index>(cell.entity) : feature_of(cell.entity));
  for (const Node& node : contents.nodes)
    mesh.features.push_back({node.dimension, node.dimension == 3 ? none : feature_of(node.entity)});
}

/// Adds to `data` one value for each cell of a kind, limited to [least, most]; 0 for a cell without one. Adds
/// nothing if the file has no data with this name.
template <class T>
void add_data(Contents& contents, std::string_view name, CellKind kind, double least, double most,
              std::vector<T>& data) {
  auto& values = contents.data.find(name)->second;
  if (values.empty()) return;
  if (!std::is_sorted(values.begin(), values.end())) std::sort(values.begin(), values.end());
  for (const Cell& cell : contents.cells[3]) {
    if (cell.kind != kind) continue;
    const auto found = std::lower_bound(values.begin(), values.end(),
                                        std::pair(cell.number, -std::numeric_limits<double>::infinity()));
    const bool given = found != values.end() && found->first == cell.number;
    data.push_back(given ? static_cast<T>(std::clamp(found->second, least, most)) : 0);
  }
}

void add_once(Tag tag, std::vector<Tag>& tags) {
  const auto at = std::lower_bound(tags.begin(), tags.end(), tag);
  if (at == tags.end() || *at != tag) tags.insert(at, tag);
}

/// Adds periodic faces: all links with one motion become one pair of groups of patches. Call it only for our
/// own files, in which all patches with a linked surface's tag belong to the periodic faces.
void add_periodic(const Contents& contents, TetMesh& mesh) {
  for (const SurfaceLink& link : contents.links) {
    const auto alike = [&](const TetMesh::PeriodicFaces& faces) {
      return faces.motion.rows == link.motion.rows && faces.motion.shift == link.motion.shift;
    };
    auto faces = std::find_if(mesh.periodic.begin(), mesh.periodic.end(), alike);
    if (faces == mesh.periodic.end())
      faces = mesh.periodic.insert(faces, TetMesh::PeriodicFaces{{}, {}, link.motion, {}});
    add_once(tag_of_entity(contents, 2, link.master), faces->first);
    add_once(tag_of_entity(contents, 2, link.entity), faces->second);
    for (const auto& [node, image] : link.nodes)
      if (const std::array<Index, 2> pair{find_node(contents, node), find_node(contents, image)};
          pair[0] != none && pair[1] != none)
        faces->nodes.push_back(pair);
  }
  for (TetMesh::PeriodicFaces& faces : mesh.periodic) sort_uniquely(faces.nodes);
}

/// Returns the mesh. Its points and cells are in the order of their numbers in the file.
TetMesh make_mesh(const std::string& path, Contents& contents) {
  TetMesh mesh;
  for (const Node& node : contents.nodes) mesh.points.push_back(node.point);
  for (std::vector<Cell>& cells : contents.cells) sort_by_number(cells);
  for (const std::size_t dimension : {3, 2, 1}) add_cells(contents.cells[dimension], mesh);
  if (contents.numbers_are_features) {
    add_features(contents, mesh);
    add_periodic(contents, mesh);
  }
  add_data(contents, "collar", CellKind::tet, 0, 2, mesh.tet_collar);
  constexpr double most = 0x1p52;  // integers up to here are exact in doubles
  add_data(contents, "crease", CellKind::tet, -most, most, mesh.tet_crease);
  add_data(contents, "thin", CellKind::tet, 0, 1, mesh.tet_thin);
  for (const CellKind kind : {CellKind::tet, CellKind::prism, CellKind::pyramid})
    add_data(contents, "layer", kind, 0, most_layers - 1, layers_of(mesh, kind));
  add_partitions(contents.cells[3], mesh);
  mesh.names = contents.names;
  complete_mesh(path, mesh);
  return mesh;
}

}  // namespace

namespace {

using NodeValues = std::vector<std::pair<std::uint64_t, double>>;

NodeValues read_node_values(const std::string& path, const MshSection& section, const MshFormat& format) {
  MshText text(path, section);
  const DataHead head = read_data_head(text);
  NodeValues values;
  if (!format.binary) {
    for (int i = 0; i < head.count; ++i) {
      const std::uint64_t number = text.number("the number of a node");
      values.emplace_back(number, text.real("a value"));
    }
    return values;
  }
  std::size_t at = 0;
  for (std::size_t line = 0; line < head.lines; ++line)
    at = std::min(section.body.find('\n', at), section.body.size() - 1) + 1;
  ByteReader bytes(path, section.body.substr(at), format.order, section.first_byte + at);
  for (int i = 0; i < head.count; ++i) {
    const auto number = bytes.get<std::int32_t>("the number of a node");
    values.emplace_back(static_cast<std::uint64_t>(number), bytes.get<double>("a value"));
  }
  return values;
}

struct MshFile {
  std::string text;
  std::vector<MshSection> sections;
  MshFormat format;

  explicit MshFile(const std::string& path) : text(read_bytes(path)), sections(split_msh(path, text)) {
    if (sections.empty()) TextScanner(path, text).fail("expected $MeshFormat, found the end of the file");
    format = read_format(path, sections.front());
  }

  Contents contents(const std::string& path, bool needs_tets = true) const {
    Contents contents;
    for (const MshSection& section : sections) read_section(path, section, format, contents);
    if (needs_tets && contents.cells[3].empty())
      throw ReadError(
          fmt::format("{}: line {}: expected tetrahedra, found none", path, sections.back().first_line));
    return contents;
  }
};

}  // namespace

TetMesh read_msh(const std::string& path) {
  Contents contents = MshFile(path).contents(path);
  return make_mesh(path, contents);
}

TetMesh read_msh_cells(const std::string& path) {
  Contents contents = MshFile(path).contents(path, false);
  return make_mesh(path, contents);
}

PointField read_msh_field(const std::string& path, const std::string& name) {
  const MshFile file(path);
  std::vector<std::string> names;
  std::vector<const MshSection*> fields;
  for (const MshSection& section : file.sections) {
    if (section.name != "NodeData") continue;
    MshText text(path, section);
    const DataHead head = read_data_head(text);
    if (head.components != 1) continue;
    names.push_back(head.name);
    fields.push_back(&section);
  }
  const std::size_t chosen = choose_field(path, names, name);
  Contents contents = file.contents(path);
  PointField field{{}, names[chosen], std::vector<double>(contents.nodes.size(), NAN)};
  for (const auto& [number, value] : read_node_values(path, *fields[chosen], file.format))
    if (const Index node = find_node(contents, number); node != none) field.values[node] = value;
  for (std::size_t i = 0; i < field.values.size(); ++i)
    if (std::isnan(field.values[i]))
      throw ReadError(
          fmt::format("{}: '{}' has no value at node {}", path, field.name, contents.nodes[i].number));
  field.mesh = make_mesh(path, contents);
  return field;
}

}  // namespace collarmesh::io
