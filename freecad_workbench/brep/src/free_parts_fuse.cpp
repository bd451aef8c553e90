// Cuts edges and vertices that belong to no face where they meet faces or one another, and inserts vertices
// and edges into these faces.
#include "free_parts_fuse.h"

#include <TopoDS_Compound.hxx>

#include <algorithm>

#include "fuse.h"

namespace collarmesh::brep {

namespace {

using Shapes = std::vector<TopoDS_Shape>;

void append(Shapes& shapes, const Shapes& more) { shapes.insert(shapes.end(), more.begin(), more.end()); }

/// Returns the internal faces and the closed solids; a region may have several solids.
Shapes closed_parts(const Topology& topology) {
  Shapes closed;
  for (const Topology::Solid& solid : topology.solids)
    if (!solid.open) append(closed, subshapes(solid.shape, TopAbs_SOLID));
  append(closed, topology.internal_faces);
  return closed;
}

Shapes faces_of(const Topology& topology) {
  Shapes faces;
  for (const Topology::Solid& solid : topology.solids) append(faces, solid.faces);
  append(faces, topology.internal_faces);
  return faces;
}

/// Returns the pieces of all shapes, in their order.
Shapes pieces_of(const Shapes& shapes, const PartsOf& parts_of) {
  Shapes pieces;
  for (const TopoDS_Shape& shape : shapes)
    for (const TopoDS_Shape& piece : parts_of(shape)) pieces.push_back(piece);
  return pieces;
}

bool spoils_a_solid(BOPAlgo_Builder& fuse, const Shapes& closed) {
  return std::any_of(closed.begin(), closed.end(), [&](const TopoDS_Shape& shape) {
    return shape.ShapeType() == TopAbs_SOLID && unsoundness(fuse, shape) > rough_volume;
  });
}

/// Replaces the closed solids and the internal faces by their pieces.
void replace_faces(const PartsOf& parts_of, Topology& topology) {
  for (Topology::Solid& solid : topology.solids)
    if (!solid.open) solid = merged(pieces_of(subshapes(solid.shape, TopAbs_SOLID), parts_of), solid.number);
  topology.internal_faces = pieces_of(topology.internal_faces, parts_of);
}

}  // namespace

std::optional<PartsOf> fuse_free_parts(const Shapes& parts, const Shapes& unchanged, Topology& topology) {
  const Shapes closed = closed_parts(topology);
  Shapes arguments{compound_of(closed)};  // one argument, so that the fuse does not intersect its faces
                                          // with one another again
  append(arguments, parts);
  const Fuse fuse = general_fuse(arguments);
  if (!fuse || spoils_a_solid(*fuse, closed)) return std::nullopt;
  const PartsOf parts_of = [fuse](const TopoDS_Shape& old) {
    TopTools_ListOfShape pieces;
    if (fuse->IsDeleted(old)) return pieces;
    pieces = fuse->Modified(old);
    if (pieces.IsEmpty()) pieces.Append(old);
    return pieces;
  };
  Shapes before = faces_of(topology);
  append(before, closed);
  append(before, parts);
  append(before, unchanged);
  replace_faces(parts_of, topology);
  Shapes after = faces_of(topology);
  topology.all = compound_of(after);
  append(after, pieces_of(parts, parts_of));
  append(after, unchanged);
  topology.kept_numbers.clear();  // parts that are left out keep their numbers through `unchanged`
  carry_numbers(compound_of(before), compound_of(after), parts_of, topology);
  return parts_of;
}

}  // namespace collarmesh::brep
