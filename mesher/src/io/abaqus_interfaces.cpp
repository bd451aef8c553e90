#include "io/abaqus_interfaces.h"

#include <algorithm>
#include <set>
#include <vector>

#include "io/cell_nodes.h"

namespace collarmesh::io {

namespace {

std::set<Index> nodes_of_side(const TetMesh& mesh, Tag tag) {
  std::set<Index> nodes;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    if (mesh.face_tag[f] == tag)
      for (const Index node : nodes_of_face(mesh, f)) nodes.insert(node);
  return nodes;
}

/// Ties the nodes of the plus sides to the minus sides. Leaves out nodes on the front of a crack, which both
/// sides share, and nodes at a junction of patches that are already tied to another patch, because a node can
/// be dependent only once.
void write_ties(FileWriter& out, const TetMesh& mesh, const Interfaces& interfaces, const NamesByTag& names) {
  std::set<Index> tied;
  for (const Sides& sides : interfaces.sides) {
    const std::set<Index> master = nodes_of_side(mesh, sides.minus);
    const std::string& slave = names.at(sides.plus);
    std::vector<Index> nodes;
    for (const Index node : nodes_of_side(mesh, sides.plus))
      if (!master.contains(node) && tied.insert(node).second) nodes.push_back(node);
    if (nodes.empty()) continue;
    out << "*NSET, NSET=" << slave << "_TIED\n";
    for (const Index node : nodes) out << node + 1 << ",\n";
    out << "*SURFACE, NAME=" << slave << "_TIED, TYPE=NODE\n" << slave << "_TIED\n";
    out << "*TIE, NAME=" << slave << "_TIE\n" << slave << "_TIED, " << names.at(sides.minus) << '\n';
  }
}

void write_contacts(FileWriter& out, const Interfaces& interfaces, const NamesByTag& names) {
  for (const Sides& sides : interfaces.sides)
    out << "*CONTACT PAIR, INTERACTION=CONTACT, TYPE=SURFACE TO SURFACE\n"
        << names.at(sides.plus) << ", " << names.at(sides.minus) << '\n';
}

/// Returns the i-th cohesive element; if it is of second order, four elements of first order that use its
/// mid-edge nodes, because Abaqus has no cohesive elements of second order.
std::vector<std::array<Index, 6>> straight_prisms(const Interfaces& interfaces, std::size_t i) {
  const auto& [a, b, c, p, q, r] = interfaces.prisms[i];
  if (interfaces.prism_mid_nodes.empty()) return {interfaces.prisms[i]};
  const auto& [ab, bc, ca, pq, qr, rp] = interfaces.prism_mid_nodes[i];
  return {{a, ab, ca, p, pq, rp}, {ab, b, bc, pq, q, qr}, {ca, bc, c, rp, qr, r}, {ab, bc, ca, pq, qr, rp}};
}

void write_prisms(FileWriter& out, const TetMesh& mesh, const Interfaces& interfaces,
                  const NamesByTag& names) {
  std::map<Tag, std::vector<std::size_t>> prisms;
  for (std::size_t i = 0; i < interfaces.prisms.size(); ++i) prisms[interfaces.prism_tag[i]].push_back(i);
  std::size_t number = count_of_dimension(mesh, 3);
  for (const auto& [tag, members] : prisms) {
    out << "*ELEMENT, TYPE=COH3D6, ELSET=COHESIVE_" << names.at(tag) << '\n';
    for (const std::size_t i : members)
      for (const auto& prism : straight_prisms(interfaces, i)) {
        out << ++number;
        for (const Index node : prism) out << ", " << node + 1;
        out << '\n';
      }
  }
}

}  // namespace

void write_abaqus_interfaces(FileWriter& out, const TetMesh& mesh, const Interfaces& interfaces,
                             const NamesByTag& names) {
  write_prisms(out, mesh, interfaces, names);
  if (interfaces.interaction == Interaction::tie) write_ties(out, mesh, interfaces, names);
  if (interfaces.interaction == Interaction::contact) write_contacts(out, interfaces, names);
}

}  // namespace collarmesh::io
