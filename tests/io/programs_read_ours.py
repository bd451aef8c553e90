#!/usr/bin/python3
"""Reads our files, of first and second order, with other programs.

    programs_read_ours.py WRITE_SAMPLE_MESH PROGRAM

PROGRAM is one of vtk, meshio, gmsh, tetgen, calculix, freecad. Exit code 0: it finds what we wrote;
1: it does not; 77: it is not installed.
"""
import glob
import os
import re
import shutil
import subprocess
import sys
import tempfile

import numpy as np

N = 2
MESHIO_TYPES = {1: ("tetra", "triangle", "line"), 2: ("tetra10", "triangle6", "line3")}
MID_EDGES = ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))  # meshio's order is VTK's
failures = []


def expect(condition, what):
    if not condition:
        failures.append(what)
        print("FAILED:", what)


class Sample:
    """The sample mesh in files of these formats."""

    def __init__(self, folder, order, *extensions):
        self.order = order
        self.files = {e: os.path.join(folder, f"sample{order}{e}") for e in extensions}
        run = subprocess.run([sys.argv[1], str(N), str(order), *self.files.values()], capture_output=True,
                             text=True, check=True)
        self.points, self.tets, self.faces, self.edges = map(int, run.stdout.split())

    # The box of SampleMesh: n cells of 1/3, n of 0.1, and 2 n of 0.3 upwards; the interface is at half the
    # height.
    volume = N / 3 * N * 0.1 * 2 * N * 0.3


def skip(what):
    print(f"{what} is not installed: nothing tested")
    sys.exit(77)


def volumes(points, tets):
    a, b, c, d = (points[tets[:, k]] for k in range(4))
    return np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) / 6


def check_mid_nodes(label, points, cells, edges):
    for k, (i, j) in enumerate(edges):
        middle = (points[cells[:, i]] + points[cells[:, j]]) / 2
        corners = cells.shape[1] - len(edges)
        expect(np.allclose(points[cells[:, corners + k]], middle, atol=1e-12),
               f"{label}: mid node {k} of {cells.shape}")


def cells_by_type(mesh):
    result = {}
    for block in mesh.cells:
        result.setdefault(block.type, []).append(block.data)
    return {kind: np.concatenate(parts) for kind, parts in result.items()}


def check_meshio_mesh(label, mesh, sample, kinds=3):
    cells = cells_by_type(mesh)
    expect(len(mesh.points) == sample.points, f"{label}: {len(mesh.points)} points, expected {sample.points}")
    for kind, count in list(zip(MESHIO_TYPES[sample.order], (sample.tets, sample.faces, sample.edges)))[:kinds]:
        found = len(cells.get(kind, ()))
        expect(found == count, f"{label}: {found} cells {kind}, expected {count}")
    tets = cells.get(MESHIO_TYPES[sample.order][0])
    if tets is None:
        return cells
    found = volumes(mesh.points, tets)
    if label.startswith(".med"):  # its tets have the opposite orientation
        found = -found
    expect((found > 0).all(), f"{label}: all tets positive")
    expect(abs(found.sum() - sample.volume) < 1e-10, f"{label}: volume {found.sum()}, expected {sample.volume}")
    if sample.order == 2:
        check_mid_nodes(label, mesh.points, tets, MID_EDGES)
        if "triangle6" in cells:
            check_mid_nodes(label, mesh.points, cells["triangle6"], ((0, 1), (1, 2), (2, 0)))
    return cells


def check_xdmf_parts(sample, meshio):
    """Checks faces and edges, which are in separate files beside the tetrahedra."""
    stem = sample.files[".xdmf"][: -len(".xdmf")]
    _, triangle, line = MESHIO_TYPES[sample.order]
    for part, kind, count in (("faces", triangle, sample.faces), ("edges", line, sample.edges)):
        mesh = meshio.read(f"{stem}_{part}.xdmf")
        cells = cells_by_type(mesh)
        label = f".xdmf of order {sample.order} by meshio: {part}"
        expect(set(cells) == {kind} and len(cells[kind]) == count,
               f"{label}: {[(k, len(v)) for k, v in cells.items()]}")
        expect(len(mesh.cell_data["tag"][0]) == count, f"{label}: tags")
        expect(len(mesh.points) == sample.points, f"{label}: points")


