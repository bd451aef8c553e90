#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "collarmesh/check.h"
#include "collarmesh/options.h"
#include "collarmesh/partition.h"
#include "collarmesh/pipeline.h"
#include "collarmesh/plc_builder.h"
#include "collarmesh/predict.h"
#include "collarmesh/remesh.h"
#include "collarmesh/tag_colours.h"
#include "report/stage_times.h"
#include "report/worst_tets.h"

namespace collarmesh::report {

/// The options of a run, and its files.
struct RequestedRun : RunOptions {
  std::vector<std::string> inputs;
  std::string output;
};

/// All results of one run of the mesher.
struct MeshRun : SoupPipelineResult {
  PlcSummary summary;
  std::vector<std::string> warnings;  ///< about options; warnings about the input are in the complex
  std::vector<std::string> notes;     ///< notes on CAD shapes, one per line
  TagColours colours;                 ///< colours of CAD shapes
  std::vector<WorstTet> worst;
  std::optional<RemeshReport> remeshing;  ///< nothing unless a mesh was adapted
  StageTimes times;
};

// As JSON (--report, --json):
/// Describes a complex. `names` is the style of names for features without a name; `colours` are by tag.
nlohmann::ordered_json complex_json(const Plc& plc, const PlcSummary& summary,
                                    GroupNames names = GroupNames::complex, const TagColours& colours = {});
nlohmann::ordered_json measures_json(const TetMesh& mesh, const MeshMeasures& measures);
nlohmann::ordered_json check_json(const CheckReport& report);
nlohmann::ordered_json repair_json(const RepairReport& report);
nlohmann::ordered_json prediction_json(const Prediction& prediction);
nlohmann::ordered_json predictions_json(const std::vector<Prediction>& predictions);
nlohmann::ordered_json run_json(const RequestedRun& arguments, const MeshRun& run);
/// Returns the report of `collarmesh repair`.
nlohmann::ordered_json repair_run_json(const RequestedRun& arguments, const Plc& plc,
                                       const PlcSummary& summary, const RepairReport& report);

// As lines of text, for display:
/// Returns "warning: ..." lines for the input; only the first ones if there are very many.
std::string warnings_text(const Plc& plc);
/// Returns "repaired: ..." lines; only the first ones if there are very many. `quiet`: only changes that may
/// alter the shape by more than the tolerance.
std::string repair_text(const RepairReport& report, bool quiet = false);
std::string complex_text(const Plc& plc, const PlcSummary& summary, GroupNames names = GroupNames::complex);
/// Returns a table; empty without predictions.
std::string predictions_text(const std::vector<Prediction>& predictions);
/// Returns a line on the partitions; empty for a mesh that is not partitioned.
std::string partitions_text(const PartitionMeasures& measures);
std::string mesh_text(const TetMesh& mesh, const MeshMeasures& measures, const CheckReport* judged = nullptr);
std::string findings_text(const CheckReport& report, std::size_t listed);
std::string check_text(const CheckReport& report);
/// Returns "straightened: ..." lines for the first nodes that did not stay on their smooth feature.
std::string straightened_text(const SecondOrderReport& report, std::size_t listed);
std::string run_text(const RequestedRun& arguments, const MeshRun& run);

}  // namespace collarmesh::report
