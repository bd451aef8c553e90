#include "periodic/change_across.h"

#include <vector>

#include "periodic/node_map.h"
#include "periodic/pair_choice.h"

namespace collarmesh::periodicity {

namespace {
constexpr unsigned edges_between = 6;  // vertices more than this many edges away from all pairs stay
}

void change_across(TetMesh& mesh, const Plc& plc, const PeriodicOptions& options, double distance,
                   const SurfaceTolerance& tolerance, Recut::Moved moved, double edges_per_hole,
                   const std::function<void(remeshing::EditableMesh&, const Recut&)>& change) {
  const std::vector<PatchPair> pairs = choose_pairs(options, plc);
  std::vector<FeatureImages> images;
  images.reserve(pairs.size());
  for (const PatchPair& pair : pairs) images.push_back(find_images(pair, plc, distance));
  Recut recut(mesh, plc, tolerance, pairs, images, moved);
  // `false`: no edge counts as forced to be short; otherwise all edges between copies would count.
  remeshing::EditableMesh edited(recut.mesh(), recut.complex().plc, recut.complex().tolerance, edges_per_hole,
                                 false);
  edited.fix(recut.fixed());
  edited.leave(recut.farther_than(edges_between));
  change(edited, recut);
  recut.note_vertices(edited.complex);
  edited.store();
  mesh = recut.back();
  map_corners(mesh);
}

}  // namespace collarmesh::periodicity
