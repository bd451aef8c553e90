#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <string>
#include <vector>

#include "arguments.h"
#include "collarmesh/pipeline.h"

namespace collarmesh::python {

/// Options by the command line's names, with `_` for `-`; those of a dict take the place of the defaults.
struct Options {
  PipelineOptions pipeline;
  cli::SolidOverlap overlap = cli::SolidOverlap::first;
  CheckOptions check;
  std::string size_field_file, size_field_json;  ///< empty: none
  std::string input_format, output_format;       ///< with their dot; empty: by extension
  std::string names;                             ///< of features: a path or JSON; empty: none

  cli::ComplexArguments complex() const {
    return {pipeline.complex, pipeline.repair, overlap, pipeline.mesh.crease_angle, names};
  }
};

/// Throws OptionError for values of the wrong type and words that are none of those known.
Options options_of(const pybind11::dict& given);

}  // namespace collarmesh::python
