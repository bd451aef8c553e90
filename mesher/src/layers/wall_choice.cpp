#include "layers/wall_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "collarmesh/error.h"
#include "common/named_tags.h"

namespace collarmesh {

namespace layering {

namespace {

constexpr double largest_growth = 10;
constexpr unsigned most_layers = 1000;

std::vector<std::string> parts_of(std::string_view text) {
  std::vector<std::string> parts;
  for (std::size_t from = 0;;) {
    const std::size_t to = text.find(',', from);
    parts.emplace_back(text.substr(from, to == std::string_view::npos ? to : to - from));
    if (to == std::string_view::npos) return parts;
    from = to + 1;
  }
}

std::optional<double> number_in(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() && std::isfinite(value)
             ? std::optional(value)
             : std::nullopt;
}

[[noreturn]] void refuse(const std::string& text, const std::string& why) {
  throw OptionError(fmt::format("layers: '{}' {}", text, why));
}

void set(WallLayers& wall, const std::string& setting, const std::string& text) {
  const std::size_t equals = setting.find('=');
  const std::string key = setting.substr(0, equals);
  const std::optional<double> value =
      equals == std::string::npos ? std::nullopt : number_in(std::string_view(setting).substr(equals + 1));
  if (key != "first" && key != "growth" && key != "count" && key != "thickness")
    refuse(text, fmt::format("sets '{}'; after the faces give first, growth, count or thickness, as in "
                             "inlet,wall:first=0.1,growth=1.2,count=3",
                             key));
  if (!value) refuse(text, fmt::format("gives {} no number", key));
  if (key == "growth") {
    if (*value < 1 || *value > largest_growth)
      refuse(text, fmt::format("has a growth of {}; it is a number from 1 to {}", *value, largest_growth));
    wall.growth = *value;
  } else if (key == "count") {
    if (*value < 1 || *value > most_layers || *value != std::floor(*value))
      refuse(text, fmt::format("has a count of {}; it is a whole number from 1 to {}", *value, most_layers));
    wall.count = static_cast<unsigned>(*value);
  } else {
    if (!(*value > 0)) refuse(text, fmt::format("has a {} of {}; it is a positive length", key, *value));
    (key == "first" ? wall.first : wall.thickness) = *value;
  }
}

WallLayers read_wall(const std::string& text) {
  WallLayers wall;
  const std::size_t colon = text.find(':');
  const std::string faces = text.substr(0, colon);
  if (faces != "all") wall.faces = parts_of(faces);
  for (const std::string& face : wall.faces)
    if (face.empty()) refuse(text, "names no face before the colon; give names or numbers of faces, or all");
  if (colon != std::string::npos)
    for (const std::string& setting : parts_of(std::string_view(text).substr(colon + 1)))
      set(wall, setting, text);
  if (wall.first > 0 && wall.thickness > 0)
    refuse(text, "gives both the first height and the thickness of all layers; leave one out");
  return wall;
}

}  // namespace

double relative_thickness(const WallLayers& wall) {
  double sum = 0, height = 1;
  for (unsigned k = 0; k < wall.count; ++k, height *= wall.growth) sum += height;
  return sum;
}

WallChoice::WallChoice(const LayerOptions& options, const Plc& plc)
    : walls_(read_walls(options)), wall_of_(plc.patches.size(), none) {
  const auto put = [&](Index patch, Index wall) {
    if (wall_of_[patch] != none)
      throw OptionError(
          fmt::format("layers: face {} gets layers twice; name it once", plc.patches[patch].tag));
    wall_of_[patch] = wall;
  };
  for (Index w = 0; w < walls_.size(); ++w) {
    std::set<Tag> tags;
    for (const std::string& face : walls_[w].faces) {
      const std::set<Tag> named = tags_named(face, 2, plc.names);
      if (std::none_of(plc.patches.begin(), plc.patches.end(),
                       [&](const Plc::Patch& patch) { return named.contains(patch.tag); }))
        throw OptionError(
            fmt::format("layers: no face is called '{}'; they are {}", face, list_of_patches(plc)));
      tags.insert(named.begin(), named.end());
    }
    for (Index p = 0; p < plc.patches.size(); ++p)
      if (tags.contains(plc.patches[p].tag)) put(p, w);
  }
  // Those that no text names.
  for (Index w = 0; w < walls_.size(); ++w)
    for (Index p = 0; p < plc.patches.size(); ++p)
      if (const auto& [behind, front] = plc.patches[p].regions;
          walls_[w].faces.empty() && (behind == 0) != (front == 0) && wall_of_[p] == none)
        wall_of_[p] = w;
}

}  // namespace layering

std::vector<WallLayers> read_walls(const LayerOptions& options) {
  std::vector<WallLayers> walls;
  for (const std::string& text : options.walls) walls.push_back(layering::read_wall(text));
  return walls;
}

void require_known_walls(const LayerOptions& options, const Plc& plc) { layering::WallChoice(options, plc); }

}  // namespace collarmesh
