#include "command/mesh_arguments.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <vector>

#include "collarmesh/error.h"
#include "command/option_values.h"
#include "files/file_groups.h"
#include "files/trace_files.h"
#include "process/machine.h"

namespace collarmesh::command {

namespace {

/// Adds an option of the table.
CLI::Option* add(CLI::App& app, const Option& option, RunOptions& options) {
  const std::string name = "--" + option.name;
  const std::string names = option.letter == 0 ? name : fmt::format("-{},{}", option.letter, name);
  if (option.kind() == Option::Kind::flag)
    return app
        .add_flag_callback(
            names, [&] { option.set(options, true); }, option.help)
        ->group(option.group);
  const auto read = [&option, &options, name](const std::string& text) {
    if (!option.read(text, options)) reject(name, "'{}' is not {}", text, option.fitting());
  };
  const auto read_all = [read](const std::vector<std::string>& texts) {
    for (const std::string& text : texts) read(text);
  };
  CLI::Option* const added =
      option.is_repeatable()
          ? app.add_option_function<std::vector<std::string>>(names, read_all, option.help + "; repeatable")
                ->allow_extra_args(false)
          : app.add_option_function<std::string>(names, read, option.help);
  return added->type_name(option.value_name)->default_str(option.default_value())->group(option.group);
}

}  // namespace

void add_options(CLI::App& app, Option::Command command, RunOptions& options) {
  options.mesh.max_memory = process::memory_of_the_machine() / 2;
  for (const Option& option : option_table())
    if (option.is_for(command)) add(app, option, options);
}

namespace {

std::vector<std::string> all_inputs(const MeshArguments& a) {
  std::vector<std::string> inputs = a.inputs;
  for (const std::string& path : {a.names, a.size_field_file})
    if (!path.empty()) inputs.push_back(path);
  return inputs;
}

/// Rejects an output file other than the mesh if it would replace a file of the mesh or of the input.
void check_second_output(const char* option, const std::string& file, const MeshArguments& a) {
  if (file.empty()) return;
  if (files::may_write(a.output, a.output_format, file))
    reject(option, "names a file of --output; choose another");
  const std::string lost = files::overwritten({file}, all_inputs(a), a.input_format);
  if (!lost.empty()) reject(option, "would overwrite {}; choose another", lost);
}

}  // namespace

void check_outputs(const MeshArguments& a) {
  const std::string in_the_way =
      files::overwritten(files::files_written(a.output, a.output_format), all_inputs(a), a.input_format);
  if (!in_the_way.empty())
    reject("--output", "'{}' would overwrite {}; choose another name or folder", a.output, in_the_way);
  std::vector<std::string> others;
  for (const std::string& report : a.reports) {
    check_second_output("--report", report, a);
    if (!files::overwritten({report}, others, {}).empty())
      reject("--report", "names {} twice; choose another", report);
    others.push_back(report);
  }
  check_second_output("--cell-decomposition", a.cell_decomposition, a);
  if (!a.cell_decomposition.empty() && !files::overwritten({a.cell_decomposition}, others, {}).empty())
    reject("--cell-decomposition", "names the file of --report; choose another");
  check_second_output("--trace", files::trace_file(a.trace_folder), a);
}

void check_run_arguments(const MeshArguments& a) {
  if (a.verbose && a.quiet) reject("--quiet", "contradicts --verbose; use one of them");
  check_outputs(a);
  try {
    validate(a);
  } catch (const OptionError& error) {
    throw CLI::ValidationError(fmt::format("--{}", error.what()));
  }
}

}  // namespace collarmesh::command
