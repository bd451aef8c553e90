#pragma once

#include <cstdint>
#include <vector>

#include "collarmesh/geometry.h"
#include "io/text_scanner.h"

namespace collarmesh::io {

/// The first line of .node, .poly and .smesh files.
struct TetgenNodeHeader {
  Index count = 0;
  std::int64_t attributes = 0;
  bool markers = false;
};
TetgenNodeHeader read_tetgen_node_header(TextScanner& scan);

/// Reads the flag that says whether lines end with a marker; false if it is missing.
bool read_tetgen_marker_flag(TextScanner& scan);

/// Reads points. Returns the number of the first point, 0 or 1. `tags` stays empty if points have no markers.
std::int64_t read_tetgen_nodes(TextScanner& scan, const TetgenNodeHeader& header, std::vector<Point>& points,
                               std::vector<Tag>& tags);

}  // namespace collarmesh::io
