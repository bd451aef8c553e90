// Any bytes give a mesh whose indices are in range, or a ReadError. Time and memory are limited by the
// options that tests/fuzz/run gives to libFuzzer.
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "collarmesh/error.h"
#include "collarmesh/io/soup_io.h"
#include "collarmesh/io/tet_mesh_io.h"
#ifdef COLLARMESH_FUZZ_OM
#include "collarmesh/openmesh_io/read_om.h"
#endif

namespace {

constexpr std::string_view format = FUZZED_FORMAT;

void require(bool holds) {
  if (!holds) std::abort();
}

void check_soup(const collarmesh::PolygonSoup& soup) {
  for (collarmesh::Index q = 0; q < soup.polygon_count(); ++q)
    for (const collarmesh::Index corner : soup.polygon(q)) require(corner < soup.points.size());
  for (const auto& segment : soup.segments)
    require(segment.a < soup.points.size() && segment.b < soup.points.size());
}

template <class Cells>
void check_cells(const Cells& cells, std::size_t points) {
  for (const auto& cell : cells)
    for (const collarmesh::Index node : cell) require(node < points);
}

void check_mesh(const collarmesh::TetMesh& mesh) {
  check_cells(mesh.tets, mesh.points.size());
  check_cells(mesh.faces, mesh.points.size());
  check_cells(mesh.edges, mesh.points.size());
  check_cells(mesh.tet_mid_nodes, mesh.points.size());
  check_cells(mesh.face_mid_nodes, mesh.points.size());
  for (const collarmesh::Index node : mesh.edge_mid_nodes) require(node < mesh.points.size());
  require(mesh.tet_tag.size() == mesh.tets.size() && mesh.tet_region.size() == mesh.tets.size());
  require(mesh.face_tag.size() == mesh.faces.size() && mesh.face_regions.size() == mesh.faces.size());
  require(mesh.edge_tag.size() == mesh.edges.size());
}

void read(const std::string& path) {
  try {
#ifdef COLLARMESH_FUZZ_OM
    check_soup(collarmesh::openmesh_io::read_om(path));
#else
    if (collarmesh::io::is_soup_format("", format))
      check_soup(collarmesh::io::read_soup(path, format));
    else
      check_mesh(collarmesh::io::read_tet_mesh(path, format));
#endif
  } catch (const collarmesh::ReadError&) {
  }
}

/// A file in memory.
class MemoryFile {
 public:
  explicit MemoryFile(std::string_view content) : file_(memfd_create("fuzzed", 0)) {
    require(file_ >= 0 &&
            write(file_, content.data(), content.size()) == static_cast<ssize_t>(content.size()));
  }
  ~MemoryFile() { close(file_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  std::string path() const { return "/proc/self/fd/" + std::to_string(file_); }

 private:
  int file_;
};

/// NAME.node, NAME.ele and so on, in one input one after the other between lines of "@".
std::string write_siblings(std::string_view content) {
  static const std::string name = "/dev/shm/collarmesh-fuzz-" + std::to_string(getpid());
  for (const char* extension : {".node", ".ele", ".face", ".edge"}) {
    const std::size_t end = std::min(content.find("\n@\n"), content.size());
    std::filesystem::remove(name + extension);
    if (!content.empty()) std::ofstream(name + extension, std::ios::binary) << content.substr(0, end) << '\n';
    content.remove_prefix(std::min(end + 3, content.size()));
  }
  return name + ".ele";
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view content(reinterpret_cast<const char*>(data), size);
  if (format == ".ele")
    read(write_siblings(content));
  else
    read(MemoryFile(content).path());
  return 0;
}
