#pragma once

#include <chrono>
#include <string>
#include <utility>
#include <vector>

namespace collarmesh::report {

/// Seconds per stage of a command, in order.
class StageTimes {
 public:
  /// Ends the previous stage and begins this one.
  void begin(std::string stage) {
    end();
    stages_.emplace_back(std::move(stage), 0.0);
    start_ = Clock::now();
  }
  void end() {
    if (!stages_.empty() && stages_.back().second == 0)
      stages_.back().second = std::chrono::duration<double>(Clock::now() - start_).count();
  }
  const std::vector<std::pair<std::string, double>>& stages() const { return stages_; }
  double total() const {
    double sum = 0;
    for (const auto& stage : stages_) sum += stage.second;
    return sum;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_;
  std::vector<std::pair<std::string, double>> stages_;
};

}  // namespace collarmesh::report
