#pragma once

#include <atomic>

#include "collarmesh/geometry.h"

namespace collarmesh {

/// Sets `last` to `item` if `last` is smaller or none. Several threads may call it at once if `alone` is
/// false.
inline void note_last(Index& last, Index item, bool alone) {
  if (alone) {
    if (last == none || last < item) last = item;
    return;
  }
  const std::atomic_ref shared(last);
  Index known = shared.load(std::memory_order_relaxed);
  while ((known == none || known < item) &&
         !shared.compare_exchange_weak(known, item, std::memory_order_relaxed)) {
  }
}

}  // namespace collarmesh
