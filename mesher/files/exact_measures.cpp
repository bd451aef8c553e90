#include "files/exact_measures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "collarmesh/brep/cad_model.h"

namespace collarmesh::files {

namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// Corrects the size of a feature of the complex by the difference between the exact CAD measure and that of
/// the tessellation. Returns NaN if the size differs too much from that of the tessellation to be the same
/// feature's.
double corrected(double in_complex, const brep::CadMeasure& measure) {
  constexpr double share = 1e-4;  // largest relative change of a feature that still counts as the same
  if (!(std::fabs(in_complex - measure.cut) <= share * measure.cut)) return unknown;
  return in_complex + (measure.exact - measure.cut);
}

/// An edge or a face of a file.
struct Source {
  Index file;  // given by its first soup
  Tag number;
  friend auto operator<=>(const Source&, const Source&) = default;  // NOLINT(modernize-use-nullptr)
};

/// The edges or faces of files that the features of the complex come from.
class Origins {
 public:
  explicit Origins(std::size_t features) : exact_(features, unknown) {}

  void add(Index file, Tag number, const std::map<Tag, brep::CadMeasure>& measures, Index feature,
           double size) {
    const auto found = measures.find(number);
    if (found == measures.end()) return;
    Group& group = groups_[{file, number}];
    group.parts.push_back({feature, size});
    group.size += size;
    group.measure = &found->second;
  }

  /// Returns the size of each feature, corrected; NaN for features without a known exact measure.
  std::vector<double> corrected_sizes() {
    for (const auto& [source, group] : groups_) {
      const double stretch = corrected(group.size, *group.measure) / group.size;
      for (const Part& part : group.parts) exact_[part.feature] = stretch * part.size;
    }
    return exact_;
  }

 private:
  struct Part {
    Index feature;
    double size;
  };
  struct Group {
    std::vector<Part> parts;
    double size = 0;
    const brep::CadMeasure* measure = nullptr;
  };

  std::vector<double> exact_;
  std::map<Source, Group> groups_;
};

class Measures {
 public:
  Measures(const Plc& plc, const FeatureSources& sources, const CadFiles& cad)
      : plc_(plc), sources_(sources), cad_(cad), of_complex_(measures_of(plc)) {
    for (Index s = 0; s < sources.soups.size(); ++s) {
      std::set<Tag> faces;
      for (Index f = 0; f < sources.soups[s].facet_count(); ++f) faces.insert(sources.soups[s].facet_tag(f));
      if (const auto cad_file = cad.measures(s))
        for (const Tag face : faces) soups_with_[{cad_file->first_soup, face}].push_back(s);
    }
  }

  std::vector<double> lengths() const {
    Origins origins(plc_.curves.size());
    const std::vector<Index> files = files_of_curves(plc_, sources_.soups, sources_.curves);
    for (Index c = 0; c < plc_.curves.size(); ++c) {
      const Index file = files[c];
      if (file == none) continue;
      if (const auto cad = cad_.measures(file))
        origins.add(cad->first_soup, sources_.curves[c], cad->measures.lengths, c, of_complex_.lengths[c]);
    }
    return origins.corrected_sizes();
  }

  std::vector<double> areas() const {
    Origins origins(plc_.patches.size());
    for (Index p = 0; p < plc_.patches.size(); ++p)
      if (const auto cad = cad_.measures(plc_.patches[p].file))
        origins.add(cad->first_soup, sources_.patches[p], cad->measures.areas, p, of_complex_.areas[p]);
    return origins.corrected_sizes();
  }

  std::vector<double> volumes() const {
    std::vector<double> result(plc_.regions.size(), unknown);
    const auto boundaries = boundaries_of_regions();
    const std::vector<double> soup_areas = areas_of_soups();
    for (Index r = 1; r < plc_.regions.size(); ++r)
      if (const auto own = soup_that_bounds(boundaries[r], soup_areas))
        if (const auto solid = solid_without_others(*own, boundaries[r]))
          result[r] = corrected(plc_.regions[r].volume, *solid);
    return result;
  }

 private:
  /// Returns the patches around each region.
  std::vector<std::vector<Index>> boundaries_of_regions() const {
    std::vector<std::vector<Index>> boundaries(plc_.regions.size());
    for (Index p = 0; p < plc_.patches.size(); ++p) {
      const auto& sides = plc_.patches[p].regions;
      if (sides[0] == sides[1]) continue;
      for (const Index r : sides) boundaries[r].push_back(p);
    }
    return boundaries;
  }

