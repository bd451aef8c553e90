#pragma once

namespace collarmesh {

/// How many threads parallel parts may use: one for each core, fewer where the system gives no more. Found
/// once, and TBB kept to it: it ends the program where a thread that it wants cannot be made.
int usable_threads();

}  // namespace collarmesh
