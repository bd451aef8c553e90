// Writes the inputs with which the fuzzers begin: the sample mesh of both orders, and its surface for the
// formats of surfaces.
//   write_seeds FOLDER FORMAT...
// makes FOLDER/FORMAT/first.FORMAT and so on. It is an error if a format that can be read is not named.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include "collarmesh/io/soup_io.h"
#include "collarmesh/io/tet_mesh_io.h"
#include "support/layer_mesh.h"
#include "support/sample_mesh.h"
#include "support/second_order.h"
#ifdef COLLARMESH_FUZZ_OM
#include "collarmesh/openmesh_io/write_om.h"
#endif

namespace {

using collarmesh::PolygonSoup;
using collarmesh::TetMesh;
namespace io = collarmesh::io;

/// Returns the boundary; with `all`, also the interface and everything else that complexes have.
PolygonSoup surface_of(const TetMesh& mesh, bool all) {
  PolygonSoup soup;
  soup.points = mesh.points;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    if (all || mesh.face_regions[f][1] == 0) soup.add_facet(mesh.faces[f], all ? mesh.face_tag[f] : 0);
  if (!all) return soup;
  soup.segments.push_back({mesh.edges[0][0], mesh.edges[0][1], mesh.edge_tag[0]});
  soup.region_points.push_back({mesh.points[0], 5, 0.25});
  soup.hole_points.push_back(mesh.points[1]);
  return soup;
}

std::string content_of(const std::filesystem::path& path) {
  std::ostringstream content;
  content << std::ifstream(path, std::ios::binary).rdbuf();
  return std::move(content).str();
}

/// Joins the files of a TetGen mesh into one, in the form that fuzz_reader.cpp splits.
void join_tetgen_files(std::filesystem::path path) {
  std::string joined = content_of(path);
  for (const char* extension : {".node", ".face", ".edge"}) {
    joined += "@\n" + content_of(path.replace_extension(extension));
    std::filesystem::remove(path);
  }
  std::ofstream(path.replace_extension(".ele"), std::ios::binary) << joined;
}

/// Writes meshes with prisms and pyramids, if the format can store them.
void write_layers(const std::filesystem::path& folder, const std::string& format) {
  const auto keeps = [&](int order) {
    const std::vector<std::string> formats = io::formats_with_layers(order);
    return std::find(formats.begin(), formats.end(), format) != formats.end();
  };
  if (keeps(1)) io::write_tet_mesh(folder / ("layers" + format), collarmesh::testing::layer_mesh());
  if (keeps(2))  // without pyramids, as not all formats have those of second order
    io::write_tet_mesh(folder / ("prisms" + format),
                       collarmesh::testing::second_order(collarmesh::testing::mesh_of_prisms()));
}

void write(const std::filesystem::path& folder, const std::string& format) {
  const TetMesh mesh = collarmesh::testing::sample_mesh(1);
  if (io::is_soup_format("", format)) {
    io::write_soup(folder / ("boundary" + format), surface_of(mesh, false));
    io::write_soup(folder / ("complex" + format), surface_of(mesh, true));
#ifdef COLLARMESH_FUZZ_OM
  } else if (format == ".om") {
    collarmesh::openmesh_io::write_om(folder / "boundary.om", surface_of(mesh, false));
#endif
  } else {
    io::write_tet_mesh(folder / ("first" + format), mesh);
    io::write_tet_mesh(folder / ("second" + format), collarmesh::testing::second_order(mesh));
    write_layers(folder, format);
    if (format == ".ele")
      for (const char* name : {"first.ele", "second.ele"}) join_tetgen_files(folder / name);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::cerr << "usage: write_seeds FOLDER FORMAT...\n";
    return 2;
  }
  std::vector<std::string> formats;
  for (int i = 2; i < argc; ++i) formats.push_back('.' + std::string(argv[i]));
  for (const auto& known : {io::soup_formats(), io::read_tet_mesh_formats()})
    for (const std::string& format : known)
      if (std::find(formats.begin(), formats.end(), format) == formats.end()) {
        std::cerr << format << " is read but not fuzzed: name it in tests/fuzz/CMakeLists.txt\n";
        return 1;
      }
  for (const std::string& format : formats) {
    const std::filesystem::path folder = std::filesystem::path(argv[1]) / format.substr(1);
    std::filesystem::create_directories(folder);
    write(folder, format);
  }
  return 0;
}
