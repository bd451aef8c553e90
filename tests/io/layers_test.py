#!/usr/bin/python3
"""Prisms, pyramids and quadrangles in our files, as other programs find them, first and second order.

    layers_test.py WRITE_SAMPLE_MESH COLLARMESH PROGRAM

PROGRAM is one of vtk, meshio, gmsh, openfoam, calculix, cgns, freecad, convert. Exit code 0: it finds what we wrote;
1: it does not; 77: it is not installed.
"""
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile

import numpy as np

VOLUME = 3 + 49 / 30  # volume of LayerMesh
EDGES = {
    "tetra": ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)),
    "wedge": ((0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)),
    "pyramid": ((0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (1, 4), (2, 4), (3, 4)),
    "triangle": ((0, 1), (1, 2), (2, 0)),
    "quad": ((0, 1), (1, 2), (2, 3), (3, 0)),
    "line": ((0, 1),),
}
CORNERS = {"tetra": 4, "wedge": 6, "pyramid": 5, "triangle": 3, "quad": 4, "line": 2}
# meshio's names of cells of second order.
KINDS = {"tetra10": "tetra", "wedge15": "wedge", "pyramid13": "pyramid", "triangle6": "triangle", "quad8": "quad",
         "line3": "line"}
failures = []


def expect(condition, what):
    if not condition:
        failures.append(what)
        print("FAILED:", what)


def skip(what):
    print(f"{what} is not installed: nothing tested")
    sys.exit(77)


class Sample:
    """The mesh of layers in files of these formats."""

    def __init__(self, folder, order, *extensions, kind="layers"):
        self.order = order
        self.files = {e: os.path.join(folder, f"{kind}{order}{e}") for e in extensions}
        run = subprocess.run([sys.argv[1], kind, str(order), *self.files.values()], capture_output=True, text=True,
                             check=True)
        names = ("points", "tetra", "triangle", "line", "wedge", "pyramid", "quad")
        self.count = dict(zip(names, map(int, run.stdout.split())))


def determinant(points, cells, a, b, c, d):
    a, b, c, d = (points[cells[:, k]] for k in (a, b, c, d))
    return np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a)


def corner_volumes(points, cells, kind):
    """Six volumes of the tets at the corners of each cell: all positive in a right one."""
    at_corners = {
        "tetra": ((0, 1, 2, 3),),
        "wedge": ((0, 1, 2, 3), (1, 2, 0, 4), (2, 0, 1, 5), (3, 5, 4, 0), (4, 3, 5, 1), (5, 4, 3, 2)),
        "pyramid": ((0, 1, 3, 4), (1, 2, 0, 4), (2, 3, 1, 4), (3, 0, 2, 4)),
    }[kind]
    return np.array([determinant(points, cells, *corner) for corner in at_corners])


def check_cells(label, points, cells, kind, turned=False):
    """Cells are not inverted, and their mid-edge nodes lie amid their edges. `turned`: the cells have the
    opposite orientation."""
    if len(cells) == 0:
        return
    if kind in ("tetra", "wedge", "pyramid"):
        volumes = corner_volumes(points, cells, kind) * (-1 if turned else 1)
        expect((volumes > 0).all(), f"{label}: volumes of {kind} at corners are from {volumes.min()}")
    corners = CORNERS[kind]
    if cells.shape[1] == corners:
        return
    for k, (i, j) in enumerate(EDGES[kind]):
        amid = (points[cells[:, i]] + points[cells[:, j]]) / 2
        expect(np.allclose(points[cells[:, corners + k]], amid, atol=1e-9), f"{label}: mid node {k} of {kind}")


def read_with_meshio(path):
    """Version 5.0 of meshio reads prisms of second order but has forgotten their dimension."""
    import meshio
    from meshio import _mesh

    for kind in ("wedge15", "pyramid13"):
        _mesh.topological_dimension.setdefault(kind, 3)
    return meshio.read(path)


