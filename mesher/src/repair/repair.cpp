// Turns facets from files into facets of a complex. `repair` at the end shows the order of the steps.
#include "collarmesh/repair.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <set>

#include "collarmesh/noise.h"
#include "facets/box_around.h"
#include "facets/cleanup.h"
#include "facets/complex_draft.h"
#include "facets/edges.h"
#include "facets/facet_triangulation.h"
#include "facets/faults.h"
#include "facets/orientation.h"
#include "facets/weld.h"
#include "plc/lost_bodies.h"
#include "repair/arrangement.h"
#include "repair/axis_planes.h"
#include "repair/better_places.h"
#include "repair/changes.h"
#include "repair/distances.h"
#include "repair/duplicate_triangles.h"
#include "repair/holes.h"
#include "repair/inside.h"
#include "repair/most_places.h"
#include "repair/noise.h"
#include "repair/repeated.h"
#include "repair/small_features.h"
#include "repair/snapping.h"
#include "repair/to_soups.h"
#include "repair/work.h"
#include "repair/wrap.h"

namespace collarmesh {

namespace {

using namespace facets;
using namespace plc;
using namespace repairing;

constexpr std::size_t most_rounds = 6;
// Borders with a gap wider than the tolerance are stitched, too, but only up to 100 tolerances and up to this
// share of the diagonal. Wider gaps are taken as intended.
constexpr double widest_stitch = 1e-3;
// If open sheets, which are dropped, have more than this share of the area, the soups count as enclosing
// nothing.
constexpr double most_in_open_sheets = 0.5;
constexpr double grain = 1e-3;  // merging distance of the arrangement, relative to the tolerance

void add_places(RepairPlaces& places, std::size_t count, double size, const std::vector<Point>& where) {
  places.count += count;
  places.size = std::max(places.size, size);
  for (const Point& p : where)
    if (places.where.size() < most_places) places.where.push_back(p);
}

// Returns the rounding error (absolute) of the coordinates if all of them are 32-bit floats, else 0.
double single_precision_error(std::span<const PolygonSoup> soups) {
  double farthest = 0;
  for (const PolygonSoup& soup : soups)
    for (const Point& p : soup.points)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (static_cast<double>(static_cast<float>(p[axis])) != p[axis]) return 0;
        farthest = std::max(farthest, std::fabs(p[axis]));
      }
  constexpr double half_unit = 6e-8;  // about 2^-24
  return half_unit * farthest;
}

/// Thrown by a repair that loses most of the enclosed volume.
struct LostVolume : PlcError {
  explicit LostVolume(const std::string& message) : PlcError(message, {}) {}
};

class Repairer {
 public:
  /// Kind of input. In solids, repair fills holes and drops parts that enclose nothing; in sheets, it keeps
  /// everything, including open borders, and cuts intersections.
  enum class Of { solids, sheets };

  Repairer(std::span<const PolygonSoup> soups, const RepairOptions& options, const PlcOptions& complex,
           const Execution& execution, Of of = Of::solids)
      : soups_(soups), options_(options), complex_(complex), of_(of), work_(options.max_work, execution) {}

  RepairResult run() {
    try {
      return repaired();
    } catch (const WorkStopped& stopped) {
      RepairResult result{{soups_.begin(), soups_.end()}, {}};
      result.report.tolerance = tolerance_;
      (stopped.cancelled ? result.report.cancelled : result.report.gave_up) = true;
      return result;
    }
  }

  /// Collapses features smaller than `size` (absolute) in the soups. Precondition: `complex` was built from
  /// these soups without faults. `measure` then measures distances from `input`.
  RepairResult collapse_features(const RepairedPlc& complex, double size,
                                 std::span<const PolygonSoup> input) {
    try {
      collect();
      report_.filled = complex.report.filled;
      first_new_point_ = static_cast<Index>(draft_.points.size());
      const State valid = state();
      const std::vector<CollapsedFeature> collapsed =
          collapse_in_draft(draft_, complex.plc, size, options_, work_);
      if (collapsed.empty()) return finished();
      const ComplexDraft after = draft_;
      if (!cut_and_keep() || encloses_nothing_) {
        const Changes changes(valid.draft, after);
        std::vector<bool> taken_back(changes.places(), false);
        restore(valid);
        draft_ = without_what_meets(changes, taken_back);
      }
      keep_better_places(valid);
      report_.small_features = gone_from(draft_, collapsed);
      Repairer of_input(input, options_, complex_, Execution());
      of_input.collect();
      input_triangles_ = std::move(of_input.input_triangles_);
      return finished();
    } catch (const WorkStopped& stopped) {
      RepairResult result;
      result.report.cancelled = stopped.cancelled;
      return result;
    }
  }

