#include "interruptible.h"

#include "common/recorded_costs.h"
#include "process/interrupt.h"
#include "process/supervisor.h"

namespace collarmesh::cli {

namespace {

/// Work of OpenCASCADE: it is supervised, and its costs are recorded apart.
class CadPart {
 public:
  CadPart(std::string_view doing, std::string_view file, double seconds)
      : costs_(doing), work_(doing, file, seconds) {}

 private:
  recorded_costs::StagePart costs_;
  process::CadWork work_;
};

}  // namespace

files::InputReading interruptible(files::InputReading reading) {
  reading.cancel = &process::interrupt_flag();
  reading.stop = [] { process::stop_if_interrupted(); };
  reading.guard = [](std::string_view doing, std::string_view file, double seconds) {
    return std::make_shared<CadPart>(doing, file, seconds);
  };
  return reading;
}

}  // namespace collarmesh::cli
