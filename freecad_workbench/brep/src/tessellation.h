#pragma once

#include <TopTools_DataMapOfShapeReal.hxx>
#include <array>
#include <map>
#include <vector>

#include "collarmesh/brep/cad_model.h"
#include "collarmesh/polygon_soup.h"
#include "topology.h"

namespace collarmesh::brep {

/// Points of an edge with their parameters on its curve, or of a face with their parameters on its surface.
struct Samples {
  TopoDS_Shape shape;
  std::vector<Point> points;
  std::vector<std::array<double, 2>> parameters;  ///< for an edge only the first of each pair counts
  std::vector<std::array<Index, 3>> triangles;    ///< for a face: indices of points; seam points occur twice
};

struct Tessellation {
  /// One soup per solid; one for the internal faces, and one for the free edges and vertices, if there are
  /// any.
  std::vector<PolygonSoup> soups;
  std::map<int, std::vector<Samples>> edges, faces;  ///< by number
  TopTools_DataMapOfShapeReal lengths, areas;        ///< lengths of the chords of each feature edge, and
                                                     ///< areas of the triangles of each face
  std::vector<std::string> notes;  ///< notes on mended faces, and on faces and free parts that are left out
};

/// Triangulates all faces. Neighbouring faces share the points of their edges, except for faces that notes
/// name. Throws PlcError if no face can be triangulated. Precondition: the deflection is above 0.
Tessellation tessellate(const Topology& topology, const std::string& file,
                        const TessellationOptions& options);

}  // namespace collarmesh::brep
