#include <algorithm>
#include <set>
#include <vector>

#include "collarmesh/plc_builder.h"

namespace collarmesh {

namespace {

bool has_facet_tags(const PolygonSoup& soup) {
  for (Index f = 0; f < soup.facet_count(); ++f)
    if (soup.facet_tag(f) != 0) return true;
  return false;
}

bool has_segment_tags(const PolygonSoup& soup) {
  return std::ranges::any_of(soup.segments,
                             [](const PolygonSoup::Segment& segment) { return segment.tag != 0; });
}

/// Gives the smallest unused numbers to features without a tag.
template <class Feature>
void number(std::vector<Feature>& features) {
  std::set<Tag> taken;
  for (const Feature& feature : features) taken.insert(feature.tag);
  Tag next = 1;
  for (Feature& feature : features) {
    if (feature.tag != 0) continue;
    while (taken.count(next) > 0) ++next;
    feature.tag = next++;
  }
}

}  // namespace

void number_untagged(std::span<const PolygonSoup> soups, Plc& plc) {
  plc.numbered_patches = std::ranges::none_of(soups, has_facet_tags);
  plc.numbered_curves = std::ranges::none_of(soups, has_segment_tags);
  if (plc.numbered_patches) number(plc.patches);
  if (plc.numbered_curves) number(plc.curves);
}

}  // namespace collarmesh