def check_meshio_mesh(label, mesh, sample, kinds, turned=()):
    found = {}
    for block in mesh.cells:
        found.setdefault(KINDS.get(block.type, block.type), []).append(block.data)
    expect(len(mesh.points) == sample.count["points"], f"{label}: {len(mesh.points)} points")
    for kind in kinds:
        cells = np.concatenate(found[kind]) if kind in found else np.empty((0, 0))
        expect(len(cells) == sample.count[kind], f"{label}: {len(cells)} cells {kind}, not {sample.count[kind]}")
        check_cells(label, mesh.points, cells, kind, kind in turned)


def with_meshio(folder):
    try:
        import meshio
    except ImportError:
        skip("python3-meshio")
    everything = tuple(CORNERS)
    volumes, faces = ("tetra", "wedge", "pyramid"), ("triangle", "quad")
    # The kinds of cells that meshio finds, and those with the opposite orientation there. For VTK, meshio
    # itself reverses prisms of first order alone.
    formats = {".vtu": (volumes, ("wedge",)), ".vtk": (everything, ("wedge",)), ".msh": (everything, ()),
               ".msh2": (everything, ()), ".mesh": (everything, ()), ".inp": (("tetra", "wedge"), ()),
               ".bdf": ((*volumes, *faces), ()), ".su2": (volumes, ("wedge",)),
               ".med": (everything, volumes)}
    try:
        import h5py  # noqa: F401
    except ImportError:
        del formats[".med"]
    for order in (1, 2):
        for extension, (kinds, turned) in formats.items():
            if order == 2 and extension in (".mesh", ".su2", ".inp"):  # in .inp pyramids are tets with further nodes
                continue
            if subprocess.run([sys.argv[1], "1", "1", os.path.join(folder, "try" + extension)],
                              capture_output=True).returncode != 0:
                continue  # built without it
            label = f"{extension} of order {order} by meshio"
            sample = Sample(folder, order, extension)
            path = sample.files[extension]
            if extension == ".msh2":
                shutil.move(path, path[:-1] + ".2.msh")
                path = path[:-1] + ".2.msh"
            if extension == ".bdf" and order == 2:
                continue  # meshio has no continued lines of more than 10 nodes
            mesh = read_with_meshio(path)
            if extension == ".med" and order == 2:
                mesh.cells = [meshio.CellBlock(b.type, turned_of_med(b.type, b.data)) for b in mesh.cells]
                turned = ()
            if extension in (".vtu", ".vtk") and order == 1:
                turned = ()
            check_meshio_mesh(label, mesh, sample, kinds, turned)


def turned_of_med(kind, cells):
    """Returns MED's cells of second order with the opposite orientation."""
    order = {"tetra10": [0, 2, 1, 3, 6, 5, 4, 7, 9, 8],
             "wedge15": [0, 2, 1, 3, 5, 4, 8, 7, 6, 11, 10, 9, 12, 14, 13],
             "pyramid13": [0, 3, 2, 1, 4, 8, 7, 6, 5, 9, 12, 11, 10]}.get(kind)
    if order is None:
        return cells
    return cells[:, order]


