#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "collarmesh/geometry.h"

namespace collarmesh {

/// The reason why a ball was placed.
enum class BallReason : std::uint8_t {
  unknown,
  subsegment,       ///< protects a piece of a curve that must not be split
  up_front,         ///< a collar ball of a run that places all of them before the first vertex
  vertex_inserted,  ///< a collar ball: its crease vertex was inserted
  vertex_isolated,  ///< a collar ball: the cell of its crease vertex meets only features that contain the
                    ///< vertex
  curve_isolated,   ///< a collar ball: cells along its crease curve meet only features that contain the curve
  curve_would_divide,  ///< a collar ball: without it, a subsegment of its crease curve would have been split
  curve_left           ///< a collar ball: its crease curve had no balls yet when all other work was done
};

/// The state of a run at one moment.
struct TraceStep {
  enum class State : std::uint8_t {
    outside,  ///< outside all regions
    region,
    ripped,  ///< inside a collar; removed when the collar is stitched
    star,
    book,
    thin
  };
  struct Triangle {
    std::array<Index, 3> corners;
    Tag tag;              ///< tag of the patch that it represents
    bool collar = false;  ///< part of the collar surface; the tag is 0
  };
  struct Segment {
    std::array<Index, 2> ends;
    Tag tag;  ///< tag of the curve
  };
  struct Ball {
    Point centre;
    double radius;
    BallReason reason;
  };

  std::string stage;          ///< the stage, such as box, refine, rip, stitch, coarsen, improve or project
  std::string detail;         ///< a line for display; may be empty
  std::vector<Point> points;  ///< vertices, and ends of segments that are not vertices yet
  std::vector<std::uint8_t> dimension;  ///< dimension of the feature that each point lies on; 3: none
  std::vector<std::array<Index, 4>> tets;
  std::vector<Index> region;  ///< region of each tet, 0 outside
  std::vector<State> state;   ///< state of each tet
  std::vector<Triangle> triangles;
  std::vector<Segment> segments;
  std::vector<Ball> balls;
};

using Trace = std::vector<TraceStep>;

}  // namespace collarmesh
