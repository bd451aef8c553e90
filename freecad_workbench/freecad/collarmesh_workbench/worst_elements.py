"""The tetrahedra with the smallest and largest dihedral angles."""

import numpy

from . import places
from .translations import translate


def tetrahedra(fem_mesh):
    """Returns element numbers, shape (n,), and their corners, shape (n, 4, 3), in mm."""
    numbers = [n for n in fem_mesh.Volumes if len(fem_mesh.getElementNodes(n)) in (4, 10)]
    nodes = fem_mesh.Nodes
    node_numbers, places_of_nodes = numpy.array(list(nodes)), numpy.array([tuple(p) for p in nodes.values()])
    row = numpy.zeros(node_numbers.max(initial=0) + 1, dtype=int)
    row[node_numbers] = numpy.arange(len(node_numbers))
    corners = numpy.array([fem_mesh.getElementNodes(n)[:4] for n in numbers], dtype=int).reshape(-1, 4)
    return numpy.array(numbers, dtype=int), places_of_nodes[row[corners]]


def smallest_dihedral_angles(corners):
    """Returns angles in degrees, shape (n,), for corners of shape (n, 4, 3)."""
    normals = []
    for a, b, c, opposite in ((1, 2, 3, 0), (0, 3, 2, 1), (0, 1, 3, 2), (0, 2, 1, 3)):
        normal = numpy.cross(corners[:, b] - corners[:, a], corners[:, c] - corners[:, a])
        outward = numpy.sign(numpy.einsum("ij,ij->i", normal, corners[:, a] - corners[:, opposite]))
        normals.append(normal * (outward / numpy.maximum(numpy.linalg.norm(normal, axis=1), 1e-300))[:, None])
    largest = numpy.full(len(corners), -1.0)
    for i in range(4):
        for j in range(i):
            cosine = -numpy.einsum("ij,ij->i", normals[i], normals[j])
            largest = numpy.maximum(largest, cosine)
    return numpy.degrees(numpy.arccos(numpy.clip(largest, -1, 1)))


def worst(fem_mesh, count=20):
    """Returns numbers, angles and corners of the `count` tetrahedra with the smallest dihedral angles, worst first."""
    numbers, corners = tetrahedra(fem_mesh)
    angles = smallest_dihedral_angles(corners)
    order = numpy.argsort(angles, kind="stable")[:count]
    return numbers[order], angles[order], corners[order]


MOST = 100000  # largest number of elements of a mesh that is searched; larger ones take too long


def in_report(fem_mesh, report):
    """Returns the worst tetrahedra, as the report of a run lists them, as Places."""
    numbers = fem_mesh.Volumes
    text = translate("collarmesh", "{smallest}° to {largest}° in element {number}")
    return [places.Place(places.WORST, text.format(smallest=f"{each['smallest']:.1f}", largest=f"{each['largest']:.1f}",
                                                   number=numbers[each["tet"]]),
                         (), (), numpy.array([each["corners"]])) for each in report.get("worst", ())]


def in_mesh(fem_mesh):
    """Returns the worst tetrahedra of a mesh without a report, unless it is large."""
    if not 0 < fem_mesh.VolumeCount <= MOST:
        return []
    text = translate("collarmesh", "{angle}° in element {number}")
    return [places.Place(places.WORST, text.format(angle=f"{angle:.1f}", number=number), (), (), corners[None])
            for number, angle, corners in zip(*worst(fem_mesh))]
