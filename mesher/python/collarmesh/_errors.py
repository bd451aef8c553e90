"""Target edge lengths for the next mesh, from the errors of a solution on this one."""

from typing import Optional

import numpy

from ._core import OptionError
from ._inputs import Array, ArrayLike, one_for_each
from ._mesh import Mesh

# The mean volume of the tetrahedra in a mesh with a target edge length, relative to the cube of that length.
_VOLUME_PER_CUBE = 0.125


def _volumes(mesh: Mesh) -> Array:
    a, b, c, d = numpy.moveaxis(mesh.points[mesh.tets], 1, 0)
    volumes: Array = abs(numpy.einsum("ij,ij->i", b - a, numpy.cross(c - a, d - a))) / 6
    return volumes


def _at_corners(corners: Array, weights: Array, values: Array) -> Array:
    """Returns, for each corner number, the weighted mean of the values of the tetrahedra with this corner; NaN if there
    are none.

    corners: (m, 4). weights: (m,). values: (m, k).
    """
    count = int(corners.max(initial=-1)) + 1
    sums = numpy.zeros((count, values.shape[1]))
    total = numpy.zeros(count)
    for corner in corners.T:
        numpy.add.at(sums, corner, weights[:, None] * values)
        numpy.add.at(total, corner, weights)
    means: Array = sums / numpy.where(total > 0, total, numpy.nan)[:, None]
    return means


def _corners_by_material(mesh: Mesh) -> Array:
    """Returns numbers for the corners of tetrahedra; a point has one number for each material that meets there."""
    materials = numpy.unique(mesh.tet_tag, return_inverse=True)[1] if len(
        mesh.tet_tag) else numpy.zeros(len(mesh.tets), int)
    pairs = mesh.tets.astype(numpy.int64) + len(mesh.points) * materials.reshape(-1, 1)
    numbers: Array = numpy.unique(pairs, return_inverse=True)[1].reshape(pairs.shape)
    return numbers


def _set_mid_nodes(mesh: Mesh, values: Array) -> None:
    """Sets the values of mid-edge nodes to the mean of those at the ends of their edges."""
    if len(mesh.tet_mid_nodes) == 0:
        return
    for nodes, (a, b) in zip(mesh.tet_mid_nodes.T, ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))):
        values[nodes] = (values[mesh.tets[:, a]] + values[mesh.tets[:, b]]) / 2


def estimated_errors(mesh: Mesh, values: ArrayLike, *, across_regions: bool = False) -> Array:
    """Estimate the error of a solution that is linear in each tetrahedron (Zienkiewicz and Zhu 1987): the L2 norm over
    each tetrahedron of the difference between the solution's gradient and its means at the corners, interpolated.

    values: (n,) or (n, k), the solution at the points of the mesh, such as a temperature or displacements.
    across_regions: if False, only tetrahedra with the same `tet_tag` contribute to a mean, because gradients jump
        between materials. Pass True if all tags stand for one material.

    Returns (m,), one for each tetrahedron. Raises OptionError for wrong shapes and flat tetrahedra.
    """
    given = numpy.asarray(values, dtype=numpy.float64)
    one_for_each(given.reshape(-1, 1) if given.ndim == 0 else given, len(mesh.points), "values", "point")
    field = given.reshape(len(mesh.points), -1)
    corners = mesh.points[mesh.tets]
    edges = corners[:, 1:] - corners[:, :1]
    rises = field[mesh.tets[:, 1:]] - field[mesh.tets[:, :1]]
    try:
        gradients = numpy.linalg.solve(edges, rises).reshape(len(mesh.tets), -1)
    except numpy.linalg.LinAlgError:
        flat = int(numpy.argmin(abs(numpy.linalg.det(edges))))
        raise OptionError(f"tetrahedron {flat} at {corners[flat].mean(axis=0)} is flat, so that the solution has no "
                          "gradient in it; remesh without a size first, which mends flat tetrahedra") from None
    volumes = _volumes(mesh)
    around = mesh.tets if across_regions else _corners_by_material(mesh)
    recovered = _at_corners(around, volumes, gradients)[around]
    off = recovered - gradients[:, None]
    # Uses the exact integral of the square of a function that is linear between the corners.
    squares = (off**2).sum(axis=(1, 2)) + (off.sum(axis=1) ** 2).sum(axis=1)
    errors: Array = numpy.sqrt(volumes * squares / 20)
    return errors


