#include "arrays.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <cstring>
#include <map>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "collarmesh/error.h"
#include "report/colour_text.h"

namespace py = pybind11;

namespace collarmesh::python {

namespace {

template <class T>
using Array = py::array_t<T, py::array::c_style | py::array::forcecast>;

template <class T>
std::vector<T> values(const py::dict& arrays, const char* key) {
  if (!arrays.contains(key)) return {};
  const auto array = arrays[key].cast<Array<T>>();
  return {array.data(), array.data() + array.size()};
}

std::vector<Point> points(const py::dict& arrays, const char* key) {
  const auto flat = values<double>(arrays, key);
  std::vector<Point> result;
  result.reserve(flat.size() / 3);
  for (std::size_t i = 0; i + 2 < flat.size(); i += 3) result.push_back({flat[i], flat[i + 1], flat[i + 2]});
  return result;
}

Index index(std::int64_t value, std::size_t size, const std::string& what) {
  if (value < 0 || value >= static_cast<std::int64_t>(size))
    throw OptionError(fmt::format("{} has the corner {}, but points are numbered from 0 to {}", what, value,
                                  std::int64_t(size) - 1));
  return static_cast<Index>(value);
}

/// Reads rows of point indices.
template <std::size_t columns>
std::vector<std::array<Index, columns>> rows(const py::dict& arrays, const char* key, std::size_t points) {
  const auto flat = values<std::int64_t>(arrays, key);
  std::vector<std::array<Index, columns>> result(flat.size() / columns);
  for (std::size_t i = 0; i < result.size(); ++i)
    for (std::size_t k = 0; k < columns; ++k)
      result[i][k] = index(flat[i * columns + k], points, fmt::format("row {} of {}", i, key));
  return result;
}

template <class T>
std::vector<T> numbers(const py::dict& arrays, const char* key) {
  const auto wide = values<std::int64_t>(arrays, key);
  return {wide.begin(), wide.end()};
}

/// Returns a read-only array that owns its values.
template <class T>
py::array owned(std::vector<T> values, py::ssize_t columns) {
  auto kept = std::make_unique<std::vector<T>>(std::move(values));
  const T* data = kept->data();
  const auto rows = static_cast<py::ssize_t>(kept->size()) / columns;
  const py::capsule owner(kept.release(), [](void* p) { delete static_cast<std::vector<T>*>(p); });
  py::array array = columns == 1 ? py::array(py::dtype::of<T>(), {rows}, {}, data, owner)
                                 : py::array(py::dtype::of<T>(), {rows, columns}, {}, data, owner);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

/// Returns an array of indices, with -1 for `none`.
py::array index_array(const std::vector<Index>& items) {
  std::vector<std::int64_t> wide;
  wide.reserve(items.size());
  for (const Index i : items) wide.push_back(i == none ? -1 : std::int64_t{i});
  return owned(std::move(wide), 1);
}
template <std::size_t columns>
py::array index_array(const std::vector<std::array<Index, columns>>& items) {
  std::vector<std::int64_t> wide;
  wide.reserve(items.size() * columns);
  for (const auto& row : items) wide.insert(wide.end(), row.begin(), row.end());
  return owned(std::move(wide), columns);
}
py::array point_array(const std::vector<Point>& items) {
  std::vector<double> flat;
  flat.reserve(3 * items.size());
  for (const Point& p : items) flat.insert(flat.end(), {p.x, p.y, p.z});
  return owned(std::move(flat), 3);
}

using Names = std::map<int, std::map<Tag, std::string>>;

TagNames names_of(const py::dict& arrays) {
  TagNames names;
  if (!arrays.contains("names")) return names;
  for (const auto& [dimension, by_tag] : arrays["names"].cast<Names>())
    for (const auto& [tag, name] : by_tag)
      if (dimension >= 0 && dimension <= 3) names.set(static_cast<std::size_t>(dimension), tag, name);
  return names;
}

Names names_of(const TagNames& names) {
  Names result;
  for (int d = 0; d < 4; ++d)
    if (!names.of(static_cast<std::size_t>(d)).empty()) result[d] = names.of(static_cast<std::size_t>(d));
  return result;
}

std::vector<TetMesh::PeriodicFaces> periodic_of(const py::dict& arrays, std::size_t points) {
  std::vector<TetMesh::PeriodicFaces> periodic;
  if (!arrays.contains("periodic")) return periodic;
  for (const py::handle& each : arrays["periodic"]) {
    const auto given = py::reinterpret_borrow<py::dict>(each);
    TetMesh::PeriodicFaces faces;
    faces.first = numbers<Tag>(given, "first");
    faces.second = numbers<Tag>(given, "second");
    const auto rows = values<double>(given, "rotation"), shift = values<double>(given, "shift");
    if (rows.size() != 9 || shift.size() != 3)
      throw OptionError("periodic: a rotation has the shape (3, 3) and a shift the shape (3,)");
    for (std::size_t k = 0; k < 3; ++k) {
      faces.motion.rows[k] = {rows[3 * k], rows[3 * k + 1], rows[3 * k + 2]};
      faces.motion.shift[k] = shift[k];
    }
    faces.nodes = collarmesh::python::rows<2>(given, "nodes", points);
    periodic.push_back(std::move(faces));
  }
  return periodic;
}

py::list periodic_of(const std::vector<TetMesh::PeriodicFaces>& periodic) {
  py::list result;
  for (const TetMesh::PeriodicFaces& faces : periodic) {
    py::dict each;
    std::vector<double> rows;
    for (const Vector& row : faces.motion.rows) rows.insert(rows.end(), {row.x, row.y, row.z});
    const Vector& shift = faces.motion.shift;
    each["first"] = owned(faces.first, 1);
    each["second"] = owned(faces.second, 1);
    each["rotation"] = owned(std::move(rows), 3);
    each["shift"] = owned(std::vector<double>{shift.x, shift.y, shift.z}, 1);
    each["nodes"] = index_array(faces.nodes);
    result.append(each);
  }
  return result;
}

}  // namespace

py::dict colours_of(const TagColours& colours) {
  py::dict result;
  const auto add = [&](int dimension, const std::map<Tag, Colour>& by_tag) {
    std::map<Tag, std::string> texts;
    for (const auto& [tag, colour] : by_tag) texts.emplace(tag, report::colour_text(colour));
    if (!texts.empty()) result[py::int_(dimension)] = texts;
  };
  add(2, colours.patches);
  add(3, colours.regions);
  return result;
}

PolygonSoup soup_of(const py::dict& arrays) {
  PolygonSoup soup;
  soup.name = arrays["name"].cast<std::string>();
  soup.points = points(arrays, "points");
  const std::size_t n = soup.points.size();
  const auto corners = values<std::int64_t>(arrays, "corners");
  const auto polygon_ends = values<std::int64_t>(arrays, "polygon_ends");
  const auto facet_ends = values<std::int64_t>(arrays, "facet_ends");
  const auto tags = values<std::int64_t>(arrays, "facet_tags");
  std::vector<Index> polygon;
  std::size_t corner = 0, q = 0;
  for (std::size_t f = 0; f < facet_ends.size(); ++f) {
    soup.begin_facet(tags.empty() ? 0 : tags[f]);
    for (; q < static_cast<std::size_t>(facet_ends[f]); ++q) {
      polygon.clear();
      for (; corner < static_cast<std::size_t>(polygon_ends[q]); ++corner)
        polygon.push_back(index(corners[corner], n, fmt::format("facet {} of {}", f, soup.name)));
      soup.add_polygon(polygon);
    }
  }
  const auto segments = rows<2>(arrays, "segments", n);
  const auto segment_tags = values<std::int64_t>(arrays, "segment_tags");
  for (std::size_t i = 0; i < segments.size(); ++i)
    soup.segments.push_back({segments[i][0], segments[i][1], segment_tags.empty() ? 0 : segment_tags[i]});
  soup.hole_points = points(arrays, "holes");
  const auto regions = values<double>(arrays, "regions");
  for (std::size_t i = 0; i + 4 < regions.size(); i += 5)
    soup.region_points.push_back(
        {{regions[i], regions[i + 1], regions[i + 2]}, static_cast<Tag>(regions[i + 3]), regions[i + 4]});
  const auto holes = values<double>(arrays, "facet_holes");
  for (std::size_t i = 0; i + 3 < holes.size(); i += 4)
    soup.facet_holes.push_back({static_cast<Index>(holes[i]), {holes[i + 1], holes[i + 2], holes[i + 3]}});
  soup.tag_names = names_of(arrays);
  return soup;
}

py::dict arrays_of(const PolygonSoup& soup) {
  std::vector<std::int64_t> corners, polygon_ends, facet_ends, tags;
  for (Index f = 0; f < soup.facet_count(); ++f) {
    const auto [first, last] = soup.facet_polygons(f);
    for (Index q = first; q < last; ++q) {
      for (const Index corner : soup.polygon(q)) corners.push_back(corner);
      polygon_ends.push_back(static_cast<std::int64_t>(corners.size()));
    }
    facet_ends.push_back(last);
    tags.push_back(soup.facet_tag(f));
  }
  py::dict arrays;
  arrays["name"] = soup.name;
  arrays["points"] = point_array(soup.points);
  arrays["corners"] = owned(std::move(corners), 1);
  arrays["polygon_ends"] = owned(std::move(polygon_ends), 1);
  arrays["facet_ends"] = owned(std::move(facet_ends), 1);
  arrays["facet_tags"] = owned(std::move(tags), 1);
  arrays["names"] = names_of(soup.tag_names);
  return arrays;
}

namespace {

/// Calls visit(key, array) for the arrays of whole numbers of a mesh, and visit(key, array, points) for those
/// that hold numbers of points.
template <class Mesh, class Visit>
void for_each_array(Mesh& mesh, const Visit& visit) {
  const std::size_t points = mesh.points.size();
  visit("tets", mesh.tets, points);
  visit("tet_region", mesh.tet_region);
  visit("tet_tag", mesh.tet_tag);
  visit("tet_collar", mesh.tet_collar);
  visit("tet_thin", mesh.tet_thin);
  visit("tet_crease", mesh.tet_crease);
  visit("tet_partition", mesh.tet_partition);
  visit("tet_mid_nodes", mesh.tet_mid_nodes, points);
  visit("faces", mesh.faces, points);
  visit("face_regions", mesh.face_regions);
  visit("face_patch", mesh.face_patch);
  visit("face_tag", mesh.face_tag);
  visit("face_mid_nodes", mesh.face_mid_nodes, points);
  visit("edges", mesh.edges, points);
  visit("edge_curve", mesh.edge_curve);
  visit("edge_tag", mesh.edge_tag);
  visit("edge_mid_nodes", mesh.edge_mid_nodes, points);
  auto& layers = mesh.layers;
  visit("prisms", layers.prisms, points);
  visit("prism_region", layers.prism_region);
  visit("prism_tag", layers.prism_tag);
  visit("prism_layer", layers.prism_layer);
  visit("prism_mid_nodes", layers.prism_mid_nodes, points);
  visit("pyramids", layers.pyramids, points);
  visit("pyramid_region", layers.pyramid_region);
  visit("pyramid_tag", layers.pyramid_tag);
  visit("pyramid_layer", layers.pyramid_layer);
  visit("pyramid_mid_nodes", layers.pyramid_mid_nodes, points);
  visit("quads", layers.quads, points);
  visit("quad_regions", layers.quad_regions);
  visit("quad_patch", layers.quad_patch);
  visit("quad_tag", layers.quad_tag);
  visit("quad_mid_nodes", layers.quad_mid_nodes, points);
  visit("tet_layer", layers.tet_layer);
}

struct Reader {
  template <class T>
  void operator()(const char* key, std::vector<T>& items) const {
    items = numbers<T>(arrays, key);
  }
  void operator()(const char* key, std::vector<std::array<Index, 2>>& regions) const {
    const auto flat = numbers<Index>(arrays, key);
    for (std::size_t i = 0; i + 1 < flat.size(); i += 2) regions.push_back({flat[i], flat[i + 1]});
  }
  template <std::size_t columns>
  void operator()(const char* key, std::vector<std::array<Index, columns>>& nodes, std::size_t points) const {
    nodes = rows<columns>(arrays, key, points);
  }
  void operator()(const char* key, std::vector<Index>& nodes, std::size_t points) const {
    for (const auto& row : rows<1>(arrays, key, points)) nodes.push_back(row[0]);
  }

