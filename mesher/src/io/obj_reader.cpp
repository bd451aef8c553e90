// Measured with CGAL 5.5.1's read_OBJ: it drops corners that are no number, takes a face line cut
// off after two corners and the index 0, and rejects lines continued with a backslash.
#include <fmt/format.h>

#include <string_view>
#include <vector>

#include "io/file_bytes.h"
#include "io/label_names.h"
#include "io/number_text.h"
#include "io/soup_formats.h"
#include "io/text_scanner.h"

namespace collarmesh::io {

namespace {

/// The faces of an .obj file may come before their vertices; indices are checked at the end, with the line.
struct Element {
  std::size_t first_corner, line;
  bool is_face;
  Tag tag;
};

struct Elements {
  std::vector<Element> list;
  Tag tag = 0;                        ///< of the group at hand, if its name is one of ours
  std::vector<std::int64_t> corners;  ///< counted from 0; negative ones are already resolved
};

/// A line that ends with a backslash goes on in the next one.
bool end_of_statement(TextScanner& scan) {
  while (!scan.at_line_end()) {
    if (scan.peek() != "\\") return false;
    scan.skip_line();
  }
  return true;
}

/// v, v/vt, v/vt/vn or v//vn: the position counts. Negative indices count back from the last vertex so far.
std::int64_t read_corner(TextScanner& scan, std::size_t points_so_far) {
  const std::string_view word = scan.word("a corner");
  std::int64_t index = 0;
  if (!parse(word.substr(0, word.find('/')), index) || index == 0)
    scan.fail("the index of a vertex, from 1 or from -1 downwards", word);
  if (index > 0) return index - 1;
  const std::int64_t resolved = static_cast<std::int64_t>(points_so_far) + index;
  if (resolved < 0)
    scan.fail(fmt::format("the corner {} counts back beyond the first of {} vertices so far", index,
                          points_so_far));
  return resolved;
}

void read_element(TextScanner& scan, bool is_face, std::size_t points_so_far, Elements& elements) {
  const std::size_t first = elements.corners.size(), line = scan.line();
  while (!end_of_statement(scan)) elements.corners.push_back(read_corner(scan, points_so_far));
  const std::size_t n = elements.corners.size() - first, least = is_face ? 3 : 2;
  if (n < least)
    scan.fail(
        fmt::format("expected {} of at least {} corners, found {}", is_face ? "a face" : "a line", least, n));
  elements.list.push_back({first, line, is_face, elements.tag});
}

void require_in_range(const std::string& path, const Element& element, std::int64_t corner,
                      std::size_t size) {
  if (corner < static_cast<std::int64_t>(size)) return;
  TextScanner(path, {}, 0, element.line)
      .fail(fmt::format("a corner is vertex {}, but the file has {} vertices", corner + 1, size));
}

void add_elements(const std::string& path, const Elements& elements, PolygonSoup& soup) {
  std::vector<Index> corners;
  for (std::size_t i = 0; i < elements.list.size(); ++i) {
    const Element& element = elements.list[i];
    const std::size_t end =
        i + 1 < elements.list.size() ? elements.list[i + 1].first_corner : elements.corners.size();
    corners.clear();
    for (std::size_t k = element.first_corner; k < end; ++k) {
      require_in_range(path, element, elements.corners[k], soup.points.size());
      corners.push_back(static_cast<Index>(elements.corners[k]));
    }
    if (element.is_face)
      soup.add_facet(corners, element.tag);
    else
      for (std::size_t k = 1; k < corners.size(); ++k) soup.segments.push_back({corners[k - 1], corners[k]});
  }
}

}  // namespace

PolygonSoup read_obj(const std::string& path) {
  const std::string text = read_bytes(path);
  TextScanner scan(path, text);
  PolygonSoup soup;
  Elements elements;
  while (!scan.at_end()) {
    const std::string_view keyword = scan.word("a keyword");
    if (keyword == "v") {
      soup.points.push_back(scan.point("a coordinate of a vertex"));
      while (!end_of_statement(scan)) scan.number("a weight or colour of a vertex");
    } else if (keyword == "f" || keyword == "l")
      read_element(scan, keyword == "f", soup.points.size(), elements);
    else if (keyword == "g" && !scan.at_line_end())
      elements.tag = tag_of_group_name(2, scan.word("a group")).value_or(0);
    else if (!((keyword[0] >= 'a' && keyword[0] <= 'z') || (keyword[0] >= 'A' && keyword[0] <= 'Z')))
      scan.fail("a keyword such as v or f", keyword);
    while (!end_of_statement(scan)) scan.word("");
    scan.skip_line();
  }
  if (soup.points.size() >= none) scan.fail("more vertices than can be numbered");
  add_elements(path, elements, soup);
  if (soup.points.empty()) scan.fail("expected vertices (v x y z), found none");
  return soup;
}

}  // namespace collarmesh::io
