// NAME.pvtu and the pieces of the ranks, made by the writer of .vtu.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <pugixml.hpp>

#include "calls.h"
#include "collarmesh/distributed.h"
#include "collarmesh/io/tet_mesh_io.h"
#include "local_mesh.h"
#include "mid_nodes.h"

namespace collarmesh::distributed {

namespace {

namespace fs = std::filesystem;

/// Returns the tets of this rank.
TetMesh piece_of(DM dm, int order, const std::map<Tag, Index>& regions) {
  LocalMesh local(dm);
  PetscInt first = 0;
  call(DMPlexGetHeightStratum(dm, 0, &first, nullptr));
  TetMesh mesh;
  if (order == 2) {
    const Edges edges(dm);
    const auto corners = static_cast<Index>(local.points.size());
    for (std::size_t t = 0; t < local.tets.size(); ++t) {
      std::array<Index, 6> nodes = edges.of_tet(first + static_cast<PetscInt>(t), local.tets[t]);
      for (Index& node : nodes) node += corners;
      mesh.tet_mid_nodes.push_back(nodes);
    }
    const std::vector<Point> nodes = edges.nodes();
    local.points.insert(local.points.end(), nodes.begin(), nodes.end());
  }
  mesh.points = std::move(local.points);
  mesh.tets = std::move(local.tets);
  for (const PetscInt tag : label_values(dm, "region", first, mesh.tets.size())) {
    mesh.tet_tag.push_back(tag);
    mesh.tet_region.push_back(regions.at(tag));
  }
  for (const PetscInt kind : label_values(dm, "collar", first, mesh.tets.size()))
    mesh.tet_collar.push_back(static_cast<std::uint8_t>(std::max<PetscInt>(kind, 0)));
  mesh.tet_crease.assign(mesh.tets.size(), 0);
  return mesh;
}

std::string piece_name(const fs::path& path, int rank) {
  return fmt::format("{}_{}.vtu", path.stem().string(), rank);
}

/// Writes the index: the arrays of the pieces without their values.
void write_index(const fs::path& path, int pieces) {
  pugi::xml_document piece, index;
  const fs::path first = path.parent_path() / piece_name(path, 0);
  // Parses only the XML before the values, so the document is incomplete.
  if (!piece.load_file(first.c_str(), pugi::parse_default | pugi::parse_fragment).operator bool())
    throw WriteError(fmt::format("{}: cannot be read back", first.string()));
  pugi::xml_node file = index.append_child("VTKFile");
  file.append_attribute("type") = "PUnstructuredGrid";
  for (const char* name : {"version", "byte_order", "header_type", "compressor"})
    file.append_attribute(name) = piece.child("VTKFile").attribute(name).value();
  pugi::xml_node grid = file.append_child("PUnstructuredGrid");
  grid.append_attribute("GhostLevel") = 0;
  const pugi::xml_node there = piece.child("VTKFile").child("UnstructuredGrid").child("Piece");
  for (const char* section : {"PointData", "CellData", "Points"}) {
    pugi::xml_node arrays = grid.append_child(fmt::format("P{}", section).c_str());
    for (const pugi::xml_node array : there.child(section).children("DataArray")) {
      pugi::xml_node made = arrays.append_child("PDataArray");
      for (const char* name : {"type", "Name", "NumberOfComponents"})
        if (const pugi::xml_attribute attribute = array.attribute(name))
          made.append_attribute(name) = attribute.value();
    }
  }
  for (int rank = 0; rank < pieces; ++rank)
    grid.append_child("Piece").append_attribute("Source") = piece_name(path, rank).c_str();
  if (!index.save_file(path.c_str())) throw WriteError(fmt::format("{}: cannot be written", path.string()));
}

}  // namespace

void ParallelMesh::write_pvtu(const std::string& path) const {
  const PetscMessages messages;
  const Ranks ranks(communicator_);
  agree(communicator_, [&] {
    io::write_tet_mesh((fs::path(path).parent_path() / piece_name(path, ranks.rank)).string(),
                       piece_of(dm_, order_, regions_), ".vtu");
  });
  agree(communicator_, [&] {
    if (ranks.rank == 0) write_index(path, ranks.count);
  });
}

}  // namespace collarmesh::distributed
