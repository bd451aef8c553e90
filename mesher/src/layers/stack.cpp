#include "layers/stack.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace collarmesh::layering {

namespace {

/// Returns the height of the first `layer` layers, relative to that of all layers.
double share_below(const WallLayers& layers, unsigned layer) {
  WallLayers lower = layers;
  lower.count = layer;
  return relative_thickness(lower) / relative_thickness(layers);
}

}  // namespace

Stack::Stack(const TetMesh& given, const Front& front, const Heights& heights, const Core& core, bool tets)
    : given_(given), front_(front), heights_(heights), core_(core), tets_(tets) {
  for (std::size_t t = 0; t < given.tets.size(); ++t) {
    const Index region = given.tet_region[t];
    if (region >= tag_of_region_.size()) tag_of_region_.resize(region + std::size_t{1}, 0);
    tag_of_region_[region] = given.tet_tag[t];
  }
}

TetMesh Stack::build() {
  mesh_.names = given_.names;
  mesh_.group_names = given_.group_names;
  mesh_.triangle_elements = given_.triangle_elements;
  number_nodes();
  take_core();
  take_walls();
  for (const WallSide& side : front_.sides) fill(side);
  for (Index s = 0; s < front_.sides.size(); ++s)
    for (unsigned i = 0; i < 3; ++i) close(s, i);
  extend_curves();
  mesh_.tet_collar.resize(mesh_.tets.size(), 0);
  mesh_.tet_crease.resize(mesh_.tets.size(), 0);
  drop_unused_points();
  return std::move(mesh_);
}

/// Adds the nodes between layers. Copies that did not move become the nodes of the wall again.
void Stack::number_nodes() {
  mesh_.points = core_.mesh().points;
  mesh_.features = core_.mesh().features;
  merged_.resize(mesh_.points.size());
  std::iota(merged_.begin(), merged_.end(), Index{0});
  first_inner_.assign(front_.nodes.size(), none);
  places_.wall.assign(mesh_.points.size(), none);
  places_.share.assign(mesh_.points.size(), 0);
  places_.is_raised.assign(mesh_.points.size(), false);
  for (Index v = 0; v < front_.on_wall.size(); ++v)
    if (front_.on_wall[v]) places_.wall[v] = v;
  for (Index n = 0; n < front_.nodes.size(); ++n) {
    const FrontNode& at = front_.nodes[n];
    const Index top = core_.vertex_of(n);
    if (!is_raised(n)) {
      merged_[top] = at.vertex;
      continue;
    }
    mesh_.points[top] = heights_.place(n);
    mesh_.features[top] = at.slides_on;
    const WallLayers& layers = heights_.layers(n);
    first_inner_[n] = static_cast<Index>(mesh_.points.size());
    for (unsigned k = 1; k < layers.count; ++k) {
      mesh_.points.push_back(heights_.place(n, share_below(layers, k) * heights_[n]));
      mesh_.features.push_back(at.slides_on);
    }
    places_.wall.resize(mesh_.points.size(), none);
    places_.share.resize(mesh_.points.size(), 0);
    places_.is_raised[at.vertex] = true;
    for (unsigned k = 1; k <= layers.count; ++k) {
      places_.wall[node(n, k)] = at.vertex;
      places_.share[node(n, k)] = k == layers.count ? 1 : share_below(layers, k);
    }
  }
}

/// Returns the node on top of this many layers.
Index Stack::node(Index of, unsigned layer) const {
  if (layer == 0 || !is_raised(of)) return front_.nodes[of].vertex;
  return layer == heights_.layers(of).count ? core_.vertex_of(of) : first_inner_[of] + layer - 1;
}

void Stack::take_core() {
  const auto& complex = core_.complex();
  for (Index t = 0; t < complex.size(); ++t) {
    if (!complex[t].alive) continue;
    std::array<Index, 4> tet = complex[t].corners;
    for (Index& v : tet)
      if (v < merged_.size()) v = merged_[v];
    mesh_.tets.push_back(tet);
    mesh_.tet_region.push_back(complex[t].region);
    mesh_.tet_tag.push_back(tag_of(complex[t].region));
  }
  mesh_.layers.tet_layer.assign(mesh_.tets.size(), 0);
}

