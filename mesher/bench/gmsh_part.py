#!/usr/bin/env python3
"""Meshes one CAD file or surface with Gmsh's HXT at a twentieth of its diagonal: gmsh_part.py INPUT OUT [ORDER]

OpenCASCADE opens CAD files. A surface (.stl) is cut into patches at angles above 40 degrees, parametrized and filled.
Prints the volume of a CAD file's solids. Errors of Gmsh end the program with exit code 1."""

from __future__ import annotations

import math
import sys
from pathlib import Path

import gmsh

cad_suffixes = (".step", ".stp", ".brep", ".iges", ".igs")


def open_cad(path: str) -> None:
    gmsh.model.occ.importShapes(path)
    gmsh.model.occ.synchronize()
    solids = gmsh.model.getEntities(3)
    if not solids:
        raise ValueError("no solid")
    print(f"volume of the solids {sum(gmsh.model.occ.getMass(*solid) for solid in solids):.9g}")


def open_surface(path: str) -> None:
    gmsh.merge(path)
    gmsh.model.mesh.classifySurfaces(math.radians(40), True, True, math.pi)
    gmsh.model.mesh.createGeometry()
    loop = gmsh.model.geo.addSurfaceLoop([tag for _, tag in gmsh.model.getEntities(2)])
    gmsh.model.geo.addVolume([loop])
    gmsh.model.geo.synchronize()


def diagonal() -> float:
    box = gmsh.model.getBoundingBox(-1, -1)
    return math.dist(box[:3], box[3:])


def mesh(path: str, out: str, order: int) -> None:
    gmsh.option.setNumber("General.NumThreads", 1)
    gmsh.option.setNumber("Mesh.Algorithm3D", 10)   # HXT
    (open_cad if Path(path).suffix.lower() in cad_suffixes else open_surface)(path)
    size = diagonal() / 20
    gmsh.option.setNumber("Mesh.MeshSizeMin", size)
    gmsh.option.setNumber("Mesh.MeshSizeMax", size)
    gmsh.model.mesh.generate(3)
    gmsh.model.mesh.setOrder(order)
    gmsh.write(out)


def main() -> int:
    gmsh.initialize(["gmsh"])
    try:
        mesh(sys.argv[1], sys.argv[2], int(sys.argv[3]) if len(sys.argv) > 3 else 1)
    except Exception as error:   # Gmsh's module has no exception type of its own
        print(f"error: {error}")
        return 1
    finally:
        gmsh.finalize()
    return 0


if __name__ == "__main__":
    sys.exit(main())
