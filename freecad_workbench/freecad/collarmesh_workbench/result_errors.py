"""The error of a finite element solution, estimated from its strains, and target edge lengths that even it out. Works
without FreeCAD.

Zienkiewicz and Zhu, A simple error estimator and adaptive procedure for practical engineering analysis, 1987. The
Python package collarmesh does the same for fields on nodes; the add-on does not need that package."""

import dataclasses

import numpy

# The mean volume of the tetrahedra in a mesh with a target edge length, relative to the cube of that length.
VOLUME_PER_CUBE = 0.125
FINEST, COARSEST = 0.25, 2.0  # least and greatest ratio of the next edge lengths to the present ones
MIDDLES = ((0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3))  # ends of the edges of nodes 5 to 10
STEPS = 80  # of bisection


@dataclasses.dataclass
class Solution:
    """Displacements on a mesh of tetrahedra. Lengths are mm, moduli MPa."""

    points: numpy.ndarray  # (n, 3)
    tets: numpy.ndarray  # (m, 4) or (m, 10): points of each tetrahedron, in FreeCAD's order
    displacements: numpy.ndarray  # (n, 3)
    materials: numpy.ndarray  # (m,): number of the material of each tetrahedron
    moduli: numpy.ndarray  # (k, 2): Young's modulus and Poisson's ratio of each material

    @property
    def order(self):
        return 1 if self.tets.shape[1] == 4 else 2

    @property
    def corners(self):
        return self.tets[:, :4]


@dataclasses.dataclass
class Errors:
    """Estimated errors in the energy norm."""

    of_tets: numpy.ndarray  # (m,); their squares add up
    energy_norm: float  # of the solution

    @property
    def relative(self):
        """Returns the error of the whole solution relative to the norm of the exact solution, which is
        estimated; from 0 to 1."""
        squares = float((self.of_tets**2).sum())
        return (squares / (squares + self.energy_norm**2)) ** 0.5 if squares else 0.0

    def absolute(self, relative):
        """Returns the absolute error for an error relative to the exact solution's norm, which is
        estimated."""
        return relative * (float((self.of_tets**2).sum()) + self.energy_norm**2) ** 0.5


def volumes(solution):
    a, b, c, d = numpy.moveaxis(solution.points[solution.corners], 1, 0)
    return abs(numpy.einsum("ij,ij->i", b - a, numpy.cross(c - a, d - a))) / 6


def strains(solution):
    """Returns the strains at the corners of each tetrahedron, shape (m, 4, 3, 3). Edges count as straight."""
    corners = solution.points[solution.corners]
    slopes = numpy.linalg.inv(corners[:, 1:] - corners[:, :1]).transpose(0, 2, 1)
    slopes = numpy.concatenate([-slopes.sum(axis=1, keepdims=True), slopes],
                               axis=1)  # gradients of barycentric coordinates
    values = solution.displacements[solution.tets]
    if solution.order == 1:
        gradients = numpy.repeat(numpy.einsum("mia,mib->mab", values, slopes)[:, None], 4, axis=1)
    else:
        # At corner k the shape function of corner i has the slope 4 L_i - 1, that of edge ij 4 L_j (grad L_i) + 4 L_i
        # (grad L_j).
        factors = 4 * numpy.eye(4) - 1
        gradients = numpy.einsum("mia,ki,mib->mkab", values[:, :4], factors, slopes)
        for node, (i, j) in enumerate(MIDDLES, 4):
            for at, other in ((i, j), (j, i)):
                gradients[:, at] += 4 * values[:, node, :, None] * slopes[:, other, None, :]
    return (gradients + gradients.transpose(0, 1, 3, 2)) / 2


def means_at_points(corners, weights, values, count):
    """Returns the weighted means of values at the corners of tetrahedra, shape (m, 4, k), over the tetrahedra around
    each of `count` points; NaN at points without any."""
    flat, weight = corners.ravel(), numpy.repeat(weights, 4)
    total = numpy.bincount(flat, weight, count)
    with numpy.errstate(invalid="ignore"):
        return numpy.stack([numpy.bincount(flat, weight * each, count) / total
                            for each in values.reshape(len(flat), -1).T], axis=1)


