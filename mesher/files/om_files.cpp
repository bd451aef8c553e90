#include "files/om_files.h"

#include <fmt/format.h>

#include "collarmesh/error.h"
#include "common/module_function.h"
#include "io/file_bytes.h"

namespace collarmesh::files {

namespace {

constexpr const char* module = "collarmesh_openmesh.so";

}  // namespace

bool is_om([[maybe_unused]] const std::string& path, [[maybe_unused]] std::string_view format) {
#ifdef COLLARMESH_OPENMESH
  return io::format_of(path, format) == ".om";
#else
  return false;
#endif
}

PolygonSoup read_om(const std::string& path) {
  std::string reason;
  void* const found = module_function(module, "collarmesh_read_om", reason);
  if (found == nullptr)
    throw ReadError(fmt::format("{}: cannot be read, because {}, or use another format", path, reason));
  PolygonSoup soup;
  reinterpret_cast<void (*)(const std::string&, PolygonSoup&)>(found)(path, soup);
  return soup;
}

void write_om(const std::string& path, const PolygonSoup& soup) {
  std::string reason;
  void* const found = module_function(module, "collarmesh_write_om", reason);
  if (found == nullptr)
    throw WriteError(fmt::format("{}: cannot be written, because {}, or write .off", path, reason));
  reinterpret_cast<void (*)(const std::string&, const PolygonSoup&)>(found)(path, soup);
}

}  // namespace collarmesh::files