  std::span<const PolygonSoup> input() const { return soups_; }
  double tolerance() const { return tolerance_; }  // the tolerance that is used, absolute
  /// Returns whether all sheets are open and none intersect, or most of the area is in open sheets.
  bool encloses_nothing() const { return encloses_nothing_; }

  /// Measures how much of the volume that the input encloses is lost, for surfaces that are closed or nearly
  /// so. Returns zeros if a soup is a complex. Also returns zeros if all parts of the input outside the
  /// result are near the result, because little volume can be lost then.
  KeptVolume kept_volume(const RepairReport& report) const {
    constexpr double far = 10;  // in tolerances
    const bool any_complex = std::ranges::any_of(draft_.soup_is_complex, [](bool b) { return b; });
    if (any_complex || report.largest_distance_of_input < far * tolerance_) return {};
    std::vector<CornerPoints> repaired;
    for (Index t = 0; t < draft_.triangles.size(); ++t)
      repaired.push_back({draft_.corner(t, 0), draft_.corner(t, 1), draft_.corner(t, 2)});
    return repairing::kept_volume(input_triangles_, repaired);
  }

  /// Measures the distances between the result and the input.
  void measure(RepairReport& report) const {
    std::set<Tag> fills;
    for (const FilledHole& hole : report.filled) fills.insert(hole.tag);
    std::vector<CornerPoints> repaired, filled;
    for (Index t = 0; t < draft_.triangles.size(); ++t)
      (fills.count(draft_.origins[t].tag) > 0 ? filled : repaired)
          .push_back({draft_.corner(t, 0), draft_.corner(t, 1), draft_.corner(t, 2)});
    const RepairDistances distances = measure_distances(input_triangles_, repaired, filled);
    report.largest_distance = distances.of_repaired;
    report.largest_distance_of_input = distances.of_input;
    report.farthest_of_input = distances.farthest_of_input;
  }

 private:
  RepairResult repaired() {
    collect();
    tidy();
    if (of_ == Of::sheets) {
      first_new_point_ = static_cast<Index>(draft_.points.size());
      report_.gave_up = !cut_what_nearly_coincides();
    } else {
      close();
      make_valid();
    }
    work_.spend(0);
    return finished();
  }

  RepairResult finished() {
    RepairResult result{to_soups(soups_, draft_, first_new_point_), std::move(report_)};
    result.report.repaired = true;
    result.report.lost_tags = lost_tags(result.soups, false);
    result.report.lost_groups = lost_tags(result.soups, true);
    return result;
  }

  void collect() {
    Faults faults;
    for (const PolygonSoup& soup : soups_) {
      draft_.soup_names.push_back(soup.name);
      draft_.soup_is_complex.push_back(is_complex(soup));
      draft_.soup_gives_features.push_back(soup.given_features);
    }
    const PointMap map = weld_points(soups_, complex_.weld, draft_, faults);
    faults.raise();
    draft_.planar_tolerance = complex_.planar_tolerance * draft_.bounds.diagonal();
    tolerance_ = std::max(options_.tolerance * draft_.bounds.diagonal(), 8 * single_precision_error(soups_));
    report_.tolerance = tolerance_;
    const BentFacets bent = triangulate_any_facets(soups_, map, draft_);
    for (Index t = 0; t < draft_.triangles.size(); ++t)
      input_triangles_.push_back({draft_.corner(t, 0), draft_.corner(t, 1), draft_.corner(t, 2)});
    report_.split_polygons = bent.split;
    report_.dropped_polygons = bent.dropped;
    for (Index s = 0; s < soups_.size(); ++s) {
      for (const Index v : soups_[s].vertices) draft_.loose_points.push_back(map.merged[s][v]);
      if (!draft_.soup_is_complex[s]) continue;
      std::vector<bool> used(draft_.points.size(), false);
      for (const Corners& t : draft_.triangles)
        for (const Index p : t) used[p] = true;
      for (const Index p : map.merged[s])
        if (!used[p]) draft_.loose_points.push_back(p);
    }
  }

