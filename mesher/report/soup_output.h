#pragma once

#include <string>
#include <vector>

#include "collarmesh/plc_builder.h"
#include "collarmesh/polygon_soup.h"

namespace collarmesh::report {

/// Several soups merged into one, ready to be written.
struct MergedSoup {
  PolygonSoup soup;
  std::string told;  ///< lines to print: what was welded, merged and dropped, and what the format loses
};

/// Merges soups for a file at `path` ("-" is standard output) in `format` (an extension with its dot; empty:
/// the path's). For .poly and .smesh also finds points inside the regions and cavities. Throws PlcError for
/// points that are not finite, indices out of range, and facets to be cut that are not planar.
MergedSoup merge_for_output(const std::vector<PolygonSoup>& soups, const std::string& path,
                            const std::string& format, const PlcOptions& plc);

}  // namespace collarmesh::report
