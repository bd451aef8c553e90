#include "collarmesh/name_features.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <vector>

#include "check/region_locator.h"
#include "collarmesh/error.h"
#include "common/distance_tree.h"
#include "common/place_in_text.h"
#include "common/segments.h"

namespace collarmesh {

namespace {

using Json = nlohmann::json;

constexpr double farthest = 0.01;  // distance of a point from the feature that it names, relative to the
                                   // diagonal

[[noreturn]] void fail(const std::string& place, const std::string& message) {
  throw OptionError(fmt::format("names: {}: {}", place, message));
}

Point point_of(const Json& value, const std::string& place) {
  const bool fits =
      value.size() == 1 && value.contains("at") && value.at("at").is_array() && value.at("at").size() == 3 &&
      std::all_of(value.at("at").begin(), value.at("at").end(), [](const Json& x) { return x.is_number(); });
  if (!fits) fail(place, "expected a number, {\"at\": [x, y, z]}, or a list of these");
  const Json& at = value.at("at");
  return {at[0].get<double>(), at[1].get<double>(), at[2].get<double>()};
}

/// A search for the feature nearest to a point, by the features' triangles; segments of curves are triangles
/// without area.
class Nearest {
 public:
  void add(const Plc& plc, Index a, Index b, Index c, Index feature) {
    triangles_.push_back({plc.points[a], plc.points[b], plc.points[c]});
    features_.push_back(feature);
  }
  Index find(const Plc& plc, const Point& p, const std::string& place, const std::string& what) const {
    const DistanceTree::Nearest nearest = DistanceTree(triangles_).nearest(p);
    const double allowed = farthest * plc.bounds.diagonal();
    if (nearest.triangle == none || !(nearest.distance <= allowed))
      fail(place, fmt::format(
                      "no {} is within {:.3g} of ({}, {}, {}); the nearest one is {:.3g} away", what, allowed,
                      p.x, p.y, p.z,
                      nearest.triangle == none ? std::numeric_limits<double>::infinity() : nearest.distance));
    return features_[nearest.triangle];
  }

 private:
  std::vector<DistanceTree::Triangle> triangles_;
  std::vector<Index> features_;
};

Index patch_at(const Plc& plc, const Point& p, const std::string& place) {
  Nearest nearest;
  for (const Plc::Triangle& t : plc.triangles)
    nearest.add(plc, t.points[0], t.points[1], t.points[2], t.patch);
  return nearest.find(plc, p, place, "patch");
}

Index curve_at(const Plc& plc, const Point& p, const std::string& place) {
  Nearest nearest;
  for (Index c = 0; c < plc.curves.size(); ++c)
    visit_segments(plc.curves[c], [&](Index a, Index b) { nearest.add(plc, a, b, b, c); });
  return nearest.find(plc, p, place, "curve");
}

Index region_at(const Plc& plc, const Point& p, const std::string& place) {
  const Index region = checks::RegionLocator(plc).region_at(p);
  if (region == 0) fail(place, fmt::format("({}, {}, {}) lies in no region", p.x, p.y, p.z));
  return region;
}

using Find = Index (*)(const Plc&, const Point&, const std::string&);

template <class Feature>
class Namer {
 public:
  Namer(Plc& plc, std::vector<Feature>& features, Index first, std::size_t dimension, std::string what,
        Find find)
      : plc_(plc),
        features_(features),
        first_(first),
        dimension_(dimension),
        what_(std::move(what)),
        find_(find) {}

  void name(const Json& names, const std::string& group) {
    if (!names.is_object()) fail(group, "expected an object of names, such as {\"inlet\": 3}");
    std::set<Index> named;
    for (const auto& [name, value] : names.items()) {
      const std::string place = fmt::format("{}.{}", group, name);
      if (name.empty()) fail(group, "a name is empty");
      std::vector<Index> members;
      for (const Json& each : value.is_array() ? value : Json::array({value})) add(each, place, members);
      if (members.empty()) fail(place, "the list is empty");
      for (const Index member : members)
        if (!named.insert(member).second)
          fail(place, fmt::format("the {} with number {} already has a name", what_, features_[member].tag));
      Tag tag = features_[members.front()].tag;
      for (const Index member : members) tag = std::min(tag, features_[member].tag);
      chosen_.push_back({name, tag, std::move(members)});
    }
    for (const Chosen& each : chosen_) {  // last, because the text uses the old numbers
      for (const Index member : each.members) features_[member].tag = each.tag;
      plc_.names.set(dimension_, each.tag, each.name);
    }
  }

 private:
  struct Chosen {
    std::string name;
    Tag tag;
    std::vector<Index> members;
  };

  void add(const Json& value, const std::string& place, std::vector<Index>& members) const {
    const bool by_number = value.is_number_integer();
    const Tag tag = by_number ? value.get<Tag>() : features_[find_(plc_, point_of(value, place), place)].tag;
    const std::size_t before = members.size();
    for (Index f = first_; f < features_.size(); ++f)
      if (features_[f].tag == tag) members.push_back(f);
    if (members.size() == before)
      fail(place, fmt::format("no {} has the number {}{}", what_, tag, in_place_of(tag)));
  }

  /// Returns a hint for messages: the number that replaces this tag where parts touch; empty if no number
  /// replaces it.
  std::string in_place_of(Tag tag) const {
    if (dimension_ != 2) return {};
    for (const auto& [gone, stays] : plc_.cleanup.replaced_tags)
      if (gone == tag)
        return fmt::format(
            ": patch {} lies on patch {} of another part, and both now have the number {}; use that number",
            gone, stays, stays);
    return {};
  }

  Plc& plc_;
  std::vector<Feature>& features_;
  Index first_;
  std::size_t dimension_;
  std::string what_;
  Find find_;
  std::vector<Chosen> chosen_;
};

}  // namespace

void name_features(const std::string& text, Plc& plc) {
  Json json;
  try {
    json = Json::parse(text);
  } catch (const Json::exception& error) {
    const auto* syntax = dynamic_cast<const Json::parse_error*>(&error);
    fail(place_in(text, syntax == nullptr ? 1 : syntax->byte), "this is not JSON");
  }
  if (!json.is_object())
    throw OptionError("names: expected a JSON object with \"patches\", \"curves\" or \"regions\"");
  for (const auto& [group, names] : json.items()) {
    if (group == "patches")
      Namer(plc, plc.patches, 0, 2, "patch", &patch_at).name(names, group);
    else if (group == "curves")
      Namer(plc, plc.curves, 0, 1, "curve", &curve_at).name(names, group);
    else if (group == "regions")
      Namer(plc, plc.regions, 1, 3, "region", &region_at).name(names, group);
    else
      fail(group, "is not known; use patches, curves or regions");
  }
}

}  // namespace collarmesh
