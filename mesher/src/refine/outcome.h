#pragma once

#include <string>

#include "collarmesh/mesher.h"
#include "refine/frame.h"

namespace collarmesh {

/// What a refinement comes to. Parts report here what they could not guarantee; the loop asks.
/// Invariant: of several messages the first one is kept, unless the refinement is stopped.
class Outcome {
 public:
  static constexpr const char* advice_at_floor =
      "look for features there that nearly touch or meet at a small angle; a larger crease-angle gives "
      "such a meeting a collar";

  explicit Outcome(const Frame& frame) : frame_(frame) {}

  /// Something could not be done. `next`: what the user can do. The refinement goes on: the loop works off
  /// the queue, checks nothing any more and returns `guarantee_missed`.
  void give_up(const Point& where, const std::string& what, const std::string& next);
  /// The refinement ends with this status, whatever else was reported: the loop returns, there is no mesh.
  void stop(MeshStatus status, const Point& where, const std::string& what, const std::string& next);

  bool given_up() const { return !message_.empty(); }
  bool stopped() const { return status_ != MeshStatus::complete; }
  /// `complete` unless it was stopped.
  MeshStatus status() const { return status_; }
  const std::string& message() const { return message_; }
  /// In the frame.
  const Point& where() const { return where_; }

 private:
  const Frame& frame_;
  MeshStatus status_ = MeshStatus::complete;
  std::string message_;
  Point where_;
};

}  // namespace collarmesh