def with_meshio(folder):
    try:
        import meshio
    except ImportError:
        skip("python3-meshio")
    optional = [e for e in (".med", ".xdmf") if subprocess.run(
        [sys.argv[1], "1", "1", os.path.join(folder, "try" + e)], capture_output=True).returncode == 0]
    if ".med" in optional or ".xdmf" in optional:
        try:
            import h5py  # noqa: F401
        except ImportError:
            print("python3-h5py is not installed: .med and .xdmf are not tested")
            optional = []
    for order in (1, 2):
        sample = Sample(folder, order, ".vtk", ".vtu", ".msh", ".inp", ".unv", *optional)
        for extension in (".vtk", ".vtu", ".msh", ".inp", *optional):
            label = f"{extension} of order {order} by meshio"
            mesh = meshio.read(sample.files[extension])
            check_meshio_mesh(label, mesh, sample, 1 if extension in (".inp", ".vtu", ".xdmf") else 3)
            if extension == ".xdmf":
                check_xdmf_parts(sample, meshio)
            if extension == ".inp":
                expect({"REGION_20", "REGION_MINUS_4", "VOLUME_1", "EALL"} <= set(
                    mesh.cell_sets), f"{label}: element sets {set(mesh.cell_sets)}")
                expect("PATCH_MINUS_3_NODES" in mesh.point_sets
                       and any(name.startswith("CURVE_") for name in mesh.point_sets),
                       f"{label}: node sets {set(mesh.point_sets)}")
            if extension == ".med":
                names = {name for families in mesh.cell_tags.values() for name in families}
                expect({"region_20", "region_-4", "patch_-3"} <= names, f"{label}: groups {names}")


def cut_through(grid, vtk):
    """A plane and a threshold give sections of the volume, without outlines of faces and edges in them."""
    cutter = vtk.vtkCutter()
    plane = vtk.vtkPlane()
    plane.SetOrigin(grid.GetCenter())
    plane.SetNormal(0.3, 0.5, 0.8)
    cutter.SetCutFunction(plane)
    cutter.SetInputData(grid)
    cutter.Update()
    kinds = {cutter.GetOutput().GetCellType(i) for i in range(cutter.GetOutput().GetNumberOfCells())}
    expect(kinds and kinds <= {vtk.VTK_TRIANGLE, vtk.VTK_QUAD,
           vtk.VTK_POLYGON}, f"a cut has cells of the types {kinds}")
    low, high = grid.GetCellData().GetArray("min_dihedral").GetRange()
    expect(low > 0, f"min_dihedral is from {low} to {high}")


def with_vtk(folder):
    try:
        import vtk
    except ImportError:
        skip("python3-vtk9")
    from vtk.util.numpy_support import vtk_to_numpy
    for order in (1, 2):
        sample = Sample(folder, order, ".vtk", ".vtu")
        grids = []
        for extension, reader in ((".vtk", vtk.vtkUnstructuredGridReader()),
                                  (".vtu", vtk.vtkXMLUnstructuredGridReader())):
            label = f"{extension} of order {order} by VTK"
            reader.SetFileName(sample.files[extension])
            if extension == ".vtk":
                reader.ReadAllFieldsOn()
            reader.Update()
            grid = reader.GetOutput()
            expect(grid.GetNumberOfPoints() == sample.points, f"{label}: points")
            cells = sample.tets + (0 if extension == ".vtu" else sample.faces + sample.edges)
            expect(grid.GetNumberOfCells() == cells, f"{label}: {grid.GetNumberOfCells()} cells")
            types = vtk_to_numpy(grid.GetCellTypesArray())
            expect((types == (10 if order == 1 else 24)).sum() == sample.tets, f"{label}: types of cells")
            grids.append(grid)
        first, second = grids
        expect(np.array_equal(vtk_to_numpy(first.GetPoints().GetData()),
               vtk_to_numpy(second.GetPoints().GetData())), "points differ")
        volume = vtk_to_numpy(second.GetCells().GetConnectivityArray())
        expect(np.array_equal(vtk_to_numpy(first.GetCells().GetConnectivityArray())
               [: len(volume)], volume), "corners differ")
        for k in range(second.GetCellData().GetNumberOfArrays()):
            name = second.GetCellData().GetArrayName(k)
            array = first.GetCellData().GetArray(name)
            of_tets = None if array is None else vtk_to_numpy(array)[: sample.tets]
            expect(of_tets is not None and np.array_equal(of_tets, vtk_to_numpy(second.GetCellData().GetArray(k))),
                   f"cell array {name}")
        field = second.GetFieldData()
        expect(len(vtk_to_numpy(field.GetArray("boundary_types"))) ==
               sample.faces + sample.edges, ".vtu: boundary in field data")
        cut_through(second, vtk)


