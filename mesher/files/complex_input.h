#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "collarmesh/error.h"
#include "collarmesh/options.h"
#include "collarmesh/plc_builder.h"
#include "collarmesh/progress.h"
#include "collarmesh/project_boundary.h"
#include "collarmesh/repair.h"
#include "collarmesh/shape_measures.h"
#include "collarmesh/surface_tolerance.h"
#include "collarmesh/tag_colours.h"
#include "files/cad_files.h"
#include "files/faces_at_faults.h"

namespace collarmesh::files {

/// Options for reading the files of one complex.
struct InputReading {
  std::string format;  ///< overrides the files' extensions; empty: by extension
  /// Returns the surface distance tolerance, absolute, given the diagonal of the bounding box. The first
  /// triangles of a CAD shape are at most a tenth of this tolerance from the shape.
  std::function<double(double diagonal)> distance = [](double diagonal) {
    return default_distance(0, diagonal);
  };
  /// Returns the tolerance of the mesh that will be made of a complex. Triangles of CAD shapes that are too
  /// coarse for it are replaced by finer ones. Empty: none are replaced.
  std::function<SurfaceTolerance(const Plc&)> tolerance = {};
  int order = 1;  ///< order of the elements of that mesh
  SolidOverlap overlap = SolidOverlap::first;
  unsigned threads = 0;                       ///< maximum number of threads for CAD shapes; 0: all cores
  std::string names = {};                     ///< names of features: the path of a file, or its text; empty:
                                              ///< none
  std::vector<std::string> given_names = {};  ///< further names, "fixed=11"
  const std::atomic<bool>* cancel = nullptr;  ///< ends the work when it is set
  CadGuard guard = {};                        ///< supervises work on CAD files
  std::function<void()> stop = [] {};         ///< called between steps; may throw to end the work
};

/// Returns the settings for reading that the options of a run give.
InputReading reading_of(const RunOptions& options, const std::string& format = {});

/// Returns the settings of `reading_of`, changed for input that will be meshed: triangles of CAD shapes are
/// as fine as the mesh's sizes ask for and, for meshes of solids, fine enough to keep volumes. The result
/// refers to `options`, which must outlive it.
InputReading reading_for_mesh(const RunOptions& options, const std::string& format = {});

/// The files of one complex: surfaces, complexes and CAD shapes, which are triangulated here.
class ComplexInput {
 public:
  /// Reads the files; "-" is standard input. Throws PlcError, and ReadError, which proposes the most similar
  /// name for a file that does not exist.
  explicit ComplexInput(const std::vector<std::string>& paths, InputReading reading = {});

  /// Adds a surface that does not come from a file.
  void add(PolygonSoup soup) {
    soups_.push_back(std::move(soup));
    known_.clear();
    first_.reset();
  }

  /// Returns the soups from which the last complex was built; if none was built yet, the soups that were
  /// read.
  const std::vector<PolygonSoup>& soups() const { return built_.soups.empty() ? soups_ : built_.soups; }
  bool has_cad() const { return !cad_.empty(); }
  std::string cad_names() const { return cad_.names(); }
  /// Returns notes on the CAD shapes and their changes, one per line. `dimension` is that of the elements:
  /// meshes of surfaces and curves need no notes on open solids.
  std::vector<std::string> notes(unsigned dimension = 3) const { return cad_.notes(dimension == 3); }

  /// Builds the complex, of repaired facets if necessary. If triangles of CAD faces intersect, tries finer
  /// ones before a repair. Remembers the last few repaired complexes, so that to build one of them again
  /// costs little. Throws PlcError; the messages name CAD faces.
  Plc build(const PlcOptions& options, const RepairOptions& repair = {});
  /// Returns the colours that a CAD file gives to the tags of the complex built last.
  TagColours colours() const;
  /// Returns the changes to the facets of the last complex.
  const RepairReport& repaired() const { return built_.repaired; }

  /// Returns the exact edges and faces behind the last complex, for `run_pipeline`. This object and `plc`
  /// must outlive the result.
  ExactGeometry exact_geometry(const Plc& plc) const;
  /// Returns the lengths, areas and volumes of the exact geometry, where known.
  ShapeMeasures exact_measures(const Plc& plc) const;

 private:
  Plc build_anew(const PlcOptions& options, const RepairOptions& repair);
  void remember(const PlcOptions& options, const RepairOptions& repair, const Plc& plc);
  void keep_numbers(const PlcOptions& options, const RepairOptions& repair, Plc& plc);
  void add_replaced_faces(Plc& plc) const;
  void name(Plc& plc) const;
  const brep::CadLabels* labels() const;
  Plc build_unnamed(const PlcOptions& options, const RepairOptions& repair);
  Plc without_small_features(Plc plc, const PlcOptions& options, const RepairOptions& repair);
  Plc build_valid(const PlcOptions& options, const RepairOptions& repair);
  Plc build_finer(const PlcOptions& options, const RepairOptions& repair, bool with_noise);
  std::optional<Plc> build_of_shapes(const PlcOptions& options, const RepairOptions& repair,
                                     std::optional<PlcError>& first);
  Plc resolved(Plc plc, const std::set<SoupFace>& fine, const PlcOptions& options,
               const RepairOptions& repair);
  Plc build_repaired(const PlcOptions& options, const RepairOptions& repair);
  PlcError with_advice(const PlcError& error, const RepairOptions& options, bool of_solids) const;
  Plc take(RepairedPlc result);
  double volume_off(const Plc& plc) const;
  void tessellate(double finer);
  void tessellate(double finer, const std::set<SoupFace>& faces);

  Execution watched() const;

  /// The data of the last complex.
  struct Built {
    RepairReport repaired;
    std::vector<PolygonSoup> soups;                 // the repaired soups; empty without repairs
    std::vector<Tag> patch_numbers, curve_numbers;  // tags before names were applied
  };

  /// A complex that was built, and the options for it.
  struct Known {
    PlcOptions options;
    RepairOptions repair;
    double finer = 1;
    Plc plc;
    Built built;
  };

  InputReading reading_;
  std::vector<PolygonSoup> soups_;  // the soups as they were read
  CadFiles cad_;
  double finer_ = 1;  // how many times finer the triangles of CAD shapes are than the first ones; 0 if only
                      // those of some faces are finer
  Built built_;
  std::vector<Known> known_;  // the first and the last few repaired complexes

  /// The first complex with the current options, if the program numbered its features; as it was before it
  /// got names. Later complexes keep its numbers.
  struct First {
    PlcOptions options;
    std::optional<double> target_size;
    Plc plc;
  };
  std::optional<First> first_;
};

}  // namespace collarmesh::files