  /// Returns the soups of a CAD file that contain the face of a patch; solids may share faces.
  const std::vector<Index>& soups_with(Index patch) const {
    static const std::vector<Index> no_soups;
    const auto cad = cad_.measures(plc_.patches[patch].file);
    if (!cad) return no_soups;
    const auto found = soups_with_.find({cad->first_soup, sources_.patches[patch]});
    return found == soups_with_.end() ? no_soups : found->second;
  }

  /// Returns for each soup the total area, in the complex, of the patches that lie on the soup's faces.
  std::vector<double> areas_of_soups() const {
    std::vector<double> areas(sources_.soups.size(), 0);
    for (Index p = 0; p < plc_.patches.size(); ++p)
      for (const Index soup : soups_with(p)) areas[soup] += of_complex_.areas[p];
    return areas;
  }

  /// Returns the soup whose faces differ least from the patches around a region: the total area
  /// of faces that only one of the two has is smallest.
  std::optional<Index> soup_that_bounds(const std::vector<Index>& patches,
                                        const std::vector<double>& soup_areas) const {
    std::map<Index, double> common;
    for (const Index p : patches)
      for (const Index soup : soups_with(p)) common[soup] += of_complex_.areas[p];
    if (common.empty()) return std::nullopt;
    const auto lacks = [&](const auto& shared) { return soup_areas[shared.first] - 2 * shared.second; };
    return std::min_element(common.begin(), common.end(),
                            [&](const auto& a, const auto& b) { return lacks(a) < lacks(b); })
        ->first;
  }

  std::optional<brep::CadMeasure> solid(Index soup) const {
    const auto cad = cad_.measures(soup);
    return cad ? cad->measures.volumes[soup - cad->first_soup] : std::nullopt;
  }

  /// Returns the volume of the solid `own` minus those of the solids inside it, whose faces also bound the
  /// region.
  std::optional<brep::CadMeasure> solid_without_others(Index own, const std::vector<Index>& boundary) const {
    std::optional<brep::CadMeasure> result = solid(own);
    if (!result) return result;
    std::set<Index> others;
    for (const Index p : boundary) {
      const std::vector<Index>& soups = soups_with(p);
      if (std::find(soups.begin(), soups.end(), own) == soups.end()) others.insert(plc_.patches[p].file);
    }
    for (const Index soup : others) {
      const auto other = solid(soup);
      if (!other) return std::nullopt;
      result->exact -= other->exact;
      result->cut -= other->cut;
    }
    return result;
  }

  const Plc& plc_;
  const FeatureSources& sources_;
  const CadFiles& cad_;
  const ShapeMeasures of_complex_;
  std::map<Source, std::vector<Index>> soups_with_;  // by face
};

}  // namespace

std::vector<Index> files_of_curves(const Plc& plc, const std::vector<PolygonSoup>& soups,
                                   const std::vector<Tag>& numbers) {
  std::vector<Index> files(plc.curves.size(), none);
  std::vector<Index> loose;
  for (Index c = 0; c < plc.curves.size(); ++c)
    if (plc.curves[c].patches.empty())
      loose.push_back(c);
    else
      files[c] = plc.patches[plc.curves[c].patches.front()].file;
  if (loose.empty()) return files;
  const auto key = [](Tag tag, const Point& p) { return std::pair(tag, std::array{p.x, p.y, p.z}); };
  std::map<std::pair<Tag, std::array<double, 3>>, Index> soup_with;
  for (Index s = 0; s < soups.size(); ++s)
    for (const PolygonSoup::Segment& segment : soups[s].segments)
      for (const Index p : {segment.a, segment.b}) soup_with.emplace(key(segment.tag, soups[s].points[p]), s);
  for (const Index c : loose)
    for (const Index p : plc.curves[c].points)
      if (const auto found = soup_with.find(key(numbers[c], plc.points[p])); found != soup_with.end())
        files[c] = found->second;
  return files;
}

ShapeMeasures measures_behind(const Plc& plc, const FeatureSources& sources, const CadFiles& cad) {
  const Measures measures(plc, sources, cad);
  return {
      .volumes = measures.volumes(), .areas = measures.areas(), .lengths = measures.lengths(), .shells = {}};
}

}  // namespace collarmesh::files
