#include "io/vtk_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <deque>
#include <functional>
#include <limits>
#include <span>

#include "common/large_pages.h"
#include "common/parallel_for.h"
#include "io/cell_nodes.h"
#include "io/cell_partitions.h"
#include "io/complete_mesh.h"
#include "io/names_text.h"

namespace collarmesh::io {

namespace {

constexpr std::uint8_t vtk_vertex = 1, vtk_line = 3, vtk_triangle = 5, vtk_tet = 10, vtk_line_2 = 21,
                       vtk_triangle_2 = 22, vtk_tet_2 = 24;

std::size_t cell_count(const TetMesh& mesh) {
  return mesh.tets.size() + mesh.faces.size() + mesh.edges.size();
}

/// Makes one value per cell, by functions for each kind of cell.
template <class T, class OfTet, class OfFace, class OfEdge>
std::vector<T> per_cell(const TetMesh& mesh, OfTet of_tet, OfFace of_face, OfEdge of_edge) {
  std::vector<T> values;
  reserve_in_large_pages(values, cell_count(mesh));
  for (std::size_t i = 0; i < mesh.tets.size(); ++i) values.push_back(static_cast<T>(of_tet(i)));
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) values.push_back(static_cast<T>(of_face(i)));
  for (std::size_t i = 0; i < mesh.edges.size(); ++i) values.push_back(static_cast<T>(of_edge(i)));
  return values;
}

constexpr auto zero = [](std::size_t) { return 0; };

/// Replaces infinity, which not all programs accept.
float finite(double value) {
  return static_cast<float>(std::min(value, double{std::numeric_limits<float>::max()}));
}

/// Makes the arrays of a grid, several at once.
class GridMaker {
 public:
  explicit GridMaker(const TetMesh& mesh) : mesh_(mesh) {
    grid_.point_count = mesh.points.size();
    grid_.cell_count = cell_count(mesh);
  }

  VtkGrid make() {
    add(grid_.points, "Points", [this] { return coordinates(); });
    grid_.points.components = 3;
    add(grid_.connectivity, "connectivity", [this] { return connectivity(); });
    add(grid_.offsets, "offsets", [this] { return offsets(); });
    add(grid_.types, "types", [this] { return types(); });
    add_features();
    add_labels();
    add_measures();
    parallel_for(tasks_.size(), [this](std::size_t i) { tasks_[i](); });
    for (VtkArray& array : point_data_) grid_.point_data.push_back(std::move(array));
    for (VtkArray& array : cell_data_) grid_.cell_data.push_back(std::move(array));
    return std::move(grid_);
  }

 private:
  static constexpr std::size_t tets_per_task = 1024;

  /// Adds an array at its place and fills it with the values that `values` returns.
  template <class Values>
  void add(VtkArray& array, std::string_view name, Values values) {
    array.name = name;
    tasks_.emplace_back([&array, values] { array.values = values(); });
  }
  template <class T, class OfTet, class OfFace, class OfEdge>
  void add_cell_data(std::string_view name, OfTet of_tet, OfFace of_face, OfEdge of_edge) {
    add(cell_data_.emplace_back(), name,
        [this, of_tet, of_face, of_edge] { return per_cell<T>(mesh_, of_tet, of_face, of_edge); });
  }

  std::vector<double> coordinates() const {
    std::vector<double> values;
    reserve_in_large_pages(values, 3 * mesh_.points.size());
    for (const Point& p : mesh_.points) values.insert(values.end(), {p.x, p.y, p.z});
    return values;
  }

  std::vector<std::int32_t> connectivity() const {
    std::vector<std::int32_t> values;
    const auto add_nodes = [&](const CellNodes& nodes) {
      values.insert(values.end(), nodes.begin(), nodes.end());
    };
    reserve_in_large_pages(values, 4 * mesh_.tets.size() + 3 * mesh_.faces.size() + 2 * mesh_.edges.size());
    for (std::size_t i = 0; i < mesh_.tets.size(); ++i) add_nodes(nodes_of_tet(mesh_, i));
    for (std::size_t i = 0; i < mesh_.faces.size(); ++i) add_nodes(nodes_of_face(mesh_, i));
    for (std::size_t i = 0; i < mesh_.edges.size(); ++i) add_nodes(nodes_of_edge(mesh_, i));
    return values;
  }

  std::vector<std::int64_t> offsets() const {
    std::int64_t end = 0;
    const bool second = mesh_.order() == 2;
    return per_cell<std::int64_t>(
        mesh_, [&](std::size_t) { return end += second ? 10 : 4; },
        [&](std::size_t) { return end += second ? 6 : 3; },
        [&](std::size_t) { return end += second ? 3 : 2; });
  }

