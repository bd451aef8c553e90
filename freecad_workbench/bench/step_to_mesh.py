"""Measures the time from a STEP file to a mesh in FreeCAD, by collarmesh and by FreeCAD's Gmsh tools, in turns.

    tests/freecad/run.py PROGRAM freecad_workbench/bench/step_to_mesh.py [-- FILE.step]

For each mesher, a size is first chosen with which it makes 85k to 115k tetrahedra. Times include all that a user waits
for: reading the STEP file, making the object, meshing, putting the mesh into the document.
Without a file, the part is a plate with twelve holes.
"""

import os
import statistics
import sys
import tempfile
import time
import traceback

import FreeCAD
import ObjectsFem
import Part
from femmesh import gmshtools
from freecad import collarmesh_workbench

TETS = 100_000
NEAR = 0.15  # relative difference from TETS that is allowed
ROUNDS = 3


def plate(path):
    shape = Part.makeBox(80, 60, 10)
    for i in range(4):
        for j in range(3):
            shape = shape.cut(Part.makeCylinder(4, 10, FreeCAD.Vector(10 + 20 * i, 10 + 20 * j, 0)))
    shape.exportStep(path)  # no fillets: small ones make Gmsh's meshes too fine at any size (default for curvature)


def by_collarmesh(document, part, size):
    return collarmesh_workbench.mesh(part, document=document, size=size)


def by_gmsh(document, part, size):
    obj = ObjectsFem.makeMeshGmsh(document, "Gmsh")
    obj.Part = part
    obj.CharacteristicLengthMax = size
    obj.ElementOrder = "1st"
    gmshtools.GmshTools(obj).create_mesh()
    return obj


def run(mesher, path, size):
    """Makes a mesh. Returns the time in seconds and the number of tetrahedra."""
    begin = time.perf_counter()
    document = FreeCAD.newDocument("bench")
    part = document.addObject("Part::Feature", "Part")
    part.Shape = Part.read(path)
    count = mesher(document, part, size).FemMesh.VolumeCount
    seconds = time.perf_counter() - begin
    FreeCAD.closeDocument(document.Name)
    return seconds, count


def fitting_size(mesher, path):
    size = Part.read(path).BoundBox.DiagonalLength / 60
    for _ in range(12):
        seconds, count = run(mesher, path, size)
        print(f"trial {mesher.__name__}: size {size:.3g} mm, {count} tets, {seconds:.2f} s", flush=True)
        if abs(count / TETS - 1) < NEAR:
            return size
        size *= (count / TETS) ** (1 / 3)
    raise RuntimeError(f"no size gives about {TETS} tetrahedra")


def main(path):
    meshers = {"collarmesh": by_collarmesh, "Gmsh": by_gmsh}
    sizes = {name: fitting_size(mesher, path) for name, mesher in meshers.items()}
    times = {name: [] for name in meshers}
    tets = {}
    for _ in range(ROUNDS):
        for name, mesher in meshers.items():
            seconds, tets[name] = run(mesher, path, sizes[name])
            times[name].append(seconds)
    for name in meshers:
        spread = f"{min(times[name]):.2f} to {max(times[name]):.2f}"
        print(
            f"RESULT {name}: size {sizes[name]:.3g} mm, {tets[name]} tets, median {statistics.median(times[name]):.2f} "
            f"s ({spread})")
    ratio = statistics.median(times["Gmsh"]) / statistics.median(times["collarmesh"])
    print(f"RESULT Gmsh's time / ours: {ratio:.2f}")


try:
    with tempfile.TemporaryDirectory() as folder:
        step = os.environ.get("COLLARMESH_TEST_ARGUMENT") or os.path.join(folder, "plate.step")
        if not os.environ.get("COLLARMESH_TEST_ARGUMENT"):
            plate(step)
        main(step)
except Exception:
    traceback.print_exc()
sys.stdout.flush()
os._exit(0)
