#include "common/recorded_costs.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <map>
#include <memory>
#include <queue>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace collarmesh::recorded_costs {

namespace {

constexpr std::array<std::size_t, 6> workers{2, 4, 8, 16, 32, 64};
using Spans = std::array<double, workers.size()>;  // seconds by numbers of workers

double now() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Returns the time at which the last piece is done if each of `count` workers takes the next piece once it
/// is free.
double makespan(const std::vector<double>& costs, std::size_t count) {
  std::priority_queue<double, std::vector<double>, std::greater<>> free_at;
  double end = 0;
  for (const double cost : costs) {
    double start = 0;
    if (free_at.size() >= count) {
      start = free_at.top();
      free_at.pop();
    }
    free_at.push(start + cost);
    end = std::max(end, start + cost);
  }
  return end;
}

/// A parallel part that is running.
struct Part {
  std::vector<double> pieces;  // costs
  double inner = 0;            // cost of the parallel parts inside the current piece
  Spans inner_spans{}, longest{};
  bool nests = false;
};

struct Sum {
  double serial = 0, work = 0;
  Spans spans{};
  std::size_t parts = 0, pieces = 0;
};

class Record {
 public:
  explicit Record(std::string path) : path_(std::move(path)), last_(now()) {}
  Record(const Record&) = delete;
  Record& operator=(const Record&) = delete;

  // Writes nothing if no part was recorded: a process that starts another one for the work records none.
  ~Record() {
    if (parts_ > 0) write();
  }

  void write() {
    begin_stage({});
    parts_ = 0;
    std::FILE* const file = std::fopen(path_.c_str(), "w");
    if (file == nullptr) return;
    std::fputs("stage\tplace\tparts\tpieces\tserial\twork", file);
    for (const std::size_t n : workers) std::fprintf(file, "\tspan_%zu", n);
    for (const auto& [key, sum] : sums_) {
      std::fprintf(file, "\n%s\t%s\t%zu\t%zu\t%.6f\t%.6f", key.first.c_str(), key.second.c_str(), sum.parts,
                   sum.pieces, sum.serial, sum.work);
      for (const double span : sum.spans) std::fprintf(file, "\t%.6f", span);
    }
    std::fputc('\n', file);
    static_cast<void>(std::fclose(file));
  }

  bool is_here() const { return std::this_thread::get_id() == thread_; }

  void run(std::size_t count, const std::function<void(std::size_t)>& work, const Place& place) {
    const double begun = now();
    const bool outermost = under_way_.empty();
    const std::string_view path(place.file);
    const std::string key =
        std::string(path.substr(path.find("mesher/") == path.npos ? 0 : path.find("mesher/"))) + ":" +
        std::to_string(place.line);
    if (outermost) sums_[{stage_, key}].serial += begun - last_;
    under_way_.push_back(std::make_unique<Part>());
    Part& part = *under_way_.back();
    for (std::size_t i = 0; i < count; ++i) {
      part.inner = 0;
      part.inner_spans = {};
      const double start = now();
      work(i);
      const double cost = now() - start;
      part.pieces.push_back(cost);
      for (std::size_t w = 0; w < workers.size(); ++w)
        part.longest[w] = std::max(part.longest[w], cost - part.inner + part.inner_spans[w]);
    }
    end_part(outermost, key);
  }

  void begin_stage(std::string_view stage) {
    const double time = now();
    sums_[{stage_, "end of the stage"}].serial += time - last_;
    stage_ = stage;
    last_ = now();
  }

  const std::string& stage() const { return stage_; }

 private:
  void end_part(bool outermost, const std::string& key) {
    const std::unique_ptr<Part> part = std::move(under_way_.back());
    under_way_.pop_back();
    double work = 0;
    for (const double cost : part->pieces) work += cost;
    Spans spans{};
    for (std::size_t w = 0; w < workers.size(); ++w)
      spans[w] = part->nests ? std::max(work / static_cast<double>(workers[w]), part->longest[w])
                             : makespan(part->pieces, workers[w]);
    if (outermost) {
      ++parts_;
      Sum& sum = sums_[{stage_, key}];
      ++sum.parts;
      sum.pieces += part->pieces.size();
      sum.work += work;
      for (std::size_t w = 0; w < workers.size(); ++w) sum.spans[w] += spans[w];
      last_ = now();
      return;
    }
    Part& around = *under_way_.back();
    around.nests = true;
    around.inner += work;
    for (std::size_t w = 0; w < workers.size(); ++w) around.inner_spans[w] += spans[w];
  }

  std::string path_, stage_ = "start";
  std::thread::id thread_ = std::this_thread::get_id();
  std::size_t parts_ = 0;  // parts since the table was written
  double last_;            // time at which the current serial part began
  std::vector<std::unique_ptr<Part>> under_way_;
  std::map<std::pair<std::string, std::string>, Sum> sums_;
};

Record* record() {
  const char* const path = std::getenv("COLLARMESH_RECORD_COSTS");
  if (path == nullptr) return nullptr;
  static Record the_record(path);
  return &the_record;
}

Record* const the_only = record();

}  // namespace

const bool on = the_only != nullptr;

void run(std::size_t count, const std::function<void(std::size_t)>& work, const Place& place) {
  if (the_only->is_here()) return the_only->run(count, work, place);
  for (std::size_t i = 0; i < count; ++i) work(i);
}

void begin_stage(std::string_view stage) {
  if (the_only != nullptr && the_only->is_here()) the_only->begin_stage(stage);
}

StagePart::StagePart(std::string_view work) {
  if (the_only == nullptr || !the_only->is_here()) return;
  stage_ = the_only->stage();
  begin_stage(stage_ + ": " + std::string(work));
}

StagePart::~StagePart() {
  if (!stage_.empty()) begin_stage(stage_);
}

void write() {
  if (the_only != nullptr && the_only->is_here()) the_only->write();
}

}  // namespace collarmesh::recorded_costs