  std::vector<std::uint8_t> types() const {
    const bool second = mesh_.order() == 2;
    return per_cell<std::uint8_t>(
        mesh_, [=](std::size_t) { return second ? vtk_tet_2 : vtk_tet; },
        [=](std::size_t) { return second ? vtk_triangle_2 : vtk_triangle; },
        [=](std::size_t) { return second ? vtk_line_2 : vtk_line; });
  }

  void add_features() {
    if (mesh_.features.empty()) return;
    add(point_data_.emplace_back(), "feature_dimension", [this] {
      std::vector<std::uint8_t> dimension;
      for (const TetMesh::VertexFeature& f : mesh_.features) dimension.push_back(f.dimension);
      return dimension;
    });
    add(point_data_.emplace_back(), "feature", [this] {
      std::vector<std::int32_t> feature;
      for (const TetMesh::VertexFeature& f : mesh_.features)
        feature.push_back(static_cast<std::int32_t>(f.feature));
      return feature;
    });
  }

  void add_labels() {
    const auto tet_region = [this](std::size_t i) { return mesh_.tet_region[i]; };
    const auto back = [this](std::size_t i) { return mesh_.face_regions[i][0]; };
    const auto front = [this](std::size_t i) { return mesh_.face_regions[i][1]; };
    const auto either = [=](std::size_t i) { return back(i) != 0 ? back(i) : front(i); };
    add_cell_data<std::int32_t>("region", tet_region, either, zero);
    add_cell_data<std::int32_t>("region_back", tet_region, back, zero);
    add_cell_data<std::int32_t>("region_front", tet_region, front, zero);
    add_cell_data<std::int64_t>(
        "tag", [this](std::size_t i) { return mesh_.tet_tag[i]; },
        [this](std::size_t i) { return mesh_.face_tag[i]; },
        [this](std::size_t i) { return mesh_.edge_tag[i]; });
    add_cell_data<std::int32_t>(
        "feature", [](std::size_t) { return -1; }, [this](std::size_t i) { return mesh_.face_patch[i]; },
        [this](std::size_t i) { return mesh_.edge_curve[i]; });
    add_cell_data<std::uint8_t>(
        "collar", [this](std::size_t i) { return mesh_.tet_collar[i]; }, zero, zero);
    add_cell_data<std::int64_t>(
        "crease", [this](std::size_t i) { return mesh_.tet_crease[i]; }, zero, zero);
    if (!mesh_.tet_thin.empty())
      add_cell_data<std::uint8_t>(
          "thin", [this](std::size_t i) { return mesh_.tet_thin[i]; }, zero, zero);
    if (mesh_.tet_partition.empty()) return;
    add(cell_data_.emplace_back(), "partition", [this] {
      const std::vector<Index> faces = partitions_of_faces(mesh_), edges = partitions_of_edges(mesh_);
      return per_cell<std::int32_t>(
          mesh_, [&](std::size_t i) { return mesh_.tet_partition[i]; },
          [&](std::size_t i) { return faces[i]; }, [&](std::size_t i) { return edges[i]; });
    });
  }

  /// Adds the measures, which take longest.
  void add_measures() {
    std::array<float*, 3> of_cells{};
    for (std::size_t k = 0; k < of_cells.size(); ++k) {
      constexpr std::array<std::string_view, 3> names{"radius_edge", "min_dihedral", "max_dihedral"};
      VtkArray& array = cell_data_.emplace_back();
      array.name = names[k];
      std::vector<float> values;
      resize_in_large_pages(values, cell_count(mesh_));
      of_cells[k] = values.data();
      array.values = std::move(values);
    }
    for (std::size_t first = 0; first < mesh_.tets.size(); first += tets_per_task)
      tasks_.emplace_back([this, of_cells, first] {
        const std::size_t end = std::min(first + tets_per_task, mesh_.tets.size());
        for (std::size_t i = first; i < end; ++i) {
          const auto& [a, b, c, d] = mesh_.tets[i];
          const auto& p = mesh_.points;
          const TetQuality quality = measure(p[a], p[b], p[c], p[d]);
          of_cells[0][i] = finite(quality.radius_edge);
          of_cells[1][i] = finite(quality.min_dihedral);
          of_cells[2][i] = finite(quality.max_dihedral);
        }
      });
  }

