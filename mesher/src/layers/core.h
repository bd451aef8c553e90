#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "collarmesh/improve.h"
#include "collarmesh/progress.h"
#include "layers/front.h"
#include "layers/heights.h"
#include "remesh/editable_mesh.h"
#include "remesh/thin_shape.h"

namespace collarmesh::layering {

/// The tets outside the layers. Nodes at the front have copies, which move away from the wall.
class Core {
 public:
  /// Copies the mesh, and keeps references to the other arguments.
  Core(const TetMesh& mesh, const Plc& plc, const Front& front, const Heights& heights,
       const ImproveOptions& improvement, const Execution& execution);

  /// Moves the copies to these heights, as far as tets stay positive, and improves the tets; where that does
  /// not suffice, lowers the heights. Returns false if tets stay poor or heights are still not reached;
  /// `failed()` then returns the nodes of the front there. Returns true if cancelled, too.
  /// `levels`: by node of the front, how strictly the tets there limit its height at first.
  bool push(Heights& heights, const std::vector<std::uint8_t>& levels);
  /// From this level on, heights are limited so that tets keep their bounds even without improvement.
  static constexpr std::uint8_t strictest = 1;
  const std::vector<Index>& failed() const { return failed_; }
  bool cancelled() const { return cancelled_; }

  const remeshing::TetComplex& complex() const { return piece_->complex; }
  const TetMesh& mesh() const { return mesh_; }
  /// Returns the vertex of the core at a node of the front: its copy or, where there are no layers, the node
  /// itself.
  Index vertex_of(Index node) const { return vertex_of_[node]; }

 private:
  void fix_wall();
  void go(const Heights& heights, double enough, bool thoroughly);
  std::size_t most_left(const Heights& heights) const;
  bool is_reached(Index node, const Heights& heights) const;
  bool advance(const Heights& heights);
  void fit_tets(Heights& heights, const std::vector<std::uint8_t>& levels);
  std::vector<Vector> moves_towards(const Heights& heights, const std::vector<Index>& near);
  std::vector<Index> vertices_near_front(unsigned rings) const;
  void find_around(const std::vector<Index>& near);
  void spread(std::vector<Vector>& moves, const std::vector<Index>& near) const;
  double margin(const remeshing::Corners& p, Index tet) const;
  void constrain(Index vertex, Vector& move) const;
  std::vector<double> shares_of(const std::vector<Vector>& moves, const std::vector<Index>& near) const;
  void improve_tets(double angle, bool thoroughly);
  void improve_by(double angle, bool thoroughly, double ratio);
  std::vector<Index> poor_tets() const;
  bool is_as_given(Index tet) const;
  bool lower_at(const std::vector<Index>& tets, double share, Heights& heights) const;
  std::vector<std::uint8_t> vertices_near(const std::vector<Index>& tets, unsigned rings) const;
  std::vector<Index> nodes_near(const std::vector<Index>& tets, unsigned rings) const;
  remeshing::Corners corners(Index tet) const { return piece_->complex.corners(tet); }

  const TetMesh& given_;
  const Plc& plc_;
  const Front& front_;
  const ImproveOptions& options_;
  const Execution& execution_;
  TetMesh mesh_;
  std::vector<Index> vertex_of_;  // by node of the front
  std::vector<Index> node_of_;    // by vertex of the initial core: its node of the front, or none
  std::vector<double> reached_;   // by node of the front: the current distance of its copy
  std::unique_ptr<remeshing::EditableMesh> piece_;
  std::unique_ptr<remeshing::ThinShape> thin_;
  std::vector<std::array<Index, 4>> poor_at_first_;  // tets that were poor from the start: sorted corners
  Lists around_;  // by vertex near the front: its neighbours; empty for fixed vertices
  std::vector<Index> failed_;
  bool cancelled_ = false;
};

}  // namespace collarmesh::layering
