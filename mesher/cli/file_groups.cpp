#include "file_groups.h"

#include <fmt/format.h>

#include <initializer_list>
#include <system_error>

namespace collarmesh::cli {

namespace fs = std::filesystem;

namespace {

std::string extension_of(const fs::path& path, const std::string& format) {
  std::string extension = format.empty() ? path.extension().string() : format;
  for (char& c : extension)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + ('a' - 'A'));
  return extension;
}

std::vector<fs::path> with_siblings(const fs::path& path, std::initializer_list<const char*> extensions) {
  std::vector<fs::path> files{path};
  for (const char* extension : extensions) files.push_back(fs::path(path).replace_extension(extension));
  return files;
}

/// With the files of faces and edges beside it.
std::vector<fs::path> parts_of_xdmf(const fs::path& path) {
  std::vector<fs::path> files;
  for (const char* part : {"", "_faces", "_edges"})
    for (const std::string& extension : {path.extension().string(), std::string(".h5")})
      files.push_back(path.parent_path() / (path.stem().string() + part + extension));
  return files;
}

/// With the pieces that are there: how many there will be is not known.
std::vector<fs::path> pieces_of_pvtu(const fs::path& path) {
  std::vector<fs::path> files{path};
  const std::string first = path.stem().string() + "_";
  std::error_code error;
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const fs::path& file = entry->path();
    const std::string stem = file.stem().string();
    if (file.extension() == ".vtu" && stem.starts_with(first) && stem.size() > first.size() &&
        stem.find_first_not_of("0123456789", first.size()) == std::string::npos)
      files.push_back(path.parent_path() / file.filename());
  }
  return files;
}

}  // namespace

std::vector<fs::path> files_written(const fs::path& path, const std::string& format) {
  const std::string extension = extension_of(path, format);
  if (path == "-") return {};
  if (extension == ".ele") return with_siblings(path, {".ele", ".node", ".face", ".edge"});
  if (extension == ".xdmf") return parts_of_xdmf(path);
  if (extension == ".pvtu") return pieces_of_pvtu(path);
  return {path};
}

std::vector<fs::path> files_read(const fs::path& path, const std::string& format) {
  if (path == "-") return {"/dev/stdin"};
  const std::string extension = extension_of(path, format);
  if (extension == ".ele") return with_siblings(path, {".node", ".face", ".edge"});
  if (extension == ".xdmf") return parts_of_xdmf(path);
  if (extension == ".pvtu") return pieces_of_pvtu(path);
  if (extension == ".poly" || extension == ".smesh") return with_siblings(path, {".node"});
  return {path};
}

bool same_file(const fs::path& a, const fs::path& b) {
  std::error_code error;
  if (fs::equivalent(a, b, error) && !error) return fs::is_regular_file(a, error);
  return fs::weakly_canonical(a, error) == fs::weakly_canonical(b, error);
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

}  // namespace collarmesh::cli