  void tidy() {
    remove_collinear_triangles(draft_);
    const auto repeated = drop_repeated(draft_);
    add_places(report_.repeated, repeated.count, 0, repeated.where);
    EdgeTable edges(draft_.triangles, draft_.points.size());
    Faults one_sided;
    orient_components(draft_, edges, one_sided);
  }

  // Stitches borders that nearly meet; fills open borders that are holes; then drops flakes and turns
  // inside-out components.
  void close() {
    std::size_t open = count_open_edges(draft_);
    for (const double factor : {1.0, 10.0, 100.0}) {
      const double width = factor * tolerance_;
      if (open == 0 || (factor > 1 && width > widest_stitch * draft_.bounds.diagonal())) break;
      ComplexDraft stitched = draft_;
      const SnapReport snapped = snap_near_features(stitched, width, SnapWhat::borders, &work_);
      const std::size_t left = count_open_edges(stitched);
      if (left >= open) continue;
      draft_ = std::move(stitched);
      open = left;
      add_places(report_.stitched, snapped.merged_points + snapped.cut_edges, snapped.largest_distance,
                 snapped.places);
    }
    if (open > 0) {
      EdgeTable edges(draft_.triangles, draft_.points.size());
      Faults one_sided;
      orient_components(draft_, edges, one_sided);
      report_.filled = fill_holes(draft_, next_tag(), &work_);
    }
    if (!is_two_sided(draft_)) {  // in a two-sided draft, what seems closed may be the two sides of an
                                  // open surface
      const FlakeReport flakes = drop_flakes(draft_, tolerance_);
      add_places(report_.flakes, flakes.places.size(), flakes.volume, flakes.places);
    }
    const TurnReport turned = turn_components(draft_);
    add_places(report_.turned, turned.turned_components, 0, turned.places);
  }

  // Returns a tag above all facet tags of the input. The numbers of CAD faces are such tags.
  Tag next_tag() const {
    Tag tag = 0;
    for (const PolygonSoup& soup : soups_)
      for (Index f = 0; f < soup.facet_count(); ++f) tag = std::max(tag, soup.facet_tag(f));
    return tag + 1;
  }

  /// A saved draft and report, for undoing steps that fail.
  struct State {
    ComplexDraft draft;
    RepairReport report;
  };
  State state() const { return {draft_, report_}; }
  void restore(State state) {
    draft_ = std::move(state.draft);
    report_ = std::move(state.report);
    encloses_nothing_ = false;
  }

  void make_valid() {
    first_new_point_ = static_cast<Index>(draft_.points.size());
    flatten();
    if (!cut_what_nearly_coincides() || encloses_nothing_) return;
    const State valid = state();
    try_on([&] { snap_in_rounds(); });
    // Cutting leaves corners that almost touch other facets. Collapse features once more within a small share
    // of the tolerance. Few corners are that near, so this rarely leads to new cuts.
    try_on([&] {
      const State clean = state();
      if (!collapse(grain * tolerance_).changed() || !cut_and_keep()) restore(clean);
    });
    keep_better_places(valid);
  }

  // Moves facets onto one plane if they are perpendicular to an axis and nearly coincide. Reports moves
  // larger than rounding.
  void flatten() {
    const FlattenReport flattened = flatten_axis_planes(draft_, tolerance_);
    constexpr double rounding = 1e-6;  // in tolerances
    if (flattened.largest_distance > rounding * tolerance_)
      add_places(report_.collapsed, flattened.moved_points, flattened.largest_distance, flattened.places);
  }

  /// Tries a step. If it takes too much work, or nothing is enclosed afterwards, restores the state before.
  template <class Step>
  void try_on(const Step& step) {
    State clean = state();
    try {
      step();
      if (!encloses_nothing_) return;
    } catch (const WorkStopped& stopped) {
      if (stopped.cancelled) throw;
    }
    restore(std::move(clean));
  }

