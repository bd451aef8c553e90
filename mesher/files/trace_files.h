#pragma once

#include <string>

#include "collarmesh/trace.h"

namespace collarmesh::files {

/// Returns the path, in this folder, of the file that lists the steps of a trace; empty without a folder.
std::string trace_file(const std::string& folder);

/// Writes the steps of a run beside `path`, a .pvd file, which lists them with their numbers as times:
/// 00_box.vtu, 01_refine.vtu and so on. Cells of a step are tets, triangles of the restricted surface,
/// segments of curves, and the centres of balls. Cell arrays, with a value for every cell:
///   kind                                     0 tet, 1 patch, 2 collar surface, 3 segment, 4 ball
///   region, state                            of tets, see TraceStep
///   tag                                      of patches and curves
///   reason                                   of balls, see BallReason
///   radius_edge, min_dihedral, max_dihedral  of tets; 0 for others
/// Point arrays: feature_dimension; radius, that of the ball around a centre, 0 for other points.
/// Throws WriteError.
void write_trace(const std::string& path, const Trace& trace);

}  // namespace collarmesh::files
