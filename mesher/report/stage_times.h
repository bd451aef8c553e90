#pragma once

#include <string>
#include <utility>
#include <vector>

#include "common/stopwatch.h"

namespace collarmesh::report {

/// Seconds per stage of a command, in order.
class StageTimes {
 public:
  /// Ends the previous stage and begins this one.
  void begin(std::string stage) {
    end();
    stages_.emplace_back(std::move(stage), 0.0);
    stopwatch_ = Stopwatch();
  }
  void end() {
    if (!stages_.empty() && stages_.back().second == 0) stages_.back().second = stopwatch_.seconds();
  }
  const std::vector<std::pair<std::string, double>>& stages() const { return stages_; }
  double total() const {
    double sum = 0;
    for (const auto& stage : stages_) sum += stage.second;
    return sum;
  }

 private:
  Stopwatch stopwatch_;
  std::vector<std::pair<std::string, double>> stages_;
};

}  // namespace collarmesh::report
