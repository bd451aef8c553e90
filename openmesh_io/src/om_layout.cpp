// Checks the layout that OpenMesh/Core/IO/OMFormat.hh defines: a header, then chunks, each with a 16-bit
// description and its values, all little endian.
#include "om_layout.h"

#include <fmt/format.h>

#include <bit>
#include <cstring>

#include "collarmesh/error.h"

namespace collarmesh::openmesh_io {

namespace {

constexpr std::size_t header_bytes = 16, status_bytes = 4;
constexpr unsigned version_2 = 2 << 5;

enum class Entity : unsigned { vertex = 0, mesh = 1, face = 2, edge = 4, halfedge = 6, sentinel = 7 };
enum class Values : unsigned { positions = 0, status = 3, custom = 6, topology = 7 };

/// The 16 bits that describe a chunk.
struct Chunk {
  bool named;
  Entity entity;
  Values values;
  bool is_float;
  std::size_t components, value_bytes;

  explicit Chunk(unsigned bits)
      : named((bits >> 1 & 1) != 0),
        entity(static_cast<Entity>(bits >> 2 & 7)),
        values(static_cast<Values>(bits >> 5 & 15)),
        is_float((bits >> 10 & 1) != 0 && values != Values::topology),
        components((bits >> 11 & 7) + 1),
        value_bytes(std::size_t{is_float ? 4U : 1U} << (bits >> 14 & 3)) {}
};

class LayoutCheck {
 public:
  LayoutCheck(const std::string& path, std::string_view bytes) : path_(path), bytes_(bytes) {}

  OmLayout run() {
    read_header();
    while (read_chunk()) {
    }
    if (!has_positions_ && layout_.vertices > 0) fail("expected the positions of the vertices, found none");
    if (!has_faces_ && layout_.faces > 0) fail("expected the corners of the faces, found none");
    if (!has_halfedges_ && layout_.faces > 0 && version_ >= version_2)
      fail("expected the halfedges, found none");
    layout_.safe_bytes.append(std::string_view("\x1c\0", 2));  // the sentinel
    return std::move(layout_);
  }

 private:
  void read_header() {
    if (bytes_.size() < header_bytes || bytes_.substr(0, 2) != "OM")
      fail("expected an OpenMesh file (OM), found none");
    kind_ = bytes_[2];
    if (kind_ != 'T' && kind_ != 'Q' && kind_ != 'P')
      fail("expected a mesh of triangles, quads or polygons (T, Q, P)");
    version_ = static_cast<unsigned char>(bytes_[3]);
    at_ = 4;
    layout_.vertices = static_cast<std::uint32_t>(unsigned_value(4));
    layout_.faces = static_cast<std::uint32_t>(unsigned_value(4));
    layout_.edges = static_cast<std::uint32_t>(unsigned_value(4));
    require(
        3 * sizeof(float) * std::uint64_t{layout_.vertices} + std::uint64_t{layout_.faces},
        fmt::format("{} vertices, {} faces and {} edges", layout_.vertices, layout_.faces, layout_.edges));
    layout_.safe_bytes = bytes_.substr(0, at_);
  }

  /// Reads a chunk. Returns false at the sentinel, at the end and at custom properties.
  bool read_chunk() {
    const std::size_t begin = at_;
    if (at_ == bytes_.size()) return false;
    const Chunk chunk(static_cast<unsigned>(unsigned_value(2)));
    if (chunk.entity == Entity::sentinel || chunk.named || chunk.values == Values::custom) return false;
    const std::uint64_t count = count_of(chunk.entity);
    require_order(chunk);
    const bool positions = chunk.values == Values::positions && chunk.entity == Entity::vertex;
    const bool face_status = chunk.values == Values::status && chunk.entity == Entity::face;
    if (chunk.values == Values::topology)
      read_topology(chunk, count);
    else if (chunk.values == Values::status)
      read_status(chunk, count);
    else if (positions)
      read_positions(chunk, count);
    else
      skip(count * chunk.components * chunk.value_bytes, "the values of a chunk");
    // Skip the status of faces in old files: OpenMesh may make fewer faces than the chunk lists.
    const bool needed =
        positions || chunk.values == Values::topology || (face_status && version_ >= version_2);
    if (needed) layout_.safe_bytes.append(bytes_.substr(begin, at_ - begin));
    return true;
  }

  std::uint64_t count_of(Entity entity) {
    switch (entity) {
      case Entity::vertex: return layout_.vertices;
      case Entity::face: return layout_.faces;
      case Entity::edge: return layout_.edges;
      case Entity::halfedge: return 2 * std::uint64_t{layout_.edges};
      case Entity::mesh: return 1;
      default: fail("unknown kind of chunk");
    }
  }

