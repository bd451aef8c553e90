#!/usr/bin/env python3
"""Meshes one CAD file or STL surface with Netgen: netgen_part.py INPUT OUT SIZE

Writes a Gmsh 2.2 file of the tetrahedra and triangles; tags are the numbers of their solids and faces. The coordinates
have all digits. Netgen's own export has only six digits, which moves nodes off the shape."""

from __future__ import annotations

import sys

import meshio
import netgen.meshing
import numpy as np
from netgen import NgOCC, stl


def corners(elements) -> np.ndarray:
    return np.array([[vertex.nr for vertex in element.vertices] for element in elements]) - 1


def main() -> None:
    path, out, size = sys.argv[1], sys.argv[2], float(sys.argv[3])
    kind = stl if path.lower().endswith(".stl") else NgOCC
    geometry = kind.LoadSTLGeometry(path) if kind is stl else kind.LoadOCCGeometry(path)
    mesh = kind.GenerateMesh(geometry, netgen.meshing.MeshingParameters(maxh=size))
    points = np.array([point.p for point in mesh.Points()])
    tets, triangles = mesh.Elements3D(), mesh.Elements2D()
    tags = [np.array([element.index for element in elements]) for elements in (tets, triangles)]
    if len(tets) == 0:
        sys.exit("error: Netgen made no tetrahedra")
    data = {"gmsh:physical": tags, "gmsh:geometrical": tags}
    meshio.write(out, meshio.Mesh(points, [("tetra", corners(tets)), ("triangle", corners(triangles))], cell_data=data),
                 file_format="gmsh22", binary=False)


if __name__ == "__main__":
    main()