def with_vtk(folder):
    try:
        import vtk
    except ImportError:
        skip("python3-vtk9")
    from vtk.util.numpy_support import vtk_to_numpy
    numbers = {1: (10, 13, 14), 2: (24, 26, 27)}
    for order in (1, 2):
        sample = Sample(folder, order, ".vtu", ".vtk", ".exo")
        for extension, reader in ((".vtu", vtk.vtkXMLUnstructuredGridReader()),
                                  (".vtk", vtk.vtkUnstructuredGridReader()), (".exo", vtk.vtkExodusIIReader())):
            label = f"{extension} of order {order} by VTK"
            reader.SetFileName(sample.files[extension])
            if extension == ".vtk":
                reader.ReadAllFieldsOn()
            reader.Update()
            grid = reader.GetOutput()
            if extension == ".exo":
                join = vtk.vtkAppendFilter()
                blocks = grid.GetBlock(0)
                for k in range(blocks.GetNumberOfBlocks()):
                    join.AddInputData(blocks.GetBlock(k))
                join.Update()
                grid = join.GetOutput()
            types = vtk_to_numpy(grid.GetCellTypesArray())
            for number, kind in zip(numbers[order], ("tetra", "wedge", "pyramid")):
                expect((types == number).sum() == sample.count[kind],
                       f"{label}: {(types == number).sum()} cells {kind}")
            sizes = vtk.vtkCellSizeFilter()
            sizes.SetInputData(grid)
            sizes.Update()
            volumes = vtk_to_numpy(sizes.GetOutput().GetCellData().GetArray("Volume"))
            volumes = volumes[np.isin(types, numbers[order])]
            expect((np.abs(volumes) if extension == ".exo" else volumes).min() > 0,
                   f"{label}: volumes from {volumes.min()}")
            expect(abs(np.abs(volumes).sum() - VOLUME) < 1e-6, f"{label}: volume {np.abs(volumes).sum()}, not {VOLUME}")
            if extension == ".exo":
                continue
            layers = vtk_to_numpy(grid.GetCellData().GetArray("layer"))
            expect((layers[types == numbers[order][1]] == 1).all(), f"{label}: layers {layers}")
            if extension == ".vtu":
                check_surface_with_vtk(label, grid, vtk)


def check_surface_with_vtk(label, grid, vtk):
    """The faces that VTK finds enclose the volume, so each turns outwards."""
    outside = vtk.vtkDataSetSurfaceFilter()
    outside.SetInputData(grid)
    triangles = vtk.vtkTriangleFilter()
    triangles.SetInputConnection(outside.GetOutputPort())
    mass = vtk.vtkMassProperties()
    mass.SetInputConnection(triangles.GetOutputPort())
    mass.Update()
    expect(abs(mass.GetVolume() - VOLUME) < 1e-2, f"{label}: the surface encloses {mass.GetVolume()}")


def with_gmsh(folder):
    gmsh = shutil.which("gmsh")
    if gmsh is None:
        skip("gmsh")
    try:
        import meshio  # noqa: F401
    except ImportError:
        skip("python3-meshio")
    for order in (1, 2):
        sample = Sample(folder, order, ".msh", ".msh2")
        for extension, path in sample.files.items():
            label = f"{extension} of order {order} by Gmsh"
            given = path[:-1] if extension == ".msh2" else path
            if extension == ".msh2":
                given = path[: -len(".msh2")] + ".two.msh"
                shutil.copy(path, given)
            out = os.path.join(folder, "by_gmsh.msh")
            run = subprocess.run([gmsh, given, "-0", "-save_all", "-format", "msh2", "-o", out], capture_output=True,
                                 text=True)
            complaints = [line for line in (run.stdout + run.stderr).splitlines()
                          if "Error" in line or "Warning" in line]
            expect(run.returncode == 0 and not complaints, f"{label}: {run.returncode} {complaints}")
            check_meshio_mesh(label, read_with_meshio(out), sample, tuple(CORNERS))
        # The sample without pyramids, which .unv cannot store.
        sample = Sample(folder, order, ".unv", kind="prisms")
        run = subprocess.run([gmsh, sample.files[".unv"], "-0", "-save_all", "-format", "msh2", "-o", out],
                             capture_output=True, text=True)
        check_meshio_mesh(f".unv of order {order} by Gmsh", read_with_meshio(out), sample, tuple(CORNERS))


FOAM_HEADER = "FoamFile {{ version 2.0; format ascii; class dictionary; object {}; }}\n"
FOAM_FILES = {
    "controlDict": "application simpleFoam; startFrom startTime; startTime 0; stopAt endTime; endTime 1; deltaT 1; "
    "writeControl timeStep; writeInterval 1; ",
    "fvSchemes": "ddtSchemes {} gradSchemes {} divSchemes {} laplacianSchemes {} interpolationSchemes {} "
    "snGradSchemes {} ",
    "fvSolution": "",
}


