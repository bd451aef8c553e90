#include "program.h"

int main(int argc, char** argv) {
  auto* const process = new collarmesh::process::Process;  // never destroyed
  return collarmesh::cli::run(*process, argc, argv);
}
