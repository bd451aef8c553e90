#pragma once

#include <string>

#include "collarmesh/mesher.h"
#include "refine/frame.h"

namespace collarmesh {

/// The outcome of a refinement. Parts report here what they could not guarantee; the loop queries it.
/// Invariant: of several messages the first one is kept, but that of `stop` replaces any other.
class Outcome {
 public:
  static constexpr const char* advice_at_floor =
      "look for features there that nearly touch or meet at a small angle; with a larger "
      "crease-angle, features that meet there get a collar";

  explicit Outcome(const Frame& frame) : frame_(frame) {}

  /// Reports a missed guarantee. `next` tells what the user can do. The refinement continues: the loop
  /// finishes the queue, makes no more checks and returns `guarantee_missed`.
  void give_up(const Point& where, const std::string& what, const std::string& next);
  /// Ends the refinement with this status, whatever was reported before: the loop returns without a mesh.
  void stop(MeshStatus status, const Point& where, const std::string& what, const std::string& next);

  bool given_up() const { return !message_.empty(); }
  bool stopped() const { return status_ != MeshStatus::complete; }
  /// Returns the status: `complete` unless the refinement was stopped.
  MeshStatus status() const { return status_; }
  const std::string& message() const { return message_; }
  /// Returns the place that the message is about, in the frame.
  const Point& where() const { return where_; }

 private:
  const Frame& frame_;
  MeshStatus status_ = MeshStatus::complete;
  std::string message_;
  Point where_;
};

}  // namespace collarmesh