def with_openfoam(folder):
    if shutil.which("checkMesh") is None:
        skip("openfoam")
    sample = Sample(folder, 1, ".vtu")
    os.makedirs(os.path.join(folder, "system"))
    os.makedirs(os.path.join(folder, "constant", "polyMesh"))
    for name, text in FOAM_FILES.items():
        with open(os.path.join(folder, "system", name), "w") as file:
            file.write(FOAM_HEADER.format(name) + text)
    collarmesh("convert", sample.files[".vtu"], "-o", os.path.join(folder, "constant", "polyMesh", "boundary"),
               "--format", "polymesh")
    environment = {**os.environ, "WM_PROJECT_DIR": "/usr/share/openfoam", "FOAM_ETC": "/usr/share/openfoam/etc"}
    run = subprocess.run(["checkMesh", "-allTopology", "-allGeometry"], cwd=folder, capture_output=True, text=True,
                         env=environment)
    said = run.stdout
    expect(run.returncode == 0 and "Mesh OK" in said, f"checkMesh: {run.returncode} {said[-1500:]} {run.stderr[-500:]}")
    for what, kind in (("prisms", "wedge"), ("pyramids", "pyramid"), ("tetrahedra", "tetra")):
        found = re.search(rf"{what}: +(\d+)", said)
        expect(found is not None and int(found[1]) == sample.count[kind], f"checkMesh: {what}: {found and found[1]}")
    volume = re.search(r"Total volume = (\d+\.\d+)", said)
    expect(volume is not None and abs(float(volume[1]) - VOLUME) < 1e-3, f"checkMesh: volume {volume and volume[1]}")
    for patch in ("patch_minus_5", "patch_6"):
        expect(re.search(rf"{patch} +\d+ +\d+", said) is not None, f"checkMesh: {patch}")


def collarmesh(*arguments, code=0):
    run = subprocess.run([sys.argv[2], *arguments], capture_output=True, text=True)
    expect(run.returncode == code, f"{arguments}: {run.returncode} {run.stderr[-1000:]}")
    return run.stdout + run.stderr


def nodes_and_elements(text):
    """Points by number, and for each element its type and nodes."""
    points, elements, kind, pending = {}, [], None, []
    for line in text.splitlines():
        if line.startswith("*"):
            kind = None
            if line.startswith("*NODE,"):
                kind = "node"
            elif line.startswith("*ELEMENT"):
                kind = re.search(r"TYPE=(\w+)", line)[1]
            continue
        if kind == "node":
            number, *xyz = line.split(",")
            points[int(number)] = np.array(list(map(float, xyz)))
        elif kind is not None:
            pending += [int(field) for field in line.split(",") if field.strip()]
            if len(pending) == {"C3D4": 5, "C3D10": 11, "C3D6": 7, "C3D15": 16, "C3D8": 9}[kind]:
                elements.append((kind, pending[1:]))
                pending = []
    return points, elements


