#include "collarmesh/io/soup_io.h"

#include <fmt/format.h>

#include <array>
#include <string_view>

#include "collarmesh/error.h"
#include "io/file_bytes.h"
#include "io/soup_formats.h"

namespace collarmesh::io {

namespace {

struct SoupFormat {
  std::string_view extension;
  PolygonSoup (*read)(const std::string& path);
};

constexpr std::array<SoupFormat, 6> soup_formats{{{".off", read_off},
                                                  {".obj", read_obj},
                                                  {".stl", read_stl},
                                                  {".ply", read_ply},
                                                  {".poly", read_poly},
                                                  {".smesh", read_smesh}}};

const SoupFormat* find_format(const std::string& path) {
  const std::string extension = lower_extension(path);
  for (const SoupFormat& format : soup_formats)
    if (format.extension == extension) return &format;
  return nullptr;
}

}  // namespace

PolygonSoup read_soup(const std::string& path) {
  const SoupFormat* format = find_format(path);
  if (format == nullptr)
    throw ReadError(
        fmt::format("{}: unknown kind of file; surfaces are .off .obj .stl .ply .poly .smesh", path));
  PolygonSoup soup = format->read(path);
  soup.name = path;
  return soup;
}

bool is_soup_format(const std::string& path) { return find_format(path) != nullptr; }

}  // namespace collarmesh::io