/// Takes the faces and edges of walls from the mesh without layers, all others from the core.
void Stack::take_walls() {
  const auto take_face = [&](const TetMesh& from, std::size_t f, const std::array<Index, 3>& corners) {
    mesh_.faces.push_back(corners);
    mesh_.face_regions.push_back(from.face_regions[f]);
    mesh_.face_patch.push_back(from.face_patch[f]);
    mesh_.face_tag.push_back(from.face_tag[f]);
  };
  for (Index f = 0; f < given_.faces.size(); ++f)
    if (front_.is_wall(f)) take_face(given_, f, given_.faces[f]);
  const TetMesh& core = core_.mesh();
  for (Index f = 0; f < core.faces.size(); ++f) {
    std::array<Index, 3> corners = core.faces[f];
    if (corners[0] == none || front_.is_wall_patch(core.face_patch[f])) continue;
    for (Index& v : corners) v = merged_[v];
    take_face(core, f, corners);
  }
  const auto take_edge = [&](const TetMesh& from, std::size_t e, const std::array<Index, 2>& ends) {
    mesh_.edges.push_back(ends);
    mesh_.edge_curve.push_back(from.edge_curve[e]);
    mesh_.edge_tag.push_back(from.edge_tag[e]);
  };
  for (Index e = 0; e < given_.edges.size(); ++e)
    if (front_.is_wall_edge(given_.edges[e][0], given_.edges[e][1])) take_edge(given_, e, given_.edges[e]);
  for (Index e = 0; e < core.edges.size(); ++e)
    if (const auto& [a, b] = core.edges[e]; a != none) take_edge(core, e, {merged_[a], merged_[b]});
}

/// Fills the layers on a side with prisms; with pyramids if one node is not raised; with tets if two are not.
void Stack::fill(const WallSide& side) {
  const auto raised = static_cast<unsigned>(
      std::count_if(side.nodes.begin(), side.nodes.end(), [&](Index n) { return is_raised(n); }));
  if (raised == 0) return;
  unsigned first = 0;  // the raised node if only one is raised, the low node if two are
  while (is_raised(side.nodes[first]) != (raised == 1)) {
    if (raised == 3) break;
    ++first;
  }
  const Index a = side.nodes[first], b = side.nodes[(first + 1) % 3], c = side.nodes[(first + 2) % 3];
  const unsigned count = heights_.layers(raised == 2 ? b : a).count;
  for (unsigned k = 1; k <= count; ++k) {
    if (raised == 1)
      add_tet({node(a, k - 1), node(b, 0), node(c, 0), node(a, k)}, side, k);
    else if (raised == 2)
      add_pyramid({node(c, k - 1), node(b, k - 1), node(b, k), node(c, k), node(a, 0)}, is_before(c, b), side,
                  k);
    else if (tets_)
      divide_prism(side, k);
    else
      add_prism({node(a, k - 1), node(b, k - 1), node(c, k - 1), node(a, k), node(b, k), node(c, k)}, side,
                k);
  }
}

/// Adds a tet of a layer. The last of the `corners` lies above the first.
void Stack::add_tet(std::array<Index, 4> corners, const WallSide& side, unsigned layer) {
  mesh_.tets.push_back(corners);
  mesh_.tet_region.push_back(side.region);
  mesh_.tet_tag.push_back(tag_of(side.region));
  mesh_.layers.tet_layer.push_back(static_cast<std::uint16_t>(layer));
}

void Stack::add_prism(const std::array<Index, 6>& corners, const WallSide& side, unsigned layer) {
  mesh_.layers.prisms.push_back(corners);
  mesh_.layers.prism_region.push_back(side.region);
  mesh_.layers.prism_tag.push_back(tag_of(side.region));
  mesh_.layers.prism_layer.push_back(static_cast<std::uint16_t>(layer));
}

/// Adds a pyramid or, if the layers are tets, two tets. Their common face contains the base's diagonal from
/// the first corner, or the one from the second.
void Stack::add_pyramid(const std::array<Index, 5>& corners, bool from_first, const WallSide& side,
                        unsigned layer) {
  if (!tets_) {
    mesh_.layers.pyramids.push_back(corners);
    mesh_.layers.pyramid_region.push_back(side.region);
    mesh_.layers.pyramid_tag.push_back(tag_of(side.region));
    mesh_.layers.pyramid_layer.push_back(static_cast<std::uint16_t>(layer));
    return;
  }
  const auto& [a, b, c, d, apex] = corners;
  add_tet(from_first ? std::array{b, a, apex, c} : std::array{a, apex, b, d}, side, layer);
  add_tet(from_first ? std::array{a, apex, c, d} : std::array{b, d, apex, c}, side, layer);
}

/// Divides a prism into tets. The diagonal of each quadrangle begins at its lower corner above the wall's
/// node with the smaller number.
void Stack::divide_prism(const WallSide& side, unsigned layer) {
  std::array<unsigned, 3> order{0, 1, 2};
  std::sort(order.begin(), order.end(),
            [&](unsigned i, unsigned j) { return is_before(side.nodes[i], side.nodes[j]); });
  const bool even = (order[1] + 3 - order[0]) % 3 == 1;
  std::array<Index, 3> low, high;
  for (unsigned i = 0; i < 3; ++i) {
    low[i] = node(side.nodes[order[i]], layer - 1);
    high[i] = node(side.nodes[order[i]], layer);
  }
  for (std::array<Index, 4> tet :
       {std::array{low[2], low[0], low[1], high[2]}, std::array{low[1], high[2], low[0], high[1]},
        std::array{low[0], high[1], high[2], high[0]}}) {
    if (!even) std::swap(tet[1], tet[2]);
    add_tet(tet, side, layer);
  }
}

