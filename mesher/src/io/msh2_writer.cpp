// Gmsh's format 2.2 as text, which OpenFOAM's gmshToFoam, SU2's and other converters read. Physical groups
// are numbered across all dimensions, because gmshToFoam has one list of names: a tag is its own number if
// Gmsh accepts it and it is free, tags of faces first, then those of regions, then those of curves. Other
// tags get free numbers. Partitions, from 1, are further tags of elements, after the physical group and the
// entity.
#include <array>
#include <limits>
#include <map>
#include <set>
#include <vector>

#include "io/cell_nodes.h"
#include "io/cell_partitions.h"
#include "io/file_writer.h"
#include "io/label_names.h"
#include "io/msh_format.h"
#include "io/msh_periodic.h"
#include "io/tet_mesh_formats.h"

namespace collarmesh::io {

namespace {

void number_group(const std::vector<Tag>& tags, std::map<Tag, int>& numbers, std::set<int>& taken) {
  constexpr Tag limit = std::numeric_limits<int>::max();
  const std::set<Tag> distinct(tags.begin(), tags.end());
  for (const Tag tag : distinct)
    if (tag > 0 && tag < limit && taken.insert(static_cast<int>(tag)).second)
      numbers.emplace(tag, static_cast<int>(tag));
  int next = 1;
  for (const Tag tag : distinct) {
    if (numbers.count(tag) > 0) continue;
    while (!taken.insert(next).second) ++next;
    numbers.emplace(tag, next);
  }
}

MshPhysicals number_groups(const TetMesh& mesh) {
  MshPhysicals numbers;
  std::set<int> taken;
  for (const std::size_t dimension : {2, 3, 1})
    number_group(all_tags(mesh, dimension), numbers[dimension], taken);
  return numbers;
}

/// Returns the number of a feature's elementary entity, from 1; cells without a feature are in entity 1.
std::size_t entity(Index feature) {
  constexpr Index limit = std::numeric_limits<int>::max();
  return feature < limit ? std::size_t{feature} + 1 : 1;
}

/// Writes the periodic links of surfaces and curves; in this format points are no entities.
void write_links(FileWriter& out, const TetMesh& mesh) {
  if (mesh.periodic.empty()) return;
  const MshEntities entities = find_entities(mesh);
  if (!entities.numbers_are_features) return;
  std::vector<MshLink> links = find_msh_links(mesh, entities);
  std::erase_if(links, [](const MshLink& link) { return link.dimension == 0; });
  write_msh_links(out, links, 2);
}

}  // namespace

void write_msh2(const std::string& path, const TetMesh& mesh) {
  FileWriter out(path);
  const MshPhysicals numbers = number_groups(mesh);
  out << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
  write_physical_names(out, mesh, numbers);
  out << "$Nodes\n" << mesh.points.size() << '\n';
  for (std::size_t i = 0; i < mesh.points.size(); ++i) out << i + 1 << ' ' << mesh.points[i] << '\n';
  out << "$EndNodes\n$Elements\n" << count_of_all(mesh) << '\n';
  std::size_t number = 0;
  const bool partitioned = !mesh.tet_partition.empty();
  // Only tets, triangles and edges have partitions.
  std::array<std::vector<Index>, 4> partitions;
  if (partitioned)
    partitions = {{{}, partitions_of_edges(mesh), partitions_of_faces(mesh), mesh.tet_partition}};
  for (const CellKind kind : {CellKind::edge, CellKind::triangle, CellKind::quadrangle, CellKind::tet,
                              CellKind::prism, CellKind::pyramid}) {
    const GmshType& type = gmsh_type(kind, mesh.order());
    for (std::size_t i = 0; i < count_of(mesh, kind); ++i) {
      const Index feature = features_of(mesh, kind)[i];
      out << ++number << ' ' << type.number << (partitioned ? " 4 " : " 2 ")
          << numbers[type.dimension()].at(tags_of(mesh, kind)[i]) << ' '
          << (type.dimension() == 3 ? std::size_t{feature} : entity(feature));
      if (partitioned)
        out << " 1 " << partitions[type.dimension()][i] + 1;  // the number of partitions, then the partition
      for (const Index v : nodes_of(kind)(mesh, i).in_order(type.node_order()))
        out << ' ' << std::size_t{v} + 1;
      out << '\n';
    }
  }
  out << "$EndElements\n";
  write_links(out, mesh);
  out.commit();
}

}  // namespace collarmesh::io
