// CGNS (cgns.github.io, "SIDS-to-HDF5 File Mapping Manual") in HDF5: one unstructured zone. Each region, each
// tag of patches and each tag of curves is a group. A group has a section of elements, with the group's name,
// for each kind of its cells. Faces of a section that lie on the boundary also form a boundary condition,
// whose family has the name of the group's first section.
#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "collarmesh/error.h"
#include "io/cell_nodes.h"
#include "io/hdf5/hdf5_file.h"
#include "io/label_names.h"
#include "io/tet_mesh_formats.h"

namespace collarmesh::io {

namespace {

constexpr std::size_t longest_name = 32;

/// CGNS' types of elements, by order.
constexpr PerKind<std::array<std::int32_t, 2>> cgns_types{{{{10, 11},   // tets
                                                            {14, 15},   // prisms
                                                            {12, 21},   // pyramids
                                                            {5, 6},     // triangles
                                                            {7, 8},     // quadrangles
                                                            {3, 4}}}};  // edges

/// Returns properties for creating an object of this kind (a file or group) whose links keep their order.
hid_t ordered(hid_t kind) {
  const hid_t properties = H5Pcreate(kind);
  H5Pset_link_creation_order(properties, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
  return properties;
}

/// A file of CGNS' nodes: groups of HDF5 with attributes, and their values in a data set.
class CgnsFile : public Hdf5File {
 public:
  explicit CgnsFile(std::string path)
      : Hdf5File(std::move(path), Handle(ordered(H5P_FILE_CREATE), H5Pclose)) {
    describe_root();
  }

  /// Adds a node without values, of type MT. Returns its path.
  std::string add(const std::string& parent, const std::string& name, const char* label) {
    return add_node(parent, name, label, "MT");
  }
  std::string add(const std::string& parent, const std::string& name, const char* label,
                  const std::string& text) {
    std::string path = add_node(parent, name, label, "C1");
    write(path + "/ data", text.data(), {text.size()});
    return path;
  }
  /// Adds a node with values. `size`: the extents of the array in Fortran's order; empty: a list.
  template <class Number>
  std::string add(const std::string& parent, const std::string& name, const char* label,
                  const std::vector<Number>& values, std::vector<hsize_t> size = {}) {
    constexpr bool whole = std::is_same_v<Number, std::int32_t>, small = std::is_same_v<Number, float>;
    std::string path = add_node(parent, name, label, whole ? "I4" : small ? "R4" : "R8");
    std::reverse(size.begin(), size.end());
    if (size.empty()) size = {values.size()};
    write(path + "/ data", values.data(), size);
    return path;
  }

 private:
  void describe_root() const {
    const Handle root(H5Gopen2(id(), "/", H5P_DEFAULT), H5Gclose);
    set_text(root, "name", "HDF5 MotherNode", longest_name);
    set_text(root, "label", "Root Node of HDF5 File", longest_name);
    set_text(root, "type", "MT", 2);
    const bool little = H5Tget_order(H5T_NATIVE_INT) == H5T_ORDER_LE;
    write_text("/ format", little ? "IEEE_LITTLE_32" : "IEEE_BIG_32", 20);
    unsigned major = 0, minor = 0, patch = 0;
    H5get_libversion(&major, &minor, &patch);
    write_text("/ hdf5version", fmt::format("HDF5 Version {}.{}.{}", major, minor, patch), 32);
  }

  std::string add_node(const std::string& parent, const std::string& name, const char* label,
                       const char* type) const {
    std::string path = parent + "/" + name;
    const Handle group(H5Gcreate2(id(), path.c_str(), H5P_DEFAULT, of_group_, H5P_DEFAULT), H5Gclose);
    set_text(group, "name", name, longest_name);
    set_text(group, "label", label, longest_name);
    set_text(group, "type", type, 2);
    const hsize_t one = 1;
    const int flag = 1;
    set(group, "flags", H5T_NATIVE_INT, Handle(H5Screate_simple(1, &one, nullptr), H5Sclose), &flag);
    return path;
  }

  void set(hid_t object, const char* name, hid_t type, hid_t space, const void* value) const {
    const Handle attribute(H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    require(attribute >= 0 && H5Awrite(attribute, type, value) >= 0);
  }
  /// Sets an attribute of a fixed `size`; zeros fill the space after the text.
  void set_text(hid_t object, const char* name, std::string text, std::size_t size) const {
    text.resize(size + 1, '\0');
    const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(type, size + 1);
    set(object, name, type, Handle(H5Screate(H5S_SCALAR), H5Sclose), text.data());
  }

  void write_text(const std::string& path, std::string text, std::size_t size) const {
    text.resize(size + 1, '\0');
    write(path, text.data(), {text.size()});
  }

  const Handle of_group_{ordered(H5P_GROUP_CREATE), H5Pclose};
};

/// The cells of one section.
struct Section {
  CellKind kind;
  std::string name;
  std::vector<Index> cells;
  std::size_t outside = 0;  // number of cells on the boundary; they come first
  std::string family = {};  // name of the group's first section
};

/// Moves the faces on the boundary to the front and returns their number.
std::size_t sort_outside_first(const TetMesh& mesh, CellKind kind, std::vector<Index>& faces) {
  const auto inside = std::stable_partition(faces.begin(), faces.end(), [&](Index f) {
    const auto& regions = regions_beside(mesh, kind)[f];
    return (regions[0] == 0) != (regions[1] == 0);
  });
  return static_cast<std::size_t>(inside - faces.begin());
}

/// Puts the sections of each group into the family of the group's first section. Precondition: the sections
/// of a group follow each other, and the `family` of each is the group's name.
void name_families(std::vector<Section>& sections) {
  std::string group;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const std::string name = std::exchange(sections[i].family, sections[i].name);
    const bool continues = i > 0 && name == group && sections[i].kind != sections[i - 1].kind &&
                           shape_of(sections[i].kind).dimension == shape_of(sections[i - 1].kind).dimension;
    if (continues) sections[i].family = sections[i - 1].family;
    group = name;
  }
}

/// Returns a section for each kind of cells in each group. A group is a region, a tag of patches or a tag of
/// curves.
std::vector<Section> sections_of(const TetMesh& mesh) {
  std::map<std::pair<Index, CellKind>, std::vector<Index>> regions;
  std::array<std::map<std::pair<Tag, CellKind>, std::vector<Index>>, 3> tagged;  // by dimension
  for (const CellKind kind : all_cell_kinds) {
    const std::size_t dimension = shape_of(kind).dimension;
    for (Index i = 0; i < count_of(mesh, kind); ++i)
      if (dimension == 3)
        regions[{features_of(mesh, kind)[i], kind}].push_back(i);
      else
        tagged[dimension][{tags_of(mesh, kind)[i], kind}].push_back(i);
  }
  std::vector<Section> sections;
  for (auto& [key, cells] : regions) {
    std::string name = group_name(mesh, 3, tags_of(mesh, key.second)[cells.front()]);
    sections.push_back({key.second, std::move(name), std::move(cells)});
  }
  for (auto& [key, faces] : tagged[2]) {
    const std::size_t outside = sort_outside_first(mesh, key.second, faces);
    sections.push_back({key.second, group_name(mesh, 2, key.first), std::move(faces), outside});
  }
  for (auto& [key, edges] : tagged[1])
    sections.push_back({key.second, group_name(mesh, 1, key.first), std::move(edges)});
  DistinctNames names(longest_name);
  for (const char* reserved : {".", "..", "ZoneType", "GridCoordinates", "ZoneBC", "Zone", "DataClass"})
    names.add(reserved);
  for (Section& section : sections) {
    std::replace(section.name.begin(), section.name.end(), '/', '_');
    section.family = section.name;
    section.name = names.add(section.name);
  }
  name_families(sections);
  return sections;
}

std::vector<std::int32_t> nodes_of_section(const TetMesh& mesh, const Section& section) {
  std::vector<std::int32_t> nodes;
  for (const Index cell : section.cells)
    for (const Index v : with_between_before_top(section.kind, nodes_of(section.kind)(mesh, cell)))
      nodes.push_back(static_cast<std::int32_t>(v + 1));
  return nodes;
}

/// Writes points with lengths in an unspecified unit.
void write_points(CgnsFile& file, const std::string& zone, const std::vector<Point>& points) {
  const std::string grid = file.add(zone, "GridCoordinates", "GridCoordinates_t");
  const std::vector<float> length{0, 1, 0, 0, 0};  // exponents of mass, length, time, temperature, angle
  std::vector<double> values(points.size());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < points.size(); ++i) values[i] = points[i][axis];
    const std::string array = file.add(grid, fmt::format("Coordinate{}", "XYZ"[axis]), "DataArray_t", values);
    file.add(array, "DimensionalExponents", "DimensionalExponents_t", length);
  }
}

void write_boundary(CgnsFile& file, const std::string& conditions, const Section& section,
                    const std::vector<std::int32_t>& range) {
  const std::string condition = file.add(conditions, section.name, "BC_t", std::string("FamilySpecified"));
  file.add(condition, "PointRange", "IndexRange_t", range, {1, 2});
  file.add(condition, "GridLocation", "GridLocation_t", std::string("FaceCenter"));
  file.add(condition, "FamilyName", "FamilyName_t", section.family);
}

}  // namespace

