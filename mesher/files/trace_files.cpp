#include "files/trace_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "collarmesh/tet_mesh.h"
#include "io/file_writer.h"
#include "io/vtk_grid.h"

namespace collarmesh::files {

namespace {

namespace fs = std::filesystem;

enum Kind : std::uint8_t { tet, patch, collar_surface, segment, ball };

/// The data of all cells of a step: one array for each quantity.
struct CellData {
  std::vector<std::uint8_t> types, kind, state, reason;
  std::vector<std::int32_t> region;
  std::vector<std::int64_t> connectivity, offsets, tag;
  std::vector<float> radius_edge, min_dihedral, max_dihedral;

  void add(std::uint8_t vtk_type, Kind of_kind, std::span<const Index> corners) {
    types.push_back(vtk_type);
    kind.push_back(of_kind);
    connectivity.insert(connectivity.end(), corners.begin(), corners.end());
    offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
    state.push_back(0);
    reason.push_back(0);
    region.push_back(0);
    tag.push_back(0);
    for (auto* values : {&radius_edge, &min_dihedral, &max_dihedral}) values->push_back(0);
  }
};

constexpr std::uint8_t vtk_vertex = 1, vtk_line = 3, vtk_triangle = 5, vtk_tetra = 10;

void add_tets(const TraceStep& step, CellData& cells) {
  for (std::size_t t = 0; t < step.tets.size(); ++t) {
    const auto& v = step.tets[t];
    const TetQuality quality =
        measure(step.points[v[0]], step.points[v[1]], step.points[v[2]], step.points[v[3]]);
    cells.add(vtk_tetra, tet, v);
    cells.region.back() = static_cast<std::int32_t>(step.region[t]);
    cells.state.back() = static_cast<std::uint8_t>(step.state[t]);
    // Flat cells have an infinite ratio, which not all readers accept, so this value replaces it.
    constexpr double largest = std::numeric_limits<float>::max();
    cells.radius_edge.back() = static_cast<float>(std::min(quality.radius_edge, largest));
    cells.min_dihedral.back() = static_cast<float>(quality.min_dihedral);
    cells.max_dihedral.back() = static_cast<float>(quality.max_dihedral);
  }
}

io::VtkGrid grid_of(const TraceStep& step) {
  CellData cells;
  add_tets(step, cells);
  for (const TraceStep::Triangle& triangle : step.triangles) {
    cells.add(vtk_triangle, triangle.collar ? collar_surface : patch, triangle.corners);
    cells.tag.back() = triangle.tag;
  }
  for (const TraceStep::Segment& s : step.segments) {
    cells.add(vtk_line, segment, s.ends);
    cells.tag.back() = s.tag;
  }
  std::vector<double> coordinates;
  std::vector<std::uint8_t> dimension = step.dimension;
  std::vector<float> radius(step.points.size(), 0);
  const auto add_point = [&](const Point& p) { coordinates.insert(coordinates.end(), {p.x, p.y, p.z}); };
  for (const Point& p : step.points) add_point(p);
  for (const TraceStep::Ball& b : step.balls) {
    cells.add(vtk_vertex, ball, std::array{static_cast<Index>(radius.size())});
    cells.reason.back() = static_cast<std::uint8_t>(b.reason);
    add_point(b.centre);
    radius.push_back(static_cast<float>(b.radius));
    constexpr std::uint8_t no_vertex = 3;
    dimension.push_back(no_vertex);
  }
  io::VtkGrid grid;
  grid.point_count = radius.size();
  grid.cell_count = cells.types.size();
  grid.points = {"Points", std::move(coordinates), 3};
  grid.connectivity = {"connectivity", std::move(cells.connectivity)};
  grid.offsets = {"offsets", std::move(cells.offsets)};
  grid.types = {"types", std::move(cells.types)};
  grid.point_data = {{"feature_dimension", std::move(dimension)}, {"radius", std::move(radius)}};
  grid.cell_data = {{"kind", std::move(cells.kind)},
                    {"region", std::move(cells.region)},
                    {"state", std::move(cells.state)},
                    {"tag", std::move(cells.tag)},
                    {"reason", std::move(cells.reason)},
                    {"radius_edge", std::move(cells.radius_edge)},
                    {"min_dihedral", std::move(cells.min_dihedral)},
                    {"max_dihedral", std::move(cells.max_dihedral)}};
  return grid;
}

}  // namespace

std::string trace_file(const std::string& folder) {
  return folder.empty() ? folder : (fs::path(folder) / "trace.pvd").string();
}

void write_trace(const std::string& path, const Trace& trace) {
  io::FileWriter out(path);
  out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" "
         "byte_order=\"LittleEndian\">\n  <Collection>\n";
  for (std::size_t i = 0; i < trace.size(); ++i) {
    const std::string name = fmt::format("{:02}_{}.vtu", i, trace[i].stage);
    io::VtkGrid grid = grid_of(trace[i]);
    io::write_vtu_grid((fs::path(path).parent_path() / name).string(), grid, {});
    out << fmt::format("    <DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>\n", i, name);
  }
  out << "  </Collection>\n</VTKFile>\n";
  out.commit();
}

}  // namespace collarmesh::files
