#pragma once

/// Constants that several stages share, or a stage and the certificate.
namespace collarmesh {

/// Least ratio of the gap size at the centre of a ball to the ball's radius (paper, Procedure 4).
constexpr double gap_per_radius = 3;

/// Largest dihedral and face angle of thin tets, degrees.
constexpr double largest_angle_of_thin_tets = 150;

/// Largest values that callers may set: `Bounds::thin_angle` (degrees), `Bounds::reserve`, and the level of
/// improvement.
constexpr double largest_thin_angle = 30, largest_reserve = 0.5;
constexpr unsigned highest_improve_level = 3;

}  // namespace collarmesh
