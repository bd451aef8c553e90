// Our own reader, because CGAL 5.5.1's read_OBJ drops corners that are no number, accepts the index 0 and
// face lines cut off after two corners, and rejects lines continued with a backslash.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "io/file_bytes.h"
#include "io/label_names.h"
#include "io/number_text.h"
#include "io/soup_formats.h"
#include "io/text_scanner.h"

namespace collarmesh::io {

namespace {

/// A face or line of an .obj file. Faces may come before their vertices, so indices are checked at the end;
/// `line` is for errors.
struct ObjElement {
  std::size_t first_corner, line;
  bool is_face;
  std::size_t group, material;  ///< indices of their names
};

/// Names in the order of their first use; "" stands for no name.
class Names {
 public:
  std::size_t position(std::string_view name) {
    const auto [known, added] = positions_.try_emplace(std::string(name), list_.size());
    if (added) list_.emplace_back(name);
    return known->second;
  }
  const std::vector<std::string>& list() const { return list_; }

 private:
  std::map<std::string, std::size_t> positions_{{"", 0}};
  std::vector<std::string> list_{""};
};

struct Elements {
  std::vector<ObjElement> list;
  Names groups, materials;
  std::size_t group = 0, material = 0;  ///< numbers for the next element
  std::vector<std::int64_t> corners;    ///< indices from 0; the file's negative ones are resolved
};

/// Returns whether the statement ends here. Skips a backslash at the end of a line, which continues the
/// statement.
bool end_of_statement(TextScanner& scan) {
  while (!scan.at_line_end()) {
    if (scan.peek() != "\\") return false;
    scan.skip_line();
  }
  return true;
}

/// Reads v, v/vt, v/vt/vn or v//vn, of which only the position counts. Negative indices count back from the
/// last vertex so far.
std::int64_t read_corner(TextScanner& scan, std::size_t points_so_far) {
  const std::string_view word = scan.word("a corner");
  std::int64_t index = 0;
  if (!parse(word.substr(0, word.find('/')), index) || index == 0)
    scan.fail("the index of a vertex, a whole number other than 0", word);
  if (index > 0) return index - 1;
  const std::int64_t resolved = static_cast<std::int64_t>(points_so_far) + index;
  if (resolved < 0)
    scan.fail(fmt::format("the corner {} counts back beyond the first of the {} vertices so far", index,
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
  elements.list.push_back({first, line, is_face, elements.group, elements.material});
}

void require_in_range(const std::string& path, const ObjElement& element, std::int64_t corner,
                      std::size_t size) {
  if (corner < static_cast<std::int64_t>(size)) return;
  TextScanner(path, {}, 0, element.line)
      .fail(fmt::format("a corner is vertex {}, but the file has {} vertices", corner + 1, size));
}

/// Returns the tags of the faces: by groups if there are several groups or one has a name of ours, otherwise
/// by materials if there are several. Adds the names of tags to `soup`.
std::vector<Tag> tags_of_faces(const Elements& elements, PolygonSoup& soup) {
  std::set<std::size_t> groups, materials;
  for (const ObjElement& element : elements.list) {
    if (!element.is_face) continue;
    groups.insert(element.group);
    materials.insert(element.material);
  }
  const bool ours = std::any_of(groups.begin(), groups.end(), [&](std::size_t group) {
    return tag_of_group_name(2, elements.groups.list()[group]).has_value();
  });
  std::vector<Tag> tags(elements.list.size(), 0);
  const bool by_group = ours || groups.size() > 1;
  if (!by_group && materials.size() < 2) return tags;
  const std::vector<std::string>& names = (by_group ? elements.groups : elements.materials).list();
  GroupTags known;
  for (const std::string& name : names)
    if (tag_of_group_name(2, name)) known.find(2, name);
  for (std::size_t i = 0; i < tags.size(); ++i) {
    const ObjElement& element = elements.list[i];
    const std::string& name = names[by_group ? element.group : element.material];
    if (!element.is_face || name.empty()) continue;
    tags[i] = known.find(2, name);
    if (!tag_of_group_name(2, name)) soup.tag_names.set(2, tags[i], name);
  }
  return tags;
}

void add_elements(const std::string& path, const Elements& elements, PolygonSoup& soup) {
  std::vector<Index> corners;
  const std::vector<Tag> tags = tags_of_faces(elements, soup);
  for (std::size_t i = 0; i < elements.list.size(); ++i) {
    const ObjElement& element = elements.list[i];
    const std::size_t end =
        i + 1 < elements.list.size() ? elements.list[i + 1].first_corner : elements.corners.size();
    corners.clear();
    for (std::size_t k = element.first_corner; k < end; ++k) {
      require_in_range(path, element, elements.corners[k], soup.points.size());
      corners.push_back(static_cast<Index>(elements.corners[k]));
    }
    if (element.is_face)
      soup.add_facet(corners, tags[i]);
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
      elements.group = elements.groups.position(scan.word("a group"));
    else if (keyword == "usemtl" && !scan.at_line_end())
      elements.material = elements.materials.position(scan.word("a material"));
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
