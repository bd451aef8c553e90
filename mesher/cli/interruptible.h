#pragma once

#include "files/complex_input.h"

namespace collarmesh::cli {

/// Returns how to read a command's input: as given, but ending when the command is interrupted, and reporting
/// work on CAD files to its supervisor.
files::InputReading interruptible(files::InputReading reading);

}  // namespace collarmesh::cli
