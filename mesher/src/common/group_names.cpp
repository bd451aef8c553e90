#include "common/group_names.h"

#include <fmt/format.h>

namespace collarmesh {

std::string group_name(GroupNames names, std::size_t dimension, Tag tag, std::string_view minus) {
  std::string digits = fmt::format("{}", tag);
  if (tag < 0) digits = fmt::format("{}{}", minus, digits.substr(1));
  const auto& prefixes = names == GroupNames::cad ? cad_name_prefix : group_name_prefix;
  return fmt::format("{}{}", prefixes[dimension], digits);
}

std::string group_name(const TetMesh& mesh, std::size_t dimension, Tag tag, std::string_view minus) {
  const std::string* given = mesh.names.find(dimension, tag);
  if (given == nullptr) return group_name(mesh.group_names, dimension, tag, minus);
  std::string name = *given;
  for (char& c : name)
    if (static_cast<unsigned char>(c) < ' ' || c == '"') c = '_';
  return name;
}

}  // namespace collarmesh
