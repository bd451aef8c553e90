// Our own reader, because with CGAL 5.5.1's read_OFF a header that claims fewer faces than follow shortens
// the file silently, and for one that claims two thousand million it allocates memory for all of them.
#include <fmt/format.h>

#include <string_view>
#include <vector>

#include "io/file_bytes.h"
#include "io/soup_formats.h"
#include "io/text_scanner.h"

namespace collarmesh::io {

namespace {

bool is_number_start(char c) { return (c >= '0' && c <= '9') || c == '-' || c == '+'; }

/// Reads the keyword [ST][C][N]OFF, which some writers leave out. Normals, colours and texture coordinates
/// follow a vertex's coordinates on their line and are skipped.
void read_keyword(TextScanner& scan) {
  if (!scan.at_end() && is_number_start(scan.peek().front())) return;
  const std::string_view keyword = scan.word("the keyword OFF");
  std::string_view rest = keyword;
  if (rest.starts_with("ST")) rest.remove_prefix(2);
  if (rest.starts_with("C")) rest.remove_prefix(1);
  if (rest.starts_with("N")) rest.remove_prefix(1);
  if (rest == "4OFF" || rest == "nOFF" || rest == "4nOFF")
    scan.fail(fmt::format("{} is for points that do not have 3 coordinates; save the file as OFF",
                          in_quotes(keyword)));
  if (rest != "OFF") scan.fail("the keyword OFF", keyword);
  if (!scan.at_line_end() && scan.peek() == "BINARY")
    scan.fail("binary OFF is not supported; convert it to text");
}

void read_face(TextScanner& scan, std::vector<Index>& corners, PolygonSoup& soup) {
  const Index n = scan.count("the number of corners of a face", 2);
  if (n < 2) scan.fail(fmt::format("expected a face of at least 2 corners, found {}", n));
  corners.resize(n);
  for (Index& corner : corners) corner = scan.index("a corner of a face", 0, soup.points.size());
  if (n == 2)
    soup.segments.push_back({corners[0], corners[1]});
  else
    soup.add_facet(corners);
  scan.skip_line();  // the colour
}

}  // namespace

PolygonSoup read_off(const std::string& path) {
  const std::string text = read_bytes(path);
  TextScanner scan(path, text);
  read_keyword(scan);
  const Index point_count = scan.count("the number of vertices", 6);
  const Index face_count = scan.count("the number of faces", 4);
  scan.skip_line();  // the number of edges, which is often wrong

  PolygonSoup soup;
  soup.points.reserve(point_count);
  for (Index i = 0; i < point_count; ++i) {
    soup.points.push_back(scan.point("a coordinate of a vertex"));
    scan.skip_line();
  }
  std::vector<Index> corners;
  for (Index i = 0; i < face_count; ++i) read_face(scan, corners, soup);
  if (!scan.at_end())
    scan.fail(fmt::format("expected the end of the file after {} vertices and {} faces, found {}",
                          point_count, face_count, in_quotes(scan.peek())));
  return soup;
}

}  // namespace collarmesh::io