  // Snaps in rounds, because cutting undoes some of the snapping. Keeps the state that leaves the fewest
  // places to snap. Stops when further rounds hardly help. If cutting cannot make the draft clean after
  // snapping, tries a smaller distance.
  void snap_in_rounds() {
    constexpr std::size_t most_worse = 2;
    constexpr double hardly_better = 0.95;
    double reach = tolerance_;
    State best = state();
    std::size_t fewest = none, worse = 0;
    bool changed = false;
    for (std::size_t round = 0; round < most_rounds; ++round) {
      State clean = state();
      const SnapReport snapped = collapse(reach);
      if (!snapped.changed()) return restore(std::move(clean));
      if (changed && snapped.changes() < fewest) {
        const auto now = static_cast<double>(snapped.changes());
        worse = now > hardly_better * static_cast<double>(fewest) ? worse + 1 : 0;
        fewest = snapped.changes();
        best = clean;
        if (worse == most_worse) break;
      } else if (changed && ++worse == most_worse) {
        break;
      }
      if (cut_and_keep() && !encloses_nothing_) {
        changed = true;
        if (fewest == none) best = state();
        continue;
      }
      restore(std::move(clean));
      reach *= 0.1;
      fewest = none;
    }
    restore(std::move(best));
  }

  // Undoes changes at places where refinement would have more trouble than before.
  void keep_better_places(const State& valid) {
    const std::optional<Plc> after = complex_of(draft_);
    const std::vector<Trouble> troubles_after =
        after ? find_troubles(*after, tolerance_) : std::vector<Trouble>();
    if (after && troubles_after.empty()) return;
    const std::optional<Plc> before = complex_of(valid.draft);
    if (!before) return;
    if (!after) return restore(valid);
    BetterPlaces better = better_places(valid.draft, find_troubles(*before, tolerance_), draft_,
                                        troubles_after, 2 * tolerance_);
    if (better.taken_back.empty()) return;
    if (better.taken_back.size() == better.places) return restore(valid);
    draft_ = std::move(better.draft);
    add_places(report_.kept, better.taken_back.size(), 0, better.taken_back);
  }

  std::optional<Plc> complex_of(const ComplexDraft& draft) const {
    PlcOptions options = complex_;
    options.require_solid = false;
    try {
      return build_plc(to_soups(soups_, draft, first_new_point_), options);
    } catch (const PlcError&) {
      return std::nullopt;
    }
  }

  // Cuts facets, some of which may nearly coincide. If rounding their cuts makes ever more intersections,
  // cuts them again with fewer merges of near corners. If that fails, too, snaps the facets together before
  // cutting, within the smallest distance that helps. Returns whether the draft is clean.
  bool cut_what_nearly_coincides() {
    const ComplexDraft before = draft_;
    const RepairReport report_before = report_;
    if (cut_and_keep()) return true;
    draft_ = before;
    report_ = report_before;
    if (cut_and_keep(KeptMerges::where_nothing_meets)) return true;
    for (const double share : {grain, 10 * grain, 100 * grain, 1.0}) {
      draft_ = before;
      report_ = report_before;
      collapse(share * tolerance_);
      if (cut_and_keep()) return true;
    }
    return false;
  }

  SnapReport collapse(double reach) {
    SnapReport snapped = snap_near_features(draft_, reach, SnapWhat::all, &work_);
    add_places(report_.collapsed, snapped.changes(), snapped.largest_distance, snapped.places);
    return snapped;
  }

  bool cut_and_keep(KeptMerges merges = KeptMerges::all) {
    const bool two_sided = is_two_sided(draft_);
    const ArrangementReport arranged = arrange(draft_, grain * tolerance_, &work_, !two_sided, merges);
    if (report_.cut.count == 0) add_places(report_.cut, arranged.intersecting_pairs, 0, arranged.places);
    if (!arranged.clean) return false;
    if (of_ == Of::sheets) {  // one of several triangles that cover each other stays
      drop_repeated(draft_);
      return true;
    }
    if (two_sided) report_.second_sides += keep_one_side(draft_);
    encloses_nothing_ = arranged.intersecting_pairs == 0 && peels_away(draft_);
    if (encloses_nothing_) return true;
    double area = 0;
    for (const Corners& t : draft_.triangles) area += area_of(draft_, t);
    cancel_duplicates(draft_);
    const InsideReport kept = keep_boundaries(draft_, tolerance_);
    encloses_nothing_ = kept.dropped_area > most_in_open_sheets * area;
    report_.merged.count += kept.removed_triangles;
    report_.merged.size += kept.removed_area;
    add_places(report_.dropped, kept.dropped_sheets, area > 0 ? kept.dropped_area / area : 0,
               kept.dropped_places);
    const double before = report_.thin_chambers.size;
    add_places(report_.thin_chambers, kept.chamber_places.size(), 0, kept.chamber_places);
    report_.thin_chambers.size = before + kept.chamber_volume;
    for (const Point& p : kept.places)
      if (report_.merged.where.size() < most_places) report_.merged.where.push_back(p);
    return true;
  }

