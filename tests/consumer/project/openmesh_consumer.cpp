#include <collarmesh/error.h>
#include <collarmesh/openmesh_io.h>

// A missing file must raise an error that names it.
int main() {
  try {
    collarmesh::openmesh_io::read_om("missing.om");
  } catch (const collarmesh::ReadError&) {
    return 0;
  }
  return 1;
}
