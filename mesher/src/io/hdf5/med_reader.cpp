// Reads SALOME's format MED with its library: the first mesh of a file, its tetrahedra, prisms,
// pyramids, triangles, quadrangles and segments. Groups become tags: groups with names of ours become the
// tags that these stand for, others are numbered and keep their names.
#include <fmt/format.h>
#include <med.h>
#include <algorithm>

#include <array>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "collarmesh/error.h"
#include "io/cell_nodes.h"
#include "io/cell_partitions.h"
#include "io/complete_mesh.h"
#include "io/finite_points.h"
#include "io/hdf5/med_format.h"
#include "io/label_names.h"
#include "io/tet_mesh_formats.h"

namespace collarmesh::io {

namespace {

class MedReader {
 public:
  explicit MedReader(const std::string& path)
      : path_(path), file_(MEDfileOpen(path.c_str(), MED_ACC_RDONLY)) {
    if (file_ < 0) fail("is not a MED file, or not of a version that can be read");
  }
  ~MedReader() {
    if (file_ >= 0) MEDfileClose(file_);
  }
  MedReader(const MedReader&) = delete;
  MedReader& operator=(const MedReader&) = delete;

  TetMesh read() {
    find_mesh();
    read_families();
    read_points();
    for (const MedType& type : med_types)
      for (const int order : {1, 2}) read_cells(type, order);
    if (mesh_.tets.empty()) fail("expected tetrahedra, found none");
    read_partitions(mesh_.order() == 2 ? MED_TETRA10 : MED_TETRA4);
    complete_mesh(path_, mesh_);
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw ReadError(fmt::format("{}: {}", path_, message));
  }

  void find_mesh() {
    if (MEDnMesh(file_) < 1) fail("has no mesh");
    std::array<char, MED_NAME_SIZE + 1> name{};
    std::array<char, MED_COMMENT_SIZE + 1> comment{};
    std::array<char, MED_SNAME_SIZE + 1> time_unit{};
    std::array<char, 3 * MED_SNAME_SIZE + 1> axes{}, units{};
    med_int space = 0, dimension = 0, steps = 0;
    med_mesh_type type = MED_UNSTRUCTURED_MESH;
    med_sorting_type sorting = MED_SORT_DTIT;
    med_axis_type axis = MED_CARTESIAN;
    if (MEDmeshnAxis(file_, 1) != 3) fail("its mesh is not in three dimensions");
    if (MEDmeshInfo(file_, 1, name.data(), &space, &dimension, &type, comment.data(), time_unit.data(),
                    &sorting, &steps, &axis, axes.data(), units.data()) < 0)
      fail("its mesh cannot be read");
    if (type != MED_UNSTRUCTURED_MESH) fail("its mesh is structured; save it as an unstructured one");
    name_ = name.data();
  }

  /// Reads the first group of each family.
  void read_families() {
    const med_int count = MEDnFamily(file_, name_.c_str());
    for (med_int i = 1; i <= count; ++i) {
      const med_int groups = MEDnFamilyGroup(file_, name_.c_str(), static_cast<int>(i));
      if (groups < 1) continue;
      std::array<char, MED_NAME_SIZE + 1> family{};
      std::string names(static_cast<std::size_t>(groups) * MED_LNAME_SIZE + 1, '\0');
      med_int number = 0;
      if (MEDfamilyInfo(file_, name_.c_str(), static_cast<int>(i), family.data(), &number, names.data()) < 0)
        continue;
      std::string group = names.substr(0, std::min<std::size_t>(MED_LNAME_SIZE, names.find('\0')));
      group.erase(group.find_last_not_of(' ') + 1);
      if (number < 0 && !group.empty()) group_of_family_.emplace(number, std::move(group));
    }
  }

  med_int count_of(med_entity_type entity, med_geometry_type type, med_data_type data,
                   med_connectivity_mode mode) const {
    med_bool changed = MED_FALSE, moved = MED_FALSE;
    return MEDmeshnEntity(file_, name_.c_str(), MED_NO_DT, MED_NO_IT, entity, type, data, mode, &changed,
                          &moved);
  }