  // Returns the facet tags of the input that no facet has after the repair. With `only_groups`, leaves out
  // tags of CAD faces, which are numbers and not groups.
  std::vector<Tag> lost_tags(const std::vector<PolygonSoup>& repaired, bool only_groups) const {
    std::set<Tag> before, after;
    for (const PolygonSoup& soup : soups_)
      for (Index f = 0; f < soup.facet_count() && !(only_groups && soup.given_features); ++f)
        before.insert(soup.facet_tag(f));
    for (const PolygonSoup& soup : repaired)
      for (Index f = 0; f < soup.facet_count(); ++f) after.insert(soup.facet_tag(f));
    std::vector<Tag> lost;
    std::set_difference(before.begin(), before.end(), after.begin(), after.end(), std::back_inserter(lost));
    return lost;
  }

  std::span<const PolygonSoup> soups_;  // the soups before the repair
  const RepairOptions& options_;
  const PlcOptions& complex_;
  Of of_;
  ComplexDraft draft_;
  std::vector<CornerPoints> input_triangles_;
  double tolerance_ = 0;  // absolute; the tolerance that is used
  Index first_new_point_ = none;
  bool encloses_nothing_ = false;
  Work work_;
  RepairReport report_;
};

// Returns the options for one try of `build_repaired_plc`. If wrapping is the last resort, each earlier try
// may take only a share of the permitted work.
RepairOptions for_try(RepairOptions options, double factor) {
  constexpr std::size_t share_of_work = 4;
  options.tolerance *= factor;
  if (options.mode == RepairMode::wrap) options.max_work /= share_of_work;
  return options;
}

// Adds to the report the tags of regions that the soups have, but the complex does not.
RepairedPlc with_lost_regions(RepairedPlc complex, std::span<const PolygonSoup> soups) {
  std::set<Tag> given, there;
  for (const PolygonSoup& soup : soups) {
    if (soup.region_tag) given.insert(*soup.region_tag);
    for (const auto* points : {&soup.region_points, &soup.named_regions})
      for (const PolygonSoup::RegionPoint& point : *points) given.insert(point.tag);
  }
  for (std::size_t r = 1; r < complex.plc.regions.size(); ++r) there.insert(complex.plc.regions[r].tag);
  std::set_difference(given.begin(), given.end(), there.begin(), there.end(),
                      std::back_inserter(complex.report.lost_regions));
  return complex;
}

// Returns a warning for each line tag in soups without facets that no curve of the complex has.
std::vector<Plc::Warning> lost_lines(std::span<const PolygonSoup> soups, const Plc& plc) {
  std::map<Tag, Point> lost;
  for (const PolygonSoup& soup : soups)
    for (const PolygonSoup::Segment& segment : soup.segments)
      if (soup.facet_count() == 0 && segment.tag != 0) lost.emplace(segment.tag, soup.points[segment.a]);
  for (const Plc::Curve& curve : plc.curves) lost.erase(curve.tag);
  std::vector<Plc::Warning> warnings;
  warnings.reserve(lost.size());
  for (const auto& [tag, where] : lost)
    warnings.push_back(
        {fmt::format("Nothing is left of the line with tag {} at {} after the repair; a smaller "
                     "--repair-tolerance may keep it.",
                     tag, text(where)),
         where});
  return warnings;
}

// Throws LostVolume if most of the volume would be lost. Adds a warning if the lost share is smaller but not
// negligible.
void judge_volume(const KeptVolume& kept, Plc& plc) {
  constexpr double most = 0.5, told = 0.05;
  if (kept.lost > most * kept.input)
    throw LostVolume(
        fmt::format("Repair would lose {:.0f}% of the volume that the surface encloses (about {:.3g} in "
                    "all), for example at {}.",
                    100 * kept.lost / kept.input, kept.input, text(kept.where)));
  if (kept.lost > told * kept.input)
    plc.warnings.push_back(
        {fmt::format("The repair lost about {:.0f}% of the volume that the surface enclosed (about {:.3g} in "
                     "all), for "
                     "example at {}; close the surface there, or try another --repair-tolerance.",
                     100 * kept.lost / kept.input, kept.input, text(kept.where)),
         kept.where});
}

// Builds the complex of the repaired soups, and measures its distances from the input. Throws PlcError.
RepairedPlc judged(const Repairer& repairer, RepairResult result, const PlcOptions& options) {
  RepairedPlc complex{build_plc(result.soups, options), std::move(result.report), std::move(result.soups)};
  number_untagged(repairer.input(), complex.plc);
  repairer.measure(complex.report);
  if (complex.report.repaired) {
    std::ranges::copy(plc::lost_bodies(repairer.input(), complex.plc, repairer.tolerance()),
                      std::back_inserter(complex.plc.warnings));
    std::ranges::copy(lost_lines(repairer.input(), complex.plc), std::back_inserter(complex.plc.warnings));
    judge_volume(repairer.kept_volume(complex.report), complex.plc);
  }
  return with_lost_regions(std::move(complex), repairer.input());
}

/// Builds the complex of sheets that are cut where they intersect. Throws `fault` if they cannot be cut.
RepairedPlc build_cut_sheets(std::span<const PolygonSoup> soups, const PlcOptions& options,
                             const RepairOptions& repair_options, const Execution& execution,
                             const PlcError& fault) {
  Repairer repairer(soups, repair_options, options, execution, Repairer::Of::sheets);
  RepairResult result = repairer.run();
  if (result.report.cancelled) return {Plc(), std::move(result.report), {}};
  if (result.report.gave_up) throw PlcError(fault);
  RepairedPlc complex{build_plc(result.soups, options), std::move(result.report), std::move(result.soups)};
  number_untagged(repairer.input(), complex.plc);
  repairer.measure(complex.report);
  return complex;
}

// Reports the regions of a valid complex that its repair removed or merged.
void compare_regions(const Plc& before, RepairedPlc& repaired) {
  RepairReport& report = repaired.report;
  const plc::LostRegions lost = plc::lost_regions(before, repaired.plc, report.tolerance);
  add_places(report.vanished, lost.thin.size(), lost.thin_volume, lost.thin);
  const std::size_t left = before.regions.size() - lost.thin.size();
  if (repaired.plc.regions.size() < left)
    add_places(report.united, left - repaired.plc.regions.size(), 0, lost.others);
}

PlcError given_up(const PlcError& error, const RepairOptions& options) {
  return {fmt::format("{} The repair was given up after {} steps; try a smaller repair tolerance, or wrap "
                      "the input (repair wrap).",
                      error.what(), options.max_work),
          error.faults};
}

// Returns the size below which features are collapsed, absolute; 0: no feature is collapsed.
double feature_size_of(const Plc& plc, const RepairOptions& options) {
  constexpr double sizes_per_diagonal = 20, most_of_diagonal = 1e-3;
  if (!options.target_size || options.mode == RepairMode::off || plc.regions.size() < 2) return 0;
  const double diagonal = plc.bounds.diagonal(),
               size = *options.target_size > 0 ? *options.target_size : diagonal / sizes_per_diagonal;
  return std::min(options.feature_size * size, most_of_diagonal * diagonal);
}

std::vector<double> sorted_volumes(const Plc& plc) {
  std::vector<double> volumes;
  for (std::size_t r = 1; r < plc.regions.size(); ++r) volumes.push_back(std::fabs(plc.regions[r].volume));
  std::sort(volumes.begin(), volumes.end());
  return volumes;
}

// Throws PlcError unless both complexes have the same regions, with nearly the same volumes, and the same
// groups.
void require_same_parts(const RepairedPlc& before, const RepairedPlc& after) {
  constexpr double most = 0.02;  // share that a region may lose or gain
  const std::vector<double> old = sorted_volumes(before.plc), now = sorted_volumes(after.plc);
  bool same = old.size() == now.size() && after.report.lost_groups.empty() &&
              after.report.lost_regions.size() <= before.report.lost_regions.size();
  for (std::size_t r = 0; same && r < old.size(); ++r) same = std::fabs(now[r] - old[r]) <= most * old[r];
  if (!same) throw PlcError("A part would be lost.", {});
}

// Returns the complex with the report of an earlier repair and the small features collapsed since.
RepairedPlc with_report_of(const RepairReport& before, RepairedPlc complex, double size) {
  RepairReport report = before;
  const RepairReport& now = complex.report;
  if (!before.repaired) report.tolerance = now.tolerance;
  report.repaired = true;
  report.feature_size = size;
  std::ranges::copy(now.small_features, std::back_inserter(report.small_features));
  add_places(report.kept, now.kept.count, 0, now.kept.where);
  for (auto list : {&RepairReport::lost_tags, &RepairReport::lost_groups, &RepairReport::lost_regions}) {
    std::ranges::copy(now.*list, std::back_inserter(report.*list));
    std::sort((report.*list).begin(), (report.*list).end());
    (report.*list).erase(std::unique((report.*list).begin(), (report.*list).end()), (report.*list).end());
  }
  report.largest_distance = now.largest_distance;
  report.largest_distance_of_input = now.largest_distance_of_input;
  report.farthest_of_input = now.farthest_of_input;
  complex.report = std::move(report);
  return complex;
}

}  // namespace