  /// Checks the order of chunks: OpenMesh makes the vertices when it reads their positions, and the faces
  /// when it reads their topology; other chunks refer to these.
  void require_order(const Chunk& chunk) const {
    const bool topology = chunk.values == Values::topology, status = chunk.values == Values::status;
    const bool too_early = (topology && chunk.entity == Entity::vertex && !has_positions_) ||
                           (status && chunk.entity == Entity::face && !has_faces_);
    // Files before version 2 contain only the corners of the faces, from which OpenMesh makes the halfedges.
    const bool too_new = topology && chunk.entity != Entity::face && version_ < version_2;
    if (too_early || too_new) fail("the chunks are not in the order that OpenMesh writes");
  }

  void read_positions(const Chunk& chunk, std::uint64_t count) {
    if (chunk.components != 3 || !chunk.is_float || chunk.value_bytes > 8 || has_positions_)
      fail("expected positions of 3 real coordinates, once");
    has_positions_ = true;
    skip(count * chunk.components * chunk.value_bytes, "the positions of the vertices");
  }

  void read_status(const Chunk& chunk, std::uint64_t count) {
    if (chunk.components != 1) fail("expected the status of entities as 1 number");
    skip(count * status_bytes, "the status of entities");
  }

  void read_topology(const Chunk& chunk, std::uint64_t count) {
    if (chunk.value_bytes > 4) fail("indices of 64 bits are not supported");
    const std::uint64_t halfedges = 2 * std::uint64_t{layout_.edges};
    switch (chunk.entity) {
      case Entity::vertex:
        for (std::uint64_t i = 0; i < count; ++i) read_index(chunk, halfedges, true);
        break;
      case Entity::face:
        if (has_faces_) fail("the corners of the faces are given twice");
        has_faces_ = true;
        for (std::uint64_t i = 0; i < count; ++i)
          if (version_ < version_2)
            read_corners(chunk);
          else
            read_index(chunk, halfedges, false);
        break;
      case Entity::halfedge:
        if (has_halfedges_) fail("the halfedges are given twice");
        has_halfedges_ = true;
        for (std::uint64_t i = 0; i < count; ++i) read_halfedge(chunk, halfedges);
        break;
      default: fail("unknown kind of topology");
    }
  }

  void read_halfedge(const Chunk& chunk, std::uint64_t halfedges) {
    read_index(chunk, halfedges, false);         // the next halfedge
    read_index(chunk, layout_.vertices, false);  // the vertex it points to
    read_index(chunk, layout_.faces, true);
  }

  void read_corners(const Chunk& chunk) {
    const std::uint64_t n = kind_ == 'T' ? 3 : kind_ == 'Q' ? 4 : unsigned_value(2);
    if (n < 3) fail(fmt::format("expected a face of at least 3 corners, found {}", n));
    for (std::uint64_t k = 0; k < n; ++k)
      if (const std::uint64_t corner = unsigned_value(chunk.value_bytes); corner >= layout_.vertices)
        fail(fmt::format("a corner is vertex {}, but the file has {} vertices", corner, layout_.vertices));
  }

  void read_index(const Chunk& chunk, std::uint64_t size, bool none_allowed) {
    const auto shift = static_cast<unsigned>(64 - 8 * chunk.value_bytes);
    const std::int64_t index = static_cast<std::int64_t>(unsigned_value(chunk.value_bytes) << shift) >> shift;
    if (index == -1 && none_allowed) return;
    if (index < 0 || static_cast<std::uint64_t>(index) >= size)
      fail(fmt::format("index {} is out of range; there are {} entries", index, size));
  }

  std::uint64_t unsigned_value(std::size_t size) {
    require(size, "a value");
    std::uint64_t value = 0;
    for (std::size_t k = 0; k < size; ++k)
      value |= std::uint64_t{static_cast<unsigned char>(bytes_[at_ + k])} << 8 * k;
    at_ += size;
    return value;
  }

  void skip(std::uint64_t size, std::string_view what) {
    require(size, what);
    at_ += size;
  }

  void require(std::uint64_t size, std::string_view what) {
    if (size > bytes_.size() - at_)
      fail(fmt::format("expected {} ({} bytes), found {} bytes; the file is cut off or wrong", what, size,
                       bytes_.size() - at_));
  }

  [[noreturn]] void fail(std::string_view message) const {
    throw ReadError(fmt::format("{}: byte {}: {}", path_, at_, message));
  }

  const std::string& path_;
  std::string_view bytes_;
  std::size_t at_ = 0;
  char kind_ = 'T';
  unsigned version_ = 0;
  bool has_positions_ = false, has_faces_ = false, has_halfedges_ = false;
  OmLayout layout_;
};

}  // namespace

OmLayout check_om_layout(const std::string& path, std::string_view bytes) {
  return LayoutCheck(path, bytes).run();
}

}  // namespace collarmesh::openmesh_io
