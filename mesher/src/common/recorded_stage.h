#pragma once

#include <string>
#include <string_view>

namespace collarmesh::recorded_costs {

/// A part of a stage whose costs are recorded apart, as "STAGE: WORK".
class StagePart {
 public:
  explicit StagePart(std::string_view work);
  /// Continues the stage.
  ~StagePart();
  StagePart(const StagePart&) = delete;
  StagePart& operator=(const StagePart&) = delete;

 private:
  std::string stage_;
};

}  // namespace collarmesh::recorded_costs
