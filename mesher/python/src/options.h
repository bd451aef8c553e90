#pragma once

#include <pybind11/pybind11.h>

#include <string>

#include "collarmesh/options.h"

namespace collarmesh::python {

/// Options by the command line's names, with `_` for `-`; those of a dict take the place of the defaults.
/// `names` may be JSON, too.
struct Options : RunOptions {
  std::string size_field_json;              ///< empty: none
  std::string input_format, output_format;  ///< with their dot; empty: by extension
};

/// Throws OptionError for values of the wrong type or out of range.
Options options_of(const pybind11::dict& given);

}  // namespace collarmesh::python
