#pragma once

#include <nlohmann/json.hpp>

#include "collarmesh/options.h"

namespace collarmesh::report {

/// What a run was asked for: the options that its mesh depends on, null where a default depends on the input.
nlohmann::ordered_json options_json(const RunOptions& options);

/// The table of options, for what is made from it elsewhere.
nlohmann::ordered_json option_table_json();

}  // namespace collarmesh::report
