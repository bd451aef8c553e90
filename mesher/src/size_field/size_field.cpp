// Reads a size field from its description in JSON.
#include "collarmesh/size_field.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "collarmesh/error.h"
#include "common/place_in_text.h"
#include "common/segments.h"
#include "location/triangle_hierarchy.h"

namespace collarmesh {

namespace {

using Json = nlohmann::json;

constexpr double default_growth = 0.3;
constexpr double right_angle = 1e-6;  // largest cosine that counts as a right angle
constexpr int deepest = 16;           // levels of JSON; deeper nesting could exhaust the stack
const std::array<std::string, 5> kinds{"ball", "box", "cylinder", "curves", "patches"};

[[noreturn]] void fail(const std::string& place, const std::string& message) {
  throw OptionError(fmt::format("size field: {}: {}", place, message));
}

void allow_only(const Json& object, const std::string& place, const std::vector<std::string>& keys) {
  if (!object.is_object()) fail(place, fmt::format("expected an object with {}", fmt::join(keys, ", ")));
  for (const auto& [key, value] : object.items())
    if (std::ranges::find(keys, key) == keys.end())
      fail(place, fmt::format("'{}' is not known; use {}", key, fmt::join(keys, ", ")));
}

double number(const Json& object, const std::string& place, const std::string& key, double least) {
  if (!object.contains(key)) fail(place, fmt::format("'{}' is missing", key));
  const Json& value = object.at(key);
  if (!value.is_number()) fail(place, fmt::format("'{}' must be a number", key));
  const auto result = value.get<double>();
  if (!(result >= least) || !std::isfinite(result))
    fail(place, fmt::format("'{}' is {}, but must be at least {}", key, result, least));
  return result;
}

double positive(const Json& object, const std::string& place, const std::string& key) {
  const double result = number(object, place, key, 0);
  if (result == 0) fail(place, fmt::format("'{}' must be positive", key));
  return result;
}

Point point(const Json& object, const std::string& place, const std::string& key) {
  const bool fits =
      object.contains(key) && object.at(key).is_array() && object.at(key).size() == 3 &&
      std::all_of(object.at(key).begin(), object.at(key).end(), [](const Json& x) { return x.is_number(); });
  if (!fits) fail(place, fmt::format("expected '{}': [x, y, z]", key));
  const Json& value = object.at(key);
  return {value[0].get<double>(), value[1].get<double>(), value[2].get<double>()};
}

using Distance = std::function<double(const Point&)>;

Distance distance_from_ball(const Json& ball, const std::string& place) {
  allow_only(ball, place, {"centre", "radius"});
  const Point centre = point(ball, place, "centre");
  const double radius = number(ball, place, "radius", 0);
  return [=](const Point& p) { return std::max(distance(p, centre) - radius, 0.0); };
}

// Returns the distance from a box given by a corner and three edges at right angles.
Distance distance_from_turned_box(const Json& box, const std::string& place) {
  allow_only(box, place, {"corner", "edges"});
  const Point corner = point(box, place, "corner");
  const bool fits = box.contains("edges") && box.at("edges").is_array() && box.at("edges").size() == 3;
  if (!fits) fail(place, "expected 'edges': three vectors [x, y, z]");
  std::array<Point, 3> axes;
  std::array<double, 3> lengths{};
  for (std::size_t i = 0; i < 3; ++i) {
    const Json edge{{"edge", box.at("edges")[i]}};
    axes[i] = point(edge, fmt::format("{}.edges[{}]", place, i), "edge");
    lengths[i] = norm(axes[i]);
    if (!(lengths[i] > 0)) fail(place, "an edge has no length");
    axes[i] = axes[i] / lengths[i];
  }
  for (std::size_t i = 0; i < 3; ++i)
    if (std::abs(dot(axes[i], axes[(i + 1) % 3])) > right_angle)
      fail(place, fmt::format("edges {} and {} are not at right angles", i, (i + 1) % 3));
  return [=](const Point& p) {
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double along = dot(p - corner, axes[i]);
      const double outside = std::max({-along, along - lengths[i], 0.0});
      sum += outside * outside;
    }
    return std::sqrt(sum);
  };
}

Distance distance_from_box(const Json& box, const std::string& place) {
  if (box.contains("corner") || box.contains("edges")) return distance_from_turned_box(box, place);
  allow_only(box, place, {"min", "max"});
  const Box b{point(box, place, "min"), point(box, place, "max")};
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (b.min[axis] > b.max[axis]) fail(place, "'min' exceeds 'max'");
  return [=](const Point& p) { return std::sqrt(squared_distance_to_box(p, b)); };
}

Distance distance_from_cylinder(const Json& cylinder, const std::string& place) {
  allow_only(cylinder, place, {"from", "to", "radius"});
  const Point from = point(cylinder, place, "from");
  const double radius = number(cylinder, place, "radius", 0);
  const Point axis = point(cylinder, place, "to") - from;
  const double height = norm(axis);
  if (!(height > 0)) fail(place, "'from' and 'to' are the same point");
  const Point direction = axis / height;
  return [=](const Point& p) {
    const double along = dot(p - from, direction);
    const double sideways = std::max(norm(p - from - along * direction) - radius, 0.0);
    return std::hypot(sideways, std::max({-along, along - height, 0.0}));
  };
}

// Returns the distance from the features with these tags; segments of curves are triangles without area.
template <class Features, class Add>
Distance distance_from_features(const Json& tags, const std::string& place, const std::string& kind,
                                const Plc& plc, const Features& features, const Add& add) {
  if (!tags.is_array() || tags.empty()) fail(place, fmt::format("expected a list of tags of {}", kind));
  std::vector<std::array<Index, 3>> triangles;
  for (const Json& tag : tags) {
    if (!tag.is_number_integer())
      fail(place, fmt::format("{} is no tag; tags are whole numbers", tag.dump()));
    const std::size_t before = triangles.size();
    for (const auto& feature : features)
      if (feature.tag == tag.get<Tag>()) add(feature, triangles);
    if (triangles.size() == before) fail(place, fmt::format("no {} have the tag {}", kind, tag.dump()));
  }
  struct Surface {
    std::vector<Point> points;
    TriangleHierarchy triangles;
    Surface(const std::vector<Point>& p, std::vector<std::array<Index, 3>> t)
        : points(p), triangles(points, std::move(t)) {}
  };
  const auto surface = std::make_shared<const Surface>(plc.points, std::move(triangles));
  return [surface](const Point& p) { return std::sqrt(surface->triangles.squared_distance_to(p)); };
}

Distance distance_of(const Json& source, const std::string& place, const Plc& plc) {
  if (source.contains("ball")) return distance_from_ball(source.at("ball"), place + ".ball");
  if (source.contains("box")) return distance_from_box(source.at("box"), place + ".box");
  if (source.contains("cylinder")) return distance_from_cylinder(source.at("cylinder"), place + ".cylinder");
  if (source.contains("curves"))
    return distance_from_features(source.at("curves"), place + ".curves", "curves", plc, plc.curves,
                                  [](const Plc::Curve& curve, auto& triangles) {
                                    const auto segments = flat_triangles_of(curve);
                                    triangles.insert(triangles.end(), segments.begin(), segments.end());
                                  });
  if (source.contains("patches"))
    return distance_from_features(source.at("patches"), place + ".patches", "patches", plc, plc.patches,
                                  [&plc](const Plc::Patch& patch, auto& triangles) {
                                    for (Index i = 0; i < patch.triangle_count; ++i)
                                      triangles.push_back(plc.triangles[patch.first_triangle + i].points);
                                  });
  fail(place, fmt::format("expected one of {}", fmt::join(kinds, ", ")));
}

struct Source {
  Distance distance;
  double size, growth, within;
  std::size_t number;  // number of the source in SizeFieldUse

