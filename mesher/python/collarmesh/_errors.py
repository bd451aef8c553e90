"""Sizes for the next mesh from the errors of a solution on this one."""

from typing import Optional

import numpy

from ._core import OptionError
from ._inputs import Array, ArrayLike, one_for_each
from ._mesh import Mesh

# The mean volume of the tetrahedra of a mesh that was made for a target edge length, as a share of the
# length's cube.
_VOLUME_PER_CUBE = 0.125


def _volumes(mesh: Mesh) -> Array:
    a, b, c, d = numpy.moveaxis(mesh.points[mesh.tets], 1, 0)
    volumes: Array = abs(numpy.einsum("ij,ij->i", b - a, numpy.cross(c - a, d - a))) / 6
    return volumes


def _at_points(mesh: Mesh, weights: Array, values: Array) -> Array:
    """The weighted mean of the values of the tetrahedra around each point; 0 at points without one."""
    sums = numpy.zeros((len(mesh.points), values.shape[1]))
    total = numpy.zeros(len(mesh.points))
    for corner in mesh.tets.T:
        numpy.add.at(sums, corner, weights[:, None] * values)
        numpy.add.at(total, corner, weights)
    means: Array = sums / numpy.where(total > 0, total, 1)[:, None]
    return means


def estimated_errors(mesh: Mesh, values: ArrayLike) -> Array:
    """An estimate of the error of a solution that is linear in each tetrahedron: how far its gradient is from the mean of the
    gradients around (Zienkiewicz and Zhu 1987), as the root of the integral of the square over the tetrahedron.

    values: (n,) or (n, k), the solution at the points of the mesh, such as a temperature or displacements.

    Returns (m,), one for each tetrahedron. Raises OptionError for wrong shapes.
    """
    given = numpy.asarray(values, dtype=numpy.float64)
    one_for_each(given.reshape(-1, 1) if given.ndim == 0 else given, len(mesh.points), "values", "point")
    field = given.reshape(len(mesh.points), -1)
    corners = mesh.points[mesh.tets]
    edges = corners[:, 1:] - corners[:, :1]
    rises = field[mesh.tets[:, 1:]] - field[mesh.tets[:, :1]]
    gradients = numpy.linalg.solve(edges, rises).reshape(len(mesh.tets), -1)
    volumes = _volumes(mesh)
    recovered = _at_points(mesh, volumes, gradients)[mesh.tets]
    off = recovered - gradients[:, None]
    # The exact integral of the square of a function that is linear between the corners.
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
    """Target edge lengths for a next mesh on which all tetrahedra have the same error: the fewest tetrahedra for an error, and
    the least error for a number of them.

    errors: (m,), of each tetrahedron, such as indicators of a solver or `estimated_errors`: roots of sums of squares, which
        add up in squares. For indicators that are squares already, give their roots.
    elements: the number of tetrahedra to aim at; or error: the root of the sum of the squares of all errors to aim at.
    order: of the elements of the solution, by which its error falls with the lengths.
    finest, coarsest: the next lengths over those of this mesh, at least and at most.

    Returns (n,), a length for each point of the mesh, for `Mesh.adapt` and for `size_field=(mesh, lengths)`. Raises OptionError
    for wrong shapes and values.
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
    power = order + 1.5  # the error of one tetrahedron falls with this power of its length
    known = numpy.maximum(given, 1e-12 * given.max() if given.max() > 0 else 1)

    def factors(goal: float) -> Array:
        return numpy.clip((goal / known) ** (1 / power), finest, coarsest)

    def excess(goal: float) -> float:
        """Returns the excess of tetrahedra, or the lack of error; it falls as each one may have more error."""
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
    at_points = numpy.exp(_at_points(mesh, volumes, numpy.log(wanted)[:, None])[:, 0])
    # The mean at the points evens out lengths, which changes how many tetrahedra they make.
    made = (volumes / at_points[mesh.tets].mean(axis=1) ** 3).sum()
    sizes: Array = at_points * numpy.cbrt(made / (volumes / wanted**3).sum())
    return sizes