  const py::dict& arrays;
};

struct Writer {
  template <class T>
  void operator()(const char* key, std::vector<T>& items, std::size_t = 0) const {
    if constexpr (std::is_same_v<T, Tag> || std::is_same_v<T, std::uint8_t>)
      arrays[key] = owned(std::move(items), 1);
    else if constexpr (std::is_same_v<T, std::uint16_t>)
      arrays[key] = owned(std::vector<std::int64_t>(items.begin(), items.end()), 1);
    else
      arrays[key] = index_array(items);
  }

  py::dict& arrays;
};

}  // namespace

TetMesh tet_mesh_of(const py::dict& arrays) {
  TetMesh mesh;
  mesh.points = points(arrays, "points");
  for_each_array(mesh, Reader{arrays});
  const auto dimension = numbers<std::uint8_t>(arrays, "feature_dimension");
  const auto feature = numbers<Index>(arrays, "feature");
  for (std::size_t i = 0; i < dimension.size(); ++i) mesh.features.push_back({dimension[i], feature[i]});
  mesh.names = names_of(arrays);
  mesh.periodic = periodic_of(arrays, mesh.points.size());
  if (arrays["cad_names"].cast<bool>()) mesh.group_names = GroupNames::cad;
  return mesh;
}

py::tuple arrays_of(const std::vector<MeshPlace>& places) {
  std::vector<Index> tet, nearest;
  std::vector<double> shares;
  for (const MeshPlace& place : places) {
    tet.push_back(place.tet);
    nearest.push_back(place.nearest);
    shares.insert(shares.end(), place.shares.begin(), place.shares.end());
  }
  return py::make_tuple(index_array(tet), owned(std::move(shares), 4), index_array(nearest));
}

py::array partition_array(const TetMesh& mesh) { return index_array(mesh.tet_partition); }

py::dict arrays_of(TetMesh mesh) {
  py::dict arrays;
  arrays["points"] = point_array(mesh.points);
  for_each_array(mesh, Writer{arrays});
  std::vector<std::uint8_t> dimension;
  std::vector<Index> feature;
  for (const TetMesh::VertexFeature& f : mesh.features) {
    dimension.push_back(f.dimension);
    feature.push_back(f.feature);
  }
  arrays["feature_dimension"] = owned(std::move(dimension), 1);
  arrays["feature"] = index_array(feature);
  arrays["names"] = names_of(mesh.names);
  arrays["periodic"] = periodic_of(mesh.periodic);
  arrays["cad_names"] = mesh.group_names == GroupNames::cad;
  return arrays;
}

}  // namespace collarmesh::python
