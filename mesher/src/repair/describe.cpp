#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>

#include "collarmesh/repair.h"

namespace collarmesh {

namespace {

std::string place(const Point& p) { return fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x, p.y, p.z); }

std::string first_place(const RepairPlaces& places) {
  return places.where.empty() ? "" : fmt::format(", the first at {}", place(places.where.front()));
}

const char* plural(std::size_t count) { return count == 1 ? "" : "s"; }

/// Describes the distances between the repaired facets and the input.
std::string moved_text(const RepairReport& r) {
  if (r.largest_distance == 0 && r.largest_distance_of_input == 0) return "repair moved nothing";
  return fmt::format(
      "the repaired surface is within {:.3g} of the input, and the input, except for parts inside solids, "
      "within {:.3g} of the repaired surface{}",
      r.largest_distance, r.largest_distance_of_input,
      r.largest_distance_of_input > r.tolerance
          ? fmt::format("; the farthest part of the input that is gone is at {}", place(r.farthest_of_input))
          : "");
}

const char* kind_name(SmallFeature::Kind kind) {
  switch (kind) {
    case SmallFeature::Kind::curve: return "curve";
    case SmallFeature::Kind::patch: return "patch";
    case SmallFeature::Kind::tip: break;
  }
  return "tip";
}

/// Lists the first few small features, with kind, tag, size and place.
std::string small_features_text(const RepairReport& r) {
  constexpr std::size_t most_listed = 10;
  std::string text =
      fmt::format("{} feature{} smaller than the feature size of {:.3g} collapsed:", r.small_features.size(),
                  plural(r.small_features.size()), r.feature_size);
  for (std::size_t i = 0; i < std::min(most_listed, r.small_features.size()); ++i) {
    const SmallFeature& f = r.small_features[i];
    fmt::format_to(std::back_inserter(text), "{} {}{} of size {:.3g} at {}", i == 0 ? "" : ",",
                   kind_name(f.kind), f.tag != 0 ? fmt::format(" (tag {})", f.tag) : "", f.size,
                   place(f.where));
  }
  if (r.small_features.size() > most_listed)
    fmt::format_to(std::back_inserter(text), ", ... and {} more (all in the JSON report)",
                   r.small_features.size() - most_listed);
  return text + "; --feature-size 0 keeps them";
}

}  // namespace

std::vector<std::string> describe(const RepairReport& r) {
  std::vector<std::string> lines;
  if (r.split_polygons > 0)
    lines.push_back(fmt::format("{} polygon{} cut into triangles, because {}", r.split_polygons,
                                plural(r.split_polygons),
                                r.split_polygons == 1 ? "it was not planar or crossed itself"
                                                      : "they were not planar or crossed themselves"));
  if (r.dropped_polygons > 0)
    lines.push_back(
        fmt::format("{} polygon{} without an area dropped", r.dropped_polygons, plural(r.dropped_polygons)));
  if (r.repeated.count > 0)
    lines.push_back(fmt::format("{} repeated facet{} dropped{}", r.repeated.count, plural(r.repeated.count),
                                first_place(r.repeated)));
  if (r.turned.count > 0)
    lines.push_back(fmt::format("{} inside-out closed surface{} turned around{}", r.turned.count,
                                plural(r.turned.count), first_place(r.turned)));
  if (r.stitched.count > 0)
    lines.push_back(
        fmt::format("{} place{} stitched where borders nearly met, over a distance of at most {:.3g}{}",
                    r.stitched.count, plural(r.stitched.count), r.stitched.size, first_place(r.stitched)));
  for (const FilledHole& hole : r.filled)
    lines.push_back(fmt::format("a hole of {} edges around {} filled with an area of {:.4g}, tag {}",
                                hole.edges, place(hole.where), hole.area, hole.tag));
  if (r.cut.count > 0)
    lines.push_back(fmt::format("{} pair{} of intersecting facets cut{}", r.cut.count, plural(r.cut.count),
                                first_place(r.cut)));
  if (r.flakes.count > 0)
    lines.push_back(fmt::format(
        "{} closed part{} thinner than the tolerance of {:.3g} dropped, with a volume of {:.3g} "
        "together{}",
        r.flakes.count, plural(r.flakes.count), r.tolerance, r.flakes.size, first_place(r.flakes)));
  if (r.second_sides > 0)
    lines.push_back(
        fmt::format("{} triangle{} dropped that coincided with others of opposite orientation: the whole "
                    "surface had two coinciding layers, and one of them is kept",
                    r.second_sides, plural(r.second_sides)));
  if (r.merged.count > 0)
    lines.push_back(
        fmt::format("{} triangle{} removed that lay inside solids or enclosed nothing, an area of {:.4g}{}",
                    r.merged.count, plural(r.merged.count), r.merged.size, first_place(r.merged)));
  if (r.dropped.count > 0)
    lines.push_back(fmt::format(
        "{} triangle{} of sheets that enclose nothing and lie outside of all solids removed, {:.2g}% of the "
        "area{}",
        r.dropped.count, plural(r.dropped.count), 100 * r.dropped.size, first_place(r.dropped)));
  if (r.collapsed.count > 0)
    lines.push_back(fmt::format(
        "{} feature{} below the tolerance of {:.3g} collapsed, over a distance of at most {:.3g}{}",
        r.collapsed.count, plural(r.collapsed.count), r.tolerance, r.collapsed.size,
        first_place(r.collapsed)));
  if (r.thin_chambers.count > 0)
    lines.push_back(fmt::format(
        "{} space{} between nearly coincident facets, thinner than the tolerance of {:.3g}, became part of "
        "the regions around {}, with a volume of {:.3g}{}",
        r.thin_chambers.count, plural(r.thin_chambers.count), r.tolerance,
        r.thin_chambers.count == 1 ? "it" : "them", r.thin_chambers.size, first_place(r.thin_chambers)));
  if (r.vanished.count > 0)
    lines.push_back(fmt::format(
        "{} region{} as thin as the tolerance of {:.3g} vanished, with a volume of {:.3g}{}; a smaller "
        "--repair-tolerance keeps {}",
        r.vanished.count, plural(r.vanished.count), r.tolerance, r.vanished.size, first_place(r.vanished),
        r.vanished.count == 1 ? "it" : "them"));
  if (r.united.count > 0)
    lines.push_back(
        fmt::format("{} region{} fewer than before, because regions nearer to each other than the tolerance "
                    "of {:.3g} were merged{}; a smaller --repair-tolerance keeps them apart",
                    r.united.count, plural(r.united.count), r.tolerance, first_place(r.united)));
  if (r.kept.count > 0)
    lines.push_back(
        fmt::format("{} place{} left as before, because repair would make creases sharper there{}",
                    r.kept.count, plural(r.kept.count), first_place(r.kept)));
  if (!r.small_features.empty()) lines.push_back(small_features_text(r));
  if (!r.lost_tags.empty())
    lines.push_back(fmt::format("nothing is left of the facets with tag{} {}", plural(r.lost_tags.size()),
                                fmt::join(r.lost_tags, ", ")));
  if (r.repaired && !r.wrapped) lines.push_back(moved_text(r));
  if (r.wrapped)
    lines.push_back(
        fmt::format("a closed surface was wrapped around everything; it keeps within {:.3g} of the input",
                    r.largest_distance));
  return lines;
}

}  // namespace collarmesh
