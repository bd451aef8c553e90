#pragma once

namespace collarmesh::testing {

// Clang has a feature test for AddressSanitizer, GCC a macro.
#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define COLLARMESH_SANITIZED
#endif
#endif
#if defined(__SANITIZE_ADDRESS__)
#define COLLARMESH_SANITIZED
#endif

/// Says whether AddressSanitizer is on, which makes the code tens of times slower.
#if defined(COLLARMESH_SANITIZED)
constexpr bool sanitized = true;
#else
constexpr bool sanitized = false;
#endif

}  // namespace collarmesh::testing