def with_gmsh(folder):
    gmsh = shutil.which("gmsh")
    if gmsh is None:
        skip("gmsh")
    import meshio
    for order in (1, 2):
        sample = Sample(folder, order, ".msh", ".mesh", ".unv", ".inp", ".vtk")
        for extension in (".msh", ".mesh", ".unv"):
            label = f"{extension} of order {order} by Gmsh"
            out = os.path.join(folder, "by_gmsh.msh")
            run = subprocess.run([gmsh, sample.files[extension], "-0", "-save_all", "-format", "msh2", "-o", out],
                                 capture_output=True, text=True)
            complaints = [line for line in (run.stdout + run.stderr).splitlines()
                          if "Error" in line or "Warning" in line]
            expect(run.returncode == 0 and not complaints, f"{label}: {run.returncode} {complaints}")
            check_meshio_mesh(label, meshio.read(out), sample)


def run_tetgen(*arguments):
    run = subprocess.run(["tetgen", *arguments], capture_output=True, text=True)
    expect(run.returncode == 0 and "Error" not in run.stdout,
           f"tetgen {arguments}: {run.returncode} {run.stdout[-300:]}")
    return run.stdout


def rows(path):
    with open(path) as file:
        lines = [line.split() for line in file if line.strip() and not line.startswith("#")]
    return lines[0], lines[1:]


def with_tetgen(folder):
    if shutil.which("tetgen") is None:
        skip("tetgen")
    sample = Sample(folder, 1, ".poly", ".smesh", ".ele")
    for extension in (".poly", ".smesh"):
        said = run_tetgen("-pAF" if extension == ".poly" else "-pAF", sample.files[extension])
        header, tets = rows(sample.files[extension].replace(extension, ".1.ele"))
        attributes = {int(float(row[-1])) for row in tets}
        expect(attributes == {20, -4}, f"{extension} by TetGen: regions {attributes} {said[-200:]}")
        for made in glob.glob(os.path.join(folder, "*.1.*")):
            os.remove(made)
    # TetGen reads the mesh again and refines it, and checks its consistency meanwhile.
    run_tetgen("-rqCC", sample.files[".ele"])
    header, tets = rows(sample.files[".ele"].replace(".ele", ".1.ele"))
    expect(len(tets) >= sample.tets, f".ele by TetGen: {len(tets)} tets from {sample.tets}")


