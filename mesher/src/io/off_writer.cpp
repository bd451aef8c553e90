// The object file format of Geomview (.off). Segments are faces of two corners; the format has no place for
// tags.
#include "io/file_writer.h"
#include "io/one_polygon.h"
#include "io/soup_formats.h"

namespace collarmesh::io {

void write_off(const std::string& path, const PolygonSoup& soup) {
  FileWriter out(path);
  out << "OFF\n" << soup.points.size() << ' ' << soup.facet_count() + soup.segments.size() << " 0\n";
  for (const Point& p : soup.points) out << p << '\n';
  for (Index f = 0; f < soup.facet_count(); ++f) {
    const auto corners = one_polygon(path, soup, f);
    out << corners.size();
    for (const Index v : corners) out << ' ' << v;
    out << '\n';
  }
  for (const auto& segment : soup.segments) out << "2 " << segment.a << ' ' << segment.b << '\n';
  out.commit();
}

}  // namespace collarmesh::io
