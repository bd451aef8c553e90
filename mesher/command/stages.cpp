#include "command/stages.h"

#include "common/recorded_costs.h"

namespace collarmesh::command {

Stages::~Stages() { recorded_costs::write(); }

void Stages::begin(const std::string& phase, double begin, double end, std::size_t tets) {
  interrupts_.stop_if_asked();
  interrupts_.note_stage({phase, 0, tets});
  times_.begin(phase);
  recorded_costs::begin_stage(phase);
  display_.begin_stage(phase, begin, end);
}

void Stages::update(ProgressReport report) {
  const double fraction = 0.08 + 0.85 * report.fraction;
  if (report.begins) {
    begin_ = fraction;
    begin(std::string(report.phase), begin_, begin_ + 1, report.tets);
    return;
  }
  interrupts_.note_stage({std::string(report.phase), report.vertices, report.tets});
  report.fraction = fraction - begin_;
  display_.update(report);
}

}  // namespace collarmesh::command
