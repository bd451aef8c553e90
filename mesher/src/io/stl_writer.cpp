// Binary STL: triangles in 32-bit numbers. Points that differ in 64 bits may become one; segments and
// tags have no place in it.
#include <fmt/format.h>

#include <array>
#include <bit>
#include <cmath>
#include <string_view>

#include "collarmesh/error.h"
#include "io/file_writer.h"
#include "io/one_polygon.h"
#include "io/soup_formats.h"

namespace collarmesh::io {

namespace {

void write_point(FileWriter& out, const Point& p) {
  static_assert(std::endian::native == std::endian::little);
  const std::array<float, 3> raw{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
  out << std::string_view(reinterpret_cast<const char*>(raw.data()), sizeof raw);
}

}  // namespace

void write_stl(const std::string& path, const PolygonSoup& soup) {
  FileWriter out(path);
  std::string header = "binary STL, written by collarmesh";
  header.resize(80, ' ');
  const auto count = std::bit_cast<std::array<char, 4>>(soup.facet_count());
  out << header << std::string_view(count.data(), count.size());
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
