// NAME.pvtu and the pieces of the ranks, made by the writer of .vtu.
#include <fmt/format.h>

#include <filesystem>

#include "calls.h"
#include "collarmesh/distributed.h"
#include "collarmesh/io/tet_mesh_io.h"
#include "io/tet_mesh_formats.h"
#include "local_mesh.h"

namespace collarmesh::distributed {

namespace {

namespace fs = std::filesystem;

/// Returns the mesh of this rank without faces and edges.
TetMesh piece_of(DM dm, int order, const std::map<Tag, Index>& regions) {
  LocalMesh mesh(dm, order);
  mesh.faces.clear(), mesh.face_patch.clear(), mesh.face_tag.clear(), mesh.face_mid_nodes.clear();
  mesh.edges.clear(), mesh.edge_curve.clear(), mesh.edge_tag.clear(), mesh.edge_mid_nodes.clear();
  mesh.features.clear();
  for (const Tag tag : mesh.tet_tag) mesh.tet_region.push_back(regions.at(tag));
  mesh.tet_crease.assign(mesh.tets.size(), 0);
  return mesh;
}

std::string piece_name(const fs::path& path, int rank) {
  return fmt::format("{}_{}.vtu", path.stem().string(), rank);
}

}  // namespace

void ParallelMesh::write_pvtu(const std::string& path) const {
  const PetscMessages messages;
  const Ranks ranks(communicator_);
  TetMesh piece;
  agree(communicator_, [&] {
    piece = piece_of(dm_, order_, regions_);
    io::write_tet_mesh((fs::path(path).parent_path() / piece_name(path, ranks.rank)).string(), piece, ".vtu");
  });
  agree(communicator_, [&] {
    if (ranks.rank != 0) return;
    std::vector<std::string> names;
    for (int rank = 0; rank < ranks.count; ++rank) names.push_back(piece_name(path, rank));
    io::write_list_of_pieces(path, piece, names);
  });
}

}  // namespace collarmesh::distributed
