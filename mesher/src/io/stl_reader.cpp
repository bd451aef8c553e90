// Our own reader, because CGAL 5.5.1's read_STL accepts an empty file, a file shorter than its header, NaN
// and bytes after the last triangle, and reads a bad text file as if it were binary.
#include <fmt/format.h>

#include <bit>
#include <map>
#include <string_view>
#include <vector>

#include "common/is_finite.h"
#include "io/byte_reader.h"
#include "io/file_bytes.h"
#include "io/point_merger.h"
#include "io/soup_formats.h"
#include "io/text_scanner.h"

namespace collarmesh::io {

namespace {

constexpr std::size_t header_bytes = 84, triangle_bytes = 50;

bool equal_ignoring_case(std::string_view a, std::string_view lower) {
  if (a.size() != lower.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i)
    if ((a[i] >= 'A' && a[i] <= 'Z' ? a[i] + ('a' - 'A') : a[i]) != lower[i]) return false;
  return true;
}

/// Returns whether the size of the file is that of a binary one with the number of triangles that its header
/// gives.
bool has_binary_size(std::string_view bytes) {
  if (bytes.size() < header_bytes) return false;
  const std::uint32_t count = ByteReader("", bytes.substr(80)).get<std::uint32_t>("");
  return bytes.size() == header_bytes + triangle_bytes * std::size_t{count};
}

/// Returns whether a file is text: binary files may begin with "solid" too, but text has no zero bytes.
bool is_text(std::string_view bytes) {
  const std::size_t start = bytes.find_first_not_of(" \t\r\n");
  return start != std::string_view::npos && equal_ignoring_case(bytes.substr(start, 5), "solid") &&
         !has_binary_size(bytes) && bytes.substr(0, 1024).find('\0') == std::string_view::npos;
}

void expect(TextScanner& scan, std::string_view keyword) {
  const std::string_view found = scan.word(keyword);
  if (!equal_ignoring_case(found, keyword)) scan.fail(keyword, found);
}

struct Solids {
  std::vector<std::string> names;
  std::vector<std::size_t> ends;  // by solid: number of triangles of it and of all solids before it
};

void read_text_facet(TextScanner& scan, PointMerger& merger, std::vector<std::array<Index, 3>>& triangles) {
  expect(scan, "normal");
  scan.skip_line();  // normals are often zero or wrong; the order of the corners counts
  expect(scan, "outer");
  expect(scan, "loop");
  std::array<Index, 3> corners;
  for (Index& corner : corners) {
    expect(scan, "vertex");
    corner = merger.add(scan.point("a coordinate of a vertex"));
  }
  expect(scan, "endloop");
  expect(scan, "endfacet");
  triangles.push_back(corners);
}

void read_text_solid(TextScanner& scan, PointMerger& merger, std::vector<std::array<Index, 3>>& triangles,
                     Solids& solids) {
  expect(scan, "solid");
  solids.names.emplace_back(scan.rest_of_line());
  for (;;) {
    const std::string_view keyword = scan.word("facet or endsolid");
    if (equal_ignoring_case(keyword, "endsolid")) break;
    if (equal_ignoring_case(keyword, "end")) {  // some programs write two words
      expect(scan, "solid");
      break;
    }
    if (!equal_ignoring_case(keyword, "facet")) scan.fail("facet or endsolid", keyword);
    read_text_facet(scan, merger, triangles);
  }
  scan.skip_line();
  solids.ends.push_back(triangles.size());
}

/// Adds the triangles. The names of the solids become tags, unless the file has a single solid; solids with
/// one name have one tag.
void add_solids(const std::vector<std::array<Index, 3>>& triangles, const Solids& solids, PolygonSoup& soup) {
  std::map<std::string, Tag> tags;
  const auto tag_of = [&](std::size_t solid) {
    const std::string& name = solids.names[solid];
    const Tag next = static_cast<Tag>(tags.size()) + 1;
    return tags.try_emplace(name.empty() ? fmt::format("solid_{}", solid + 1) : name, next).first->second;
  };
  std::size_t first = 0;
  for (std::size_t s = 0; s < solids.ends.size(); ++s) {
    const Tag tag = solids.ends.size() > 1 && solids.ends[s] > first ? tag_of(s) : 0;
    for (; first < solids.ends[s]; ++first) soup.add_facet(triangles[first], tag);
  }
  for (const auto& [name, tag] : tags) soup.tag_names.set(2, tag, name);
}

PolygonSoup read_text(const std::string& path, std::string_view text) {
  TextScanner scan(path, text, 0);
  PolygonSoup soup;
  PointMerger merger(soup.points);
  std::vector<std::array<Index, 3>> triangles;
  Solids solids;
  while (!scan.at_end()) read_text_solid(scan, merger, triangles, solids);
  add_solids(triangles, solids, soup);
  return soup;
}

Point read_binary_point(ByteReader& reader) {
  const auto coordinate = [&reader] { return double{reader.get<float>("a coordinate of a vertex")}; };
  const double x = coordinate(), y = coordinate(), z = coordinate();
  if (!is_finite({x, y, z}))
    reader.fail(fmt::format("the vertex that ends here, ({}, {}, {}), is not finite", x, y, z));
  return {x, y, z};
}

PolygonSoup read_binary(const std::string& path, std::string_view bytes) {
  ByteReader reader(path, bytes);
  reader.skip(80, "the header of a binary STL file");
  const std::uint32_t count = reader.get<std::uint32_t>("the number of triangles");
  if (reader.left() != triangle_bytes * std::size_t{count})
    reader.fail(
        fmt::format("expected {} triangles ({} bytes), found {} bytes; the file is cut off or is no STL file",
                    count, triangle_bytes * std::size_t{count}, reader.left()));
  PolygonSoup soup;
  PointMerger merger(soup.points);
  for (std::uint32_t i = 0; i < count; ++i) {
    reader.skip(3 * sizeof(float), "the normal of a triangle");
    std::array<Index, 3> corners;
    for (Index& corner : corners) corner = merger.add(read_binary_point(reader));
    reader.skip(2, "the attribute of a triangle");
    soup.add_facet(corners);
  }
  return soup;
}

}  // namespace

PolygonSoup read_stl(const std::string& path) {
  const std::string bytes = read_bytes(path);
  return is_text(bytes) ? read_text(path, bytes) : read_binary(path, bytes);
}

}  // namespace collarmesh::io