RepairResult repair(std::span<const PolygonSoup> soups, const RepairOptions& options,
                    const PlcOptions& complex, const Execution& execution) {
  if (complex.domain == DomainShape::box)
    return repair(facets::with_box(soups, complex), options, facets::enclosed(complex), execution);
  Repairer repairer(soups, options, complex, execution);
  RepairResult result = repairer.run();
  if (result.report.repaired) repairer.measure(result.report);
  return result;
}

RepairedPlc collapse_small_features(RepairedPlc complex, std::span<const PolygonSoup> soups,
                                    const PlcOptions& options, const RepairOptions& repair_options,
                                    const Execution& execution) {
  const double size = feature_size_of(complex.plc, repair_options);
  if (options.domain == DomainShape::box && size > 0)
    return collapse_small_features(std::move(complex), facets::with_box(soups, options),
                                   facets::enclosed(options), repair_options, execution);
  constexpr int most_tries = 3;  // a collapse may make neighbours small
  for (int i = 0; i < most_tries && size > 0; ++i) {
    const std::vector<PolygonSoup> current = complex.soups;
    Repairer repairer(current.empty() ? soups : std::span<const PolygonSoup>(current), repair_options,
                      options, execution);
    RepairResult result = repairer.collapse_features(complex, size, soups);
    if (result.report.cancelled) return {Plc(), std::move(result.report), {}};
    if (result.report.small_features.empty()) break;
    try {
      RepairedPlc after = judged(repairer, std::move(result), options);
      require_same_parts(complex, after);
      keep_numbers(complex.plc, after.plc);
      complex = with_report_of(complex.report, std::move(after), size);
    } catch (const PlcError&) {
      break;  // the complex is valid with these features
    }
  }
  return complex;
}