  const TetMesh& mesh_;
  VtkGrid grid_;
  std::deque<VtkArray> point_data_, cell_data_;
  std::vector<std::function<void()>> tasks_;
};

// Reading

/// The cells of one piece by kind, as positions in its arrays.
struct CellKinds {
  std::vector<std::size_t> tets, faces, edges;
};

std::size_t nodes_of_type(std::size_t cell, std::int64_t type) {
  switch (type) {
    case vtk_vertex: return 1;
    case vtk_line: return 2;
    case vtk_triangle:
    case vtk_line_2: return 3;
    case vtk_tet: return 4;
    case vtk_triangle_2: return 6;
    case vtk_tet_2: return 10;
    default:
      throw VtkPieceError{
          "types", fmt::format("cell {} has the type {}, which is not supported, only tetrahedra (10, 24), "
                               "triangles (5, 22) and lines (3, 21)",
                               cell, type)};
  }
}

CellNodes read_nodes(const VtkPiece& piece, std::size_t cell, std::span<const std::int64_t> corners,
                     std::size_t first_point) {
  CellNodes nodes;
  for (const std::int64_t corner : corners) {
    if (corner < 0 || corner >= static_cast<std::int64_t>(piece.points.size()))
      throw VtkPieceError{"connectivity", fmt::format("cell {} has the corner {}, but there are {} points",
                                                      cell, corner, piece.points.size())};
    nodes.add(static_cast<Index>(first_point + static_cast<std::size_t>(corner)));
  }
  return nodes;
}

void add_cell(std::int64_t type, const CellNodes& nodes, std::size_t cell, TetMesh& mesh, CellKinds& kinds) {
  if (type == vtk_tet || type == vtk_tet_2) {
    add_tet(nodes, mesh);
    kinds.tets.push_back(cell);
  } else if (type == vtk_triangle || type == vtk_triangle_2) {
    add_face(nodes, mesh);
    kinds.faces.push_back(cell);
  } else if (type == vtk_line || type == vtk_line_2) {
    add_edge(nodes, mesh);
    kinds.edges.push_back(cell);
  }
}

CellKinds add_cells(const VtkPiece& piece, std::size_t first_point, TetMesh& mesh) {
  CellKinds kinds;
  const auto corner_count = static_cast<std::int64_t>(piece.connectivity.size());
  std::int64_t begin = 0;
  for (std::size_t i = 0; i < piece.types.size(); ++i) {
    const std::size_t n = nodes_of_type(i, piece.types[i]);
    if (piece.ends[i] < begin || piece.ends[i] > corner_count ||
        piece.ends[i] - begin != static_cast<std::int64_t>(n))
      throw VtkPieceError{"types",
                          fmt::format("cell {} of type {} ends at {} of {} corners, but begins at {}", i,
                                      piece.types[i], piece.ends[i], corner_count, begin)};
    const auto* first = piece.connectivity.data() + begin;
    add_cell(piece.types[i], read_nodes(piece, i, {first, n}, first_point), i, mesh, kinds);
    begin = piece.ends[i];
  }
  if (begin != corner_count)
    throw VtkPieceError{"connectivity", fmt::format("expected {} corners, found {}", begin, corner_count)};
  return kinds;
}

template <class T>
void pick(const std::vector<std::int64_t>& values, const std::vector<std::size_t>& cells,
          std::vector<T>& to) {
  if (!values.empty())
    for (const std::size_t cell : cells) to.push_back(static_cast<T>(values[cell]));
}

/// Returns the first of these arrays that exists; empty if none does.
const std::vector<std::int64_t>& find_array(const VtkPiece::Arrays& arrays,
                                            std::initializer_list<std::string_view> names) {
  static const std::vector<std::int64_t> nothing;
  for (const std::string_view name : names)
    if (const auto found = arrays.find(name); found != arrays.end()) return found->second;
  return nothing;
}

void add_read_labels(const VtkPiece& piece, const CellKinds& kinds, TetMesh& mesh) {
  const auto find = [&](std::initializer_list<std::string_view> names) -> const auto& {
    return find_array(piece.cell_data, names);
  };
  const auto& tags = find({"tag", "gmsh:physical", "medit:ref", "CellEntityIds", "region"});
  pick(tags, kinds.tets, mesh.tet_tag);
  pick(tags, kinds.faces, mesh.face_tag);
  pick(tags, kinds.edges, mesh.edge_tag);
  const auto& regions = find({"region"});
  if (std::all_of(regions.begin(), regions.end(), [](std::int64_t r) { return r >= 0 && r < none; }))
    pick(regions, kinds.tets, mesh.tet_region);
  pick(find({"collar"}), kinds.tets, mesh.tet_collar);
  pick(find({"crease"}), kinds.tets, mesh.tet_crease);
  pick(find({"thin"}), kinds.tets, mesh.tet_thin);
  const auto& partitions = find({"partition"});
  if (std::all_of(partitions.begin(), partitions.end(),
                  [](std::int64_t p) { return p >= 0 && p < most_partitions; }))
    pick(partitions, kinds.tets, mesh.tet_partition);
  const auto& features = find({"feature"});
  pick(features, kinds.faces, mesh.face_patch);
  pick(features, kinds.edges, mesh.edge_curve);
  const auto &back = find({"region_back"}), &front = find({"region_front"});
  if (!back.empty() && !front.empty())
    for (const std::size_t cell : kinds.faces)
      mesh.face_regions.push_back({static_cast<Index>(back[cell]), static_cast<Index>(front[cell])});
}

void add_read_features(const VtkPiece& piece, TetMesh& mesh) {
  const auto &dimensions = find_array(piece.point_data, {"feature_dimension"}),
             &features = find_array(piece.point_data, {"feature"});
  if (dimensions.empty() || features.empty()) return;
  for (std::size_t i = 0; i < piece.points.size(); ++i) {
    if (dimensions[i] < 0 || dimensions[i] > 3)
      throw VtkPieceError{"feature_dimension",
                          fmt::format("point {} has the feature dimension {}", i, dimensions[i])};
    mesh.features.push_back({static_cast<std::uint8_t>(dimensions[i]), static_cast<Index>(features[i])});
  }
}

template <class T>
void drop_partial(std::vector<T>& values, std::size_t count) {
  if (values.size() != count) values.clear();
}

}  // namespace