  double at(const Point& p) const { return size + growth * std::max(distance(p) - within, 0.0); }
};

/// Returns the name of a source for messages, as in "sources[2] (ball)".
std::string called(std::size_t number, const Json& source) {
  for (const std::string& kind : kinds)
    if (source.contains(kind)) return fmt::format("sources[{}] ({})", number, kind);
  return fmt::format("sources[{}]", number);
}

}  // namespace

std::size_t SizeFieldUse::add(std::string source) {
  sources_.push_back(std::move(source));
  used_.emplace_back(false);
  return sources_.size() - 1;
}

std::vector<std::string> SizeFieldUse::without_effect() const {
  std::vector<std::string> unused;
  for (std::size_t i = 0; i < sources_.size(); ++i)
    if (!used_[i].load(std::memory_order_relaxed)) unused.push_back(sources_[i]);
  return unused;
}

SizeField size_field_from_json(const std::string& text, const Plc& plc,
                               const std::shared_ptr<SizeFieldUse>& use) {
  Json json;
  try {
    json = Json::parse(text, [](int depth, Json::parse_event_t, const Json&) {
      if (depth > deepest)
        throw ReadError(fmt::format(
            "size field: the JSON is nested deeper than {} levels, so it is no size field", deepest));
      return true;
    });
  } catch (const Json::parse_error& error) {
    throw OptionError(fmt::format("size field: {}: this is not JSON", place_in(text, error.byte)));
  } catch (const Json::out_of_range&) {
    throw OptionError(
        "size field: a number is larger than any double; leave it out where no size is asked for");
  }
  allow_only(json, "the top level", {"size", "sources"});
  const double everywhere = json.contains("size") ? positive(json, "the top level", "size") : INFINITY;
  std::vector<Source> sources;
  const Json list = json.value("sources", Json::array());
  if (!list.is_array()) fail("sources", "expected a list");
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string place = fmt::format("sources[{}]", i);
    if (std::ranges::count_if(kinds, [&](const auto& kind) { return list[i].contains(kind); }) > 1)
      fail(place, fmt::format("expected only one of {}; give each of them a source of its own",
                              fmt::join(kinds, ", ")));
    std::vector<std::string> keys(kinds.begin(), kinds.end());
    keys.insert(keys.end(), {"size", "growth", "within"});
    allow_only(list[i], place, keys);
    const double growth = list[i].contains("growth") ? number(list[i], place, "growth", 0) : default_growth;
    const double within = list[i].contains("within") ? number(list[i], place, "within", 0) : 0;
    sources.push_back({distance_of(list[i], place, plc), positive(list[i], place, "size"), growth, within,
                       use ? use->add(called(i, list[i])) : 0});
  }
  if (sources.empty() && everywhere == INFINITY)
    fail("the top level", "it asks for no size; give 'size' or 'sources'");
  return [=](const Point& p) {
    double size = everywhere;
    for (const Source& source : sources) {
      const double asked = source.at(p);
      if (use) use->note(source.number, asked);
      size = std::min(size, asked);
    }
    return size;
  };
}

}  // namespace collarmesh
