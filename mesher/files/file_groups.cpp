#include "files/file_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <system_error>

#include "collarmesh/error.h"
#include "io/abaqus_periodic.h"
#include "io/file_format.h"
#include "io/tet_mesh_formats.h"

namespace collarmesh::files {

namespace fs = std::filesystem;

namespace {

std::vector<fs::path> with_siblings(const fs::path& path, std::initializer_list<const char*> extensions) {
  std::vector<fs::path> files{path};
  for (const char* extension : extensions) files.push_back(fs::path(path).replace_extension(extension));
  return files;
}

/// Returns the file and those beside it with its faces and edges, each followed by its .h5 file.
std::vector<fs::path> parts_of_xdmf(const fs::path& path) {
  std::vector<fs::path> files;
  for (const char* part : {"", "_faces", "_edges"})
    for (const std::string& extension : {path.extension().string(), std::string(".h5")})
      files.push_back(path.parent_path() / (path.stem().string() + part + extension));
  return files;
}

std::vector<fs::path> parts_of_polymesh(const fs::path& path) {
  std::vector<fs::path> files{path};
  for (const char* name : {"points", "faces", "owner", "neighbour", "cellZones", "faceZones"})
    files.push_back(path.parent_path() / name);
  return files;
}

/// Returns whether a file has a name such as we give to the pieces of this .pvtu.
bool is_named_as_piece(const fs::path& file, const fs::path& pvtu) {
  const std::string first = pvtu.stem().string() + "_", stem = file.stem().string();
  return file.extension() == ".vtu" && stem.starts_with(first) && stem.size() > first.size() &&
         stem.find_first_not_of("0123456789", first.size()) == std::string::npos;
}

/// Returns the file and its existing pieces. The number of pieces that will be written is unknown.
std::vector<fs::path> written_with_pvtu(const fs::path& path) {
  std::vector<fs::path> files{path};
  std::error_code error;
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (is_named_as_piece(entry->path(), path))
      files.push_back(path.parent_path() / entry->path().filename());
  return files;
}

/// Returns the file and its pieces, which may have other names if another program wrote them.
std::vector<fs::path> read_with_pvtu(const fs::path& path) {
  std::vector<fs::path> files{path};
  try {
    for (std::string& piece : io::pieces_of_pvtu(path.string())) files.emplace_back(std::move(piece));
  } catch (const ReadError&) {
    // The reader will report the error.
  }
  return files;
}

}  // namespace

std::vector<fs::path> files_written(const fs::path& path, const std::string& format) {
  const std::string extension = io::format_of(path, format);
  if (path == "-") return {};
  if (extension == ".ele") return with_siblings(path, {".ele", ".node", ".face", ".edge"});
  if (extension == ".xdmf") return parts_of_xdmf(path);
  if (extension == ".pvtu") return written_with_pvtu(path);
  if (extension == ".polymesh") return parts_of_polymesh(path);
  if (extension == ".inp") return {path, io::abaqus_periodic_path(path.string())};
  return {path};
}

bool is_of_several_files(const std::string& format) {
  return format == ".ele" || format == ".xdmf" || format == ".pvtu" || format == ".polymesh";
}

bool may_write(const fs::path& path, const std::string& format, const fs::path& file) {
  const std::vector<fs::path> written = files_written(path, format);
  return std::any_of(written.begin(), written.end(),
                     [&](const fs::path& each) { return same_file(each, file); }) ||
         (io::format_of(path, format) == ".pvtu" && is_named_as_piece(file, path) &&
          same_file(path.parent_path() / file.filename(), file));
}

std::vector<fs::path> files_read(const fs::path& path, const std::string& format) {
  if (path == "-") return {"/dev/stdin"};
  const std::string extension = io::format_of(path, format);
  if (extension == ".ele") return with_siblings(path, {".node", ".face", ".edge"});
  if (extension == ".xdmf") return parts_of_xdmf(path);
  if (extension == ".pvtu") return read_with_pvtu(path);
  if (extension == ".poly" || extension == ".smesh") return with_siblings(path, {".node"});
  return {path};
}

bool same_file(const fs::path& a, const fs::path& b) {
  std::error_code error;
  if (fs::equivalent(a, b, error) && !error) return fs::is_regular_file(a, error);
  // weakly_canonical leaves a relative path relative if no part of it exists.
  const auto canonical = [&](const fs::path& path) {
    return fs::weakly_canonical(fs::absolute(path, error), error);
  };
  return canonical(a) == canonical(b);
}

std::string overwritten(const std::vector<fs::path>& written, const std::vector<std::string>& inputs,
                        const std::string& input_format) {
  for (const std::string& input : inputs)
    for (const fs::path& read : files_read(input, input_format))
      for (const fs::path& file : written)
        if (same_file(file, read))
          return read == input ? fmt::format("the input {}", input)
                               : fmt::format("{}, a file of the input {}", read.string(), input);
  return {};
}

}  // namespace collarmesh::files
