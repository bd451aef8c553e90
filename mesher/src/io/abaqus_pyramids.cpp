#include "io/abaqus_pyramids.h"

#include <algorithm>
#include <map>
#include <set>

namespace collarmesh::io {

namespace {

// The nodes of the two tets into which a pyramid is cut along the diagonal of its base from its first corner;
// `middle_node` is the node in the middle of the base.
constexpr std::uint8_t middle_node = 13;
constexpr std::array<std::array<std::uint8_t, 10>, 2> nodes_of_halves{
    {{0, 1, 2, 4, 5, 6, middle_node, 9, 10, 11}, {0, 2, 3, 4, middle_node, 7, 8, 9, 11, 12}}};

// For each side of such a pyramid: the half that has this side (for the base, the first half's part of it),
// and the side's number there, 1 for S1.
constexpr std::array<HalvedPyramids::Side, 5> sides_of_halves{{{0, 1}, {0, 2}, {0, 3}, {1, 3}, {1, 4}}};

}  // namespace

HalvedPyramids::HalvedPyramids(const TetMesh& mesh) : mesh_(mesh) {
  if (mesh.order() == 1) return;
  std::map<std::array<Index, 4>, Index> known;
  for (Index i = 0; i < mesh.layers.pyramids.size(); ++i) {
    const CellNodes p = turned(i);
    std::array<Index, 4> base{p[0], p[1], p[2], p[3]};
    std::sort(base.begin(), base.end());
    const auto [found, added] =
        known.try_emplace(base, static_cast<Index>(mesh.points.size() + nodes_.size()));
    middle_.push_back(found->second);
    if (!added) continue;
    Point amid{};
    for (std::size_t k = 0; k < 4; ++k) amid = amid - 0.25 * mesh.points[p[k]] + 0.5 * mesh.points[p[k + 5]];
    nodes_.push_back(amid);
    bases_.push_back({p[0], p[1], p[2], p[3], p[5], p[6], p[7], p[8]});
  }
}

std::size_t HalvedPyramids::first_corner(Index pyramid) const {
  const auto& corners = mesh_.layers.pyramids[pyramid];
  return static_cast<std::size_t>(std::min_element(corners.begin(), corners.begin() + 4) - corners.begin());
}

/// Returns the nodes of a pyramid, turned so that the corner of its base with the smallest index comes first.
CellNodes HalvedPyramids::turned(Index pyramid) const {
  const CellNodes nodes = nodes_of(CellKind::pyramid)(mesh_, pyramid);
  const std::size_t first = first_corner(pyramid);
  CellNodes result;
  for (std::size_t k = 0; k < 4; ++k) result.add(nodes[(first + k) % 4]);
  result.add(nodes[4]);
  for (const std::size_t begin : {5, 9})
    for (std::size_t k = 0; k < 4; ++k) result.add(nodes[begin + (first + k) % 4]);
  return result;
}

CellNodes HalvedPyramids::half(Index pyramid, std::size_t half) const {
  const CellNodes nodes = turned(pyramid);
  CellNodes result;
  for (const std::uint8_t place : nodes_of_halves[half])
    result.add(place == middle_node ? middle_[pyramid] : nodes[place]);
  return result;
}

std::vector<HalvedPyramids::Side> HalvedPyramids::sides(Index pyramid, std::size_t side) const {
  if (side == 0) return {{0, 1}, {1, 1}};
  return {sides_of_halves[1 + (side - 1 + 4 - first_corner(pyramid)) % 4]};
}

void HalvedPyramids::write_equations(FileWriter& out) const {
  constexpr std::array<int, 4> freedoms{1, 2, 3, 11};
  for (std::size_t k = 0; k < nodes_.size(); ++k)
    for (const int freedom : freedoms) {
      out << "*EQUATION\n9\n" << mesh_.points.size() + k + 1 << ", " << freedom << ", 1.";
      for (std::size_t j = 0; j < 8; ++j)
        out << (j == 3 || j == 7 ? ",\n" : ", ") << bases_[k][j] + 1 << ", " << freedom
            << (j < 4 ? ", 0.25" : ", -0.5");
      out << '\n';
    }
}

std::optional<std::vector<Index>> join_pyramids(const std::vector<std::array<Index, 2>>& halves,
                                                TetMesh& mesh) {
  std::vector<Index> number(mesh.tets.size(), 0);
  std::set<Index> amid;
  for (const auto& [first, second] : halves) {
    if (mesh.tet_mid_nodes.size() != mesh.tets.size() || number[first] == none || number[second] == none)
      return std::nullopt;
    const CellNodes one = nodes_of_tet(mesh, first), other = nodes_of_tet(mesh, second);
    std::array<Index, 13> nodes{};
    for (std::size_t k = 0; k < 10; ++k)
      if (nodes_of_halves[0][k] != middle_node) nodes[nodes_of_halves[0][k]] = one[k];
    for (std::size_t k = 0; k < 10; ++k)
      if (nodes_of_halves[1][k] != middle_node) nodes[nodes_of_halves[1][k]] = other[k];
    for (std::size_t k = 0; k < 10; ++k)
      if (nodes_of_halves[0][k] != middle_node && nodes[nodes_of_halves[0][k]] != one[k]) return std::nullopt;
    if (one[6] != other[4]) return std::nullopt;
    amid.insert(one[6]);
    CellNodes pyramid;
    for (const Index node : nodes) pyramid.add(node);
    add_cell(CellKind::pyramid, pyramid, mesh);
    number[first] = number[second] = none;
  }
  Index kept = 0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (number[t] == none) continue;
    mesh.tets[kept] = mesh.tets[t];
    mesh.tet_mid_nodes[kept] = mesh.tet_mid_nodes[t];
    number[t] = kept++;
  }
  mesh.tets.resize(kept);
  mesh.tet_mid_nodes.resize(kept);
  if (!amid.empty() && *amid.begin() + amid.size() == mesh.points.size()) mesh.points.resize(*amid.begin());
  return number;
}

std::optional<std::size_t> side_of_pyramid(std::size_t half, unsigned number) {
  for (std::size_t side = 0; side < sides_of_halves.size(); ++side)
    if (sides_of_halves[side].half == half && sides_of_halves[side].number == number) return side;
  return std::nullopt;
}

}  // namespace collarmesh::io
