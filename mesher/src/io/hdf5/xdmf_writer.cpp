// XDMF 3 with its values in HDF5 (www.xdmf.org, "XDMF Model and Format"), as uniform grids of one kind of
// cells, one grid per file, as dolfinx and meshio read them. vtk_grid.h describes the arrays.
#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "common/xml_text.h"
#include "io/cell_nodes.h"
#include "io/file_writer.h"
#include "io/hdf5/hdf5_file.h"
#include "io/hdf5/xdmf_format.h"
#include "io/label_names.h"
#include "io/tet_mesh_formats.h"
#include "io/vtk_grid.h"

namespace collarmesh::io {

namespace {

/// XDMF's name of a type of numbers.
template <class Number>
constexpr std::string_view number_type = std::is_floating_point_v<Number> ? "Float"
                                         : sizeof(Number) == 1            ? "UChar"
                                                                          : "Int";

/// The contents of one file: the cells of one dimension, as a uniform grid.
struct Cells {
  std::string_view name;      ///< name of the grid, and of its topology in the HDF5 file
  std::string_view topology;  ///< XDMF's name of the kind of cells
  std::size_t first, count;   ///< range among all cells of the grid
  std::vector<std::int64_t> nodes;
  std::vector<std::string_view> arrays;  ///< names of arrays; dolfinx takes the first array for tags
};

std::vector<Cells> cells_by_dimension(const TetMesh& mesh) {
  constexpr std::array<const char*, 3> names{"tets", "faces", "edges"};
  const std::array<std::vector<std::string_view>, 3> arrays{
      {{"tag", "region", "collar", "crease", "thin", "partition", "radius_edge", "min_dihedral",
        "max_dihedral"},
       {"tag", "region_back", "region_front", "feature", "partition"},
       {"tag", "feature", "partition"}}};
  const std::size_t main = mesh.is_curves() ? 2 : mesh.is_surface() ? 1 : 0;
  std::vector<Cells> all;
  for (std::size_t k = 0; k < xdmf_topologies.size(); ++k) {
    const auto& [kind, topologies] = xdmf_topologies[k];
    Cells& cells = all.emplace_back();
    cells.name = k == main ? "mesh" : names[k];
    cells.topology = topologies[mesh.order() == 2 ? 1 : 0];
    cells.first = count_before(mesh, kind);
    cells.count = count_of(mesh, kind);
    for (std::size_t i = 0; i < cells.count; ++i)
      for (const Index v : nodes_of(kind)(mesh, i)) cells.nodes.push_back(v);
    cells.arrays = arrays[k];
  }
  return all;
}

/// An XDMF file and the HDF5 file with its values; dolfinx requires the same name for both.
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
    out_ << "<DataItem Format=\"HDF\" NumberType=\"" << number_type<T> << "\" Precision=\"" << sizeof(T)
         << "\" Dimensions=\"" << values.size() / columns;
    if (columns > 1) out_ << ' ' << columns;
    out_ << "\">" << values_name_ << ":/" << name << "</DataItem>\n";
    const hsize_t rows = values.size() / columns;
    values_.write(name, values.data(),
                  columns > 1 ? std::vector<hsize_t>{rows, columns} : std::vector<hsize_t>{rows});
  }

  Hdf5File values_;
  std::string values_name_;
  FileWriter out_;
};

/// Returns the tags whose names are not made of dimension and tag (patch_7), with their names, in the form of
/// meshio's field data.
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

/// Returns NAME.xdmf for the cells of the mesh's highest dimension, and NAME_faces.xdmf or NAME_edges.xdmf
/// for other cells.
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
