#include "interruptible.h"

#include "process/interrupt.h"
#include "process/supervisor.h"

namespace collarmesh::cli {

files::InputReading interruptible(files::InputReading reading) {
  reading.cancel = &process::interrupt_flag();
  reading.stop = [] { process::stop_if_interrupted(); };
  reading.guard = [](std::string_view doing, std::string_view file, double seconds) {
    return std::make_shared<process::CadWork>(doing, file, seconds);
  };
  return reading;
}

}  // namespace collarmesh::cli
