#pragma once

#include <pybind11/pybind11.h>

#include <string>

#include "collarmesh/options.h"
#include "collarmesh/plc.h"
#include "collarmesh/sampled_sizes.h"

namespace collarmesh::python {

/// The options of a call. In Python they are a dict with the names of the command line, `_` for `-`; options
/// that it lacks have their defaults. `names` may be JSON, too.
struct Options : RunOptions {
  std::string size_field_json;              ///< empty: none
  SizesAt sizes_at;                         ///< a size field that takes arrays of places; empty: none
  std::string input_format, output_format;  ///< extensions with their dot; empty: the files' own
};

/// Returns the size field for this complex if it comes from a file, a JSON description or a callable of
/// arrays; else an empty one, because other size fields are already in `mesh.size_field`.
SizeField size_field_for(const Plc& plc, const Options& options);

/// Reads options from a dict. Throws OptionError for values of the wrong type or out of range.
Options options_of(const pybind11::dict& given);

}  // namespace collarmesh::python
