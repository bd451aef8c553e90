#pragma once

#include <TopTools_DataMapOfShapeReal.hxx>
#include <array>
#include <map>
#include <vector>

#include "collarmesh/brep/cad_model.h"
#include "collarmesh/polygon_soup.h"
#include "topology.h"

namespace collarmesh::brep {

/// Points of an edge with the parameters of its curve, or of a face with those of its surface.
struct Samples {
  TopoDS_Shape shape;
  std::vector<Point> points;
  std::vector<std::array<double, 2>> parameters;  ///< of an edge the first one only
  std::vector<std::array<Index, 3>> triangles;    ///< of a face, corners among the points; two at a seam
};

struct Tessellation {
  /// One per solid, one for the internal faces and one for the free edges and vertices where there are any.
  std::vector<PolygonSoup> soups;
  std::map<int, std::vector<Samples>> edges, faces;  ///< by number
  TopTools_DataMapOfShapeReal lengths, areas;  ///< of the chords of edges that are features, of the triangles
  std::vector<std::string> notes;              ///< on faces that were cut in another way, or not at all
};

/// Triangulate all faces; neighbours share the points of their edges, but for faces that notes name.
/// Throws PlcError when no face has a triangulation. Precondition: the deflection is above 0.
Tessellation tessellate(const Topology& topology, const std::string& file,
                        const TessellationOptions& options);

}  // namespace collarmesh::brep
