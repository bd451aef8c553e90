#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace collarmesh::brep {

enum class CadFormat { brep, step, iges, other };

/// Returns the format of files with an extension (in upper or lower case). The extension is `format`, such as
/// ".step", or, if that is empty, the extension of the path.
inline CadFormat cad_format_of(const std::string& path, std::string_view format = {}) {
  std::string extension =
      format.empty() ? std::filesystem::path(path).extension().string() : std::string(format);
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c; });
  if (extension == ".brep" || extension == ".brp") return CadFormat::brep;
  if (extension == ".step" || extension == ".stp") return CadFormat::step;
  if (extension == ".iges" || extension == ".igs") return CadFormat::iges;
  return CadFormat::other;
}

inline bool is_cad_format(const std::string& path, std::string_view format = {}) {
  return cad_format_of(path, format) != CadFormat::other;
}

/// Returns the extensions of CAD files, in lower case.
inline std::vector<std::string> cad_formats() { return {".brep", ".brp", ".step", ".stp", ".iges", ".igs"}; }

}  // namespace collarmesh::brep
