#include "layers/wall_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>

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

/// The layers that a text asks for, and the only region that gets them, if it names one.
struct ReadWall {
  WallLayers layers;
  std::string region;
};

void set(ReadWall& read, const std::string& setting, const std::string& text) {
  const std::size_t equals = setting.find('=');
  const std::string key = setting.substr(0, equals);
  if (key == "region" && equals != std::string::npos && equals + 1 < setting.size()) {
    read.region = setting.substr(equals + 1);
    return;
  }
  WallLayers& wall = read.layers;
  const std::optional<double> value =
      equals == std::string::npos ? std::nullopt : number_in(std::string_view(setting).substr(equals + 1));
  if (key != "first" && key != "growth" && key != "count" && key != "thickness")
    refuse(text, fmt::format(
                     "sets '{}'; the settings after the faces are first, growth, count, thickness or region, "
                     "as in inlet,wall:first=0.1,growth=1.2,count=3",
                     key));
  if (!value) refuse(text, fmt::format("sets {} to no number", key));
  if (key == "growth") {
    if (*value < 1 || *value > largest_growth)
      refuse(text,
             fmt::format("has a growth of {}; it must be a number from 1 to {}", *value, largest_growth));
    wall.growth = *value;
  } else if (key == "count") {
    if (*value < 1 || *value > most_layers || *value != std::floor(*value))
      refuse(text,
             fmt::format("has a count of {}; it must be a whole number from 1 to {}", *value, most_layers));
    wall.count = static_cast<unsigned>(*value);
  } else {
    if (!(*value > 0)) refuse(text, fmt::format("has a {} of {}; it must be a positive length", key, *value));
    (key == "first" ? wall.first : wall.thickness) = *value;
  }
}

ReadWall read_wall(const std::string& text) {
  ReadWall read;
  WallLayers& wall = read.layers;
  const std::size_t colon = text.find(':');
  const std::string faces = text.substr(0, colon);
  if (faces != "all") wall.faces = parts_of(faces);
  for (const std::string& face : wall.faces)
    if (face.empty()) refuse(text, "names no face before the colon; give names or numbers of faces, or all");
  if (colon != std::string::npos)
    for (const std::string& setting : parts_of(std::string_view(text).substr(colon + 1)))
      set(read, setting, text);
  if (wall.first > 0 && wall.thickness > 0)
    refuse(text, "gives both the first height and the thickness of all layers; leave one out");
  return read;
}

}  // namespace

double relative_thickness(const WallLayers& wall) {
  double sum = 0, height = 1;
  for (unsigned k = 0; k < wall.count; ++k, height *= wall.growth) sum += height;
  return sum;
}

WallChoice::WallChoice(const LayerOptions& options, const Plc& plc) : wall_of_(plc.patches.size(), none) {
  for (const std::string& text : options.walls) {
    auto [layers, region] = read_wall(text);
    walls_.push_back(std::move(layers));
    only_in_.push_back(std::move(region));
  }
  require_heights(options, plc);
  find_regions(plc);
  put_on_named(plc);
  put_on_all(options, plc);
}

/// Throws OptionError if a first layer would be so thin that coordinates cannot tell its sides apart. Assumes
/// that all layers of a wall together are at most as high as the shape's diagonal.
void WallChoice::require_heights(const LayerOptions& options, const Plc& plc) const {
  constexpr double least_share_of_shape = 1e-10;
  Box box;
  for (const Point& p : plc.points) box.add(p);
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    const WallLayers& wall = walls_[w];
    const double relative = relative_thickness(wall), asked = wall.thickness > 0 ? wall.thickness
                                                              : wall.first > 0   ? wall.first * relative
                                                                                 : INFINITY;
    const double first = std::min(asked, box.diagonal()) / relative,
                 least = least_share_of_shape * box.diagonal();
    if (first < least)
      refuse(options.walls[w],
             fmt::format("makes the first of {} layers with a growth of {} at most {:.3g} high, which is too "
                         "little for a shape with a diagonal of {:.6g}; use a larger first height (at least "
                         "{:.3g}) or thickness, a smaller growth or a smaller count",
                         wall.count, wall.growth, first, box.diagonal(), least));
  }
}

