#pragma once

#include <pybind11/pybind11.h>

#include <string>

#include "collarmesh/options.h"
#include "collarmesh/plc.h"
#include "collarmesh/sampled_sizes.h"

namespace collarmesh::python {

/// Options by the command line's names, with `_` for `-`; those of a dict take the place of the defaults.
/// `names` may be JSON, too.
struct Options : RunOptions {
  std::string size_field_json;              ///< empty: none
  SizesAt sizes_at;                         ///< a size field that takes arrays of places; empty: none
  std::string input_format, output_format;  ///< with their dot; empty: by extension
};

/// The size field that is for this complex: of a file, of a description or of arrays; empty where none of
/// them is given.
SizeField size_field_for(const Plc& plc, const Options& options);

/// Throws OptionError for values of the wrong type or out of range.
Options options_of(const pybind11::dict& given);

}  // namespace collarmesh::python