void keep_feature_numbers(const Plc& before, Plc& after) { keep_numbers(before, after); }

bool has_noise(const Plc& plc, const RepairOptions& options) {
  return options.mode != RepairMode::off && find_noise(plc, options.tolerance * plc.bounds.diagonal());
}

RepairedPlc remove_noise(Plc plc, std::span<const PolygonSoup> soups, const PlcOptions& options,
                         const RepairOptions& repair_options, const Execution& execution) {
  if (options.domain == DomainShape::box)
    return remove_noise(std::move(plc), facets::with_box(soups, options), facets::enclosed(options),
                        repair_options, execution);
  if (repair_options.mode == RepairMode::off) return with_lost_regions({std::move(plc), {}, {}}, soups);
  const double tolerance = repair_options.tolerance * plc.bounds.diagonal();
  const std::optional<Point> noise = find_noise(plc, tolerance);
  if (!noise) return with_lost_regions({std::move(plc), {}, {}}, soups);
  Repairer repairer(soups, repair_options, options, execution);
  RepairResult result = repairer.run();
  if (result.report.cancelled) return {Plc(), std::move(result.report), {}};
  const bool changes = result.report.changed();
  if (!result.report.gave_up && changes) {
    try {
      RepairedPlc complex = judged(repairer, std::move(result), options);
      compare_regions(plc, complex);
      return complex;
    } catch (const PlcError&) {
      // The complex is valid without this repair, so it is kept.
    }
  }
  plc.warnings.push_back(
      {fmt::format("Features below the repair tolerance of {:.3g} stay, the first one at {}: removing them "
                   "{}. Such features cost elements and time; another --repair-tolerance may help.",
                   tolerance, text(*noise),
                   result.report.gave_up ? "takes too long"
                   : changes             ? "would make the complex invalid"
                                         : "would create worse features"),
       *noise});
  return with_lost_regions({std::move(plc), {}, {}}, soups);
}

