// XDMF 3 with its values in HDF5 (www.xdmf.org, "XDMF Model and Format"), as uniform grids of one kind of
// cells, one grid per file, as dolfinx and meshio read them. vtk_grid.h describes the arrays.
#include <fmt/format.h>
#include <hdf5.h>

#include <array>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "common/xml_text.h"
#include "io/cell_nodes.h"
#include "io/file_writer.h"
#include "io/label_names.h"
#include "io/tet_mesh_formats.h"
#include "io/unfinished_file.h"
#include "io/vtk_grid.h"

namespace collarmesh::io {

namespace {

struct NumberType {
  std::string_view name;
  int bytes;
  hid_t stored;
};
NumberType number_type(std::uint8_t) { return {"UChar", 1, H5T_NATIVE_UINT8}; }
NumberType number_type(std::int32_t) { return {"Int", 4, H5T_NATIVE_INT32}; }
NumberType number_type(std::int64_t) { return {"Int", 8, H5T_NATIVE_INT64}; }
NumberType number_type(float) { return {"Float", 4, H5T_NATIVE_FLOAT}; }
NumberType number_type(double) { return {"Float", 8, H5T_NATIVE_DOUBLE}; }

/// An HDF5 file that appears under its name when it is complete.
class ValueFile {
 public:
  explicit ValueFile(std::string path) : target_(std::move(path)) {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // we report errors ourselves
    file_ = H5Fcreate(target_.temporary().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    require(file_ >= 0);
  }
  ~ValueFile() {
    if (file_ >= 0) H5Fclose(file_);
  }
  ValueFile(const ValueFile&) = delete;
  ValueFile& operator=(const ValueFile&) = delete;

  template <class T>
  void write(const std::string& name, const std::vector<T>& values, std::size_t columns) {
    const hsize_t size[2] = {values.size() / columns, columns};
    const hid_t space = H5Screate_simple(columns > 1 ? 2 : 1, size, nullptr);
    const hid_t type = number_type(T{}).stored;
    const hid_t set = H5Dcreate2(file_, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    const bool written = set >= 0 && H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0;
    if (set >= 0) H5Dclose(set);
    if (space >= 0) H5Sclose(space);
    require(written);
  }

  void commit() {
    require(H5Fclose(std::exchange(file_, -1)) >= 0);
    target_.commit();
  }

 private:
  void require(bool done) const {
    if (!done) target_.fail(0);
  }

  UnfinishedFile target_;
  hid_t file_ = -1;
};

/// The contents of one file: the cells of one dimension, as a uniform grid.
struct Cells {
  std::string_view name;      ///< name of the grid, and of its topology in the HDF5 file
  std::string_view topology;  ///< XDMF's name of the kind of cells
  std::size_t first, count;   ///< range among all cells of the grid
  std::vector<std::int64_t> nodes;
  std::vector<std::string_view> arrays;  ///< arrays of these cells; dolfinx takes the first one for tags
};

template <class NodesOf>
std::vector<std::int64_t> nodes_of_all(const TetMesh& mesh, std::size_t count, NodesOf nodes_of) {
  std::vector<std::int64_t> nodes;
  for (std::size_t i = 0; i < count; ++i)
    for (const Index v : nodes_of(mesh, i)) nodes.push_back(v);
  return nodes;
}

std::array<Cells, 3> cells_by_dimension(const TetMesh& mesh) {
  const bool second = mesh.order() == 2;
  const std::size_t tets = mesh.tets.size(), faces = mesh.faces.size(), edges = mesh.edges.size();
  const bool surface = mesh.is_surface(), curves = mesh.is_curves();
  return {Cells{surface || curves ? "tets" : "mesh",
                second ? "Tetrahedron_10" : "Tetrahedron",
                0,
                tets,
                nodes_of_all(mesh, tets, nodes_of_tet),
                {"tag", "region", "collar", "crease", "thin", "partition", "radius_edge", "min_dihedral",
                 "max_dihedral"}},
          Cells{surface ? "mesh" : "faces",
                second ? "Triangle_6" : "Triangle",
                tets,
                faces,
                nodes_of_all(mesh, faces, nodes_of_face),
                {"tag", "region_back", "region_front", "feature", "partition"}},
          Cells{curves ? "mesh" : "edges",
                second ? "Edge_3" : "Polyline",
                tets + faces,
                edges,
                nodes_of_all(mesh, edges, nodes_of_edge),
                {"tag", "feature", "partition"}}};
}

/// A file and the one with its values; dolfinx requires the same name for both.
class GridFile {
 public:
  explicit GridFile(const std::filesystem::path& path)
      : values_(std::filesystem::path(path).replace_extension(".h5").string()),
        values_name_(std::filesystem::path(path).replace_extension(".h5").filename().string()),
        out_(path.string()) {}

  /// Writes a grid. `names` is the text of `names_information`.
  void write(const VtkGrid& grid, const Cells& cells, const std::string& names) {
    const std::size_t nodes = cells.count == 0 ? 1 : cells.nodes.size() / cells.count;
    out_ << "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\">\n<Domain>\n<Grid Name=\"" << cells.name
         << "\" GridType=\"Uniform\">\n<Topology TopologyType=\"" << cells.topology
         << "\" NumberOfElements=\"" << cells.count << "\" NodesPerElement=\"" << nodes << "\">\n";
    write_item("topology", cells.nodes, nodes);
    out_ << "</Topology>\n<Geometry GeometryType=\"XYZ\">\n";
    write_item("points", std::get<std::vector<double>>(grid.points.values), 3);
    out_ << "</Geometry>\n";
    for (const std::string_view name : cells.arrays)
      for (const VtkArray& array : grid.cell_data)
        if (array.name == name) write_attribute("Cell", "cell_", array, cells.first, cells.count);
    out_ << names;
    if (cells.first == 0)
      for (const VtkArray& array : grid.point_data)
        write_attribute("Node", "point_", array, 0, grid.point_count);
    out_ << "</Grid>\n</Domain>\n</Xdmf>\n";
  }

  void commit() {
    values_.commit();
    out_.commit();
  }

 private:
  void write_attribute(std::string_view centre, const std::string& prefix, const VtkArray& array,
                       std::size_t first, std::size_t count) {
    out_ << "<Attribute Name=\"" << array.name << "\" AttributeType=\"Scalar\" Center=\"" << centre
         << "\">\n";
    std::visit(
        [&](const auto& values) {
          const auto begin = values.begin() + static_cast<std::ptrdiff_t>(first);
          write_item(prefix + array.name,
                     std::decay_t<decltype(values)>(begin, begin + static_cast<std::ptrdiff_t>(count)), 1);
        },
        array.values);
    out_ << "</Attribute>\n";
  }

  template <class T>
  void write_item(const std::string& name, const std::vector<T>& values, std::size_t columns) {
    const NumberType type = number_type(T{});
    out_ << "<DataItem Format=\"HDF\" NumberType=\"" << type.name << "\" Precision=\"" << type.bytes
         << "\" Dimensions=\"" << values.size() / columns;
    if (columns > 1) out_ << ' ' << columns;
    out_ << "\">" << values_name_ << ":/" << name << "</DataItem>\n";
    values_.write(name, values, columns);
  }

  ValueFile values_;
  std::string values_name_;
  FileWriter out_;
};

/// Returns the names of tags that have one, in the form of meshio's field data.
std::string names_information(const TetMesh& mesh) {
  std::string maps;
  const auto add = [&](std::size_t dimension, const std::vector<Tag>& tags) {
    for (const Tag tag : std::set<Tag>(tags.begin(), tags.end()))
      if (const std::string name = group_name(mesh, dimension, tag);
          name != group_name(GroupNames::complex, dimension, tag))
        maps += fmt::format("<map key=\"{}\" dim=\"{}\">{}</map>", xml_text(name), dimension, tag);
  };
  add(1, mesh.edge_tag);
  add(2, mesh.face_tag);
  add(3, mesh.tet_tag);
  if (maps.empty()) return {};
  return fmt::format("<Information Name=\"names\"><![CDATA[<main>{}</main>]]></Information>\n", maps);
}

/// Returns NAME.xdmf for the tetrahedra, or for triangles without tetrahedra, and NAME_faces.xdmf and
/// NAME_edges.xdmf for the others.
std::filesystem::path path_of(const std::filesystem::path& path, const Cells& cells) {
  if (cells.first == 0 && cells.name == "mesh") return path;
  return path.parent_path() /
         fmt::format("{}_{}{}", path.stem().string(), cells.name, path.extension().string());
}

}  // namespace

void write_xdmf(const std::string& path, const TetMesh& mesh) {
  const VtkGrid grid = make_vtk_grid(mesh);
  std::vector<std::unique_ptr<GridFile>> files;
  const std::string names = names_information(mesh);
  for (const Cells& cells : cells_by_dimension(mesh)) {
    if (cells.count == 0 && cells.name != "mesh") continue;
    files.push_back(std::make_unique<GridFile>(path_of(path, cells)));
    files.back()->write(grid, cells, names);
  }
  // Commit the requested file last: a reader who sees it sees the others, too.
  for (auto file = files.rbegin(); file != files.rend(); ++file) (*file)->commit();
}

}  // namespace collarmesh::io
