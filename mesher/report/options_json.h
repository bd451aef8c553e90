#pragma once

#include <nlohmann/json_fwd.hpp>

#include "collarmesh/options.h"

namespace collarmesh::report {

/// Returns the options that determine the mesh of a run; null for options whose default depends on the input.
nlohmann::ordered_json options_json(const RunOptions& options);

/// Returns the table of options, for files generated from it.
nlohmann::ordered_json option_table_json();

}  // namespace collarmesh::report
