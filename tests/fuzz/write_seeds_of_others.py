#!/usr/bin/python3
"""Seeds for the fuzzers as Gmsh, VTK and meshio write the sample mesh: the variants of formats that we only read.

    write_seeds_of_others.py FOLDER

FOLDER holds the files of write_seeds. Programs that are not installed are left out and named.
"""
import os
import shutil
import subprocess
import sys

folder = sys.argv[1]
ORDERS = ("first", "second")


def seed(name, extension):
    return os.path.join(folder, extension, f"{name}.{extension}")


def by_gmsh():
    if not shutil.which("gmsh"):
        return print("gmsh is not installed: no seeds of it")
    variants = [("msh", "msh22", []), ("msh", "msh22", ["-bin"]), ("msh", "msh40", []), ("msh", "msh41", ["-bin"]),
                ("inp", "inp", []), ("unv", "unv", []), ("vtk", "vtk", []), ("vtk", "vtk", ["-bin"]),
                ("mesh", "mesh", []), ("stl", "stl", [])]
    for order in ORDERS:
        for extension, kind, options in variants:
            out = seed("_".join(["gmsh", kind, order] + [o.strip("-") for o in options]), extension)
            command = ["gmsh", seed(order, "msh"), "-0", "-v", "0", "-save_all", "-format", kind, *options, "-o", out]
            subprocess.run(command, check=True, stdout=subprocess.DEVNULL)


def by_meshio():
    try:
        import meshio
    except ImportError:
        return print("python3-meshio is not installed: no seeds of it")
    for order in ORDERS:
        mesh = meshio.read(seed(order, "vtu"))
        variants = {"text": {"binary": False}, "plain": {"compression": None}, "zlib": {"compression": "zlib"}}
        for name, arguments in variants.items():
            meshio.write(seed(f"meshio_{name}_{order}", "vtu"), mesh, "vtu", **arguments)
        mesh.cell_data, mesh.point_data = {}, {}
        meshio.write(seed(f"meshio_{order}", "inp"), mesh, "abaqus")
    surface = meshio.read(seed("boundary", "off"))
    for extension in ("stl", "ply"):
        for name, binary in (("text", False), ("binary", True)):
            meshio.write(seed(f"meshio_{name}", extension), surface, extension, binary=binary)


def by_vtk():
    try:
        import vtk
    except ImportError:
        return print("python3-vtk9 is not installed: no seeds of it")
    for order in ORDERS:
        reader = vtk.vtkXMLUnstructuredGridReader()
        reader.SetFileName(seed(order, "vtu"))
        reader.Update()
        for version in (42, 51):
            for text in (True, False):
                writer = vtk.vtkUnstructuredGridWriter()
                writer.SetFileVersion(version)
                writer.SetFileTypeToASCII() if text else writer.SetFileTypeToBinary()
                save(writer, reader, seed(f"vtk_{version}_{'text' if text else 'binary'}_{order}", "vtk"))
        for raw in (True, False):
            writer = vtk.vtkXMLUnstructuredGridWriter()
            writer.SetDataModeToAppended()
            writer.SetEncodeAppendedData(not raw)
            writer.SetCompressorTypeToNone()
            save(writer, reader, seed(f"vtk_{'raw' if raw else 'base64'}_{order}", "vtu"))
            writer.SetCompressorTypeToLZ4()
            save(writer, reader, seed(f"vtk_lz4_{'raw' if raw else 'base64'}_{order}", "vtu"))


def save(writer, reader, path):
    writer.SetInputConnection(reader.GetOutputPort())
    writer.SetFileName(path)
    if writer.Write() != 1:
        sys.exit(f"{path}: VTK cannot write it")


by_gmsh()
by_meshio()
by_vtk()
