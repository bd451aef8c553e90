#pragma once

#include <pybind11/pybind11.h>

#include <string>

#include "collarmesh/options.h"
#include "collarmesh/plc.h"
#include "collarmesh/sampled_sizes.h"

namespace collarmesh::python {

/// Options by the command line's names, with `_` for `-`; entries of a dict replace the defaults. `names` may
/// be JSON, too.
struct Options : RunOptions {
  std::string size_field_json;              ///< empty: none
  SizesAt sizes_at;                         ///< a size field that takes arrays of places; empty: none
  std::string input_format, output_format;  ///< with their dot; empty: by extension
};

/// Returns the size field for this complex: of a file, of a description or of arrays; empty if none of them
/// is given.
SizeField size_field_for(const Plc& plc, const Options& options);

/// Reads options from a dict. Throws OptionError for values of the wrong type or out of range.
Options options_of(const pybind11::dict& given);

}  // namespace collarmesh::python
