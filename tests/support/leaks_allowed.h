#pragma once

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#include <sanitizer/lsan_interface.h>
#define COLLARMESH_TESTS_LOOK_FOR_LEAKS
#endif
#endif

namespace collarmesh::testing {

/// Permits leaks during its lifetime: other libraries' writers, with which tests make files, leak memory.
class LeaksAllowed {
 public:
  LeaksAllowed() = default;
  LeaksAllowed(const LeaksAllowed&) = delete;
  LeaksAllowed& operator=(const LeaksAllowed&) = delete;
  ~LeaksAllowed() {}

 private:
#ifdef COLLARMESH_TESTS_LOOK_FOR_LEAKS
  __lsan::ScopedDisabler disabler_;
#endif
};

}  // namespace collarmesh::testing
