#include "collarmesh/mesh_files.h"

#include <utility>

#include "collarmesh/io/size_field_io.h"
#include "collarmesh/surface_tolerance.h"
#include "files/complex_input.h"

namespace collarmesh {

namespace {

/// A builder of complexes from files: one complex for each repair.
class FilesSource : public ComplexSource {
 public:
  /// Keeps references to both arguments.
  FilesSource(const RunOptions& options, files::ComplexInput& input) : options_(options), input_(input) {}

  RepairedPlc build(const RepairOptions& repair, const Execution&) override {
    return {input_.build(options_.complex, repair), input_.repaired(), {}};
  }

  void adapt(const Plc& plc, PipelineOptions& options) override {
    if (!options_.size_field_file.empty())
      options.mesh.size_field = io::read_size_field(options_.size_field_file, plc);
    if (!input_.has_cad()) return;
    options.exact = input_.exact_geometry(plc);
    options.exact_measures = input_.exact_measures(plc);
  }

 private:
  const RunOptions& options_;
  files::ComplexInput& input_;
};

}  // namespace

FilesResult mesh_files(const std::vector<std::string>& paths, const RunOptions& options,
                       const std::string& format, const Execution& execution) {
  files::InputReading reading = files::reading_for_mesh(options, format);
  reading.cancel = execution.cancel;
  files::ComplexInput input(paths, std::move(reading));
  FilesSource source(options, input);
  FilesResult result{run_pipeline(source, options, execution), {}};
  if (input.has_cad()) result.result.mesh.group_names = GroupNames::cad;
  result.notes = input.notes(options.dimension);
  return result;
}

}  // namespace collarmesh
