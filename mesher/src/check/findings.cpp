#include "check/findings.h"

namespace collarmesh::checks {

std::size_t& Findings::count(std::string_view guarantee) {
  for (auto& [name, number] : counts_)
    if (name == guarantee) return number;
  return counts_.emplace_back(guarantee, 0).second;
}

}  // namespace collarmesh::checks
