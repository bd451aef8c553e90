#include "collarmesh/io/size_field_io.h"

#include <fmt/format.h>

#include <string_view>
#include <utility>

#include "collarmesh/error.h"
#include "collarmesh/io/point_field_io.h"
#include "io/file_bytes.h"

namespace collarmesh::io {

SizeField read_size_field(const std::string& path, const Plc& plc, const std::shared_ptr<SizeFieldUse>& use) {
  try {
    if (path.ends_with(".json")) return size_field_from_json(read_bytes(path), plc, use);
    const PointField read = read_point_field(path);
    SizeField field = size_field_on_mesh(read.mesh, read.values);
    if (!use) return field;
    return [field = std::move(field), use, number = use->add("the field")](const Point& p) {
      const double asked = field(p);
      use->note(number, asked);
      return asked;
    };
  } catch (const OptionError& error) {
    throw OptionError(fmt::format("{}: {}", path, error.what()));
  } catch (const ReadError& error) {
    if (std::string_view(error.what()).starts_with(path)) throw;
    throw ReadError(fmt::format("{}: {}", path, error.what()));
  }
}

}  // namespace collarmesh::io
