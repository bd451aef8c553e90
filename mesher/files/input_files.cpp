#include "files/input_files.h"

#include <fmt/format.h>

#include <filesystem>
#include <string_view>

#include "collarmesh/error.h"
#include "collarmesh/io/mesh_surface_io.h"
#include "collarmesh/io/tet_mesh_io.h"
#include "common/lower_case.h"
#include "files/edit_distance.h"
#include "files/surface_files.h"

namespace collarmesh::files {

namespace fs = std::filesystem;

namespace {

void require_file(const std::string& path) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored))
    throw ReadError(fmt::format("{}: is a folder; name a file in it", path));
  if (fs::exists(path, ignored)) return;
  const std::string similar = similar_file(path);
  throw ReadError(similar.empty() ? fmt::format("{}: no such file; check the name and the folder", path)
                                  : fmt::format("{}: no such file; did you mean {}?", path, similar));
}

/// Returns the path to open: for "-", the system's name of standard input.
std::string opened(const std::string& path) { return path == "-" ? "/dev/stdin" : path; }

}  // namespace

std::string similar_file(const std::string& path) {
  const fs::path wanted(path);
  const fs::path folder = wanted.has_parent_path() ? wanted.parent_path() : fs::path(".");
  const std::string name = lower_case(wanted.filename().string());
  std::size_t nearest = 1 + name.size() / 3;
  std::string found;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const std::string candidate = entry->path().filename().string();
    const std::size_t distance = edit_distance(name, lower_case(candidate));
    if (distance > nearest || (distance == nearest && !found.empty())) continue;
    nearest = distance;
    found = (wanted.parent_path() / candidate).string();
  }
  return found;
}

std::string existing_file(const std::string& path) {
  require_file(opened(path));
  return opened(path);
}

TetMesh read_mesh(const std::string& path, const std::string& format) {
  const std::string file = existing_file(path);
  if (const std::string missing = io::missing_library(path, format); !missing.empty())
    throw ReadError(fmt::format("{}: {}", path, missing));
  if (!io::is_tet_mesh_format(path, format))
    throw ReadError(fmt::format("{}: no mesh can be read from a file with the extension '{}'; use {}", path,
                                fs::path(path).extension().string(),
                                fmt::join(io::read_tet_mesh_formats(), " ")));
  return io::read_tet_mesh(file, format);
}

std::optional<TetMesh> read_mesh_if_there(const std::string& path, const std::string& format) {
  if (!io::missing_library(path, format).empty()) return read_mesh(path, format);
  if (!io::is_tet_mesh_format(path, format)) return std::nullopt;
  if (!io::is_mesh_surface_format(path, format)) return read_mesh(path, format);
  try {
    return read_mesh(path, format);
  } catch (const ReadError& error) {
    if (std::string_view(error.what()).find("expected tetrahedra, found none") == std::string_view::npos)
      throw;
    return std::nullopt;
  }
}

TetMesh read_mesh_or_triangles(const std::string& path) {
  std::optional<TetMesh> mesh = read_mesh_if_there(path);
  if (mesh) return std::move(*mesh);
  if (!io::is_mesh_surface_format(path) && is_surface_format(path)) {
    existing_file(path);
    throw ReadError(
        fmt::format("{}: {} files have no edges on curves, so they cannot be checked; write the mesh in one "
                    "of these formats, too: {}",
                    path, fs::path(path).extension().string(), fmt::join(io::read_tet_mesh_formats(), " ")));
  }
  if (!io::is_mesh_surface_format(path)) return read_mesh(path);
  TetMesh mesh_of_triangles = io::read_mesh_cells(existing_file(path));
  if (!mesh_of_triangles.layers.quads.empty())
    throw ReadError(fmt::format(
        "{}: has {} quadrangles, which cannot be checked without volume cells; save triangles alone", path,
        mesh_of_triangles.layers.quads.size()));
  return mesh_of_triangles;
}

}  // namespace collarmesh::files
