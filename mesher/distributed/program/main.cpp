#include "distributed_command.h"
#include "process/console.h"
#include "process/out_of_memory.h"

int main(int argc, char** argv) {
  using namespace collarmesh;
  process::replace_closed_streams();
  process::end_when_memory_is_used_up();
  return static_cast<int>(distributed::run(argc, argv));
}
