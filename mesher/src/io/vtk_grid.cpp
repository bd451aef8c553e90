#include "io/vtk_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <deque>
#include <functional>
#include <limits>
#include <optional>
#include <span>

#include "common/large_pages.h"
#include "common/parallel_for.h"
#include "io/cell_nodes.h"
#include "io/cell_orientation.h"
#include "io/cell_partitions.h"
#include "io/complete_mesh.h"
#include "io/names_text.h"

namespace collarmesh::io {

namespace {

constexpr std::int64_t vtk_vertex = 1;

/// VTK's types of cells, by order.
constexpr PerKind<std::array<std::uint8_t, 2>> vtk_types{{{{10, 24},    // tets
                                                           {13, 26},    // prisms
                                                           {14, 27},    // pyramids
                                                           {5, 22},     // triangles
                                                           {9, 23},     // quadrangles
                                                           {3, 21}}}};  // edges

/// Returns the values `of_cell(kind, i)` of all cells, in the order of the kinds.
template <class T, class OfCell>
std::vector<T> per_cell(const TetMesh& mesh, const OfCell& of_cell) {
  std::vector<T> values;
  reserve_in_large_pages(values, count_of_all(mesh));
  for (const CellKind kind : all_cell_kinds)
    for (std::size_t i = 0; i < count_of(mesh, kind); ++i) values.push_back(static_cast<T>(of_cell(kind, i)));
  return values;
}

/// Returns a function that gives the values of tets, and 0 for other cells.
template <class Values>
auto of_tets(const Values& values) {
  return [&values](CellKind kind, std::size_t i) {
    return kind == CellKind::tet ? values[i] : typename Values::value_type{0};
  };
}

/// Limits a value to the largest float, because not all programs accept infinity.
float finite(double value) {
  return static_cast<float>(std::min(value, double{std::numeric_limits<float>::max()}));
}

/// A maker of a grid's arrays. Several threads fill different arrays at once.
class GridMaker {
 public:
  explicit GridMaker(const TetMesh& mesh) : mesh_(mesh) {
    grid_.point_count = mesh.points.size();
    grid_.cell_count = count_of_all(mesh);
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

  /// Names an array, and adds a task that fills it with the values that `values()` returns.
  template <class Values>
  void add(VtkArray& array, std::string_view name, Values values) {
    array.name = name;
    tasks_.emplace_back([&array, values] { array.values = values(); });
  }
  template <class T, class OfCell>
  void add_cell_data(std::string_view name, OfCell of_cell) {
    add(cell_data_.emplace_back(), name, [this, of_cell] { return per_cell<T>(mesh_, of_cell); });
  }

  std::vector<double> coordinates() const {
    std::vector<double> values;
    reserve_in_large_pages(values, 3 * mesh_.points.size());
    for (const Point& p : mesh_.points) values.insert(values.end(), {p.x, p.y, p.z});
    return values;
  }

  std::vector<std::int32_t> connectivity() const {
    std::vector<std::int32_t> values;
    std::size_t corners = 0;
    for (const CellKind kind : all_cell_kinds) corners += shape_of(kind).corners * count_of(mesh_, kind);
    reserve_in_large_pages(values, corners);
    for (const CellKind kind : all_cell_kinds)
      for (std::size_t i = 0; i < count_of(mesh_, kind); ++i) {
        const CellNodes nodes = in_vtk_order(kind, nodes_of(kind)(mesh_, i));
        values.insert(values.end(), nodes.begin(), nodes.end());
      }
    return values;
  }

  std::vector<std::int64_t> offsets() const {
    std::size_t end = 0;
    return per_cell<std::int64_t>(
        mesh_, [&](CellKind kind, std::size_t) { return end += shape_of(kind).nodes(mesh_.order()); });
  }

  std::vector<std::uint8_t> types() const {
    const int order = mesh_.order();
    return per_cell<std::uint8_t>(mesh_,
                                  [&](CellKind kind, std::size_t) { return vtk_type_of(kind, order); });
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

  /// Returns the region behind a face (`side` 0) or in front of it (1); for a cell with volume, its own
  /// region; for an edge, 0.
  Index region_beside(CellKind kind, std::size_t i, std::size_t side) const {
    const std::size_t dimension = shape_of(kind).dimension;
    if (dimension == 3) return features_of(mesh_, kind)[i];
    return dimension == 2 ? regions_beside(mesh_, kind)[i][side] : 0;
  }

  void add_labels() {
    add_cell_data<std::int32_t>("region", [this](CellKind kind, std::size_t i) {
      const Index back = region_beside(kind, i, 0);
      return back != 0 ? back : region_beside(kind, i, 1);
    });
    add_cell_data<std::int32_t>("region_back",
                                [this](CellKind kind, std::size_t i) { return region_beside(kind, i, 0); });
    add_cell_data<std::int32_t>("region_front",
                                [this](CellKind kind, std::size_t i) { return region_beside(kind, i, 1); });
    add_cell_data<std::int64_t>("tag",
                                [this](CellKind kind, std::size_t i) { return tags_of(mesh_, kind)[i]; });
    add_cell_data<std::int32_t>("feature", [this](CellKind kind, std::size_t i) {
      return shape_of(kind).dimension == 3 ? none : features_of(mesh_, kind)[i];
    });
    add_cell_data<std::uint8_t>("collar", of_tets(mesh_.tet_collar));
    add_cell_data<std::int64_t>("crease", of_tets(mesh_.tet_crease));
    if (!mesh_.tet_thin.empty()) add_cell_data<std::uint8_t>("thin", of_tets(mesh_.tet_thin));
    if (!mesh_.layers.empty())
      add_cell_data<std::int32_t>("layer",
                                  [this](CellKind kind, std::size_t i) { return layer_of(mesh_, kind, i); });
    if (mesh_.tet_partition.empty()) return;
    add(cell_data_.emplace_back(), "partition", [this] {
      const std::vector<Index> faces = partitions_of_faces(mesh_), edges = partitions_of_edges(mesh_);
      return per_cell<std::int32_t>(mesh_, [&](CellKind kind, std::size_t i) {
        return kind == CellKind::tet ? mesh_.tet_partition[i] : kind == CellKind::edge ? edges[i] : faces[i];
      });
    });
  }

  /// Adds the measures of tets in many tasks, because they take longest.
  void add_measures() {
    std::array<float*, 3> of_cells{};
    for (std::size_t k = 0; k < of_cells.size(); ++k) {
      constexpr std::array<std::string_view, 3> names{"radius_edge", "min_dihedral", "max_dihedral"};
      VtkArray& array = cell_data_.emplace_back();
      array.name = names[k];
      std::vector<float> values;
      resize_in_large_pages(values, count_of_all(mesh_));
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
using CellKinds = PerKind<std::vector<std::size_t>>;

/// The kind of cells that a VTK cell type stands for, and their number of nodes.
struct ReadType {
  std::size_t nodes = 1;
  std::optional<CellKind> kind;  ///< nothing: a point, which is skipped
};

ReadType find_type(std::size_t cell, std::int64_t type) {
  if (type == vtk_vertex) return {};
  for (const CellKind kind : all_cell_kinds)
    for (const int order : {1, 2})
      if (vtk_type_of(kind, order) == type) return {shape_of(kind).nodes(order), kind};
  throw VtkPieceError{
      "types",
      fmt::format(
          "cell {} has the type {}, which is not supported, only tetrahedra (10, 24), prisms (13, 26), "
          "pyramids (14, 27), triangles (5, 22), quadrangles (9, 23) and lines (3, 21)",
          cell, type)};
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

CellKinds add_cells(const VtkPiece& piece, std::size_t first_point, TetMesh& mesh) {
  CellKinds kinds;
  const auto corner_count = static_cast<std::int64_t>(piece.connectivity.size());
  std::int64_t begin = 0;
  for (std::size_t i = 0; i < piece.types.size(); ++i) {
    const ReadType type = find_type(i, piece.types[i]);
    if (piece.ends[i] < begin || piece.ends[i] > corner_count ||
        piece.ends[i] - begin != static_cast<std::int64_t>(type.nodes))
      throw VtkPieceError{"types", fmt::format("cell {} of type {} has {} node{}, but its part of the "
                                               "connectivity goes from {} to {}, of {} entries",
                                               i, piece.types[i], type.nodes, type.nodes == 1 ? "" : "s",
                                               begin, piece.ends[i], corner_count)};
    const auto* first = piece.connectivity.data() + begin;
    const CellNodes nodes = read_nodes(piece, i, {first, type.nodes}, first_point);
    if (type.kind) {
      add_cell(*type.kind, in_vtk_order(*type.kind, nodes), mesh);
      kinds[*type.kind].push_back(i);
    }
    begin = piece.ends[i];
  }
  if (begin != corner_count)
    throw VtkPieceError{"connectivity",
                        fmt::format("the cells have {} corners in all, but the connectivity has {} entries",
                                    begin, corner_count)};
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

bool all_below(const std::vector<std::int64_t>& values, std::int64_t limit) {
  return std::all_of(values.begin(), values.end(), [=](std::int64_t v) { return v >= 0 && v < limit; });
}

void add_read_labels(const VtkPiece& piece, const CellKinds& kinds, TetMesh& mesh) {
  const auto find = [&](std::initializer_list<std::string_view> names) -> const auto& {
    return find_array(piece.cell_data, names);
  };
  const auto &tags = find({"tag", "gmsh:physical", "medit:ref", "CellEntityIds", "region"}),
             &regions = find({"region"}), &features = find({"feature"}), &layers = find({"layer"}),
             &back = find({"region_back"}), &front = find({"region_front"});
  for (const CellKind kind : all_cell_kinds) {
    const std::vector<std::size_t>& cells = kinds[kind];
    const std::size_t dimension = shape_of(kind).dimension;
    pick(tags, cells, tags_of(mesh, kind));
    if (dimension < 3 || all_below(regions, none))
      pick(dimension == 3 ? regions : features, cells, features_of(mesh, kind));
    if (dimension == 3 && all_below(layers, most_layers)) pick(layers, cells, layers_of(mesh, kind));
    if (dimension == 2 && !back.empty() && !front.empty())
      for (const std::size_t cell : cells)
        regions_beside(mesh, kind)
            .push_back({static_cast<Index>(back[cell]), static_cast<Index>(front[cell])});
  }
  const std::vector<std::size_t>& tets = kinds[CellKind::tet];
  pick(find({"collar"}), tets, mesh.tet_collar);
  pick(find({"crease"}), tets, mesh.tet_crease);
  pick(find({"thin"}), tets, mesh.tet_thin);
  const auto& partitions = find({"partition"});
  if (all_below(partitions, most_partitions)) pick(partitions, tets, mesh.tet_partition);
}

void add_read_features(const VtkPiece& piece, TetMesh& mesh) {
  const auto &dimensions = find_array(piece.point_data, {"feature_dimension"}),
             &features = find_array(piece.point_data, {"feature"});
  if (dimensions.empty() || features.empty()) return;
  for (std::size_t i = 0; i < piece.points.size(); ++i) {
    if (dimensions[i] < 0 || dimensions[i] > 3)
      throw VtkPieceError{
          "feature_dimension",
          fmt::format("point {} has the feature dimension {}, which must be from 0 to 3", i, dimensions[i])};
    mesh.features.push_back({static_cast<std::uint8_t>(dimensions[i]), static_cast<Index>(features[i])});
  }
}

template <class T>
void drop_partial(std::vector<T>& values, std::size_t count) {
  if (values.size() != count) values.clear();
}

}  // namespace

int vtk_type_of(CellKind kind, int order) { return vtk_types[kind][order == 2 ? 1 : 0]; }

CellNodes in_vtk_order(CellKind kind, const CellNodes& nodes) {
  return kind == CellKind::prism ? turned(kind, nodes) : nodes;
}

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
  const std::size_t volumes = count_of_dimension(mesh, 3);
  std::size_t corners = 0;
  for_each_kind(mesh, 3,
                [&](CellKind kind) { corners += count_of(mesh, kind) * shape_of(kind).nodes(mesh.order()); });
  const auto name_of = [](const VtkArray& array) { return std::string(vtk_boundary_prefix) + array.name; };
  std::vector<VtkArray> boundary;
  // Cuts an array before value `at` and returns the part from there on.
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
                                                static_cast<std::int64_t>(volumes)}});
  boundary.push_back(cut(grid.connectivity, corners));
  boundary.push_back(cut(grid.offsets, volumes));
  for (auto& end : std::get<std::vector<std::int64_t>>(boundary.back().values))
    end -= static_cast<std::int64_t>(corners);
  boundary.push_back(cut(grid.types, volumes));
  for (VtkArray& array : grid.cell_data) {
    VtkArray rest = cut(array, volumes);
    if (std::find(vtk_boundary_arrays.begin(), vtk_boundary_arrays.end(), array.name) !=
        vtk_boundary_arrays.end())
      boundary.push_back(std::move(rest));
  }
  std::erase_if(grid.cell_data, [](const VtkArray& array) {
    return array.name == "region_back" || array.name == "region_front" || array.name == "feature";
  });
  grid.cell_count = volumes;
  for (VtkArray& names : names_array(mesh)) boundary.push_back(std::move(names));
  return boundary;
}

void add_vtk_piece(const VtkPiece& piece, TetMesh& mesh) {
  assert(piece.ends.size() == piece.types.size());
  assert(std::ranges::all_of(piece.point_data,
                             [&](const auto& array) { return array.second.size() == piece.points.size(); }));
  assert(std::ranges::all_of(piece.cell_data,
                             [&](const auto& array) { return array.second.size() == piece.types.size(); }));
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
  for (const CellKind kind : all_cell_kinds) {
    const std::size_t count = count_of(mesh, kind), dimension = shape_of(kind).dimension;
    drop_partial(tags_of(mesh, kind), count);
    drop_partial(features_of(mesh, kind), count);
    if (dimension == 3) drop_partial(layers_of(mesh, kind), count);
    if (dimension == 2) drop_partial(regions_beside(mesh, kind), count);
  }
  drop_partial(mesh.tet_collar, mesh.tets.size());
  drop_partial(mesh.tet_crease, mesh.tets.size());
  drop_partial(mesh.tet_thin, mesh.tets.size());
  drop_partial(mesh.tet_partition, mesh.tets.size());
  complete_mesh(path, mesh);
}

}  // namespace collarmesh::io
