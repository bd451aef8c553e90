#pragma once

#include "files/complex_input.h"

namespace collarmesh::cli {

/// How a command's input is read: as given, and so that it ends when the command is interrupted, and its
/// supervisor knows of work on CAD files.
files::InputReading interruptible(files::InputReading reading);

}  // namespace collarmesh::cli
