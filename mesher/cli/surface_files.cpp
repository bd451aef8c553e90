#include "surface_files.h"

#include <fmt/format.h>

#include <filesystem>

#include "cad_files.h"
#include "collarmesh/error.h"
#include "collarmesh/io/mesh_surface_io.h"
#include "collarmesh/io/soup_io.h"
#ifdef COLLARMESH_OPENMESH
#include "collarmesh/openmesh_io/read_om.h"
#include "collarmesh/openmesh_io/write_om.h"
#endif

namespace collarmesh::cli {

namespace {

bool is_om([[maybe_unused]] const std::string& path, [[maybe_unused]] std::string_view format) {
#ifdef COLLARMESH_OPENMESH
  std::string extension =
      format.empty() ? std::filesystem::path(path).extension().string() : std::string(format);
  for (char& c : extension)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + ('a' - 'A'));
  return extension == ".om";
#else
  return false;
#endif
}

}  // namespace

bool is_surface_format(const std::string& path, std::string_view format) {
  return is_om(path, format) || io::is_soup_format(path, format);
}

std::vector<std::string> surface_formats() {
  std::vector<std::string> formats = io::soup_formats();
  if (is_om("", ".om")) formats.emplace_back(".om");
  return formats;
}

PolygonSoup read_surface(const std::string& path, std::string_view format) {
#ifdef COLLARMESH_OPENMESH
  if (is_om(path, format)) return openmesh_io::read_om(path);
#endif
  if (io::is_mesh_surface_format(path, format)) return io::read_mesh_surface(path, format);
  if (!io::is_soup_format(path, format))
    throw ReadError(fmt::format("{}: its format is not known by its extension '{}'; use {}{}{}", path,
                                std::filesystem::path(path).extension().string(),
                                fmt::join(surface_formats(), " "), CadFiles::formats().empty() ? "" : " ",
                                fmt::join(CadFiles::formats(), " ")));
  return io::read_soup(path, format);
}

void write_surface(const std::string& path, const PolygonSoup& soup, std::string_view format) {
#ifdef COLLARMESH_OPENMESH
  if (is_om(path, format)) {
    openmesh_io::write_om(path, soup);
    return;
  }
#endif
  io::write_soup(path, soup, format);
}

}  // namespace collarmesh::cli
