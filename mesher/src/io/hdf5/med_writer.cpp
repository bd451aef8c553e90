// SALOME's format MED (.med), written with its library: one unstructured mesh, named like the file, of
// volumes, faces and segments. Each tag has a family, in a group named as in label_names.h. Partitions are
// the whole numbers of a field on the cells.
#include <fmt/format.h>
#include <med.h>

#include <array>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "io/cell_nodes.h"
#include "io/cell_partitions.h"
#include "io/hdf5/med_format.h"
#include "io/label_names.h"
#include "io/tet_mesh_formats.h"
#include "io/unfinished_file.h"

namespace collarmesh::io {

namespace {

/// Pads a text: MED's texts have a fixed size.
std::string padded(std::string text, std::size_t size) {
  text.resize(size, '\0');
  return text;
}

class MedFile {
 public:
  MedFile(std::string path, const TetMesh& mesh)
      : name_(std::filesystem::path(path).stem().string().substr(0, MED_NAME_SIZE)),
        target_(std::move(path)),
        mesh_(mesh),
        file_(MEDfileOpen(target_.temporary().c_str(), MED_ACC_CREAT)) {
    require(file_);
  }
  ~MedFile() {
    if (file_ >= 0) MEDfileClose(file_);
  }
  MedFile(const MedFile&) = delete;
  MedFile& operator=(const MedFile&) = delete;

  void create_mesh() const {
    const std::string axes =
        padded("x", MED_SNAME_SIZE) + padded("y", MED_SNAME_SIZE) + padded("z", MED_SNAME_SIZE);
    const std::string units(3 * MED_SNAME_SIZE, '\0');
    require(MEDmeshCr(file_, name_.c_str(), 3, 3, MED_UNSTRUCTURED_MESH, "Written by collarmesh.", "",
                      MED_SORT_DTIT, MED_CARTESIAN, axes.c_str(), units.c_str()));
    require(MEDfamilyCr(file_, name_.c_str(), "FAMILLE_ZERO", 0, 0, ""));
  }

  void write_points(const std::vector<Point>& points) const {
    std::vector<double> values;
    values.reserve(3 * points.size());
    for (const Point& p : points) values.insert(values.end(), {p.x, p.y, p.z});
    require(MEDmeshNodeCoordinateWr(file_, name_.c_str(), MED_NO_DT, MED_NO_IT, MED_UNDEF_DT,
                                    MED_FULL_INTERLACE, static_cast<med_int>(points.size()), values.data()));
  }

  void write_cells(const MedType& of) {
    const std::vector<Tag>& tags = tags_of(mesh_, of.kind);
    if (tags.empty()) return;
    std::vector<med_int> nodes, families;
    for (std::size_t i = 0; i < tags.size(); ++i) {
      for (const Index v : nodes_of(of.kind)(mesh_, i).in_order(of.node_order(mesh_.order())))
        nodes.push_back(static_cast<med_int>(v) + 1);
      families.push_back(family(shape_of(of.kind).dimension, tags[i]));
    }
    const auto count = static_cast<med_int>(tags.size());
    const med_geometry_type type = of.type(mesh_.order());
    require(MEDmeshElementConnectivityWr(file_, name_.c_str(), MED_NO_DT, MED_NO_IT, MED_UNDEF_DT, MED_CELL,
                                         type, MED_NODAL, MED_FULL_INTERLACE, count, nodes.data()));
    require(MEDmeshEntityFamilyNumberWr(file_, name_.c_str(), MED_NO_DT, MED_NO_IT, MED_CELL, type, count,
                                        families.data()));
  }

  void create_partitions() const {
    const std::string component = padded(med_partition_field, MED_SNAME_SIZE), unit(MED_SNAME_SIZE, '\0');
    require(MEDfieldCr(file_, med_partition_field, MED_INT, 1, component.c_str(), unit.c_str(), "",
                       name_.c_str()));
  }

  void write_partitions(const std::vector<Index>& partitions, med_geometry_type type) const {
    if (partitions.empty()) return;
    const std::vector<med_int> values(partitions.begin(), partitions.end());
    require(MEDfieldValueWr(file_, med_partition_field, MED_NO_DT, MED_NO_IT, 0, MED_CELL, type,
                            MED_FULL_INTERLACE, MED_ALL_CONSTITUENT, static_cast<med_int>(values.size()),
                            reinterpret_cast<const unsigned char*>(values.data())));
  }

  void commit() {
    require(MEDfileClose(std::exchange(file_, -1)));
    target_.commit();
  }

 private:
  /// Returns the family of a tag; families of cells have negative numbers.
  med_int family(std::size_t dimension, Tag tag) {
    const auto [found, added] =
        families_.try_emplace({dimension, tag}, -1 - static_cast<med_int>(families_.size()));
    if (added) {
      const std::string group = group_name(mesh_, dimension, tag, "-");
      const std::string name = names_of_families_.add(fmt::format("FAM_{}_{}", -found->second, group));
      require(MEDfamilyCr(file_, name_.c_str(), name.c_str(), found->second, 1,
                          padded(group, MED_LNAME_SIZE).c_str()));
    }
    return found->second;
  }

  void require(med_idt result) const {
    if (result < 0) target_.fail(0);
  }

  std::string name_;  // name of the mesh: the file's name
  UnfinishedFile target_;
  const TetMesh& mesh_;
  med_idt file_;
  std::map<std::pair<std::size_t, Tag>, med_int> families_;
  DistinctNames names_of_families_{MED_NAME_SIZE};
};

}  // namespace

void write_med(const std::string& path, const TetMesh& mesh) {
  MedFile file(path, mesh);
  file.create_mesh();
  file.write_points(mesh.points);
  for (const MedType& type : med_types) file.write_cells(type);
  if (!mesh.tet_partition.empty()) {  // on all cells: meshio reads no field that some cells lack
    const bool second = mesh.order() == 2;
    file.create_partitions();
    file.write_partitions(mesh.tet_partition, second ? MED_TETRA10 : MED_TETRA4);
    file.write_partitions(partitions_of_faces(mesh), second ? MED_TRIA6 : MED_TRIA3);
    file.write_partitions(partitions_of_edges(mesh), second ? MED_SEG3 : MED_SEG2);
  }
  file.commit();
}

}  // namespace collarmesh::io