def with_calculix(folder):
    """The patch test: nodes on the boundary are displaced linearly, and so all others follow, with one stress."""
    ccx = shutil.which("ccx")
    if ccx is None:
        skip("calculix-ccx")
    gradient = np.array([[1.0, 0.3, -0.2], [0.4, -0.5, 0.7], [0.1, 0.6, 0.8]]) * 1e-3
    strain = (gradient + gradient.T) / 2
    modulus, poisson = 2.0, 0.3
    stress = modulus / (1 + poisson) * (strain + poisson / (1 - 2 * poisson) * np.trace(strain) * np.eye(3))
    wanted = stress[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]
    # In second order, pyramids whose base is no parallelogram are not exact.
    for kind, order, exact in (("layers", 1, 1e-5), ("prisms", 1, 1e-5), ("prisms", 2, 1e-5), ("layers", 2, 1e-2)):
        label = f"ccx of {kind} of order {order}"
        sample = Sample(folder, order, ".inp", kind=kind)
        with open(sample.files[".inp"]) as file:
            text = file.read()
        points, elements = nodes_and_elements(text)
        kinds = {name for name, _ in elements}
        expect(kinds == {("layers", 1): {"C3D4", "C3D6", "C3D8"}, ("prisms", 1): {"C3D4", "C3D6"},
                         ("prisms", 2): {"C3D10", "C3D15"}, ("layers", 2): {"C3D10", "C3D15"}}[kind, order],
               f"{label}: elements {kinds}")
        outside = set()
        for match in re.finditer(r"\*NSET, NSET=PATCH_(\S+?)_NODES\n([^*]*)", text):
            if match[1] != "7":  # nodes on the interface are free
                outside |= {int(number) for number in match[2].replace("\n", " ").split(",") if number.strip()}
        free = set(points) - outside
        expect(len(free) > 0, f"{label}: there are free nodes")
        name = os.path.join(folder, f"{kind}_patch{order}")
        with open(name + ".inp", "w") as file:
            file.write(text + "*MATERIAL, NAME=M\n*ELASTIC\n2., 0.3\n*SOLID SECTION, ELSET=EALL, MATERIAL=M\n"
                       "*STEP\n*STATIC\n*BOUNDARY\n")
            for number in sorted(outside):
                for axis, value in enumerate(gradient @ points[number], 1):
                    file.write(f"{number}, {axis}, {axis}, {value:.12e}\n")
            file.write("*NODE PRINT, NSET=NALL\nU\n*EL PRINT, ELSET=EALL\nS\n*END STEP\n")
        run = subprocess.run([ccx, "-i", os.path.basename(name)], cwd=folder, capture_output=True, text=True)
        expect(run.returncode == 0 and "Job finished" in run.stdout and "*ERROR" not in run.stdout,
               f"{label}: {run.returncode} {run.stdout[-800:]}")
        with open(name + ".dat") as file:
            dat = file.read()
        moved = 0
        for line in dat.split("displacements", 1)[1].split("stresses")[0].splitlines()[1:]:
            fields = line.split()
            if len(fields) == 4 and int(fields[0]) in free:
                moved += 1
                u = np.array(list(map(float, fields[1:])))
                expect(np.allclose(u, gradient @ points[int(fields[0])],
                       atol=1e-3 * exact), f"{label}: node {fields[0]} moved {u}")
        expect(moved == len(free), f"{label}: {moved} of {len(free)} free nodes")
        stresses = np.array([list(map(float, line.split()[2:])) for line in
                             dat.split("stresses", 1)[1].splitlines()[1:] if len(line.split()) == 8])
        expect(len(stresses) > 0 and np.abs(stresses - wanted).max() < exact * np.abs(wanted).max(),
               f"{label}: stresses off by {np.abs(stresses - wanted).max()}")


def with_cgns(folder):
    check = shutil.which("cgnscheck")
    if check is None:
        skip("cgns-convert")
    for order in (1, 2):
        sample = Sample(folder, order, ".cgns")
        run = subprocess.run([check, "-v", sample.files[".cgns"]], capture_output=True, text=True)
        said = run.stdout + run.stderr
        expect(run.returncode == 0 and "ERROR" not in said, f".cgns of order {order}: {run.returncode} {said[-1500:]}")
        types = set(re.findall(r"element type = (\w+)|Element Type *[:=] *(\w+)", said, re.IGNORECASE))
        found = {name for pair in types for name in pair if name}
        names = {1: {"TETRA_4", "PENTA_6", "PYRA_5", "TRI_3", "QUAD_4", "BAR_2"},
                 2: {"TETRA_10", "PENTA_15", "PYRA_13", "TRI_6", "QUAD_8", "BAR_3"}}[order]
        expect(not found or names <= found, f".cgns of order {order}: types {found}")


FREECAD_SCRIPT = """
import Fem
mesh = Fem.read({path!r})
print("FOUND", mesh.NodeCount, mesh.TetraCount, mesh.TriangleCount, mesh.EdgeCount, mesh.PrismCount, mesh.HexaCount,
      mesh.QuadrangleCount, mesh.Volume.Value)
"""


