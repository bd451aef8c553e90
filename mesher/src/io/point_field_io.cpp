#include "collarmesh/io/point_field_io.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "collarmesh/error.h"
#include "io/tet_mesh_formats.h"

namespace collarmesh::io {

PointField read_point_field(const std::string& path, const std::string& name) {
  if (path.ends_with(".vtu")) return read_vtu_field(path, name);
  if (path.ends_with(".msh")) return read_msh_field(path, name);
  throw ReadError(fmt::format(
      "{}: fields on points are read from .vtu and .msh only; convert the file to one of these", path));
}

std::size_t choose_field(const std::string& path, const std::vector<std::string>& names,
                         const std::string& wanted) {
  if (wanted.empty() && names.size() == 1) return 0;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i] == wanted) return i;
  throw ReadError(fmt::format(
      "{}: {}; its points have {}", path,
      wanted.empty() ? "expected one scalar field on points" : "no field '" + wanted + "'",
      names.empty() ? "no scalar field" : fmt::format("the scalar fields {}", fmt::join(names, ", "))));
}

}  // namespace collarmesh::io