RepairedPlc build_repaired_plc(std::span<const PolygonSoup> soups, const PlcOptions& options,
                               const RepairOptions& repair_options, const Execution& execution) {
  if (options.domain == DomainShape::box)
    return build_repaired_plc(facets::with_box(soups, options), facets::enclosed(options), repair_options,
                              execution);
  if (repair_options.mode == RepairMode::wrap && repair_options.wrap_at_once) {
    if (auto wrapped = build_wrapped_plc(soups, options, repair_options)) return *std::move(wrapped);
    throw PlcError("The closed surface around everything is no valid complex; try another wrap offset.", {});
  }
  std::optional<PlcError> first;
  try {
    return remove_noise(build_plc(soups, options), soups, options, repair_options, execution);
  } catch (const PlcError& error) {
    const bool unusable = std::any_of(error.faults.begin(), error.faults.end(), [](const PlcFault& fault) {
      return fault.kind == PlcFault::Kind::bad_point;
    });
    if (repair_options.mode == RepairMode::off || unusable) throw;
    first = error;
  }
  std::optional<std::string> lost_volume;
  bool are_sheets = false;
  for (const double factor : {1.0, 10.0, 0.1}) {
    if (factor < 1 && !lost_volume) break;  // a smaller tolerance only helps to keep volume
    const RepairOptions other = for_try(repair_options, factor);
    Repairer repairer(soups, other, options, execution);
    RepairResult result = repairer.run();
    if (result.report.cancelled) return {Plc(), std::move(result.report), {}};
    if (result.report.gave_up) {
      first = given_up(*first, other);
      break;
    }
    if (repairer.encloses_nothing()) {
      are_sheets = !options.require_solid;
      if (are_sheets) break;
      continue;
    }
    try {
      return judged(repairer, std::move(result), options);
    } catch (const LostVolume& error) {
      lost_volume = error.what();
    } catch (const PlcError&) {
      continue;  // another tolerance may help
    }
  }
  if (are_sheets) return build_cut_sheets(soups, options, repair_options, execution, *first);
  // As a last resort, wrap, if the mode permits it.
  if (repair_options.mode == RepairMode::wrap)
    if (auto wrapped = build_wrapped_plc(soups, options, repair_options)) return *std::move(wrapped);
  if (lost_volume) throw PlcError(fmt::format("{} {}", first->what(), *lost_volume), first->faults);
  throw PlcError(*first);
}

std::vector<RepairOptions> coarser_repairs(const RepairOptions& options, double size, double diagonal) {
  constexpr double most_of_size = 0.01, least_factor = 2;
  const double most = most_of_size * size / diagonal;
  std::vector<RepairOptions> coarser;
  if (options.mode == RepairMode::off || options.wrap_at_once) return coarser;
  double last = options.tolerance;
  for (const double tolerance : {1e-4, 1e-3}) {
    if (std::min(tolerance, most) < least_factor * last) continue;
    last = std::min(tolerance, most);
    coarser.push_back(options);
    coarser.back().tolerance = last;
  }
  return coarser;
}

std::vector<RepairOptions> further_repairs(const RepairOptions& options, const RepairReport& report) {
  constexpr double factor = 3, coarsest = 1e-2;
  std::vector<RepairOptions> further;
  if (options.mode == RepairMode::off || report.wrapped) return further;
  if (report.repaired && factor * options.tolerance <= coarsest) {
    further.push_back(options);
    further.back().tolerance *= factor;
  }
  if (options.mode == RepairMode::wrap) {
    further.push_back(options);
    further.back().wrap_at_once = true;
  }
  return further;
}

}  // namespace collarmesh
