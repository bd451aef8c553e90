#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "collarmesh/check.h"

namespace collarmesh::checks {

/// A point as messages print it.
struct At {
  Point point;
};

/// A collector of findings: lists the first ones of each guarantee and counts all.
class Findings {
 public:
  Findings(CheckReport& report, std::size_t listed_per_guarantee)
      : report_(report), listed_per_guarantee_(listed_per_guarantee) {}

  template <class... Arguments>
  void add(std::string_view guarantee, const Point& where, std::initializer_list<Index> ids,
           fmt::format_string<Arguments...> message, Arguments&&... arguments) {
    ++report_.findings_total;
    if (++count(guarantee) > listed_per_guarantee_) return;
    report_.findings.push_back(
        {std::string(guarantee), fmt::format(message, std::forward<Arguments>(arguments)...), ids, where});
  }

  /// Adds the findings of a separate report, which another part of the check filled in.
  void take(CheckReport& part);

  /// Returns the number of findings so far, including those not listed.
  std::size_t total() const { return report_.findings_total; }

 private:
  std::size_t& count(std::string_view guarantee);

  CheckReport& report_;
  std::size_t listed_per_guarantee_;
  std::vector<std::pair<std::string, std::size_t>> counts_;
};

}  // namespace collarmesh::checks

template <>
struct fmt::formatter<collarmesh::checks::At> {
  constexpr auto parse(format_parse_context& context) { return context.begin(); }
  template <class Context>
  auto format(const collarmesh::checks::At& at, Context& context) const {
    return fmt::format_to(context.out(), "({:.12g}, {:.12g}, {:.12g})", at.point.x, at.point.y, at.point.z);
  }
};
