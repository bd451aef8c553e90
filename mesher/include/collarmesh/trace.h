#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "collarmesh/geometry.h"

namespace collarmesh {

/// The reason why a ball is there.
enum class BallReason : std::uint8_t {
  unknown,
  subsegment,          ///< protects a piece of a curve that is not split
  up_front,            ///< of a collar: all are placed before the first vertex
  vertex_inserted,     ///< of a collar: its crease vertex came in
  vertex_isolated,     ///< of a collar: the cell of its crease vertex meets no other feature
  curve_isolated,      ///< of a collar: the cells along its crease curve meet no other feature
  curve_would_divide,  ///< of a collar: a subsegment of its crease curve would be split
  curve_left           ///< of a collar: its crease curve had none when nothing else was left to do
};

/// What a run has at one moment.
struct TraceStep {
  enum class State : std::uint8_t {
    outside,  ///< of all regions
    region,
    ripped,  ///< inside a collar: it goes when the collar is stitched
    star,
    book,
    thin
  };
  struct Triangle {
    std::array<Index, 3> corners;
    Tag tag;              ///< of the patch that it represents
    bool collar = false;  ///< of the collar surface; the tag is 0
  };
  struct Segment {
    std::array<Index, 2> ends;
    Tag tag;  ///< of the curve
  };
  struct Ball {
    Point centre;
    double radius;
    BallReason reason;
  };

  std::string stage;                    ///< box, refine, rip, stitch, coarsen, improve, project
  std::string detail;                   ///< for people; may be empty
  std::vector<Point> points;            ///< vertices, and ends of segments that are no vertices yet
  std::vector<std::uint8_t> dimension;  ///< of the feature that each point lies on; 3: none
  std::vector<std::array<Index, 4>> tets;
  std::vector<Index> region;  ///< of each tet, 0 outside
  std::vector<State> state;   ///< of each tet
  std::vector<Triangle> triangles;
  std::vector<Segment> segments;
  std::vector<Ball> balls;
};

using Trace = std::vector<TraceStep>;

}  // namespace collarmesh
