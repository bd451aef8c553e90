"""Writes the mesh of a mesh object in the program's formats, and measures it with the program."""

import json
import os
import subprocess

from . import elements, preferences
from .program import MesherError, find_program
from .translations import translate
from .work_folder import WorkFolder

# FreeCAD's own export writes only some of these formats, and loses groups of faces in .inp.
FORMATS = (
    ("VTK, ParaView", ".vtu"), ("VTK", ".vtk"), ("Gmsh", ".msh"), ("Gmsh 2.2", ".msh2"), ("Abaqus, CalculiX", ".inp"),
    ("I-DEAS, SALOME", ".unv"), ("Medit", ".mesh"), ("TetGen", ".ele"), ("STL", ".stl"), ("OBJ", ".obj"),
    ("PLY", ".ply"), ("OFF", ".off"),
)


def filters():
    """Returns filters for a file dialog."""
    return ";;".join(f"{name} (*{extension})" for name, extension in FORMATS)


def extension_in(text):
    """Returns the extension in one of the `filters()`, without the dot."""
    return text[text.index("*.") + 2 : text.rindex(")")]


def _run(mesh_object, arguments):
    """Runs the program and returns its standard output. The word `MESH` among the arguments stands for the
    object's mesh. Raises MesherError."""
    if not elements.is_there(mesh_object.FemMesh):
        raise MesherError(translate("collarmesh", "{label} has no mesh yet."), label=mesh_object.Label)
    program = find_program(preferences.program())
    folder = WorkFolder()
    try:
        path = os.path.join(folder.name, "mesh.unv")
        mesh_object.FemMesh.write(path)
        command = [program, *(path if each == "MESH" else each for each in arguments)]
        with subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              text=True, errors="replace") as process:
            folder.program_is(process.pid)
            answer, complaint = process.communicate()
        folder.program_is(None)
    finally:
        folder.cleanup()
    if process.returncode != 0:
        raise MesherError(complaint.replace(path, mesh_object.Label).strip().removeprefix("collarmesh: "))
    return answer


def export(mesh_object, path):
    """Writes the object's mesh, with its groups by sub-shapes and, if the format can store them, their names.
    The path's extension determines the format. Raises MesherError."""
    _run(mesh_object, ["convert", "MESH", "-o", path, "--quiet"])


def statistics(mesh_object):
    """Returns the program's measurements: points, tets, angles, histograms (`collarmesh info --json`). Raises
    MesherError."""
    return json.loads(_run(mesh_object, ["info", "MESH", "--json"]))["mesh"]