std::map<std::pair<Index, Index>, unsigned> WallChoice::counts(const Plc& plc) const {
  std::map<std::pair<Index, Index>, unsigned> counts;
  for (Index p = 0; p < plc.patches.size(); ++p)
    for (const Index region : plc.patches[p].regions)
      if (region != 0 && has_layers(p, region)) counts[{p, region}] = (*this)[p].count;
  return counts;
}

void WallChoice::find_regions(const Plc& plc) {
  for (const std::string& region : only_in_) {
    std::set<Index>& regions = regions_.emplace_back();
    if (region.empty()) continue;
    const std::set<Tag> named = tags_named(region, 3, plc.names);
    for (Index r = 1; r < plc.regions.size(); ++r)
      if (named.contains(plc.regions[r].tag)) regions.insert(r);
    if (regions.empty())
      throw OptionError(
          fmt::format("layers: no region is called '{}'; `collarmesh info` lists the regions", region));
  }
}

void WallChoice::put_on_named(const Plc& plc) {
  const auto put = [&](Index patch, Index wall) {
    const auto& [behind, front] = plc.patches[patch].regions;
    if (wall_of_[patch] != none)
      throw OptionError(
          fmt::format("layers: face {} gets layers twice; name it once", plc.patches[patch].tag));
    if (!lies_in(wall, behind) && !lies_in(wall, front))
      throw OptionError(
          fmt::format("layers: face {} is not beside region '{}'", plc.patches[patch].tag, only_in_[wall]));
    wall_of_[patch] = wall;
  };
  for (Index w = 0; w < walls_.size(); ++w) {
    std::set<Tag> tags;
    for (const std::string& face : walls_[w].faces) {
      const std::set<Tag> named = tags_named(face, 2, plc.names);
      if (std::none_of(plc.patches.begin(), plc.patches.end(),
                       [&](const Plc::Patch& patch) { return named.contains(patch.tag); }))
        throw OptionError(
            fmt::format("layers: no face is called '{}'; the faces are {}", face, list_of_patches(plc)));
      tags.insert(named.begin(), named.end());
    }
    for (Index p = 0; p < plc.patches.size(); ++p)
      if (tags.contains(plc.patches[p].tag)) put(p, w);
  }
}

/// Puts the layers of texts for all faces on the boundary patches that no other text names.
void WallChoice::put_on_all(const LayerOptions& options, const Plc& plc) {
  for (Index w = 0; w < walls_.size(); ++w) {
    if (!walls_[w].faces.empty()) continue;
    bool any = false;
    for (Index p = 0; p < plc.patches.size(); ++p) {
      const auto& [behind, front] = plc.patches[p].regions;
      if ((behind == 0) == (front == 0) || !lies_in(w, behind == 0 ? front : behind)) continue;
      const Index other = wall_of_[p];
      if (other != none && !walls_[other].faces.empty()) continue;
      if (other != none)
        throw OptionError(fmt::format("layers: face {} gets layers twice, by '{}' and '{}'; leave one out",
                                      plc.patches[p].tag, options.walls[other], options.walls[w]));
      wall_of_[p] = w;
      any = true;
    }
    if (!any)
      refuse(options.walls[w],
             "covers no face: the other layers take all boundaries, or there is no boundary");
  }
}

}  // namespace layering

std::vector<WallLayers> read_walls(const LayerOptions& options) {
  std::vector<WallLayers> walls;
  for (const std::string& text : options.walls) walls.push_back(layering::read_wall(text).layers);
  return walls;
}

void require_known_walls(const LayerOptions& options, const Plc& plc) { layering::WallChoice(options, plc); }

}  // namespace collarmesh
