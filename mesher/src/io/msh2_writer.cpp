// Gmsh's format 2.2 as text, which OpenFOAM's gmshToFoam, SU2's and other converters read. Physical groups
// are numbered across all dimensions, because gmshToFoam has one list of names: faces keep tags that Gmsh
// accepts, then regions and curves get free numbers. Partitions, from 1, are tags of elements after these and
// the entity.
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

using Numbers = std::array<std::map<Tag, int>, 4>;

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

Numbers number_groups(const TetMesh& mesh) {
  Numbers numbers;
  std::set<int> taken;
  number_group(mesh.face_tag, numbers[2], taken);
  number_group(mesh.tet_tag, numbers[3], taken);
  number_group(mesh.edge_tag, numbers[1], taken);
  return numbers;
}

void write_names(FileWriter& out, const TetMesh& mesh, const Numbers& numbers) {
  std::size_t count = 0;
  for (const auto& group : numbers) count += group.size();
  out << "$PhysicalNames\n" << count << '\n';
  for (std::size_t dimension = 1; dimension < 4; ++dimension)
    for (const auto& [tag, number] : numbers[dimension])
      out << dimension << ' ' << number << " \"" << group_name(mesh, dimension, tag, "-") << "\"\n";
  out << "$EndPhysicalNames\n";
}

/// Gmsh's elementary entities are the features, from 1; cells without a feature share one entity.
std::size_t entity(Index feature) {
  constexpr Index limit = std::numeric_limits<int>::max();
  return feature < limit ? std::size_t{feature} + 1 : 1;
}

/// Writes links of surfaces and curves; points are no entities here.
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
  const Numbers numbers = number_groups(mesh);
  out << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
  write_names(out, mesh, numbers);
  out << "$Nodes\n" << mesh.points.size() << '\n';
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    const Point& p = mesh.points[i];
    out << i + 1 << ' ' << p.x << ' ' << p.y << ' ' << p.z << '\n';
  }
  out << "$EndNodes\n$Elements\n" << mesh.tets.size() + mesh.faces.size() + mesh.edges.size() << '\n';
  std::size_t number = 0;
  const bool partitioned = !mesh.tet_partition.empty();
  const std::vector<Index> none_given;
  const std::vector<Index> of_faces = partitioned ? partitions_of_faces(mesh) : none_given,
                           of_edges = partitioned ? partitions_of_edges(mesh) : none_given;
  const auto write = [&](const GmshType& type, Tag tag, std::size_t elementary,
                         const std::vector<Index>& partition, std::size_t i, const CellNodes& nodes) {
    out << ++number << ' ' << type.number << (partitioned ? " 4 " : " 2 ") << numbers[type.dimension].at(tag)
        << ' ' << elementary;
    if (partitioned) out << " 1 " << partition[i] + 1;  // number of partitions, then the partition
    for (const Index v : nodes.in_order({type.order.data(), type.nodes})) out << ' ' << std::size_t{v} + 1;
    out << '\n';
  };
  const std::size_t second = mesh.order() == 2 ? 1 : 0;
  for (std::size_t i = 0; i < mesh.edges.size(); ++i)
    write(gmsh_types[second], mesh.edge_tag[i], entity(mesh.edge_curve[i]), of_edges, i,
          nodes_of_edge(mesh, i));
  for (std::size_t i = 0; i < mesh.faces.size(); ++i)
    write(gmsh_types[2 + second], mesh.face_tag[i], entity(mesh.face_patch[i]), of_faces, i,
          nodes_of_face(mesh, i));
  for (std::size_t i = 0; i < mesh.tets.size(); ++i)
    write(gmsh_types[4 + second], mesh.tet_tag[i], mesh.tet_region[i], mesh.tet_partition, i,
          nodes_of_tet(mesh, i));
  out << "$EndElements\n";
  write_links(out, mesh);
  out.commit();
}

}  // namespace collarmesh::io
