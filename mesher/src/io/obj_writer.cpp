// Wavefront's format (.obj): vertices, faces, lines. A tag other than 0 is a group, named as in
// label_names.h.
#include <optional>

#include "io/file_writer.h"
#include "io/label_names.h"
#include "io/one_polygon.h"
#include "io/soup_formats.h"

namespace collarmesh::io {

namespace {

/// Returns the name of a tag as a single word.
std::string name_of(const PolygonSoup& soup, Tag tag) {
  const std::string* given = soup.tag_names.find(2, tag);
  if (given == nullptr) return group_name(GroupNames::complex, 2, tag);
  std::string name = *given;
  for (char& c : name)
    if (static_cast<unsigned char>(c) <= ' ' || c == '#') c = '_';
  return name;
}

}  // namespace

void write_obj(const std::string& path, const PolygonSoup& soup) {
  FileWriter out(path);
  out << "# Written by collarmesh.\n";
  for (const Point& p : soup.points) out << "v " << p << '\n';
  Tag group = 0;
  for (Index f = 0; f < soup.facet_count(); ++f) {
    if (soup.facet_tag(f) != group) out << "g " << name_of(soup, group = soup.facet_tag(f)) << '\n';
    out << 'f';
    for (const Index v : one_polygon(path, soup, f)) out << ' ' << std::size_t{v} + 1;
    out << '\n';
  }
  for (const auto& segment : soup.segments)
    out << "l " << std::size_t{segment.a} + 1 << ' ' << std::size_t{segment.b} + 1 << '\n';
  out.commit();
}

}  // namespace collarmesh::io
