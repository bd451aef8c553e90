#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "collarmesh/geometry.h"
#include "collarmesh/plc_builder.h"
#include "collarmesh/polygon_soup.h"
#include "collarmesh/progress.h"

/// From facets as they come to facets that are a complex: borders that nearly meet are stitched, features
/// below a tolerance collapsed, facets that intersect or cover each other cut, what lies inside removed,
/// holes filled.
namespace collarmesh {

enum class RepairMode {
  automatic,  ///< what is no valid complex is repaired
  off,        ///< what is no valid complex is an error
  wrap  ///< automatic, and where that makes no solid, or none that can be meshed, a closed surface around
        ///< everything
};

struct RepairOptions {
  RepairMode mode = RepairMode::automatic;
  double tolerance = 1e-5;  ///< relative to the bounding-box diagonal; features below it are noise
  double wrap_offset =
      5e-3;  ///< relative to the bounding-box diagonal; of the closed surface around everything
  bool wrap_at_once = false;  ///< in `RepairMode::wrap`: even where the rest makes a solid
  /// Repair gives up beyond so much work, counted in pairs of facets near each other (some 0.2 microseconds
  /// each; to cut a pair that intersects counts 1000), so that it ends in the same place on every machine. In
  /// `RepairMode::wrap` a quarter of this counts.
  std::size_t max_work = 200'000'000;
};

/// Places of one kind of change, some of them.
struct RepairPlaces {
  std::size_t count = 0;
  double size = 0;           ///< the largest distance or the total area, as the field says
  std::vector<Point> where;  ///< at most 100
};

/// A hole that was closed.
struct FilledHole {
  Tag tag = 0;            ///< of the facets that fill it
  std::size_t edges = 0;  ///< around it
  double length = 0;      ///< of the curve around it, input units
  double area = 0;        ///< of the facets that fill it, input units squared
  Point where;            ///< the mean of the points around it
};

/// What was done to the input.
struct RepairReport {
  bool repaired = false;
  bool wrapped = false;
  double tolerance = 0;              ///< absolute: what was used
  std::size_t split_polygons = 0;    ///< that were not planar, now triangles
  std::size_t dropped_polygons = 0;  ///< without an area
  RepairPlaces repeated;             ///< triangles that lay on others, dropped
  RepairPlaces turned;               ///< components turned inside out
  RepairPlaces stitched;             ///< points of borders; size: largest distance
  RepairPlaces collapsed;        ///< points, edges and triangles below the tolerance; size: largest distance
  RepairPlaces cut;              ///< pairs of facets that intersected
  RepairPlaces kept;             ///< as they were before, as creases there would become sharper
  RepairPlaces flakes;           ///< closed parts thinner than the tolerance, dropped; size: volume
  std::size_t second_sides = 0;  ///< triangles of surfaces that had two sides everywhere, dropped
  RepairPlaces merged;           ///< triangles inside solids, removed; size: area
  RepairPlaces dropped;          ///< triangles of open sheets outside of all solids, removed
  std::vector<FilledHole> filled;
  std::vector<Tag> lost_tags;     ///< of facets of which nothing is left
  std::vector<Tag> lost_groups;   ///< those of them that are more than the number of a CAD face
  std::vector<Tag> lost_regions;  ///< that the input gives, of which the complex has none
  /// Absolute: of a point of what is left of the facets from those of the input. What fills holes does not
  /// count.
  double largest_distance = 0;
  /// Absolute: of a point of the input's facets from the repaired ones. What lies inside of these does not
  /// count.
  double largest_distance_of_input = 0;
  bool gave_up = false;    ///< the work was more than `RepairOptions::max_work`
  bool cancelled = false;  ///< by the execution

  /// Are there facets that are not as they were?
  bool changed() const {
    return split_polygons + dropped_polygons + repeated.count + turned.count + stitched.count +
               collapsed.count + cut.count + second_sides + flakes.count + merged.count + dropped.count +
               filled.size() >
           0;
  }
};

struct RepairResult {
  std::vector<PolygonSoup> soups;  ///< as many as came in, in their order; what is left of each
  RepairReport report;
};

/// Make the soups fit for `build_plc`. Tags and features survive cutting; each soup keeps the place that it
/// encloses and no earlier one does (winding number above 1/2). Region points, hole points and loose segments
/// stay. What cannot be repaired is left for `build_plc` to name.
/// Where it gave up or was cancelled, as the report says, the soups are those that came in.
/// Throws PlcError for points that are not finite and indices out of range.
/// Cost: O(n log n), and some 0.1 ms for each pair of facets that intersect.
/// Based on Zhou, Grinspun, Zorin, Jacobson 2016 (arrangements) and Jacobson, Kavan, Sorkine-Hornung 2013
/// (winding numbers).
RepairResult repair(std::span<const PolygonSoup> soups, const RepairOptions& options = {},
                    const PlcOptions& complex = {}, const Execution& execution = {});

/// A complex, and what was done to the soups to make it one.
struct RepairedPlc {
  Plc plc;
  RepairReport report;
  std::vector<PolygonSoup> soups;  ///< what the complex was built from, if anything was repaired; else empty
};

/// The complex as it is, or that of the repaired soups where it has features below the tolerance: curves that
/// are shorter, features that come as close without meeting, slits. `plc` is that of the soups. Where they
/// cannot be removed, it stays and has a warning that says so.
RepairedPlc remove_noise(Plc plc, std::span<const PolygonSoup> soups, const PlcOptions& options = {},
                         const RepairOptions& repair_options = {}, const Execution& execution = {});

/// `build_plc`, and where it finds faults or noise, `repair` first, with a tolerance that grows where that
/// helps. Valid soups without features below the tolerance give the complex of `build_plc`. When the report
/// says that it was cancelled, the complex is empty. Throws PlcError: the faults of what came in, and what
/// helps.
RepairedPlc build_repaired_plc(std::span<const PolygonSoup> soups, const PlcOptions& options = {},
                               const RepairOptions& repair_options = {}, const Execution& execution = {});

/// The repairs to try, one after the other, while no mesh of the complex keeps every guarantee. First one
/// that is three times as coarse, where something was repaired: refinement does not end in folds about as
/// fine as the tolerance, which a repair may leave. Then, in `RepairMode::wrap`, a surface around everything.
std::vector<RepairOptions> further_repairs(const RepairOptions& options, const RepairReport& report);

/// The repairs to try, one after the other, where the refinement of a complex takes far more vertices than
/// its sizes ask for: features just above the tolerance may be resolved as if they mattered. With tolerances
/// of 1e-4 and 1e-3 of the diagonal, none above a hundredth of `size` (absolute).
std::vector<RepairOptions> coarser_repairs(const RepairOptions& options, double size, double diagonal);

/// For people: a line for each kind of change with counts, sizes and places; empty if there was none.
std::vector<std::string> describe(const RepairReport& report);

}  // namespace collarmesh
