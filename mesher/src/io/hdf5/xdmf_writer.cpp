// XDMF 3 with its values in HDF5: NAME.xdmf and beside it NAME.h5 (www.xdmf.org, "XDMF Model and Format").
// One uniform grid of mixed cells; what the arrays are: vtk_grid.h.
#include <fmt/format.h>
#include <hdf5.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "io/cell_nodes.h"
#include "io/file_writer.h"
#include "io/tet_mesh_formats.h"
#include "io/unfinished_file.h"
#include "io/vtk_grid.h"

namespace collarmesh::io {

namespace {

/// XDMF's numbers of cell types.
constexpr std::int32_t xdmf_polyline = 2, xdmf_triangle = 4, xdmf_tet = 6, xdmf_edge_2 = 34,
                       xdmf_triangle_2 = 36, xdmf_tet_2 = 38;

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
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // errors are ours to tell
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

/// The type and nodes of each cell; lines of first order say how many nodes they have.
std::vector<std::int32_t> mixed_topology(const TetMesh& mesh) {
  std::vector<std::int32_t> values;
  const bool second = mesh.order() == 2;
  const auto add = [&](std::int32_t type, const CellNodes& nodes) {
    values.push_back(type);
    if (type == xdmf_polyline) values.push_back(2);
    values.insert(values.end(), nodes.begin(), nodes.end());
  };
  for (std::size_t i = 0; i < mesh.tets.size(); ++i)
    add(second ? xdmf_tet_2 : xdmf_tet, nodes_of_tet(mesh, i));
  for (std::size_t i = 0; i < mesh.faces.size(); ++i)
    add(second ? xdmf_triangle_2 : xdmf_triangle, nodes_of_face(mesh, i));
  for (std::size_t i = 0; i < mesh.edges.size(); ++i)
    add(second ? xdmf_edge_2 : xdmf_polyline, nodes_of_edge(mesh, i));
  return values;
}

class XdmfWriter {
 public:
  explicit XdmfWriter(const std::string& path)
      : values_(std::filesystem::path(path).replace_extension(".h5").string()),
        file_name_(std::filesystem::path(path).replace_extension(".h5").filename().string()),
        out_(path) {}

  void write(const TetMesh& mesh) {
    const VtkGrid grid = make_vtk_grid(mesh);
    out_ << "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\">\n<Domain>\n<Grid Name=\"mesh\" "
            "GridType=\"Uniform\">\n"
         << "<Topology TopologyType=\"Mixed\" NumberOfElements=\"" << grid.cell_count << "\">\n";
    write_item("topology", mixed_topology(mesh), 1);
    out_ << "</Topology>\n<Geometry GeometryType=\"XYZ\">\n";
    write_item("points", std::get<std::vector<double>>(grid.points.values), 3);
    out_ << "</Geometry>\n";
    for (const VtkArray& array : grid.cell_data) write_attribute("Cell", "cell_", array);
    for (const VtkArray& array : grid.point_data) write_attribute("Node", "point_", array);
    out_ << "</Grid>\n</Domain>\n</Xdmf>\n";
    values_.commit();
    out_.commit();
  }

 private:
  void write_attribute(std::string_view centre, const std::string& prefix, const VtkArray& array) {
    out_ << "<Attribute Name=\"" << array.name << "\" AttributeType=\"Scalar\" Center=\"" << centre
         << "\">\n";
    std::visit([&](const auto& values) { write_item(prefix + std::string(array.name), values, 1); },
               array.values);
    out_ << "</Attribute>\n";
  }

  template <class T>
  void write_item(const std::string& name, const std::vector<T>& values, std::size_t columns) {
    const NumberType type = number_type(T{});
    out_ << "<DataItem Format=\"HDF\" NumberType=\"" << type.name << "\" Precision=\"" << type.bytes
         << "\" Dimensions=\"" << values.size() / columns;
    if (columns > 1) out_ << ' ' << columns;
    out_ << "\">" << file_name_ << ":/" << name << "</DataItem>\n";
    values_.write(name, values, columns);
  }

  ValueFile values_;
  std::string file_name_;
  FileWriter out_;
};

}  // namespace

void write_xdmf(const std::string& path, const TetMesh& mesh) { XdmfWriter(path).write(mesh); }

}  // namespace collarmesh::io
