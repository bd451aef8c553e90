#include "report/conversion_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>
#include <vector>

#include "collarmesh/io/tet_mesh_io.h"
#include "collarmesh/partition.h"
#include "io/cell_nodes.h"
#include "io/node_groups.h"
#include "report/layer_counts.h"
#include "report/listed.h"

namespace collarmesh::report {

namespace {

/// The data that a format can store in addition to points and corners of cells, which all formats store.
struct Kept {
  std::string_view format;
  bool facet_tags = false, segments = false, point_tags = false, regions = false, names = false;
};
constexpr std::array surfaces{
    Kept{".off", false, true, false, false},  Kept{".obj", true, true, false, false, true},
    Kept{".stl", false, false, false, false}, Kept{".ply", true, true, false, false},
    Kept{".om", false, false, false, false},  Kept{".poly", true, true, true, true},
    Kept{".smesh", true, true, true, true}};

constexpr unsigned curve_names = 1U << 1, patch_names = 1U << 2, region_names = 1U << 3,
                   all_names = curve_names | patch_names | region_names;
struct MeshKept {
  std::string_view format;
  bool collar = false, features = false, edges = true, curve_nodes = false, regions = true,
       region_tags = true, region_numbers = true, loose_triangles = true, inner_faces = true, layers = false;
  unsigned names = all_names;
};
constexpr std::array meshes{
    MeshKept{.format = ".vtu", .collar = true, .features = true, .layers = true},
    MeshKept{.format = ".pvtu", .collar = true, .features = true},
    MeshKept{.format = ".vtk", .collar = true, .features = true, .layers = true},
    MeshKept{.format = ".msh", .collar = true, .features = true, .layers = true},
    MeshKept{.format = ".msh2"},
    MeshKept{.format = ".mesh", .region_tags = false, .names = 0},
    MeshKept{.format = ".inp", .edges = false, .curve_nodes = true, .loose_triangles = false},
    MeshKept{.format = ".unv"},
    MeshKept{.format = ".ele", .region_numbers = false, .names = 0},
    MeshKept{.format = ".bdf", .edges = false, .names = patch_names | region_names},
    MeshKept{.format = ".cdb", .edges = false, .curve_nodes = true},
    MeshKept{
        .format = ".mfem", .edges = false, .loose_triangles = false, .names = patch_names | region_names},
    MeshKept{.format = ".exo", .edges = false, .curve_nodes = true, .loose_triangles = false},
    MeshKept{.format = ".cgns"},
    MeshKept{.format = ".su2",
             .edges = false,
             .regions = false,
             .loose_triangles = false,
             .inner_faces = false,
             .names = patch_names},
    MeshKept{.format = ".polymesh",
             .edges = false,
             .region_numbers = false,
             .loose_triangles = false,
             .names = patch_names | region_names},
    MeshKept{.format = ".med", .region_numbers = false},
    MeshKept{.format = ".xdmf", .collar = true, .features = true}};

void add(std::vector<std::string>& losses, bool kept, std::size_t count, const char* what) {
  if (!kept && count > 0) losses.push_back(fmt::format("{} {}", count, what));
}

template <class Values>
std::size_t count_tags(const Values& values) {
  return static_cast<std::size_t>(std::count_if(values.begin(), values.end(), [](auto v) { return v != 0; }));
}

/// Counts the names of groups of the dimensions whose bits are set in `which`: bit 1 for curves and so on.
std::size_t count_names(const TagNames& names, unsigned which) {
  std::size_t count = 0;
  for (std::size_t dimension = 1; dimension <= 3; ++dimension)
    if ((which >> dimension & 1U) != 0) count += names.of(dimension).size();
  return count;
}

/// Counts cells of a dimension for which `holds(kind, cell)` is true.
template <class Holds>
std::size_t count_cells(const TetMesh& mesh, std::size_t dimension, const Holds& holds) {
  std::size_t count = 0;
  io::for_each_kind(mesh, dimension, [&](CellKind kind) {
    for (std::size_t i = 0; i < io::count_of(mesh, kind); ++i) count += holds(kind, i) ? 1 : 0;
  });
  return count;
}

std::string shown(const std::string& path) { return path == "-" ? "standard output" : path; }

std::string counts_text(std::string_view verb,
                        std::initializer_list<std::pair<Index, std::string_view>> counts) {
  std::string text;
  for (const auto& [count, what] : counts)
    if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, what);
  return text.empty() ? text : fmt::format("  {}: {}\n", verb, text);
}

}  // namespace

std::vector<std::string> lost_by(const std::string& format, const PolygonSoup& soup) {
  const auto* kept = std::ranges::find(surfaces, format, &Kept::format);
  if (kept == surfaces.end()) return {};
  std::vector<std::string> losses;
  std::size_t facet_tags = 0;
  for (Index f = 0; f < soup.facet_count(); ++f) facet_tags += soup.facet_tag(f) != 0 ? 1 : 0;
  add(losses, kept->facet_tags, facet_tags, "tags of facets");
  add(losses, kept->segments, soup.segments.size(), "segments");
  add(losses, kept->point_tags, count_tags(soup.point_tags), "tags of points");
  add(losses, kept->regions, soup.region_points.size(), "region points");
  add(losses, kept->regions, soup.hole_points.size(), "hole points");
  add(losses, kept->names, soup.tag_names.of(2).size(), "names of patches");
  return losses;
}

