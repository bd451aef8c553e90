#include "io/file_format.h"

#include <filesystem>

#include "common/lower_case.h"

namespace collarmesh::io {

std::string format_of(const std::string& path, std::string_view format) {
  if (!format.empty()) return lower_case(format);
  return lower_case(std::filesystem::path(path).extension().string());
}

}  // namespace collarmesh::io