/// Lists the sides of the layers that lie on a face without layers, along an edge of a wall: quadrangles, or
/// triangles where only one end of the edge is raised or the layers are tets.
void Stack::close(Index s, unsigned corner) {
  const WallSide& side = front_.sides[s];
  const WallSide::Edge& edge = side.edges[corner];
  if (edge.across == none || (edge.beyond != none && edge.beyond < s)) return;
  const Index a = side.nodes[corner], b = side.nodes[(corner + 1) % 3];
  if (!is_raised(a) && !is_raised(b)) return;
  const Index other = edge.beyond == none ? 0 : front_.sides[edge.beyond].region;
  const unsigned count = heights_.layers(is_raised(a) ? a : b).count;
  for (unsigned k = 1; k <= count; ++k) {
    const std::array<Index, 4> quad{node(a, k - 1), node(b, k - 1), node(b, k), node(a, k)};
    const auto list = [&](std::array<Index, 3> corners) {
      if (!edge.outwards) std::swap(corners[1], corners[2]);
      add_face(corners, edge.across, side.region, other, edge.outwards);
    };
    if (!is_raised(a)) {
      list({quad[0], quad[1], quad[2]});
    } else if (!is_raised(b)) {
      list({quad[0], quad[1], quad[3]});
    } else if (tets_) {
      const bool from_a = is_before(a, b);
      list({quad[0], quad[1], from_a ? quad[2] : quad[3]});
      list({from_a ? quad[0] : quad[1], quad[2], quad[3]});
    } else {
      LayerCells& layers = mesh_.layers;
      layers.quads.push_back(edge.outwards ? quad : std::array{quad[0], quad[3], quad[2], quad[1]});
      layers.quad_regions.push_back(edge.outwards ? std::array{side.region, other}
                                                  : std::array{other, side.region});
      layers.quad_patch.push_back(given_.face_patch[edge.across]);
      layers.quad_tag.push_back(given_.face_tag[edge.across]);
    }
  }
}

void Stack::add_face(const std::array<Index, 3>& corners, Index like, Index from, Index to, bool outwards) {
  mesh_.faces.push_back(corners);
  mesh_.face_regions.push_back(outwards ? std::array{from, to} : std::array{to, from});
  mesh_.face_patch.push_back(given_.face_patch[like]);
  mesh_.face_tag.push_back(given_.face_tag[like]);
}

/// Extends curves that end at a wall through the layers.
void Stack::extend_curves() {
  for (Index n = 0; n < front_.nodes.size(); ++n) {
    if (!is_raised(n)) continue;
    for (const Index e : front_.edges_of[n]) {
      const bool begins = given_.edges[e][0] == front_.nodes[n].vertex;
      for (unsigned k = 1; k <= heights_.layers(n).count; ++k) {
        std::array<Index, 2> ends{node(n, k - 1), node(n, k)};
        if (!begins) std::swap(ends[0], ends[1]);
        mesh_.edges.push_back(ends);
        mesh_.edge_curve.push_back(given_.edge_curve[e]);
        mesh_.edge_tag.push_back(given_.edge_tag[e]);
      }
    }
  }
}

void Stack::drop_unused_points() {
  std::vector<Index> number(mesh_.points.size(), none);
  LayerCells& layers = mesh_.layers;
  const auto for_all = [&](const auto& visit) {
    visit(mesh_.tets), visit(layers.prisms), visit(layers.pyramids);
    visit(mesh_.faces), visit(layers.quads), visit(mesh_.edges);
  };
  for_all([&](const auto& cells) {
    for (const auto& cell : cells)
      for (const Index v : cell) number[v] = 0;
  });
  Index kept = 0;
  places_.is_raised.resize(number.size(), false);
  for (Index v = 0; v < number.size(); ++v) {
    if (number[v] == none) continue;
    places_.wall[kept] = places_.wall[v];
    places_.share[kept] = places_.share[v];
    places_.is_raised[kept] = places_.is_raised[v];
    mesh_.points[kept] = mesh_.points[v];
    mesh_.features[kept] = mesh_.features[v];
    number[v] = kept++;
  }
  mesh_.points.resize(kept);
  mesh_.features.resize(kept);
  places_.wall.resize(kept), places_.share.resize(kept), places_.is_raised.resize(kept);
  places_.given = places_.wall;
  for (Index& v : places_.wall)
    if (v != none) v = number[v];
  for_all([&](auto& cells) {
    for (auto& cell : cells)
      for (Index& v : cell) v = number[v];
  });
}

}  // namespace collarmesh::layering
