#include "distributed_command.h"

int main(int argc, char** argv) {
  using namespace collarmesh;
  auto* const process = new process::Process;  // never destroyed
  return static_cast<int>(distributed::run(*process, argc, argv));
}
