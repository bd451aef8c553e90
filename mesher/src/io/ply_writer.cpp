// Stanford's polygon format (.ply), binary, little endian, in 64-bit numbers. Segments are edges; tags of
// faces are a property, if there are any and all fit into 32 bits.
#include <bit>
#include <string_view>

#include "io/file_writer.h"
#include "io/one_polygon.h"
#include "io/soup_formats.h"

namespace collarmesh::io {

namespace {

/// Returns whether tags are written: if one is not 0, and all fit into 32 bits, because the format has no
/// integers of 64 bits.
bool has_tags(const PolygonSoup& soup) {
  bool any = false;
  for (Index f = 0; f < soup.facet_count(); ++f) {
    const Tag tag = soup.facet_tag(f);
    if (tag != static_cast<std::int32_t>(tag)) return false;
    any = any || tag != 0;
  }
  return any;
}

}  // namespace

void write_ply(const std::string& path, const PolygonSoup& soup) {
  FileWriter out(path);
  out << "ply\nformat binary_little_endian 1.0\ncomment Written by collarmesh.\nelement vertex "
      << soup.points.size() << "\nproperty double x\nproperty double y\nproperty double z\nelement face "
      << soup.facet_count() << "\nproperty list uint uint vertex_indices\n";
  const bool tags = has_tags(soup);
  if (tags) out << "property int tag\n";
  if (!soup.segments.empty())
    out << "element edge " << soup.segments.size() << "\nproperty uint vertex1\nproperty uint vertex2\n";
  out << "end_header\n";
  for (const Point& p : soup.points)
    for (const double c : {p.x, p.y, p.z}) out.append_bytes(c, std::endian::little);
  for (Index f = 0; f < soup.facet_count(); ++f) {
    const auto corners = one_polygon(path, soup, f);
    out.append_bytes(static_cast<std::uint32_t>(corners.size()), std::endian::little);
    for (const Index v : corners) out.append_bytes(v, std::endian::little);
    if (tags) out.append_bytes(static_cast<std::int32_t>(soup.facet_tag(f)), std::endian::little);
  }
  for (const auto& segment : soup.segments) {
    out.append_bytes(segment.a, std::endian::little);
    out.append_bytes(segment.b, std::endian::little);
  }
  out.commit();
}

}  // namespace collarmesh::io
