#include "io/tetgen_nodes.h"

#include <fmt/format.h>

namespace collarmesh::io {

TetgenNodeHeader read_tetgen_node_header(TextScanner& scan) {
  TetgenNodeHeader header;
  header.count = scan.count("the number of points", 7);
  if (!scan.at_line_end()) {
    const std::int64_t dimension = scan.integer("the dimension");
    if (dimension != 3) scan.fail(fmt::format("the dimension is {}, but has to be 3", dimension));
  }
  if (!scan.at_line_end()) header.attributes = scan.integer("the number of attributes of a point");
  if (header.attributes < 0)
    scan.fail(fmt::format("the number of attributes is {}, but must be at least 0", header.attributes));
  header.markers = read_tetgen_marker_flag(scan);
  scan.skip_line();
  return header;
}

bool read_tetgen_marker_flag(TextScanner& scan) {
  return !scan.at_line_end() && scan.integer("the flag for boundary markers") != 0;
}

std::int64_t read_tetgen_nodes(TextScanner& scan, const TetgenNodeHeader& header, std::vector<Point>& points,
                               std::vector<Tag>& tags) {
  std::int64_t first = 0;
  points.reserve(header.count);
  for (Index i = 0; i < header.count; ++i) {
    const std::int64_t number = scan.integer("the number of a point");
    if (i == 0) first = number;
    if (first != 0 && first != 1)
      scan.fail(fmt::format("the first point has number {}, but has to have 0 or 1", first));
    if (number != first + i) scan.fail(fmt::format("expected point number {}, found {}", first + i, number));
    points.push_back(scan.point("a coordinate of a point"));
    for (std::int64_t k = 0; k < header.attributes && !scan.at_line_end(); ++k)
      scan.number("an attribute of a point");
    if (header.markers) tags.push_back(scan.at_line_end() ? 0 : scan.integer("a boundary marker"));
    scan.skip_line();
  }
  return first;
}

}  // namespace collarmesh::io
