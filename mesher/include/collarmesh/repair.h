#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "collarmesh/geometry.h"
#include "collarmesh/plc_builder.h"
#include "collarmesh/polygon_soup.h"
#include "collarmesh/progress.h"

/// Repairs facets that do not form a valid complex: stitches borders that nearly meet, collapses features
/// below a tolerance, cuts facets that intersect or cover each other, removes facets inside solids, and fills
/// holes.
namespace collarmesh {

enum class RepairMode {
  automatic,  ///< repair facets that do not form a valid complex
  off,        ///< report such facets as an error
  wrap        ///< like `automatic`; if that makes no solid, or none that can be meshed, wraps a closed
              ///< surface around everything
};

struct RepairOptions {
  RepairMode mode = RepairMode::automatic;
  double tolerance = 1e-5;  ///< relative to the bounding-box diagonal; smaller features are noise
  double wrap_offset =
      5e-3;  ///< tolerance of the closed surface around everything, relative to the bounding-box diagonal
  bool wrap_at_once = false;  ///< in `RepairMode::wrap`: wrap even if the other steps make a solid
  /// Features of a complex that are smaller than this share of the target size are collapsed; 0: none.
  double feature_size = 0.01;
  /// The smallest target size that is given, absolute; 0: a twentieth of the diagonal. Without a value, no
  /// feature is collapsed.
  std::optional<double> target_size = {};
  std::vector<Tag> kept_patches = {}, kept_curves = {};  ///< tags of features that are never collapsed
  /// Maximum work before repair gives up, counted in pairs of facets near each other; a cut of an
  /// intersecting pair and an edge around a hole count 1000. Counting work instead of time makes the result
  /// the same on every machine. `RepairMode::wrap` gets a quarter of this.
  std::size_t max_work = 200'000'000;
};

/// The number of changes of one kind, and some of their places.
struct RepairPlaces {
  std::size_t count = 0;
  double size = 0;           ///< a distance, area, volume or share: see each field of RepairReport
  std::vector<Point> where;  ///< at most 100
};

/// A hole that was closed.
struct FilledHole {
  Tag tag = 0;            ///< tag of the facets that fill it
  std::size_t edges = 0;  ///< number of edges around it
  double length = 0;      ///< length of the curve around it, input units
  double area = 0;        ///< area of the facets that fill it, input units squared
  Point where;            ///< the mean of the points around it
};

/// A feature that was collapsed because it was smaller than the feature size.
struct SmallFeature {
  enum class Kind {
    curve,  ///< size: its length
    patch,  ///< size: its width
    tip     ///< the part of a patch between two curves near their common vertex; size: its length
  };
  Kind kind = Kind::curve;
  double size = 0;  ///< absolute
  Tag tag = 0;      ///< tag of the curve or patch
  Point where;
};

/// The changes that repair made to the input.
struct RepairReport {
  bool repaired = false;
  bool wrapped = false;
  double tolerance = 0;              ///< the tolerance that was used, absolute
  std::size_t split_polygons = 0;    ///< polygons that were not planar, now triangles
  std::size_t dropped_polygons = 0;  ///< polygons without an area
  RepairPlaces repeated;             ///< duplicate triangles, dropped
  RepairPlaces turned;               ///< components turned inside out
  RepairPlaces stitched;             ///< border points that were joined; size: largest distance
  RepairPlaces collapsed;        ///< points, edges and triangles below the tolerance; size: largest distance
  RepairPlaces cut;              ///< pairs of facets that intersected
  RepairPlaces kept;             ///< places left unrepaired because creases there would become sharper
  RepairPlaces flakes;           ///< closed parts thinner than the tolerance, dropped; size: volume
  std::size_t second_sides = 0;  ///< triangles dropped because the surface was double everywhere: each
                                 ///< coincided with another one of opposite orientation
  RepairPlaces merged;           ///< triangles inside solids, which were removed; size: area
  RepairPlaces dropped;          ///< triangles of open sheets outside of all solids, removed; size:
                                 ///< share of the area of all facets
  RepairPlaces thin_chambers;    ///< regions between facets that nearly coincide; they became parts of their
                                 ///< neighbours; size: volume
  RepairPlaces vanished;         ///< regions of valid input that were as thin as the tolerance and are gone;
                                 ///< size: volume
  /// Other regions of valid input that were lost; places: points in the regions that took their space.
  RepairPlaces united;
  std::vector<FilledHole> filled;
  double feature_size = 0;                   ///< size below which features were collapsed, absolute
  std::vector<SmallFeature> small_features;  ///< the features that were collapsed
  std::vector<Tag> lost_tags;                ///< tags of the input's facets that no facet has now
  std::vector<Tag> lost_groups;   ///< the lost tags except those that are only numbers of CAD faces
  std::vector<Tag> lost_regions;  ///< tags that the input gives and that no region of the complex has
  /// The largest distance of the repaired facets from those of the input, absolute. Facets that fill holes do
  /// not count.
  double largest_distance = 0;
  /// The largest distance of the input's facets from the repaired ones, absolute. Facets that lie inside the
  /// repaired solids do not count.
  double largest_distance_of_input = 0;
  Point farthest_of_input;  ///< a point of the input at that distance
  bool gave_up = false;     ///< the work was more than `RepairOptions::max_work`
  bool cancelled = false;   ///< the execution cancelled the repair

