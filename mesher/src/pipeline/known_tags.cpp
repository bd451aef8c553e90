#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>

#include "collarmesh/error.h"
#include "collarmesh/pipeline.h"

namespace collarmesh {

namespace {

template <class Features>
void require_tags(const std::map<Tag, double>& sizes, const Features& features, const std::string& option,
                  const std::string& what) {
  std::set<Tag> tags;
  for (const auto& feature : features) tags.insert(feature.tag);
  for (const auto& [tag, size] : sizes) {
    if (tags.count(tag) > 0) continue;
    std::string known;
    for (const Tag each : tags) {
      if (known.size() > 60) {
        known += ", ...";
        break;
      }
      known += (known.empty() ? "" : ", ") + std::to_string(each);
    }
    throw OptionError(fmt::format("{} {}={}: no {} has the tag {}; {}", option, tag, size, what, tag,
                                  known.empty() ? "there are no tags" : "the tags are " + known));
  }
}

// Throws OptionError if a size is given for a patch that was dropped because it lies on a patch of another
// part.
void refuse_replaced_patches(const std::map<Tag, double>& sizes, const Plc& plc) {
  for (const auto& [gone, stays] : plc.cleanup.replaced_tags) {
    const auto found = sizes.find(gone);
    const bool there = std::ranges::any_of(
        plc.patches, [gone = gone](const Plc::Patch& patch) { return patch.tag == gone; });
    if (found != sizes.end() && !there)
      throw OptionError(
          fmt::format("patch-size {}={}: patch {} lies on patch {} of another part, and both now have the "
                      "number {}; use that number",
                      gone, found->second, gone, stays, stays));
  }
}

}  // namespace

void require_known_tags(const MeshOptions& options, const Plc& plc) {
  const std::vector<Plc::Region> solids(
      plc.regions.begin() + std::min<std::ptrdiff_t>(1, std::ssize(plc.regions)), plc.regions.end());
  refuse_replaced_patches(options.patch_size, plc);
  require_tags(options.region_size, solids, "region-size", "region");
  require_tags(options.patch_size, plc.patches, "patch-size", "patch");
  require_tags(options.curve_size, plc.curves, "curve-size", "curve");
}

}  // namespace collarmesh
