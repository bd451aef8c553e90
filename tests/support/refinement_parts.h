#pragma once

#include "collarmesh/plc_builder.h"
#include "refine/collar_cells.h"
#include "refine/domain.h"
#include "refine/refined_mesh.h"
#include "refine/restricted_surface.h"
#include "refine/surface_nodes.h"

/// Parts of the refinement without its loop: a test inserts what it likes and tells them in the loop's order.
namespace collarmesh::testing {

/// What is there: the mesh, and what is known of it.
struct KnownMesh {
  /// The complex is kept by reference.
  explicit KnownMesh(const Plc& plc, const MeshOptions& options = {})
      : domain(plc, options),
        mesh(plc, domain.box),
        nodes(domain, mesh),
        collar_cells(mesh, collars),
        surface(domain, mesh, nodes, collar_cells) {}

  Index insert(const Point& p, const Feature& feature = {3, none}) {
    find_zone(p);
    surface.cells_vanish(zone);
    const Index vertex = mesh.insert(zone, feature);
    nodes.cells_made(zone, vertex);
    collar_cells.cells_made(zone, vertex);
    surface.cells_made(zone, vertex);
    return vertex;
  }
  void find_zone(const Point& p) {
    mesh.find_conflict_zone(p, mesh.conflicting_cell_around(mesh.nearest_vertex(p), p), zone);
  }

  const Domain domain;
  CollarSystem collars;
  RefinedMesh mesh;
  SurfaceNodes nodes;
  CollarCells collar_cells;
  RestrictedSurface surface;
  ConflictZone zone;
};

}  // namespace collarmesh::testing