std::vector<std::string> lost_by(const std::string& format, const TetMesh& mesh) {
  const auto* kept = std::ranges::find(meshes, format, &MeshKept::format);
  if (kept == meshes.end()) return {};
  std::vector<std::string> losses;
  add(losses, kept->collar, count_tags(mesh.tet_collar), "collar marks of tets");
  add(losses, kept->collar, count_tags(mesh.tet_thin), "marks of thin tets");
  const std::vector<std::string> partitioned = io::formats_with_partitions();
  add(losses, std::find(partitioned.begin(), partitioned.end(), format) != partitioned.end(),
      measure_partitions(mesh).partitions, "partitions");
  add(losses, false, count_names(mesh.names, all_names & ~kept->names), "names of groups");
  add(losses, kept->features, mesh.features.size(), "features of points");
  add(losses, kept->edges, mesh.edges.size(),
      kept->curve_nodes ? "edges on curves (node sets are kept)" : "edges on curves");
  const auto loose =
      std::count(mesh.face_regions.begin(), mesh.face_regions.end(), std::array<Index, 2>{0, 0});
  add(losses, kept->loose_triangles, static_cast<std::size_t>(loose), "triangles that are no side of a tet");
  const auto is_inside = [&](CellKind kind, std::size_t f) {
    const auto& regions = io::regions_beside(mesh, kind)[f];
    return regions[0] != 0 && regions[1] != 0;
  };
  add(losses, kept->inner_faces, count_cells(mesh, 2, is_inside),
      mesh.layers.quads.empty() ? "triangles inside" : "triangles and quadrangles inside");
  add(losses, kept->layers,
      count_cells(mesh, 3, [&](CellKind kind, std::size_t i) { return io::layer_of(mesh, kind, i) != 0; }),
      "numbers of layers");
  const std::size_t regions = io::tags_of_regions(mesh).size();
  add(losses, kept->regions || regions == 1, regions, "regions");
  const std::size_t other = count_cells(mesh, 3, [&](CellKind kind, std::size_t i) {
    return io::tags_of(mesh, kind)[i] != static_cast<Tag>(io::features_of(mesh, kind)[i]);
  });
  add(losses, kept->region_tags, other, "tags of tets (the number of their region is kept)");
  add(losses, kept->region_numbers, other, "region numbers of tets (the tag of their region is kept)");
  return losses;
}

bool keeps_names(const std::string& format) {
  const auto* kept = std::ranges::find(meshes, format, &MeshKept::format);
  return kept == meshes.end() || kept->names != 0;
}

std::string soup_text(const std::string& path, const PolygonSoup& soup) {
  return fmt::format("{}: {} points, {} facets, {} segments, {} region points, {} hole points\n", shown(path),
                     soup.points.size(), soup.facet_count(), soup.segments.size(), soup.region_points.size(),
                     soup.hole_points.size());
}

std::string tet_mesh_text(const std::string& path, const TetMesh& mesh) {
  return fmt::format(
      "{}: {} tets of order {}, {}{} points, {} boundary and interface triangles, {}{} curve edges\n",
      shown(path), mesh.tets.size(), mesh.order(),
      layers_text(mesh.layers.prisms.size(), mesh.layers.pyramids.size()), mesh.points.size(),
      mesh.faces.size(), quads_text(mesh.layers.quads.size()), mesh.edges.size());
}

std::string merge_text(const MergeReport& report) {
  return counts_text("welded", {{report.welded_points, "points to others"}}) +
         counts_text("cut into triangles", {{report.cut_facets, "facets"}}) +
         counts_text("dropped", {{report.unused_points, "points that nothing uses"},
                                 {report.degenerate_facets, "facets without three distinct corners"},
                                 {report.repeated_facets, "facets that repeat another one"}});
}

namespace {

// Describes patches that were merged where parts touch: "; there patch 7 became patch 2, 9 became 3".
std::string replaced_text(const std::vector<std::pair<Tag, Tag>>& replaced) {
  std::string text;
  for (std::size_t k = 0; k < std::min(replaced.size(), listed); ++k)
    text += text.empty()
                ? fmt::format("; there patch {} became patch {}", replaced[k].first, replaced[k].second)
                : fmt::format(", {} became {}", replaced[k].first, replaced[k].second);
  return replaced.size() > listed ? fmt::format("{} and {} more", text, replaced.size() - listed) : text;
}

}  // namespace

std::string cleanup_text(const Plc::Cleanup& cleanup) {
  const std::string merged = "triangles that parts have in common" + replaced_text(cleanup.replaced_tags);
  return counts_text("welded", {{cleanup.welded_points, "points to others"}}) +
         counts_text("merged", {{cleanup.shared_triangles, merged}}) +
         counts_text("dropped", {{cleanup.degenerate_triangles, "triangles without an area"},
                                 {cleanup.repeated_triangles, "triangles that repeat another one"}});
}

std::string losses_text(const std::vector<std::string>& losses) {
  return losses.empty()
             ? std::string()
             : fmt::format("  dropped, the format has no place for: {}\n", fmt::join(losses, ", "));
}

}  // namespace collarmesh::report
