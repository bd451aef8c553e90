#pragma once

#include "collarmesh/plc_builder.h"
#include "refine/collar_cells.h"
#include "refine/curve_chains.h"
#include "refine/domain.h"
#include "refine/facing_sheets.h"
#include "refine/graded_sizes.h"
#include "refine/open_creases.h"
#include "refine/outcome.h"
#include "refine/random_offsets.h"
#include "refine/refined_mesh.h"
#include "refine/restricted_surface.h"
#include "refine/surface_nodes.h"
#include "refine/unresolved_points.h"
#include "refine/work_queue.h"

/// Parts of the refinement without its loop: a test inserts vertices and calls the parts in the loop's order.
namespace collarmesh::testing {

/// The mesh, and the parts that store data of it.
struct KnownMesh {
  /// Keeps a reference to the complex.
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

/// A KnownMesh with curves and the parts they need, without subsegments yet.
struct KnownCurves : KnownMesh {
  explicit KnownCurves(const Plc& plc, const MeshOptions& options = {}) : KnownMesh(plc, options) {
    for (Index i = 0; i < plc.vertices.size(); ++i) points.add(domain.points[plc.vertices[i].point], {0, i});
  }

  Outcome outcome{domain.frame};
  WorkQueue queue{100};
  RandomOffsets random{0, collars};
  GradedSizes sizes{domain, mesh, surface};
  FacingSheets facing_sheets{domain, mesh, nodes, collars, surface};
  UnresolvedPoints points{mesh, 0.25, queue};
  OpenCreases open_creases;
  CurveChains chains{domain, mesh,          collars, points,  open_creases,
                     sizes,  facing_sheets, random,  outcome, queue};
};

}  // namespace collarmesh::testing
