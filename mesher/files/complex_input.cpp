#include "files/complex_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "collarmesh/error.h"
#include "collarmesh/name_features.h"
#include "collarmesh/noise.h"
#include "common/sort_uniquely.h"
#include "files/cad_labels.h"
#include "files/exact_measures.h"
#include "files/faces_at_faults.h"
#include "files/input_files.h"
#include "files/named_features.h"
#include "files/surface_files.h"

namespace collarmesh::files {

namespace {

constexpr double share_of_triangles = 0.1;  // permitted distance of the first triangles from the shape,
                                            // relative to that of the mesh
constexpr double finest = 4;  // triangles of CAD faces get at most this many times finer than the first ones
constexpr double finest_for_nodes = 8;  // this limit if mid-edge nodes are too far from coarser triangles

bool may_be_too_coarse(const PlcError& error) {
  return std::all_of(error.faults.begin(), error.faults.end(), [](const PlcFault& fault) {
    return fault.kind == PlcFault::Kind::intersection || fault.kind == PlcFault::Kind::not_orientable;
  });
}

PlcError with_names(const PlcError& error, const CadFiles& cad) {
  std::vector<PlcFault> faults = error.faults;
  for (PlcFault& fault : faults)
    if (const std::string near = cad.faces_near(fault.where); !near.starts_with("no face"))
      fault.message += fmt::format(" The nearest faces are {}.", near);
  const std::string open = cad.open_edges(), invalid = cad.invalid_parts();
  return {
      fmt::format("{}{}{}", faults.empty() ? error.what() : faults.front().message,
                  open.empty() ? "" : fmt::format(" {}", open),
                  invalid.empty() ? "" : fmt::format(" OpenCASCADE finds the shape invalid: {}.", invalid)),
      faults};
}

bool has_fault(const PlcError& error, std::initializer_list<PlcFault::Kind> kinds) {
  return std::any_of(error.faults.begin(), error.faults.end(), [&](const PlcFault& fault) {
    return std::find(kinds.begin(), kinds.end(), fault.kind) != kinds.end();
  });
}

/// Returns a sentence on other ways to mesh the input when repair failed.
std::string advice(const PlcError& error, const RepairOptions& options, bool of_solids) {
  using Kind = PlcFault::Kind;
  if (has_fault(error, {Kind::bad_point})) return {};
  if (!of_solids && options.mode == RepairMode::automatic)
    return has_fault(error, {Kind::empty})
               ? std::string()
               : fmt::format(" The input could not be repaired: try a larger --repair-tolerance than {:.3g}.",
                             options.tolerance);
  const std::string wider = fmt::format("a larger --repair-tolerance than {:.3g}", options.tolerance);
  switch (options.mode) {
    case RepairMode::off: return " Leave out --repair none to repair the input as far as possible.";
    case RepairMode::wrap:
      return fmt::format(
          " A closed surface around everything failed, too; {} or another --wrap-offset may help.", wider);
    case RepairMode::automatic: break;
  }
  const bool open = has_fault(error, {Kind::open_boundary, Kind::empty});
  return fmt::format(
      " The input could not be repaired: {}try {}, or --repair wrap, which puts a closed surface around "
      "everything.",
      open ? "close the surface, mesh it with triangles (--dimension 2), " : "", wider);
}

// Returns all members, for comparison.
auto all_of(const PlcOptions& options) {
  const auto& [domain, box_margin, feature_angle, planar_tolerance, weld, require_solid] = options;
  return std::tie(domain, box_margin, feature_angle, planar_tolerance, weld, require_solid);
}
auto all_of(const RepairOptions& options) {
  const auto& [mode, tolerance, wrap_offset, wrap_at_once, feature_size, target_size, kept_patches,
               kept_curves, max_work] = options;
  return std::tie(mode, tolerance, wrap_offset, wrap_at_once, feature_size, target_size, kept_patches,
                  kept_curves, max_work);
}

}  // namespace

InputReading reading_of(const RunOptions& options, const std::string& format) {
  InputReading reading;
  reading.format = format;
  reading.overlap = options.overlap;
  reading.threads = options.mesh.threads;
  reading.names = options.names;
  reading.given_names = options.given_names;
  return reading;
}

InputReading reading_for_mesh(const RunOptions& options, const std::string& format) {
  InputReading reading = reading_of(options, format);
  reading.distance = [&options](double diagonal) { return distance_of(options, diagonal); };
  if (options.dimension == 3)
    reading.tolerance = [&options](const Plc& plc) {
      return tolerance_of(plc, options.mesh.bounds, options.mesh.size, static_cast<int>(options.order));
    };
  reading.order = static_cast<int>(options.order);
  return reading;
}

ComplexInput::ComplexInput(const std::vector<std::string>& paths, InputReading reading)
    : reading_(std::move(reading)), cad_(reading_.guard) {
  const CadReading cad{[&](double diagonal) { return share_of_triangles * reading_.distance(diagonal); },
                       reading_.overlap, reading_.threads};
  Tag largest_named = 0;  // largest tag so far in files with names; tags of such files must differ
  for (const std::string& path : paths) {
    reading_.stop();
    const std::string file = existing_file(path);
    if (CadFiles::knows(file, reading_.format)) {
      cad_.read(file, reading_.format, cad, soups_);
      continue;
    }
    PolygonSoup soup = read_surface(file, reading_.format);
    if (!soup.tag_names.of(2).empty()) {
      soup.shift_facet_tags(largest_named);
      largest_named = soup.tag_names.of(2).rbegin()->first;
    }
    soups_.push_back(std::move(soup));
  }
}

Execution ComplexInput::watched() const {
  Execution execution;
  execution.cancel = reading_.cancel;
  return execution;
}

Plc ComplexInput::build(const PlcOptions& options, const RepairOptions& repair) {
  const auto known = std::ranges::find_if(known_, [&](const Known& other) {
    return all_of(other.options) == all_of(options) && all_of(other.repair) == all_of(repair);
  });
  if (known == known_.end()) return build_anew(options, repair);
  if (!cad_.empty()) tessellate(known->finer);
  built_ = known->built;
  return known->plc;
}

/// Keeps a repaired complex for later calls of `build`, unless it is large or only some faces have finer
/// triangles.
void ComplexInput::remember(const PlcOptions& options, const RepairOptions& repair, const Plc& plc) {
  constexpr std::size_t most = 4, most_triangles = 500'000;
  const bool some_finer = !cad_.empty() && finer_ == 0;
  if (!built_.repaired.repaired || built_.repaired.cancelled || some_finer ||
      plc.triangles.size() > most_triangles)
    return;
  // Keep the first one, to which later tries return, and drop the oldest of the others.
  if (known_.size() == most) known_.erase(known_.begin() + 1);
  known_.push_back({options, repair, finer_, plc, built_});
}

Plc ComplexInput::build_anew(const PlcOptions& options, const RepairOptions& repair) {
  built_ = {};
  Plc plc = without_small_features(build_unnamed(options, repair), options, repair);
  if (!built_.repaired.wrapped) keep_numbers(options, repair, plc);
  for (const Plc::Patch& patch : plc.patches) built_.patch_numbers.push_back(patch.tag);
  for (const Plc::Curve& curve : plc.curves) built_.curve_numbers.push_back(curve.tag);
  if (!built_.repaired.wrapped) add_replaced_faces(plc);
  name(plc);
  if (labels() != nullptr) name_regions(*labels(), plc);
  remember(options, repair, plc);
  return plc;
}

/// Gives features the numbers that they had in the first complex with these options and target size, because
/// names and sizes refer to those numbers.
void ComplexInput::keep_numbers(const PlcOptions& options, const RepairOptions& repair, Plc& plc) {
  if (!plc.numbered_patches && !plc.numbered_curves) return;
  if (first_ && all_of(first_->options) == all_of(options) && first_->target_size == repair.target_size)
    keep_feature_numbers(first_->plc, plc);
  else
    first_ = {options, repair.target_size, plc};
}

/// Collapses features that are smaller than the feature size and have no name.
Plc ComplexInput::without_small_features(Plc plc, const PlcOptions& options, const RepairOptions& repair) {
  if (!repair.target_size || built_.repaired.wrapped) return plc;
  RepairOptions kept = repair;
  Plc named = plc;
  try {
    name(named);
  } catch (const OptionError&) {
    return plc;  // names that do not fit are reported when the complex gets them
  }
  for (Index p = 0; p < plc.patches.size(); ++p)
    if (named.names.of(2).contains(named.patches[p].tag)) kept.kept_patches.push_back(plc.patches[p].tag);
  for (Index c = 0; c < plc.curves.size(); ++c)
    if (named.names.of(1).contains(named.curves[c].tag)) kept.kept_curves.push_back(plc.curves[c].tag);
  return take(collapse_small_features({std::move(plc), std::move(built_.repaired), std::move(built_.soups)},
                                      soups_, options, kept, watched()));
}

/// Appends to the complex's replaced tags the pairs of CAD faces that were merged because solids touch.
void ComplexInput::add_replaced_faces(Plc& plc) const {
  std::vector<std::pair<Tag, Tag>>& all = plc.cleanup.replaced_tags;
  std::ranges::copy(cad_.replaced_faces(), std::back_inserter(all));
  sort_uniquely(all);
}

const brep::CadLabels* ComplexInput::labels() const {
  return built_.repaired.wrapped ? nullptr : cad_.labels(soups_.size());  // after wrapping, tags are not
                                                                          // numbers of faces
}

TagColours ComplexInput::colours() const { return labels() == nullptr ? TagColours() : labels()->colours; }

/// Names the features by `reading_.names` (a file, or JSON text) and then by the single names given.
void ComplexInput::name(Plc& plc) const {
  const std::string& path = reading_.names;
  if (path.empty() && reading_.given_names.empty()) return;
  if (path.empty() || path.starts_with('{')) {
    name_features(with_names(path, reading_.given_names), plc);
    return;
  }
  std::ifstream file(existing_file(path));
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  try {
    name_features(with_names(text, reading_.given_names), plc);
  } catch (const OptionError& error) {
    throw OptionError(fmt::format("{}: {}", path, error.what()));
  }
}

Plc ComplexInput::build_unnamed(const PlcOptions& options, const RepairOptions& repair) {
  if (cad_.empty() || repair.wrap_at_once) {
    if (!cad_.empty()) tessellate(1);
    try {
      return build_repaired(options, repair);
    } catch (const PlcError& error) {
      throw with_advice(error, repair, options.require_solid);
    }
  }
  std::optional<PlcError> first;
  if (std::optional<Plc> plc = build_of_shapes(options, repair, first)) return std::move(*plc);
  if (repair.mode == RepairMode::off) throw with_advice(*first, repair, options.require_solid);
  tessellate(may_be_too_coarse(*first) ? 2 : 1);  // finer triangles intersect less often, which leaves less
                                                  // to cut
  try {
    return build_repaired(options, repair);
  } catch (const PlcError&) {
    throw with_advice(*first, repair, options.require_solid);
  }
}

/// Builds the complex without cutting triangles that intersect. Triangles of faces that nearly touch may
/// intersect although finer ones do not: those faces get finer triangles, and if that does not help, all do.
/// Returns nothing if that fails, too; then `first` is the error of the first attempt.
std::optional<Plc> ComplexInput::build_of_shapes(const PlcOptions& options, const RepairOptions& repair,
                                                 std::optional<PlcError>& first) {
  constexpr unsigned most_partial = 2;  // attempts with finer triangles on some faces
  std::set<SoupFace> faces;
  tessellate(1);
  for (unsigned partial = 0;;) {
    try {
      Plc plc = build_valid(options, repair);
      return finer_ == finest ? std::move(plc) : resolved(std::move(plc), faces, options, repair);
    } catch (const PlcError& error) {
      if (!first) first = with_names(error, cad_);
      if (finer_ == finest || !cad_.fused() || !may_be_too_coarse(*first)) return std::nullopt;
      const std::size_t before = faces.size();
      for (const SoupFace& face : faces_at(error.faults, soups_))
        if (cad_.has(face.first)) faces.insert(face);
      if (may_be_too_coarse(error) && faces.size() > before && partial++ < most_partial)
        tessellate(finest, faces);
      else
        tessellate(finest);
    }
  }
}

Plc ComplexInput::build_valid(const PlcOptions& options, const RepairOptions& repair) {
  return take(remove_noise(build_plc(soups_, options), soups_, options, repair, watched()));
}

/// Builds the complex like `build_valid`. Without `with_noise`, throws PlcError if there is noise, before the
/// repair, which would be the most expensive part.
Plc ComplexInput::build_finer(const PlcOptions& options, const RepairOptions& repair, bool with_noise) {
  if (with_noise) return build_valid(options, repair);
  Plc plc = build_plc(soups_, options);
  if (has_noise(plc, repair)) throw PlcError("Finer triangles have features below the tolerance.", {});
  RepairOptions none = repair;
  none.mode = RepairMode::off;
  return take(remove_noise(std::move(plc), soups_, options, none, watched()));
}

/// Returns the complex with finer triangles on the faces whose triangles are too coarse for the mesh. It must
/// be valid without repair, with as many regions as `plc` and hardly worse volumes. If it is not, tries finer
/// triangles on all faces, because a wall becomes thinner if only one of its sides gets them. If that fails,
/// too, returns `plc`. With elements of second order, whose mid-edge nodes lie on the exact shape, triangles
/// must be nearer to the shape than the tolerance. The faces in `fine` have the finest triangles already.
Plc ComplexInput::resolved(Plc plc, const std::set<SoupFace>& fine, const PlcOptions& options,
                           const RepairOptions& repair) {
  constexpr double margin = 1.5, little = 2e-3, allowed_for_nodes = 4;  // the tolerance, in units of `by`
  if (!reading_.tolerance || built_.repaired.repaired) return plc;
  std::set<SoupFace> faces = fine;
  double finer = fine.empty() ? 1 : finest;
  for (const auto& [patch, by] : coarse_patches(plc, reading_.tolerance(plc))) {
    if (!cad_.measures(plc.patches[patch].file)) continue;  // the patch is not of a CAD file
    faces.emplace(plc.patches[patch].file, plc.patches[patch].tag);
    double needed = std::min(margin * by, finest);
    if (reading_.order == 2)
      needed = std::max(needed, std::min(margin * by / allowed_for_nodes, finest_for_nodes));
    finer = std::max(finer, needed);
  }
  if (faces.size() == fine.size()) return plc;
  const double most_off = std::max(volume_off(plc), little);
  const bool noisy = has_noise(plc, repair);
  Built coarse = std::exchange(built_, {});
  std::vector<std::pair<double, bool>> ways{{finer, false}};
  if (finer > finest) ways.emplace_back(finest, false);
  ways.emplace_back(std::min(finer, finest), true);
  for (const auto& [by, everywhere] : ways) {
    try {
      everywhere ? tessellate(by) : tessellate(by, faces);
      Plc finer_plc = build_finer(options, repair, noisy);
      if (!built_.repaired.repaired && finer_plc.regions.size() == plc.regions.size() &&
          volume_off(finer_plc) <= most_off)
        return finer_plc;
    } catch (const PlcError&) {
    }
    built_ = {};
  }
  tessellate(1);  // all faces, because the next call leaves files without faces in `fine` as they are
  if (!fine.empty()) tessellate(finest, fine);
  built_ = std::move(coarse);
  return plc;
}

/// Returns the largest relative difference between the volume of a region and that in the CAD shape, over the
/// regions whose exact volume is known.
double ComplexInput::volume_off(const Plc& plc) const {
  std::vector<Tag> patches, curves;
  for (const Plc::Patch& patch : plc.patches) patches.push_back(patch.tag);
  for (const Plc::Curve& curve : plc.curves) curves.push_back(curve.tag);
  const std::vector<double> exact = measures_behind(plc, {soups(), patches, curves}, cad_).volumes;
  double most = 0;
  for (std::size_t r = 1; r < std::min(exact.size(), plc.regions.size()); ++r)
    if (exact[r] > 0) most = std::max(most, std::fabs(plc.regions[r].volume / exact[r] - 1));
  return most;
}

PlcError ComplexInput::with_advice(const PlcError& error, const RepairOptions& options,
                                   bool of_solids) const {
  const bool has_facets = std::any_of(soups_.begin(), soups_.end(),
                                      [](const PolygonSoup& soup) { return soup.facet_count() > 0; });
  return {error.what() + (has_facets ? advice(error, options, of_solids) : std::string()), error.faults};
}

void ComplexInput::tessellate(double finer) {
  reading_.stop();
  if (std::exchange(finer_, 0) != finer) cad_.tessellate(finer, soups_);
  finer_ = finer;
}

/// Replaces the triangles of these faces by finer ones.
void ComplexInput::tessellate(double finer, const std::set<SoupFace>& faces) {
  reading_.stop();
  finer_ = 0;
  cad_.tessellate(finer, faces, soups_);
}

Plc ComplexInput::build_repaired(const PlcOptions& options, const RepairOptions& repair) {
  return take(build_repaired_plc(soups_, options, repair, watched()));
}

Plc ComplexInput::take(RepairedPlc result) {
  if (result.report.cancelled) reading_.stop();
  built_.repaired = std::move(result.report);
  built_.soups = std::move(result.soups);
  return std::move(result.plc);
}

ShapeMeasures ComplexInput::exact_measures(const Plc& plc) const {
  if (cad_.empty() || built_.repaired.wrapped) return {};
  return measures_behind(plc, {soups_, built_.patch_numbers, built_.curve_numbers}, cad_);
}

ExactGeometry ComplexInput::exact_geometry(const Plc& plc) const {
  return [this, &plc, files = files_of_curves(plc, soups(), built_.curve_numbers)](
             unsigned dimension, Index feature, const Point& p) -> std::optional<Point> {
    if (built_.repaired.wrapped) return std::nullopt;  // a wrap's tags are not numbers of faces
    const Index file = dimension == 2 ? plc.patches[feature].file : files[feature];
    if (file == none) return std::nullopt;
    const Tag number = dimension == 2 ? built_.patch_numbers[feature] : built_.curve_numbers[feature];
    return cad_.nearest(file, dimension, number, p);
  };
}

}  // namespace collarmesh::files