def recovered(solution, strain, weights):
    """Returns the mean strain of the tetrahedra of one material around each corner, shape (m, 4, 3, 3)."""
    result = numpy.empty_like(strain)
    for material in numpy.unique(solution.materials):
        here = solution.materials == material
        corners = solution.corners[here]
        means = means_at_points(corners, weights[here], strain[here].reshape(-1, 4, 9), len(solution.points))
        result[here] = means.reshape(-1, 3, 3)[corners]
    return result


def energies(solution, strain, size):
    """Returns twice the energy in each tetrahedron of strains that are linear between the corners."""
    modulus, ratio = solution.moduli[solution.materials].T
    shear = modulus / (2 * (1 + ratio))
    lame = modulus * ratio / ((1 + ratio) * (1 - 2 * ratio))
    traces = numpy.trace(strain, axis1=2, axis2=3)

    def integral(values):  # integrates the square of a linear function
        flat = values.reshape(len(values), 4, -1)
        return size / 20 * ((flat**2).sum(axis=(1, 2)) + (flat.sum(axis=1) ** 2).sum(axis=1))

    return 2 * shear * integral(strain) + lame * integral(traces)


def estimate(solution):
    """Returns the Errors of a solution."""
    size, strain = volumes(solution), strains(solution)
    off = recovered(solution, strain, size) - strain
    return Errors(numpy.sqrt(energies(solution, off, size)), float(energies(solution, strain, size).sum()) ** 0.5)


class Sizes:
    """Target edge lengths for the next mesh, with which every tetrahedron has the same error: this takes the fewest
    tetrahedra. Each length is within FINEST and COARSEST times the present one."""

    def __init__(self, solution, errors):
        self.solution, self.errors, self.volumes = solution, errors, volumes(solution)
        self._power = solution.order + 1.5  # the error of one tetrahedron grows with this power of its edges
        greatest = errors.of_tets.max(initial=0)
        self._known = numpy.maximum(errors.of_tets, 1e-12 * greatest if greatest > 0 else 1)

    def _factors(self, goal):
        return numpy.clip((goal / self._known) ** (1 / self._power), FINEST, COARSEST)

    def _goal(self, is_too_fine):
        """Returns the factors for the error of one tetrahedron at which `is_too_fine(factors)` changes from true to
        false."""
        low = self._known.min() * FINEST**self._power
        high = self._known.max() * COARSEST**self._power
        for _ in range(STEPS):
            middle = (low * high) ** 0.5
            low, high = (middle, high) if is_too_fine(self._factors(middle)) else (low, middle)
        return self._factors((low * high) ** 0.5)

    def count(self, factors):
        """Predicts the number of tetrahedra."""
        return float((factors**-3.0).sum())

    def error(self, factors):
        """Predicts the relative error."""
        squares = float((self.errors.of_tets**2 * factors ** (2.0 * self.solution.order)).sum())
        return min(1.0, squares**0.5 / self.errors.absolute(1)) if squares else 0.0

    def for_elements(self, elements):
        """Returns the factors of the edge lengths for a number of tetrahedra."""
        return self._goal(lambda factors: self.count(factors) > elements)

    def for_error(self, relative):
        """Returns the factors of the edge lengths for a relative error, 0 to 1."""
        return self._goal(lambda factors: self.error(factors) < relative)

    def at_points(self, factors):
        """Returns the edge length at each point of the mesh; NaN at points that are no corners."""
        wanted = numpy.cbrt(self.volumes / VOLUME_PER_CUBE) * factors
        logarithms = numpy.repeat(numpy.log(wanted)[:, None, None], 4, axis=1)
        count = len(self.solution.points)
        lengths = numpy.exp(means_at_points(self.solution.corners, self.volumes, logarithms, count)[:, 0])
        # Means at the points even out lengths, which changes the number of tetrahedra; the factor restores this number.
        made = (self.volumes / lengths[self.solution.corners].mean(axis=1) ** 3).sum()
        return lengths * numpy.cbrt(made / (self.volumes / wanted**3).sum())
