#include "io/names_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "io/label_names.h"
#include "io/number_text.h"

namespace collarmesh::io {

namespace {

constexpr std::string_view of_cad_shape = "cad";
constexpr std::array<std::string_view, 4> feature_kinds{"vertex", "curve", "patch", "region"};

void take_name(std::string_view line, TetMesh& mesh) {
  const std::size_t first = line.find(' '), second = line.find(' ', first + 1);
  if (first == std::string_view::npos || second == std::string_view::npos) return;
  const auto* const kind = std::find(feature_kinds.begin(), feature_kinds.end(), line.substr(0, first));
  Tag tag = 0;
  if (kind == feature_kinds.end() || !parse(line.substr(first + 1, second - first - 1), tag)) return;
  mesh.names.set(static_cast<std::size_t>(kind - feature_kinds.begin()), tag,
                 std::string(line.substr(second + 1)));
}

}  // namespace

std::string names_text(const TetMesh& mesh) {
  std::string text;
  if (mesh.group_names == GroupNames::cad) text = fmt::format("{}\n", of_cad_shape);
  for (std::size_t dimension = 0; dimension < feature_kinds.size(); ++dimension)
    for (const auto& [tag, name] : mesh.names.of(dimension))
      text += fmt::format("{} {} {}\n", feature_kinds[dimension], tag, group_name(mesh, dimension, tag));
  return text;
}

void take_names(std::string_view text, TetMesh& mesh) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    if (line == of_cad_shape)
      mesh.group_names = GroupNames::cad;
    else
      take_name(line, mesh);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

}  // namespace collarmesh::io
