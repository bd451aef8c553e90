#pragma once

#include <array>
#include <map>
#include <set>
#include <vector>

#include "collarmesh/tet_mesh.h"
#include "common/face_finder.h"
#include "constrained/sheathed_rods.h"
#include "pipeline/complex_without_rods.h"
#include "pipeline/rod_axes.h"

namespace collarmesh::pipeline {

/// Thrown if there is no room for a sheath.
struct NoRoom {};

/// The refined mesh of a complex without rods, and the data that all cavities in it share. Keeps references
/// to all arguments.
struct MeshAroundRods {
  MeshAroundRods(const TetMesh& refined, const ComplexWithoutRods& of, const std::vector<SheathedRod>& in_it)
      : mesh(refined),
        without(of),
        rods(in_it),
        axes(in_it),
        faces(refined.faces),
        near(in_it.size()),
        taken(refined.tets.size(), false) {}

  const TetMesh& mesh;
  const ComplexWithoutRods& without;
  const std::vector<SheathedRod>& rods;
  RodAxes axes;
  FaceFinder faces;
  std::vector<std::vector<Index>> near;  ///< by rod: the tets that may be in its cavity, in order
  std::vector<bool> taken;               ///< by tet: whether it is in a cavity that is filled
};

/// The part of a refined mesh that makes room for a rod and its sheath.
class RodCavity {
 public:
  /// A face between the cavity and the rest of the mesh. Its normal points away from the cavity.
  struct Wall {
    std::array<Index, 3> corners;
    Index region;
  };
  using Edges = std::set<std::array<Index, 2>>;

  /// Finds a cavity that is `room` times as wide as the sheath. Throws NoRoom if it touches other features.
  RodCavity(MeshAroundRods& around, Index rod, double room);

  const std::vector<Index>& tets() const { return tets_; }
  /// Returns the mesh faces of tets in the cavity. They lie on the patches that host the rod's ends.
  const std::vector<Index>& faces() const { return faces_; }
  const std::vector<Wall>& walls() const { return walls_; }
  /// Returns the edges around the faces of the cavity on planar patches, by patch of the whole complex.
  const std::map<Index, Edges>& outlines() const { return outlines_; }

 private:
  bool comes_within(double bound, const std::array<Point, 4>& corners) const;
  void find_walls();
  void require_inner(const std::array<Index, 4>& tet) const;
  void add_outline(Index patch, Index a, Index b);

  MeshAroundRods& around_;
  const SheathedRod& rod_;
  Index number_;
  std::vector<Index> tets_, faces_;
  std::vector<Wall> walls_;
  std::map<Index, Edges> outlines_;
};

}  // namespace collarmesh::pipeline
