#include "program.h"

int main(int argc, char** argv) { return collarmesh::cli::run(argc, argv); }