void write_cgns(const std::string& path, const TetMesh& mesh) {
  const std::vector<Section> sections = sections_of(mesh);
  std::size_t cells = 0;
  for (const Section& section : sections) cells += section.cells.size();
  if (std::max(cells, mesh.points.size()) > std::numeric_limits<std::int32_t>::max())
    throw WriteError(
        fmt::format("{}: the mesh has more cells than the format has numbers for; write .vtu", path));
  const auto whole = [](std::size_t value) { return static_cast<std::int32_t>(value); };
  CgnsFile file(path);
  file.add("", "CGNSLibraryVersion", "CGNSLibraryVersion_t", std::vector<float>{3.4F});
  const std::string base = file.add("", "Base", "CGNSBase_t", std::vector<std::int32_t>{3, 3});
  file.add(base, "DataClass", "DataClass_t", std::string("NormalizedByUnknownDimensional"));
  const std::string zone = file.add(
      base, "Zone", "Zone_t",
      std::vector<std::int32_t>{whole(mesh.points.size()), whole(count_of_dimension(mesh, 3)), 0}, {1, 3});
  file.add(zone, "ZoneType", "ZoneType_t", std::string("Unstructured"));
  write_points(file, zone, mesh.points);
  std::string conditions;
  std::set<std::string> families;
  std::size_t first = 1;
  for (const Section& section : sections) {
    const std::vector<std::int32_t> range{whole(first), whole(first + section.cells.size() - 1)};
    const std::string elements =
        file.add(zone, section.name, "Elements_t",
                 std::vector<std::int32_t>{cgns_types[section.kind][mesh.order() == 2 ? 1 : 0], 0});
    file.add(elements, "ElementRange", "IndexRange_t", range);
    file.add(elements, "ElementConnectivity", "DataArray_t", nodes_of_section(mesh, section));
    const std::vector<std::int32_t> outside{whole(first), whole(first + section.outside - 1)};
    first += section.cells.size();
    if (section.outside == 0) continue;
    if (conditions.empty()) conditions = file.add(zone, "ZoneBC", "ZoneBC_t");
    write_boundary(file, conditions, section, outside);
    if (families.insert(section.family).second) file.add(base, section.family, "Family_t");
  }
  file.commit();
}

}  // namespace collarmesh::io