def sizes_from_errors(
    mesh: Mesh,
    errors: ArrayLike,
    *,
    elements: Optional[float] = None,
    error: Optional[float] = None,
    order: int = 1,
    finest: float = 0.25,
    coarsest: float = 2.0,
) -> Array:
    """Return target edge lengths for the next mesh such that all its tetrahedra have the same error. This takes the
    fewest tetrahedra for a given error, and makes the least error for a given number of tetrahedra.

    errors: (m,), the error of each tetrahedron, from `estimated_errors` or a solver's indicators: norms, whose squares
        add up. If indicators are squares already, pass their square roots.
    elements: the number of tetrahedra to aim for; or error: the total error to aim for, the root of the sum of squares.
    order: order of the solution's elements, which determines how fast its error falls with the lengths.
    finest, coarsest: least and greatest ratio of the next lengths to those of this mesh.

    Returns (n,), a length for each point of the mesh, for `Mesh.adapt` and for `size_field=(mesh, lengths)`. Raises
    OptionError for wrong shapes and values.
    """
    given = one_for_each(numpy.asarray(errors, dtype=numpy.float64), len(mesh.tets), "errors", "tetrahedron")
    if given.ndim != 1 or not (numpy.isfinite(given) & (given >= 0)).all():
        raise OptionError("errors must be an array of shape (m,) of numbers that are not negative")
    if (elements is None) == (error is None) or not (elements or error or 0) > 0:
        raise OptionError("give either elements or error, a positive number")
    if not 0 < finest <= 1 <= coarsest:
        raise OptionError(f"finest must be above 0 and at most 1, coarsest at least 1, not {finest!r} and {coarsest!r}")
    volumes = _volumes(mesh)
    lengths = numpy.cbrt(volumes / _VOLUME_PER_CUBE)
    power = order + 1.5  # the error of one tetrahedron is proportional to this power of its edge length
    known = numpy.maximum(given, 1e-12 * given.max() if given.max() > 0 else 1)

    def factors(goal: float) -> Array:
        return numpy.clip((goal / known) ** (1 / power), finest, coarsest)

    def excess(goal: float) -> float:
        """Returns by how much the number of tetrahedra exceeds `elements`, or the square of the total error falls
        short of the square of `error`. The result decreases with `goal`, the error per tetrahedron."""
        factor = factors(goal)
        if elements is not None:
            return float((factor**-3.0).sum() - elements)
        assert error is not None
        return float(error**2 - (given**2 * factor ** (2.0 * order)).sum())

    low, high = known.min() * finest**power, known.max() * coarsest**power
    for _ in range(100):
        middle = numpy.sqrt(low * high)
        low, high = (middle, high) if excess(middle) > 0 else (low, middle)
    wanted = lengths * factors(numpy.sqrt(low * high))
    at_points = numpy.full(len(mesh.points), lengths.mean())
    means = numpy.exp(_at_corners(mesh.tets, volumes, numpy.log(wanted)[:, None])[:, 0])
    at_points[: len(means)] = numpy.where(numpy.isnan(means), at_points[: len(means)], means)
    _set_mid_nodes(mesh, at_points)
    # Averaging at the points evens out lengths, which changes the number of tetrahedra.
    made = (volumes / at_points[mesh.tets].mean(axis=1) ** 3).sum()
    sizes: Array = at_points * numpy.cbrt(made / (volumes / wanted**3).sum())
    return sizes