VtkGrid make_vtk_grid(const TetMesh& mesh) { return GridMaker(mesh).make(); }

std::vector<VtkArray> names_array(const TetMesh& mesh) {
  const std::string text = names_text(mesh);
  if (text.empty()) return {};
  return {{std::string(vtk_names), std::vector<std::uint8_t>(text.begin(), text.end())}};
}

std::string names_of(const std::vector<std::int64_t>& bytes) {
  std::string text;
  for (const std::int64_t byte : bytes) text += static_cast<char>(byte);
  return text;
}

std::vector<VtkArray> take_boundary(const TetMesh& mesh, VtkGrid& grid) {
  const std::size_t tets = mesh.tets.size(), corners = tets * (mesh.order() == 2 ? 10 : 4);
  const auto name_of = [](const VtkArray& array) { return std::string(vtk_boundary_prefix) + array.name; };
  std::vector<VtkArray> boundary;
  // Cuts an array and returns the part behind the cut.
  const auto cut = [&](VtkArray& array, std::size_t at) {
    VtkArray rest{name_of(array), {}};
    std::visit(
        [&](auto& values) {
          const auto middle = values.begin() + static_cast<std::ptrdiff_t>(at);
          rest.values = std::decay_t<decltype(values)>(middle, values.end());
          values.erase(middle, values.end());
        },
        array.values);
    return rest;
  };
  boundary.push_back({std::string(vtk_boundary_prefix) + "of",
                      std::vector<std::int64_t>{static_cast<std::int64_t>(mesh.points.size()),
                                                static_cast<std::int64_t>(tets)}});
  boundary.push_back(cut(grid.connectivity, corners));
  boundary.push_back(cut(grid.offsets, tets));
  for (auto& end : std::get<std::vector<std::int64_t>>(boundary.back().values))
    end -= static_cast<std::int64_t>(corners);
  boundary.push_back(cut(grid.types, tets));
  for (VtkArray& array : grid.cell_data) {
    VtkArray rest = cut(array, tets);
    if (std::find(vtk_boundary_arrays.begin(), vtk_boundary_arrays.end(), array.name) !=
        vtk_boundary_arrays.end())
      boundary.push_back(std::move(rest));
  }
  std::erase_if(grid.cell_data, [](const VtkArray& array) {
    return array.name == "region_back" || array.name == "region_front" || array.name == "feature";
  });
  grid.cell_count = tets;
  for (VtkArray& names : names_array(mesh)) boundary.push_back(std::move(names));
  return boundary;
}

void add_vtk_piece(const VtkPiece& piece, TetMesh& mesh) {
  const std::size_t first_point = mesh.points.size();
  if (first_point + piece.points.size() >= none)
    throw VtkPieceError{"Points", "more points than can be numbered"};
  mesh.points.insert(mesh.points.end(), piece.points.begin(), piece.points.end());
  const CellKinds kinds = add_cells(piece, first_point, mesh);
  add_read_labels(piece, kinds, mesh);
  add_read_features(piece, mesh);
  take_names(piece.names, mesh);
}

void complete_vtk_mesh(const std::string& path, TetMesh& mesh) {
  drop_partial(mesh.features, mesh.points.size());
  drop_partial(mesh.tet_tag, mesh.tets.size());
  drop_partial(mesh.tet_region, mesh.tets.size());
  drop_partial(mesh.tet_collar, mesh.tets.size());
  drop_partial(mesh.tet_crease, mesh.tets.size());
  drop_partial(mesh.tet_thin, mesh.tets.size());
  drop_partial(mesh.tet_partition, mesh.tets.size());
  drop_partial(mesh.face_tag, mesh.faces.size());
  drop_partial(mesh.face_patch, mesh.faces.size());
  drop_partial(mesh.face_regions, mesh.faces.size());
  drop_partial(mesh.edge_tag, mesh.edges.size());
  drop_partial(mesh.edge_curve, mesh.edges.size());
  complete_mesh(path, mesh);
}

}  // namespace collarmesh::io
