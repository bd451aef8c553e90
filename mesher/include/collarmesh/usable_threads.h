#pragma once

namespace collarmesh {

/// Returns the number of threads that parallel parts may use: one for each core, or fewer if the system
/// allows no more. The first call limits TBB to this number, because TBB would end the program if it could
/// not create a thread.
int usable_threads();

}  // namespace collarmesh
