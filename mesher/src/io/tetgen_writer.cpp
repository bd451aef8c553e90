// The file formats .poly and .smesh of TetGen 1.5 (its manual, section "File formats"), numbered from 1. A
// loose segment is a facet of two corners. The target size of a region becomes its largest volume: that of
// the regular tetrahedron with this edge length.
#include <fmt/format.h>

#include <numbers>
#include <vector>

#include "collarmesh/error.h"
#include "io/file_writer.h"
#include "io/one_polygon.h"
#include "io/soup_formats.h"

namespace collarmesh::io {

namespace {

void write_soup_nodes(FileWriter& out, const PolygonSoup& soup) {
  const bool markers = !soup.point_tags.empty();
  out << "# Written by collarmesh.\n" << soup.points.size() << " 3 0 " << (markers ? 1 : 0) << '\n';
  for (std::size_t i = 0; i < soup.points.size(); ++i) {
    out << i + 1 << ' ' << soup.points[i];
    if (markers) out << ' ' << soup.point_tags[i];
    out << '\n';
  }
}

void write_corners(FileWriter& out, std::span<const Index> corners) {
  out << corners.size();
  for (const Index v : corners) out << ' ' << std::size_t{v} + 1;
}

void write_poly_facets(FileWriter& out, const PolygonSoup& soup) {
  std::vector<std::vector<Point>> holes(soup.facet_count());
  for (const auto& hole : soup.facet_holes) holes[hole.facet].push_back(hole.point);
  out << soup.facet_count() + soup.segments.size() << " 1\n";
  for (Index f = 0; f < soup.facet_count(); ++f) {
    const auto [first, last] = soup.facet_polygons(f);
    out << last - first << ' ' << holes[f].size() << ' ' << soup.facet_tag(f) << '\n';
    for (Index q = first; q < last; ++q) {
      write_corners(out, soup.polygon(q));
      out << '\n';
    }
    for (std::size_t h = 0; h < holes[f].size(); ++h) out << h + 1 << ' ' << holes[f][h] << '\n';
  }
  for (const auto& segment : soup.segments) {
    out << "1 0 " << segment.tag << '\n';
    write_corners(out, std::array{segment.a, segment.b});
    out << '\n';
  }
}

void write_smesh_facets(FileWriter& out, const std::string& path, const PolygonSoup& soup) {
  out << soup.facet_count() + soup.segments.size() << " 1\n";
  for (Index f = 0; f < soup.facet_count(); ++f) {
    write_corners(out, one_polygon(path, soup, f));
    out << ' ' << soup.facet_tag(f) << '\n';
  }
  for (const auto& segment : soup.segments) {
    write_corners(out, std::array{segment.a, segment.b});
    out << ' ' << segment.tag << '\n';
  }
}

double volume_of_edge(double edge) { return edge * edge * edge / (6 * std::numbers::sqrt2); }

void write_holes_and_regions(FileWriter& out, const PolygonSoup& soup) {
  out << soup.hole_points.size() << '\n';
  for (std::size_t i = 0; i < soup.hole_points.size(); ++i)
    out << i + 1 << ' ' << soup.hole_points[i] << '\n';
  out << soup.region_points.size() << '\n';
  for (std::size_t i = 0; i < soup.region_points.size(); ++i) {
    const auto& region = soup.region_points[i];
    out << i + 1 << ' ' << region.point << ' ' << region.tag << ' ';
    if (region.size > 0)
      out << volume_of_edge(region.size) << '\n';
    else
      out << "-1\n";
  }
}

}  // namespace

void write_poly(const std::string& path, const PolygonSoup& soup) {
  FileWriter out(path);
  write_soup_nodes(out, soup);
  write_poly_facets(out, soup);
  write_holes_and_regions(out, soup);
  out.commit();
}

void write_smesh(const std::string& path, const PolygonSoup& soup) {
  FileWriter out(path);
  write_soup_nodes(out, soup);
  write_smesh_facets(out, path, soup);
  write_holes_and_regions(out, soup);
  out.commit();
}

}  // namespace collarmesh::io
