"""The tetrahedra with the smallest dihedral angles, and how they are shown in the 3D view."""

import numpy


def tetrahedra(fem_mesh):
    """Element numbers, shape (n,), and their corners, shape (n, 4, 3), in mm."""
    numbers = [n for n in fem_mesh.Volumes if len(fem_mesh.getElementNodes(n)) in (4, 10)]
    places = {node: tuple(place) for node, place in fem_mesh.Nodes.items()}
    corners = [[places[node] for node in fem_mesh.getElementNodes(n)[:4]] for n in numbers]
    return numpy.array(numbers, dtype=int), numpy.array(corners, dtype=float).reshape(-1, 4, 3)


def smallest_dihedral_angles(corners):
    """In degrees, shape (n,), for corners of shape (n, 4, 3)."""
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
    """Numbers, angles and corners of the worst tetrahedra, the worst first."""
    numbers, corners = tetrahedra(fem_mesh)
    angles = smallest_dihedral_angles(corners)
    order = numpy.argsort(angles, kind="stable")[:count]
    return numbers[order], angles[order], corners[order]


class Highlight:
    """Tetrahedra in red, over a mesh that is made transparent for as long."""

    def __init__(self, view, corners):
        from pivy import coin

        self.view = view
        self.transparency = view.Transparency
        view.Transparency = 85
        self.node = coin.SoSeparator()
        self.node.setName("collarmesh_worst_elements")
        colour = coin.SoMaterial()
        colour.diffuseColor = (0.9, 0.1, 0.1)
        colour.emissiveColor = (0.5, 0, 0)
        points = coin.SoCoordinate3()
        points.point.setValues(0, corners.size // 3, corners.reshape(-1, 3).tolist())
        faces = coin.SoIndexedFaceSet()
        indices = []
        for first in range(0, corners.size // 3, 4):
            for a, b, c in ((0, 1, 2), (0, 1, 3), (0, 2, 3), (1, 2, 3)):
                indices += [first + a, first + b, first + c, -1]
        faces.coordIndex.setValues(0, len(indices), indices)
        for each in (colour, points, faces):
            self.node.addChild(each)
        view.RootNode.addChild(self.node)

    def remove(self):
        self.view.RootNode.removeChild(self.node)
        self.view.Transparency = self.transparency
