// Any bytes give a mesh with indices in range, or a ReadError, in memory proportional to their number. A
// tetrahedral mesh that was read can be written and read again. FUZZED_FORMAT is the format; tests/fuzz/run
// limits the time.
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <system_error>

#include "collarmesh/error.h"
#include "collarmesh/io/soup_io.h"
#include "collarmesh/io/tet_mesh_io.h"
#include "memory_limit.h"
#ifdef COLLARMESH_FUZZ_OM
#include "collarmesh/openmesh_io/read_om.h"
#endif

namespace {

using collarmesh::Index;
using collarmesh::PolygonSoup;
using collarmesh::TetMesh;

constexpr std::string_view format = FUZZED_FORMAT;

void require(bool holds, std::string_view what) {
  if (holds) return;
  std::cerr << "Not as promised: " << what << '\n';
  std::abort();
}

/// Returns the memory that a reader may allocate for a file: two characters and a line end may become a value
/// of 8 bytes that is in several lists at once.
std::size_t allowed_memory(std::size_t file_bytes) {
  constexpr std::size_t fixed = std::size_t{1} << 20, per_byte = 256;
  return fixed + per_byte * file_bytes;
}

void check(const PolygonSoup& soup) {
  const std::size_t points = soup.points.size();
  for (Index q = 0; q < soup.polygon_count(); ++q)
    for (const Index corner : soup.polygon(q)) require(corner < points, "corners of polygons");
  for (const auto& segment : soup.segments)
    require(segment.a < points && segment.b < points, "ends of segments");
  for (const auto& hole : soup.facet_holes) require(hole.facet < soup.facet_count(), "facets of holes");
  require(soup.point_tags.empty() || soup.point_tags.size() == points, "tags of points");
}

template <class Cells>
void check_nodes(const Cells& cells, std::size_t points, std::string_view what) {
  for (const auto& cell : cells)
    for (const Index node : cell) require(node < points, what);
}

void check(const TetMesh& mesh) {
  const std::size_t points = mesh.points.size(), tets = mesh.tets.size(), faces = mesh.faces.size(),
                    edges = mesh.edges.size();
  check_nodes(mesh.tets, points, "corners of tets");
  check_nodes(mesh.faces, points, "corners of faces");
  check_nodes(mesh.edges, points, "ends of edges");
  check_nodes(mesh.tet_mid_nodes, points, "mid nodes of tets");
  check_nodes(mesh.face_mid_nodes, points, "mid nodes of faces");
  for (const Index node : mesh.edge_mid_nodes) require(node < points, "mid nodes of edges");
  require(tets > 0, "any tets");
  require(mesh.features.empty() || mesh.features.size() == points, "features of points");
  require(mesh.tet_tag.size() == tets && mesh.tet_region.size() == tets && mesh.tet_collar.size() == tets &&
              mesh.tet_crease.size() == tets,
          "labels of tets");
  require(
      mesh.face_tag.size() == faces && mesh.face_regions.size() == faces && mesh.face_patch.size() == faces,
      "labels of faces");
  require(mesh.edge_tag.size() == edges && mesh.edge_curve.size() == edges, "labels of edges");
  if (mesh.order() == 1)
    require(mesh.face_mid_nodes.empty() && mesh.edge_mid_nodes.empty(), "one order");
  else
    require(mesh.tet_mid_nodes.size() == tets && mesh.face_mid_nodes.size() == faces &&
                mesh.edge_mid_nodes.size() == edges,
            "mid nodes of all cells");
}

/// Returns the number of different faces that are sides of tets.
std::size_t sides_among_faces(const TetMesh& mesh) {
  const auto sorted = [](std::array<Index, 3> corners) {
    std::sort(corners.begin(), corners.end());
    return corners;
  };
  std::set<std::array<Index, 3>> faces, sides;
  for (const auto& face : mesh.faces) faces.insert(sorted(face));
  for (const auto& [a, b, c, d] : mesh.tets)
    for (const auto& side : {sorted({a, b, c}), sorted({a, b, d}), sorted({a, c, d}), sorted({b, c, d})})
      if (faces.contains(side)) sides.insert(side);
  return sides.size();
}

/// Any error is a fault here. `.inp` can store the sides of tets, but no other faces and edges.
void check_round_trip(const TetMesh& mesh, const std::string& path) {
  collarmesh::io::write_tet_mesh(path, mesh, format);
  const TetMesh again = collarmesh::io::read_tet_mesh(path, format);
  check(again);
  const bool sides_only = format == ".inp";
  require(again.order() == mesh.order(), "the order after writing and reading");
  require(again.points.size() == mesh.points.size(), "the points after writing and reading");
  require(again.tets.size() == mesh.tets.size(), "the tets after writing and reading");
  require(again.faces.size() == (sides_only ? sides_among_faces(mesh) : mesh.faces.size()),
          "the faces after writing and reading");
  require(again.edges.size() == (sides_only ? 0 : mesh.edges.size()), "the edges after writing and reading");
}

/// Returns the result of `read`; nothing if it throws the documented error.
template <class Read>
auto read_within(std::size_t file_bytes, Read read) -> std::optional<decltype(read())> {
  const collarmesh::testing::MemoryLimit limit(allowed_memory(file_bytes));
  try {
    return read();
  } catch (const collarmesh::ReadError&) {
    return std::nullopt;
  }
}

void read_and_check(const std::string& path, std::size_t size) {
#ifdef COLLARMESH_FUZZ_OM
  if (const auto soup = read_within(size, [&] { return collarmesh::openmesh_io::read_om(path); }))
    check(*soup);
#else
  if (collarmesh::io::is_soup_format("", format)) {
    const auto soup = read_within(size, [&] { return collarmesh::io::read_soup(path, format); });
    if (soup) check(*soup);
    return;
  }
  const auto mesh = read_within(size, [&] { return collarmesh::io::read_tet_mesh(path, format); });
  if (!mesh) return;
  check(*mesh);
  check_round_trip(*mesh, path);
#endif
}

/// TetGen's mesh is several files; in an input they come one after the other with lines of "@" between them.
constexpr std::array<std::string_view, 4> tetgen_extensions{".ele", ".node", ".face", ".edge"};

/// The files that the reader gets; they are removed at the end.
class InputFiles {
 public:
  InputFiles()
      : name_((std::filesystem::temp_directory_path() / ("collarmesh-fuzz-" + std::to_string(getpid())))
                  .string()) {}
  ~InputFiles() {
    remove(format);
    if (format == ".ele")
      for (const std::string_view extension : tetgen_extensions) remove(extension);
  }
  InputFiles(const InputFiles&) = delete;
  InputFiles& operator=(const InputFiles&) = delete;

  std::string path() const { return path(format); }

  void write(std::string_view content) const {
    if (format != ".ele") {
      write(format, content);
      return;
    }
    for (const std::string_view extension : tetgen_extensions) {
      const std::size_t end = std::min(content.find("@\n"), content.size());
      remove(extension);
      if (!content.empty()) write(extension, content.substr(0, end));
      content.remove_prefix(std::min(end + 2, content.size()));
    }
  }

 private:
  std::string path(std::string_view extension) const { return name_ + std::string(extension); }
  void write(std::string_view extension, std::string_view content) const {
    std::ofstream file(path(extension), std::ios::binary);
    file.write(content.data(), static_cast<std::streamsize>(content.size()));
    require(static_cast<bool>(file.flush()), "a place for temporary files");
  }
  void remove(std::string_view extension) const {
    std::error_code ignored;
    std::filesystem::remove(path(extension), ignored);
  }

  std::string name_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const InputFiles files;
  files.write({reinterpret_cast<const char*>(data), size});
  read_and_check(files.path(), size);
  return 0;
}
