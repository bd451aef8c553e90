#include "check/findings.h"

namespace collarmesh::checks {

void Findings::take(CheckReport& part) {
  report_.findings_total += part.findings_total;
  for (Finding& finding : part.findings)
    if (++count(finding.guarantee) <= listed_per_guarantee_) report_.findings.push_back(std::move(finding));
}

std::size_t& Findings::count(std::string_view guarantee) {
  for (auto& [name, number] : counts_)
    if (name == guarantee) return number;
  return counts_.emplace_back(guarantee, 0).second;
}

}  // namespace collarmesh::checks
