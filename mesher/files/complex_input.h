#pragma once

#include <atomic>
#include <functional>
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

namespace collarmesh::files {

/// How the files of one complex are read.
struct InputReading {
  std::string format;  ///< in place of the files' extensions; empty: by these
  /// Surface distance tolerance, absolute, from the diagonal; the triangles of CAD shapes keep a tenth of it.
  std::function<double(double diagonal)> distance = [](double diagonal) {
    return default_distance(0, diagonal);
  };
  /// Of the mesh that will be made of a complex: triangles of CAD shapes that are too coarse for it are cut
  /// finer. Empty: none is.
  std::function<SurfaceTolerance(const Plc&)> tolerance = {};
  SolidOverlap overlap = SolidOverlap::first;
  unsigned threads = 0;                       ///< for CAD shapes, at most; 0: all cores
  std::string names = {};                     ///< of features: the path of a file, or its text; empty: none
  std::vector<std::string> given_names = {};  ///< further ones, "fixed=11"
  const std::atomic<bool>* cancel = nullptr;  ///< ends the work when it is set
  CadGuard guard = {};                        ///< of work on CAD files
  std::function<void()> stop = [] {};         ///< called between steps; throws when the work is to end
};

/// The files of one complex: surfaces, complexes and CAD shapes, which are cut into triangles here.
class ComplexInput {
 public:
  /// Reads them; "-" is standard input. Throws ReadError, for a file that does not exist with the most
  /// similar name, and PlcError.
  explicit ComplexInput(const std::vector<std::string>& paths, InputReading reading = {});

  /// Surfaces that are no files.
  void add(PolygonSoup soup) { soups_.push_back(std::move(soup)); }

  /// What the complex built last was made of; before, what was read.
  const std::vector<PolygonSoup>& soups() const { return built_.soups.empty() ? soups_ : built_.soups; }
  bool has_cad() const { return !cad_.empty(); }
  std::string cad_names() const { return cad_.names(); }
  /// What was done to CAD shapes, a line each. `dimension` of the elements: meshes of surfaces and curves
  /// need not know that solids are open.
  std::vector<std::string> notes(unsigned dimension = 3) const { return cad_.notes(dimension == 3); }

  /// The complex, of repaired facets where that is needed. Where triangles of CAD faces meet that should not,
  /// finer ones are tried first.
  /// Throws PlcError; with CAD faces the messages name them.
  Plc build(const PlcOptions& options, const RepairOptions& repair = {});
  /// Returns the colours that a CAD file gives to the tags of the complex built last.
  TagColours colours() const;
  /// What was done to the facets of the complex built last.
  const RepairReport& repaired() const { return built_.repaired; }

  /// The exact edges and faces behind the complex built last, for `run_pipeline`. Both must outlive the
  /// result.
  ExactGeometry exact_geometry(const Plc& plc) const;
  /// Their lengths, areas and volumes, where they are known.
  ShapeMeasures exact_measures(const Plc& plc) const;

 private:
  void add_replaced_faces(Plc& plc) const;
  void name(Plc& plc) const;
  const brep::CadLabels* labels() const;
  Plc build_unnamed(const PlcOptions& options, const RepairOptions& repair);
  Plc build_valid(const PlcOptions& options, const RepairOptions& repair);
  Plc build_finer(const PlcOptions& options, const RepairOptions& repair, bool with_noise);
  Plc resolved(Plc plc, const PlcOptions& options, const RepairOptions& repair);
  Plc build_repaired(const PlcOptions& options, const RepairOptions& repair);
  PlcError with_advice(const PlcError& error, const RepairOptions& options, bool of_solids) const;
  Plc take(RepairedPlc result);
  double volume_off(const Plc& plc) const;
  void tessellate(double finer);
  void tessellate(double finer, const std::set<std::pair<Index, Tag>>& faces);

  Execution watched() const;

  /// Of the complex built last.
  struct Built {
    RepairReport repaired;
    std::vector<PolygonSoup> soups;                 // repaired; empty where nothing was
    std::vector<Tag> patch_numbers, curve_numbers;  // before names were given
  };

  InputReading reading_;
  std::vector<PolygonSoup> soups_;  // as they were read
  CadFiles cad_;
  double finer_ = 1;  // than the first triangles of CAD shapes; 0 where some faces alone are
  Built built_;
};

}  // namespace collarmesh::files