  void read_points() {
    const med_int count = count_of(MED_NODE, MED_NONE, MED_COORDINATE, MED_NO_CMODE);
    if (count < 1) fail("its mesh has no points");
    std::vector<double> values(3 * static_cast<std::size_t>(count));
    if (MEDmeshNodeCoordinateRd(file_, name_.c_str(), MED_NO_DT, MED_NO_IT, MED_FULL_INTERLACE,
                                values.data()) < 0)
      fail("its points cannot be read");
    mesh_.points = finite_points(values, [this](const std::string& message) { fail(message); });
  }

  void read_cells(const MedType& of, int order) {
    const med_geometry_type type = of.type(order);
    const std::size_t nodes_of_cell = of.node_order(order).size(), dimension = shape_of(of.kind).dimension;
    const med_int count = count_of(MED_CELL, type, MED_CONNECTIVITY, MED_NODAL);
    if (count < 1) return;
    const auto n = static_cast<std::size_t>(count);
    std::vector<med_int> nodes(n * nodes_of_cell), families(n, 0);
    if (MEDmeshElementConnectivityRd(file_, name_.c_str(), MED_NO_DT, MED_NO_IT, MED_CELL, type, MED_NODAL,
                                     MED_FULL_INTERLACE, nodes.data()) < 0)
      fail("its cells cannot be read");
    // Without families no cell is in a group.
    if (MEDmeshEntityFamilyNumberRd(file_, name_.c_str(), MED_NO_DT, MED_NO_IT, MED_CELL, type,
                                    families.data()) < 0)
      families.assign(n, 0);
    for (std::size_t i = 0; i < n; ++i) {
      CellNodes cell;
      for (std::size_t k = 0; k < nodes_of_cell; ++k) {
        const med_int node = nodes[i * nodes_of_cell + k];
        if (node < 1 || static_cast<std::size_t>(node) > mesh_.points.size())
          fail(fmt::format("a cell has the node {}, but there are {}", node, mesh_.points.size()));
        cell.add(static_cast<Index>(node - 1));
      }
      add_cell(of.kind, cell.from_order(of.node_order(order)), mesh_);
      tags_of(mesh_, of.kind).push_back(tag_of(dimension, families[i]));
    }
  }

  /// Reads the partitions in our own files: the values of the mesh's field `partition` on tets.
  void read_partitions(med_geometry_type type) {
    const med_int fields = MEDnField(file_);
    for (int i = 1; i <= static_cast<int>(fields); ++i) {
      const med_int components = MEDfieldnComponent(file_, i);
      if (components != 1) continue;
      std::array<char, MED_NAME_SIZE + 1> name{}, mesh{};
      std::array<char, MED_SNAME_SIZE + 1> component{}, unit{}, time_unit{};
      med_bool local = MED_FALSE;
      med_field_type kind = MED_FLOAT64;
      med_int steps = 0;
      if (MEDfieldInfo(file_, i, name.data(), mesh.data(), &local, &kind, component.data(), unit.data(),
                       time_unit.data(), &steps) < 0 ||
          name.data() != std::string_view(med_partition_field) || name_ != mesh.data() || kind != MED_INT)
        continue;
      std::vector<med_int> values(mesh_.tets.size());
      if (MEDfieldnValue(file_, name.data(), MED_NO_DT, MED_NO_IT, MED_CELL, type) !=
              static_cast<med_int>(values.size()) ||
          MEDfieldValueRd(file_, name.data(), MED_NO_DT, MED_NO_IT, MED_CELL, type, MED_FULL_INTERLACE,
                          MED_ALL_CONSTITUENT, reinterpret_cast<unsigned char*>(values.data())) < 0)
        continue;
      if (std::all_of(values.begin(), values.end(),
                      [](med_int p) { return p >= 0 && static_cast<std::int64_t>(p) < most_partitions; }))
        mesh_.tet_partition.assign(values.begin(), values.end());
    }
  }

  Tag tag_of(std::size_t dimension, med_int family) {
    const auto found = group_of_family_.find(family);
    if (found == group_of_family_.end()) return 0;
    const Tag tag = tags_.find(dimension, found->second);
    if (is_given_name(dimension, found->second)) mesh_.names.set(dimension, tag, found->second);
    return tag;
  }

  const std::string& path_;
  med_idt file_;
  std::string name_;
  std::map<med_int, std::string> group_of_family_;
  GroupTags tags_;
  TetMesh mesh_;
};

}  // namespace

TetMesh read_med(const std::string& path) { return MedReader(path).read(); }

}  // namespace collarmesh::io