def with_freecad(folder):
    freecad = shutil.which("freecadcmd") or shutil.which("FreeCADCmd")
    if freecad is None:
        skip("freecad")
    for order in (1, 2):
        sample = Sample(folder, order, ".unv")
        script = os.path.join(folder, "read.py")
        with open(script, "w") as file:
            file.write(FREECAD_SCRIPT.format(path=sample.files[".unv"]))
        run = subprocess.run([freecad, script], capture_output=True, text=True, timeout=120, stdin=subprocess.DEVNULL,
                             env={**os.environ, "HOME": folder})
        found = re.search(r"FOUND ((?:\d+ ){7})([\d.e+-]+)", run.stdout)
        expect(found is not None, f".unv of order {order} by FreeCAD: {run.stdout[-500:]} {run.stderr[-500:]}")
        if found is None:
            continue
        wanted = [sample.count[kind] for kind in ("points", "tetra", "triangle", "line", "wedge", "pyramid", "quad")]
        expect(list(map(int, found[1].split())) == wanted,
               f".unv of order {order} by FreeCAD: {found[1]}, not {wanted}")


def with_convert(folder):
    """The program's own commands."""
    sample = Sample(folder, 1, ".vtu")
    second = Sample(folder, 2, ".vtu")
    path = sample.files[".vtu"]
    figures = json.loads(collarmesh("info", path, "--json"))["mesh"]
    for name, kind in (("tets", "tetra"), ("prisms", "wedge"), ("pyramids", "pyramid"), ("quads", "quad"),
                       ("faces", "triangle")):
        expect(figures[name] == sample.count[kind], f"info: {name} {figures[name]}")
    expect(abs(sum(figures["region_volumes"].values()) - VOLUME) < 1e-9, f"info: volumes {figures['region_volumes']}")
    said = collarmesh("info", path)
    expect("6 prisms, 5 pyramids, " in said and "quadrangles" in said, f"info: {said}")
    skin = os.path.join(folder, "skin.off")
    collarmesh("convert", path, "-o", skin)
    said = collarmesh("check", path, "--against", skin)
    expect("every guarantee holds" in said and "6 prisms" in said, f"check: {said}")
    # Converts from format to format, and compares the last file with the first one.
    for start, formats in ((path, (".msh", ".msh2", ".unv", ".mesh", ".inp", ".vtk")),
                           (second.files[".vtu"], (".msh", ".msh2", ".inp", ".unv", ".vtk"))):
        before, at = collarmesh("info", start), start
        for number, extension in enumerate(formats):
            out = os.path.join(folder, f"chain{number}{extension}")
            collarmesh("convert", at, "-o", out)
            at = out
        after = collarmesh("info", at)
        expect(before.split("boundary")[0] == after.split("boundary")[0], f"converted: {before} {after}")
    # Formats that cannot store these cells say so, and nothing is written.
    for target in ("a.xdmf", "a.pvtu", "a.ele"):
        said = collarmesh("convert", path, "-o", os.path.join(folder, target), code=8)
        expect("prisms and pyramids" in said and not os.path.exists(os.path.join(folder, target)), f"{target}: {said}")
    said = collarmesh(skin, "-o", os.path.join(folder, "a.pvtu"), "--size", "1", "--layers", "all", code=2)
    expect("--layers" in said and "no place for prisms" in said, f"a.pvtu: {said}")
    said = collarmesh("convert", second.files[".vtu"], "-o", os.path.join(folder, "second.su2"), code=8)
    expect("pyramids of second order" in said, f"second.su2: {said}")
    said = collarmesh("convert", path, "-o", os.path.join(folder, "a.msh"), "--partitions", "2", code=2)
    expect("prisms" in said, f"partitions: {said}")


PROGRAMS = {"vtk": with_vtk, "meshio": with_meshio, "gmsh": with_gmsh, "openfoam": with_openfoam,
            "calculix": with_calculix, "cgns": with_cgns, "freecad": with_freecad, "convert": with_convert}

if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as work:
        PROGRAMS[sys.argv[3]](work)
    print("failed" if failures else "all agree")
    sys.exit(1 if failures else 0)
