#include "common/traced_mesh.h"

#include <utility>

namespace collarmesh {

namespace {

using State = TraceStep::State;

State state_of(const TetMesh& mesh, std::size_t tet) {
  constexpr std::uint8_t star = 1, book = 2;
  if (!mesh.tet_collar.empty() && mesh.tet_collar[tet] == star) return State::star;
  if (!mesh.tet_collar.empty() && mesh.tet_collar[tet] == book) return State::book;
  return !mesh.tet_thin.empty() && mesh.tet_thin[tet] != 0 ? State::thin : State::region;
}

}  // namespace

TraceStep traced_mesh(const TetMesh& mesh, std::string stage) {
  TraceStep step;
  step.stage = std::move(stage);
  step.points = mesh.points;
  for (const TetMesh::VertexFeature& feature : mesh.features) step.dimension.push_back(feature.dimension);
  step.tets = mesh.tets;
  step.region = mesh.tet_region;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) step.state.push_back(state_of(mesh, t));
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    step.triangles.push_back({mesh.faces[f], mesh.face_tag[f]});
  for (std::size_t e = 0; e < mesh.edges.size(); ++e)
    step.segments.push_back({mesh.edges[e], mesh.edge_tag[e]});
  return step;
}

}  // namespace collarmesh
