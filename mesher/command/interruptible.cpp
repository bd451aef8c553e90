#include "command/interruptible.h"

#include "common/recorded_costs.h"

namespace collarmesh::command {

namespace {

/// An object that reports work of OpenCASCADE, as long as it exists, to the supervisor and to the record of
/// costs.
class CadPart {
 public:
  CadPart(process::Supervisor& supervisor, std::string_view doing, std::string_view file, double seconds)
      : costs_(doing), work_(supervisor, doing, file, seconds) {}

 private:
  recorded_costs::StagePart costs_;
  process::CadWork work_;
};

}  // namespace

files::InputReading interruptible(process::Process& process, files::InputReading reading) {
  reading.cancel = &process.interrupts.flag();
  reading.stop = [&process] { process.interrupts.stop_if_asked(); };
  reading.guard = [&process](std::string_view doing, std::string_view file, double seconds) {
    return std::make_shared<CadPart>(process.supervisor, doing, file, seconds);
  };
  return reading;
}

}  // namespace collarmesh::command
