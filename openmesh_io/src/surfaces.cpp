#include "collarmesh/openmesh_io/surfaces.h"

#include <fmt/format.h>

namespace collarmesh::openmesh_io {

namespace {

void note(std::vector<std::string>& notes, const std::string& name, std::size_t count, const char* what) {
  if (count > 0) notes.push_back(fmt::format("{}: {} {}", name, count, what));
}

void add_notes(const SurfaceReport& report, std::size_t number, std::vector<std::string>& notes) {
  const std::string name = report.name.empty() ? fmt::format("surface {}", number) : report.name;
  note(notes, name, report.deleted_faces, "faces are marked as deleted and were left out");
  note(notes, name, report.isolated_vertices, "vertices without a face were left out");
  note(notes, name, report.detached_faces,
       "faces had been detached by OpenMesh at an edge or vertex that it cannot represent; their vertices "
       "were welded to those of the neighbouring faces again");
  note(notes, name, report.non_manifold_vertices, "vertices join several fans of faces");
  note(notes, name, report.border_edges,
       "edges have one face; they are closed where they coincide with others");
}

void add_notes(const Plc::Cleanup& cleanup, std::vector<std::string>& notes) {
  note(notes, "complex", cleanup.welded_points, "points were merged with others");
  note(notes, "complex", cleanup.degenerate_triangles, "triangles have no area and were dropped");
  note(notes, "complex", cleanup.repeated_triangles, "triangles repeat another one and were dropped");
  note(notes, "complex", cleanup.shared_triangles, "triangles of two surfaces became an interface");
}

}  // namespace

PolygonSoup& Surfaces::soup_of(Tag region, std::size_t first, const PolygonSoup& pattern) {
  for (std::size_t s = first; s < soups_.size(); ++s)
    if (soups_[s].region_tag == region) return soups_[s];
  soups_.push_back(pattern);
  soups_.back().region_tag = region;
  return soups_.back();
}

SurfacesPlc Surfaces::to_plc(const PlcOptions& options) const {
  SurfacesPlc result{build_plc(soups_, options), reports_, {}};
  for (std::size_t s = 0; s < reports_.size(); ++s) add_notes(reports_[s], s + 1, result.notes);
  add_notes(result.plc.cleanup, result.notes);
  return result;
}

}  // namespace collarmesh::openmesh_io
