#include "collarmesh/io/soup_io.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

#include "collarmesh/error.h"
#include "io/file_format.h"
#include "io/soup_formats.h"

namespace collarmesh::io {

namespace {

struct SoupFormat {
  std::string_view extension;
  PolygonSoup (*read)(const std::string& path);
  void (*write)(const std::string& path, const PolygonSoup& soup);
};

constexpr std::array formats{
    SoupFormat{".off", read_off, write_off},    SoupFormat{".obj", read_obj, write_obj},
    SoupFormat{".stl", read_stl, write_stl},    SoupFormat{".ply", read_ply, write_ply},
    SoupFormat{".poly", read_poly, write_poly}, SoupFormat{".smesh", read_smesh, write_smesh}};

constexpr std::array<std::string_view, 6> cad_extensions{".step", ".stp", ".iges", ".igs", ".brep", ".brp"};

std::string unknown(const std::string& path) {
  if (std::ranges::count(cad_extensions, format_of(path)) > 0)
    return path +
           ": this is a CAD shape, not a surface; to mesh CAD shapes, call mesh_files (collarmesh::files)";
  return fmt::format("{}: unknown kind of file; surfaces are {}", path, fmt::join(soup_formats(), " "));
}

}  // namespace

PolygonSoup read_soup(const std::string& path, std::string_view format) {
  const SoupFormat* found = find_format(formats, path, format);
  if (found == nullptr) throw ReadError(unknown(path));
  PolygonSoup soup = found->read(path);
  soup.name = path;
  return soup;
}

void write_soup(const std::string& path, const PolygonSoup& soup, std::string_view format) {
  const SoupFormat* found = find_format(formats, path, format);
  if (found == nullptr) throw WriteError(unknown(path));
  found->write(path, soup);
}

bool is_soup_format(const std::string& path, std::string_view format) {
  return find_format(formats, path, format) != nullptr;
}

std::vector<std::string> soup_formats() {
  std::vector<std::string> result;
  result.reserve(formats.size());
  for (const SoupFormat& format : formats) result.emplace_back(format.extension);
  return result;
}

}  // namespace collarmesh::io
