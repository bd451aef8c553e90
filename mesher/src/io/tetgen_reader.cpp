// Reads the file formats .poly and .smesh of TetGen 1.5 (its manual, section "File formats"). The largest
// volume of a region becomes a target size: the edge length of the regular tetrahedron of that volume.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <numbers>
#include <string_view>
#include <vector>

#include "io/file_bytes.h"
#include "io/soup_formats.h"
#include "io/tetgen_nodes.h"
#include "io/text_scanner.h"

namespace collarmesh::io {

namespace {

Tag marker(TextScanner& scan, bool given) {
  return given && !scan.at_line_end() ? scan.integer("a boundary marker") : 0;
}

/// Reads the .node file beside a .poly file that declares no points.
std::int64_t read_node_file(const std::string& poly_path, PolygonSoup& soup) {
  const std::string path = std::filesystem::path(poly_path).replace_extension(".node").string();
  const std::string text = read_bytes(path);
  TextScanner scan(path, text);
  return read_tetgen_nodes(scan, read_tetgen_node_header(scan), soup.points, soup.point_tags);
}

/// A facet of the file, which may span no area.
struct FileFacet {
  Tag tag = 0;
  std::vector<std::vector<Index>> polygons;
  std::vector<Point> holes;
};

/// Adds a facet. A facet without a polygon of three or more corners spans no area: its edges become loose
/// segments.
void add_facet(const FileFacet& facet, PolygonSoup& soup) {
  bool spans = false, has_point = false;
  for (const std::vector<Index>& polygon : facet.polygons) {
    spans = spans || polygon.size() >= 3;
    has_point = has_point || polygon.size() == 1;
  }
  if (spans || has_point) soup.begin_facet(facet.tag);
  for (const std::vector<Index>& polygon : facet.polygons)
    if (polygon.size() == 2 && !spans)
      soup.segments.push_back({polygon[0], polygon[1], facet.tag});
    else
      soup.add_polygon(polygon);
  for (const Point& hole : facet.holes) soup.facet_holes.push_back({soup.facet_count() - 1, hole});
}

/// Reads the corners, which may continue over several lines.
std::vector<Index> read_polygon(TextScanner& scan, std::int64_t first, const PolygonSoup& soup) {
  const Index n = scan.count("the number of corners of a polygon", 2);
  if (n == 0) scan.fail("expected a polygon of at least 1 corner, found 0");
  std::vector<Index> corners(n);
  for (Index& corner : corners) corner = scan.index("a corner of a polygon", first, soup.points.size());
  return corners;
}

Point read_numbered_point(TextScanner& scan, std::string_view what) {
  scan.integer(fmt::format("the number of {}", what));
  return scan.point(fmt::format("a coordinate of {}", what));
}

FileFacet read_poly_facet(TextScanner& scan, std::int64_t first, bool markers, const PolygonSoup& soup) {
  FileFacet facet;
  const Index polygons = scan.count("the number of polygons of a facet", 4);
  if (polygons == 0) scan.fail("expected a facet of at least 1 polygon, found 0");
  const Index holes = scan.at_line_end() ? 0 : scan.count("the number of holes of a facet", 8);
  facet.tag = marker(scan, markers);
  scan.skip_line();
  for (Index i = 0; i < polygons; ++i) {
    facet.polygons.push_back(read_polygon(scan, first, soup));
    scan.skip_line();
  }
  for (Index i = 0; i < holes; ++i) {
    facet.holes.push_back(read_numbered_point(scan, "a hole of a facet"));
    scan.skip_line();
  }
  return facet;
}

FileFacet read_smesh_facet(TextScanner& scan, std::int64_t first, bool markers, const PolygonSoup& soup) {
  FileFacet facet;
  facet.polygons.push_back(read_polygon(scan, first, soup));
  facet.tag = marker(scan, markers);
  scan.skip_line();
  return facet;
}

using FacetReader = FileFacet (*)(TextScanner&, std::int64_t, bool, const PolygonSoup&);

void read_facets(TextScanner& scan, std::int64_t first, FacetReader read_facet, PolygonSoup& soup) {
  const Index count = scan.count("the number of facets", 4);
  const bool markers = read_tetgen_marker_flag(scan);
  scan.skip_line();
  for (Index i = 0; i < count; ++i) {
    const FileFacet facet = read_facet(scan, first, markers, soup);
    if (!facet.holes.empty() && facet.polygons.front().size() < 3)
      scan.fail("a facet with holes has to begin with a polygon of at least 3 corners");
    add_facet(facet, soup);
  }
}

/// Returns the edge length of a regular tetrahedron of this volume.
double edge_of_volume(double volume) { return std::cbrt(6 * std::numbers::sqrt2 * volume); }

Tag region_tag(TextScanner& scan) {
  const double attribute = scan.coordinate("the attribute of a region");
  if (std::abs(attribute) >= 0x1p62)
    scan.fail(fmt::format("the attribute of a region, {}, is too large", attribute));
  return static_cast<Tag>(std::llround(attribute));
}

void read_regions(TextScanner& scan, PolygonSoup& soup) {
  const Index count = scan.count("the number of regions", 8);
  for (Index i = 0; i < count; ++i) {
    PolygonSoup::RegionPoint region;
    region.point = read_numbered_point(scan, "a region point");
    if (!scan.at_line_end()) region.tag = region_tag(scan);
    const double volume = scan.at_line_end() ? 0 : scan.coordinate("the largest volume of a region");
    if (volume > 0) region.size = edge_of_volume(volume);
    soup.region_points.push_back(region);
    scan.skip_line();
  }
}

/// Reads the lists of holes and regions, which may be missing. Ignores the rest of the file, as TetGen does.
void read_holes_and_regions(TextScanner& scan, PolygonSoup& soup) {
  if (scan.at_end()) return;
  const Index count = scan.count("the number of holes", 8);
  scan.skip_line();
  for (Index i = 0; i < count; ++i) {
    soup.hole_points.push_back(read_numbered_point(scan, "a hole point"));
    scan.skip_line();
  }
  if (!scan.at_end()) read_regions(scan, soup);
}

PolygonSoup read(const std::string& path, FacetReader read_facet) {
  const std::string text = read_bytes(path);
  TextScanner scan(path, text);
  PolygonSoup soup;
  const TetgenNodeHeader header = read_tetgen_node_header(scan);
  const std::int64_t first = header.count > 0 ? read_tetgen_nodes(scan, header, soup.points, soup.point_tags)
                                              : read_node_file(path, soup);
  read_facets(scan, first, read_facet, soup);
  read_holes_and_regions(scan, soup);
  return soup;
}

}  // namespace

PolygonSoup read_poly(const std::string& path) { return read(path, read_poly_facet); }
PolygonSoup read_smesh(const std::string& path) { return read(path, read_smesh_facet); }

}  // namespace collarmesh::io
