#include "report/soup_output.h"

#include <fmt/format.h>

#include "collarmesh/error.h"
#include "collarmesh/merge_soups.h"
#include "io/file_format.h"
#include "report/conversion_report.h"
#include "report/report.h"

namespace collarmesh::report {

namespace {

CutFacets cut_for(const std::string& format) {
  if (format == ".poly") return CutFacets::nothing;
  return format == ".stl" ? CutFacets::all : CutFacets::complex;
}

/// Adds region and hole points: in a complex they say which parts of space are solid; in a surface its
/// orientation says so. Returns the text to print.
std::string place_regions(const std::vector<PolygonSoup>& soups, PlcOptions options, PolygonSoup& merged) {
  options.require_solid = false;
  try {
    const Plc plc = build_plc(soups, options);
    const Index missing = place_region_points(plc, merged);
    return warnings_text(plc) +
           (missing > 0
                ? fmt::format("{} regions or cavities get no point, because they are too thin to hold one\n",
                              missing)
                : "");
  } catch (const PlcError& error) {
    return fmt::format("no region points are written, because the facets do not form a valid complex: {}\n",
                       error.what());
  }
}

}  // namespace

MergedSoup merge_for_output(const std::vector<PolygonSoup>& soups, const std::string& path,
                            const std::string& format, const PlcOptions& plc) {
  const std::string extension = io::format_of(path, format);
  MergeReport report;
  MergedSoup merged{merge_soups(soups, {plc.weld, cut_for(extension)}, report), {}};
  if (extension == ".poly" || extension == ".smesh") merged.told = place_regions(soups, plc, merged.soup);
  merged.told +=
      soup_text(path, merged.soup) + merge_text(report) + losses_text(lost_by(extension, merged.soup));
  return merged;
}

}  // namespace collarmesh::report
