// SU2's mesh format (.su2; su2code.github.io/docs_v7/Mesh-File): tetrahedra, points, and a marker for each
// tag of faces on the boundary. The format has no place for faces inside, regions, edges and second order.
#include <map>
#include <string>
#include <vector>

#include "collarmesh/error.h"
#include "io/label_names.h"
#include "io/node_groups.h"
#include "io/tet_mesh_formats.h"
#include "io/write_each.h"

namespace collarmesh::io {

namespace {

constexpr int tetrahedron = 10, triangle = 5;  // VTK's numbers

void write_markers(FileWriter& out, const TetMesh& mesh) {
  Groups markers;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    if ((mesh.face_regions[f][0] == 0) != (mesh.face_regions[f][1] == 0))
      markers[mesh.face_tag[f]].push_back(static_cast<Index>(f));
  out << "NMARK= " << markers.size() << '\n';
  for (const auto& [tag, faces] : markers) {
    out << "MARKER_TAG= " << word_name(mesh, 2, tag) << "\nMARKER_ELEMS= " << faces.size() << '\n';
    for (const Index f : faces) {
      out << triangle;
      for (const Index v : mesh.faces[f]) out << ' ' << v;
      out << '\n';
    }
  }
}

}  // namespace

void write_su2(const std::string& path, const TetMesh& mesh) {
  if (mesh.order() == 2)
    throw WriteError(path + ": SU2's format has no elements of second order; write those of first order");
  FileWriter out(path);
  out << "% Written by collarmesh.\nNDIME= 3\nNELEM= " << mesh.tets.size() << '\n';
  write_each(out, mesh.tets.size(), [&](TextBuffer& text, std::size_t i) {
    text << tetrahedron;
    for (const Index v : mesh.tets[i]) text << ' ' << v;
    text << ' ' << i << '\n';
  });
  out << "NPOIN= " << mesh.points.size() << '\n';
  write_each(out, mesh.points.size(), [&](TextBuffer& text, std::size_t i) {
    const Point& p = mesh.points[i];
    text << p.x << ' ' << p.y << ' ' << p.z << ' ' << i << '\n';
  });
  write_markers(out, mesh);
  out.commit();
}

}  // namespace collarmesh::io