def with_calculix(folder):
    """A bar is stretched by its temperature: free expansion gives u = alpha dT x exactly, on any mesh."""
    ccx = shutil.which("ccx")
    if ccx is None:
        skip("calculix-ccx")
    expansion, rise = 1e-5, 100
    for order in (1, 2):
        sample = Sample(folder, order, ".inp")
        coordinates = {}
        with open(sample.files[".inp"]) as file:
            text = file.read()
        for line in text.split("*NODE", 1)[1].split("\n*", 1)[0].splitlines()[1:]:
            number, *xyz = line.split(",")
            coordinates[int(number)] = tuple(map(float, xyz))
        origin = min(coordinates.values())
        corner = {key: number for number, key in coordinates.items()}
        a = corner[origin]
        far_x = max(n for n, p in coordinates.items() if p[1:] ==
                    origin[1:] and p[0] == max(q[0] for q in coordinates.values()))
        far_y = max(n for n, p in coordinates.items() if (p[0], p[2]) == (
            origin[0], origin[2]) and p[1] == max(q[1] for q in coordinates.values()))
        name = os.path.join(folder, f"job{order}")
        with open(name + ".inp", "w") as file:
            file.write(f"*INCLUDE, INPUT={os.path.basename(sample.files['.inp'])}\n"
                       "*MATERIAL, NAME=STEEL\n*ELASTIC\n210000., 0.3\n"
                       f"*EXPANSION, ZERO=0.\n{expansion},\n"
                       "*SOLID SECTION, ELSET=REGION_20, MATERIAL=STEEL\n"
                       "*SOLID SECTION, ELSET=REGION_MINUS_4, MATERIAL=STEEL\n"
                       "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nNALL, 0.\n"
                       f"*BOUNDARY\n{a}, 1, 3\n{far_x}, 2, 3\n{far_y}, 3, 3\n"
                       f"*STEP\n*STATIC\n*TEMPERATURE\nNALL, {rise}.\n"
                       "*DLOAD\nEALL, P1, 0.\n*DSLOAD\nPATCH_6, P, 0.\n"
                       "*NODE PRINT, NSET=PATCH_MINUS_3_NODES\nU\n*EL PRINT, ELSET=VOLUME_1\nS\n*END STEP\n")
        run = subprocess.run([ccx, "-i", os.path.basename(name)], cwd=folder, capture_output=True, text=True)
        problems = re.findall(r"\*(?:ERROR|WARNING)[^\n]*", run.stdout)
        expect(run.returncode == 0 and "Job finished" in run.stdout,
               f"ccx of order {order}: {run.returncode} {run.stdout[-500:]}")
        expect(not [p for p in problems if "ERROR" in p], f"ccx of order {order}: {problems}")
        with open(name + ".dat") as file:
            dat = file.read()
        displacements = [list(map(float, line.split())) for line in
                         dat.split("displacements", 1)[1].split("stresses")[0].splitlines()[1:]
                         if len(line.split()) == 4]
        expect(len(displacements) > 0, f"ccx of order {order}: displacements of a node set")
        for number, *u in displacements:
            wanted = [expansion * rise * (c - o) for c, o in zip(coordinates[int(number)], origin)]
            expect(np.allclose(u, wanted, atol=1e-8),
                   f"ccx of order {order}: node {number} moved {u}, expected {wanted}")
        stresses = [list(map(float, line.split()[2:])) for line in
                    dat.split("stresses", 1)[1].splitlines()[1:] if len(line.split()) == 8]
        expect(len(stresses) > 0 and np.abs(stresses).max() < 1e-3, f"ccx of order {order}: stresses of an element set")


FREECAD_SCRIPT = """
import Fem, sys
mesh = Fem.read({path!r})
print("FOUND", mesh.NodeCount, mesh.TetraCount, mesh.TriangleCount, mesh.EdgeCount, mesh.Volume.Value)
for group in mesh.Groups:
    print("GROUP", mesh.getGroupName(group), mesh.getGroupElementType(group), len(mesh.getGroupElements(group)))
"""


def with_freecad(folder):
    freecad = shutil.which("freecadcmd") or shutil.which("FreeCADCmd")
    if freecad is None:
        skip("freecad")
    for order in (1, 2):
        sample = Sample(folder, order, ".unv", ".inp")
        for extension in (".unv", ".inp"):
            label = f"{extension} of order {order} by FreeCAD"
            script = os.path.join(folder, "read.py")
            with open(script, "w") as file:
                file.write(FREECAD_SCRIPT.format(path=sample.files[extension]))
            run = subprocess.run([freecad, script], capture_output=True, text=True, timeout=120,
                                 stdin=subprocess.DEVNULL, env={**os.environ, "HOME": folder})
            found = re.search(r"FOUND (\d+) (\d+) (\d+) (\d+) ([\d.e+-]+)", run.stdout)
            expect(found is not None, f"{label}: {run.stdout[-500:]} {run.stderr[-500:]}")
            if found is None:
                continue
            expect(int(found[1]) == sample.points, f"{label}: {found[1]} nodes, expected {sample.points}")
            expect(int(found[2]) == sample.tets, f"{label}: {found[2]} tets, expected {sample.tets}")
            if extension == ".inp":
                continue
            expect(int(found[3]) == sample.faces, f"{label}: {found[3]} triangles, expected {sample.faces}")
            expect(int(found[4]) == sample.edges, f"{label}: {found[4]} edges, expected {sample.edges}")
            groups = {name: int(count) for name, count in re.findall(r"GROUP (\S+) \w+ (\d+)", run.stdout)}
            expect(groups.get("region_20") == sample.tets // 2, f"{label}: groups {groups}")
            expect("patch_-3" in groups and "curve_7" in groups, f"{label}: groups {groups}")


PROGRAMS = {"vtk": with_vtk, "meshio": with_meshio, "gmsh": with_gmsh, "tetgen": with_tetgen,
            "calculix": with_calculix, "freecad": with_freecad}

if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as work:
        PROGRAMS[sys.argv[2]](work)
    print("failed" if failures else "all agree")
    sys.exit(1 if failures else 0)
