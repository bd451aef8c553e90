// Reads XDMF as collarmesh, meshio and dolfinx write it: a uniform grid of tetrahedra with its values in HDF5
// or in the text, and the tagged faces and edges in files beside it, NAME_faces.xdmf and NAME_edges.xdmf.
#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <pugixml.hpp>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "collarmesh/error.h"
#include "common/lower_case.h"
#include "io/finite_points.h"
#include "io/hdf5/hdf5_file.h"
#include "io/hdf5/xdmf_format.h"
#include "io/tet_mesh_formats.h"
#include "io/vtk_grid.h"

namespace collarmesh::io {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& path, const std::string& message) {
  throw ReadError(fmt::format("{}: {}", path, message));
}

template <class T>
std::vector<T> read_dataset(const std::string& path, const fs::path& file, const std::string& name) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // we report errors ourselves
  const Handle values(H5Fopen(file.string().c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (values < 0)
    fail(path, fmt::format("its values in {} cannot be read; put that file beside this one", file.string()));
  const Handle set(H5Dopen2(values, name.c_str(), H5P_DEFAULT), H5Dclose);
  if (set < 0) fail(path, fmt::format("{} has no dataset {}", file.string(), name));
  const Handle space(H5Dget_space(set), H5Sclose);
  const hssize_t count = H5Sget_simple_extent_npoints(space);
  const hsize_t stored = H5Dget_storage_size(set);
  // A file may claim more values than it holds.
  if (count < 0 || static_cast<hsize_t>(count) > 2000 * (stored + 1))
    fail(path, fmt::format("{}:{} claims to have {} values in {} bytes; the file is damaged", file.string(),
                           name, count, stored));
  std::vector<T> result(static_cast<std::size_t>(count));
  if (!result.empty() && H5Dread(set, native_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, result.data()) < 0)
    fail(path, fmt::format("{}:{} cannot be read", file.string(), name));
  return result;
}

/// One uniform grid.
class Grid {
 public:
  explicit Grid(std::string path) : path_(std::move(path)) {
    const pugi::xml_parse_result parsed = document_.load_file(path_.c_str());
    if (!parsed) fail(path_, fmt::format("the XML is malformed: {}", parsed.description()));
    grid_ = document_.child("Xdmf").child("Domain").child("Grid");
    if (!grid_) fail(path_, "expected the elements Xdmf, Domain and Grid");
    if (grid_.attribute("GridType").as_string("Uniform") != std::string_view("Uniform"))
      fail(path_, "expected a uniform grid; name a file that has one");
    find_topology();
  }

  std::vector<double> coordinates() const {
    const pugi::xml_node geometry = grid_.child("Geometry");
    if (type_of(geometry, "GeometryType") != "xyz") fail(path_, "expected a Geometry of the type XYZ");
    std::vector<double> values = read<double>(geometry.child("DataItem"));
    if (values.size() % 3 != 0) fail(path_, "the number of coordinates is not a multiple of three");
    return values;
  }

  /// Adds the grid's cells and their data to `piece`.
  void append(VtkPiece& piece) const {
    const auto nodes = read<std::int64_t>(grid_.child("Topology").child("DataItem"));
    const std::size_t of_cell = shape_of(kind_).nodes(order_);
    if (nodes.size() % of_cell != 0)
      fail(path_, fmt::format("{} nodes are not a whole number of cells of {} nodes", nodes.size(), of_cell));
    const std::size_t before = piece.types.size(), count = nodes.size() / of_cell;
    piece.connectivity.insert(piece.connectivity.end(), nodes.begin(), nodes.end());
    const std::int64_t first = piece.ends.empty() ? 0 : piece.ends.back();
    for (std::size_t i = 1; i <= count; ++i)
      piece.ends.push_back(first + static_cast<std::int64_t>(i * of_cell));
    piece.types.resize(before + count, vtk_type_of(kind_, order_));
    for (const pugi::xml_node& attribute : grid_.children("Attribute")) {
      const std::string name = attribute.attribute("Name").value();
      const bool of_cells = attribute.attribute("Center").value() == std::string_view("Cell");
      if (of_cells && is_among(name, vtk_cell_arrays))
        take(attribute, name, before, count, piece.cell_data);
      else if (!of_cells && before == 0 && is_among(name, vtk_point_arrays))
        take(attribute, name, 0, piece.points.size(), piece.point_data);
    }
    for (auto& [name, values] : piece.cell_data) values.resize(before + count);
  }

  /// Gives the mesh the names of groups that our files and meshio's contain.
  void take_names(TetMesh& mesh) const {
    pugi::xml_document names;
    if (!names.load_string(grid_.child("Information").text().as_string())) return;
    for (const pugi::xml_node& map : names.child("main").children("map")) {
      const unsigned dimension = map.attribute("dim").as_uint(4);
      if (dimension <= 3 && *map.attribute("key").value() != '\0')
        mesh.names.set(dimension, map.text().as_llong(), map.attribute("key").value());
    }
  }

 private:
  static bool is_among(std::string_view name, std::span<const std::string_view> names) {
    return std::ranges::count(names, name) > 0;
  }

  static std::string type_of(const pugi::xml_node& node, const char* attribute) {
    return lower_case(node.attribute(node.attribute(attribute) ? attribute : "Type").value());
  }

  void find_topology() {
    const std::string type = type_of(grid_.child("Topology"), "TopologyType");
    for (const auto& [kind, names] : xdmf_topologies)
      for (const int order : {1, 2})
        if (lower_case(names[order == 2 ? 1 : 0]) == type) {
          kind_ = kind;
          order_ = order;
          return;
        }
    fail(path_, fmt::format("cells of the type '{}' are not supported, only tetrahedra, triangles and lines "
                            "of first or second order, with one type in each grid",
                            type));
  }

  void take(const pugi::xml_node& attribute, const std::string& name, std::size_t before, std::size_t count,
            VtkPiece::Arrays& arrays) const {
    const auto values = read<std::int64_t>(attribute.child("DataItem"));
    if (values.size() != count)
      fail(path_, fmt::format("expected {} values of {}, found {}", count, name, values.size()));
    auto& all = arrays[name];
    all.resize(before);
    all.insert(all.end(), values.begin(), values.end());
  }

  template <class T>
  std::vector<T> read(const pugi::xml_node& item) const {
    if (!item) fail(path_, "expected a DataItem");
    const std::string text = item.text().as_string();
    if (item.attribute("Format").value() != std::string_view("HDF")) return read_text<T>(text);
    const std::size_t first = text.find_first_not_of(" \t\r\n"), last = text.find_last_not_of(" \t\r\n");
    const std::size_t colon = text.rfind(':');
    if (first == std::string::npos || colon == std::string::npos || colon < first)
      fail(path_, fmt::format("expected FILE:/VALUES, found '{}'", text.substr(0, 60)));
    return read_dataset<T>(path_, fs::path(path_).parent_path() / text.substr(first, colon - first),
                           text.substr(colon + 1, last - colon));
  }

  template <class T>
  std::vector<T> read_text(const std::string& text) const {
    std::istringstream words(text);
    words.imbue(std::locale::classic());
    std::vector<T> values;
    for (T value; words >> value;) values.push_back(value);
    if (!words.eof()) fail(path_, "expected numbers in a DataItem");
    return values;
  }

  std::string path_;
  pugi::xml_document document_;
  pugi::xml_node grid_;
  CellKind kind_ = CellKind::tet;
  int order_ = 1;
};

}  // namespace

TetMesh read_xdmf(const std::string& path) {
  const Grid tets(path);
  VtkPiece piece;
  const std::vector<double> coordinates = tets.coordinates();
  piece.points = finite_points(coordinates, [&](const std::string& message) { fail(path, message); });
  tets.append(piece);
  const fs::path place(path);
  for (const char* part : {"faces", "edges"}) {
    const fs::path beside =
        place.parent_path() / fmt::format("{}_{}{}", place.stem().string(), part, place.extension().string());
    std::error_code ignored;
    if (!fs::exists(beside, ignored)) continue;
    const Grid grid(beside.string());
    if (grid.coordinates() == coordinates) grid.append(piece);  // otherwise it is of another mesh
  }
  TetMesh mesh;
  try {
    add_vtk_piece(piece, mesh);
  } catch (const VtkPieceError& error) {
    fail(path, error.message);
  }
  tets.take_names(mesh);
  if (mesh.tets.empty()) fail(path, "expected tetrahedra, found none");
  complete_vtk_mesh(path, mesh);
  return mesh;
}

}  // namespace collarmesh::io
