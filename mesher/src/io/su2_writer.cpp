// SU2's mesh format (.su2; su2code.github.io/docs_v7/Mesh-File): volumes, points, and a marker for each tag
// of faces on the boundary. The format has no place for faces inside, regions, edges and second order.
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "collarmesh/error.h"
#include "io/label_names.h"
#include "io/tet_mesh_formats.h"
#include "io/vtk_grid.h"
#include "io/write_each.h"

namespace collarmesh::io {

namespace {

void write_markers(FileWriter& out, const TetMesh& mesh) {
  std::map<Tag, std::vector<std::pair<CellKind, Index>>> markers;
  for_each_kind(mesh, 2, [&](CellKind kind) {
    for (Index f = 0; f < count_of(mesh, kind); ++f) {
      const auto& regions = regions_beside(mesh, kind)[f];
      if ((regions[0] == 0) != (regions[1] == 0)) markers[tags_of(mesh, kind)[f]].emplace_back(kind, f);
    }
  });
  out << "NMARK= " << markers.size() << '\n';
  for (const auto& [tag, faces] : markers) {
    out << "MARKER_TAG= " << word_name(mesh, 2, tag) << "\nMARKER_ELEMS= " << faces.size() << '\n';
    for (const auto& [kind, f] : faces) {
      out << vtk_type_of(kind, 1);
      for (const Index v : nodes_of(kind)(mesh, f)) out << ' ' << v;
      out << '\n';
    }
  }
}

}  // namespace

void write_su2(const std::string& path, const TetMesh& mesh) {
  if (mesh.order() == 2)
    throw WriteError(path + ": SU2's format has no elements of second order; write those of first order");
  FileWriter out(path);
  out << "% Written by collarmesh.\nNDIME= 3\nNELEM= " << count_of_dimension(mesh, 3) << '\n';
  for_each_kind(mesh, 3, [&](CellKind kind) {
    const std::size_t before = count_before(mesh, kind);
    write_each(out, count_of(mesh, kind), [&](TextBuffer& text, std::size_t i) {
      text << vtk_type_of(kind, 1);
      for (const Index v : in_vtk_order(kind, nodes_of(kind)(mesh, i))) text << ' ' << v;
      text << ' ' << before + i << '\n';
    });
  });
  out << "NPOIN= " << mesh.points.size() << '\n';
  write_each(out, mesh.points.size(),
             [&](TextBuffer& text, std::size_t i) { text << mesh.points[i] << ' ' << i << '\n'; });
  write_markers(out, mesh);
  out.commit();
}

}  // namespace collarmesh::io
