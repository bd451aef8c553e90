#pragma once

#include <nlohmann/json_fwd.hpp>

#include "collarmesh/options.h"

namespace collarmesh::report {

/// Returns the values of the options that determine a mesh; null for an option that was not given and has no
/// fixed default.
nlohmann::ordered_json options_json(const RunOptions& options);

/// Returns the table of options, for files generated from it.
nlohmann::ordered_json option_table_json();

}  // namespace collarmesh::report
