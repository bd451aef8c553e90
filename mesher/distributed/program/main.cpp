#include "console.h"
#include "distributed_command.h"
#include "out_of_memory.h"

int main(int argc, char** argv) {
  using namespace collarmesh;
  cli::replace_closed_streams();
  cli::end_when_memory_is_used_up();
  return static_cast<int>(distributed::run(argc, argv));
}
