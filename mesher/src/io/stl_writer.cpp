// Binary STL: triangles in 32-bit numbers. Points that differ only beyond 32 bits become equal; the format
// has no place for segments and tags.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <string_view>

#include "collarmesh/error.h"
#include "io/file_writer.h"
#include "io/number_bytes.h"
#include "io/one_polygon.h"
#include "io/soup_formats.h"

namespace collarmesh::io {

namespace {

void write_point(FileWriter& out, const Point& p) {
  std::array<char, 12> bytes;
  auto at = bytes.begin();
  for (const double c : {p.x, p.y, p.z})
    at = std::ranges::copy(bytes_of(static_cast<float>(c), std::endian::little), at).out;
  out << std::string_view(bytes.data(), bytes.size());
}

}  // namespace

void write_stl(const std::string& path, const PolygonSoup& soup) {
  FileWriter out(path);
  std::string header = "binary STL, written by collarmesh";
  header.resize(80, ' ');
  out << header;
  out.append_bytes(soup.facet_count(), std::endian::little);
  for (Index f = 0; f < soup.facet_count(); ++f) {
    const auto corners = one_polygon(path, soup, f);
    if (corners.size() != 3)
      throw WriteError(
          fmt::format("{}: facet {} has {} corners, but STL holds triangles only", path, f, corners.size()));
    const Point &a = soup.points[corners[0]], &b = soup.points[corners[1]], &c = soup.points[corners[2]];
    const Vector normal = cross(b - a, c - a);
    const double length = norm(normal);
    write_point(out, length > 0 ? normal / length : Point{});
    for (const Point& p : {a, b, c}) write_point(out, p);
    out << std::string_view("\0\0", 2);
  }
  out.commit();
}

}  // namespace collarmesh::io