  /// Returns whether any facet changed.
  bool changed() const {
    return split_polygons + dropped_polygons + repeated.count + turned.count + stitched.count +
               collapsed.count + cut.count + second_sides + flakes.count + merged.count + dropped.count +
               filled.size() + small_features.size() >
           0;
  }
};

struct RepairResult {
  std::vector<PolygonSoup> soups;  ///< one for each input soup, in their order
  RepairReport report;
};

/// Repairs the soups so that `build_plc` accepts them. Tags and features survive cutting. Each soup keeps the
/// space that it encloses (winding number above 1/2), except the part that an earlier soup encloses. Region
/// points, hole points and loose segments stay. `build_plc` reports faults that cannot be repaired. If repair
/// gave up or was cancelled, as the report says, the soups are the original ones. Throws PlcError for points
/// that are not finite and indices out of range. Cost: O(n log n), and exact constructions for each pair of
/// facets that intersect. Based on Zhou, Grinspun, Zorin, Jacobson 2016 (arrangements) and Jacobson, Kavan,
/// Sorkine-Hornung 2013 (winding numbers).
RepairResult repair(std::span<const PolygonSoup> soups, const RepairOptions& options = {},
                    const PlcOptions& complex = {}, const Execution& execution = {});

/// A complex, and the changes to the soups that made it one.
struct RepairedPlc {
  Plc plc;
  RepairReport report;
  std::vector<PolygonSoup>
      soups;  ///< the repaired soups that the complex was built from; empty without repairs
};

/// Returns `plc`, the complex of the soups, unless it has features below the tolerance: curves shorter than
/// the tolerance, slits, or features that come closer to each other than that without meeting. In that case
/// returns the complex of the repaired soups. If the features cannot be removed, returns `plc` with a
/// warning.
RepairedPlc remove_noise(Plc plc, std::span<const PolygonSoup> soups, const PlcOptions& options = {},
                         const RepairOptions& repair_options = {}, const Execution& execution = {});

/// Collapses the curves, patches and tips of patches of a complex that are smaller than
/// `RepairOptions::feature_size`, unless the target size is not known or the mode is `off`. Keeps features
/// that carry a name or a kept tag, every tag that is no number of a CAD face, every region, and all volumes
/// within 2%; where that fails, or the complex would not be valid, returns the complex as it was. `soups` are
/// those from which the complex was built. Cost: O(n log n).
RepairedPlc collapse_small_features(RepairedPlc complex, std::span<const PolygonSoup> soups,
                                    const PlcOptions& options = {}, const RepairOptions& repair_options = {},
                                    const Execution& execution = {});

/// Renumbers the patches and curves of a complex that another repair made, so that a number given by the user
/// still means the same feature. Features of `before` keep the numbers that they have there; new features get
/// the numbers after these. `before` is the complex in which untagged facets and edges were numbered. Cost:
/// O(n log n).
void keep_feature_numbers(const Plc& before, Plc& after);

/// Builds the complex, after `repair` if there are faults or noise, with a tolerance that grows while that
/// helps. For valid soups without features below the tolerance, returns the complex of `build_plc`. If the
/// report says that it was cancelled, the complex is empty. Throws PlcError with the faults of the input and
/// a remedy.
RepairedPlc build_repaired_plc(std::span<const PolygonSoup> soups, const PlcOptions& options = {},
                               const RepairOptions& repair_options = {}, const Execution& execution = {});

/// Returns the repairs to try, one after the other, while no mesh of the complex keeps every guarantee. If
/// something was repaired, the first has three times the tolerance: a repair may leave folds about as fine as
/// its tolerance, in which refinement does not end. In `RepairMode::wrap`, a surface around everything comes
/// last.
std::vector<RepairOptions> further_repairs(const RepairOptions& options, const RepairReport& report);

/// Returns the repairs to try, one after the other, if the refinement of a complex takes far more vertices
/// than its sizes ask for, because it resolves irrelevant features just above the tolerance. The tolerances
/// are 1e-4 and 1e-3 of the diagonal, none above a hundredth of `size` (absolute).
std::vector<RepairOptions> coarser_repairs(const RepairOptions& options, double size, double diagonal);

/// Returns a line with counts, sizes and places for each kind of change, for display; empty without changes.
std::vector<std::string> describe(const RepairReport& report);

}  // namespace collarmesh
