"""Undo and redo of a meshing.
FreeCAD 0.20 writes a new mesh into the same mesh data that its undo remembers, so undo would bring the new
mesh back. Therefore this module keeps the meshes of an object by number. The number is a property, which undo
and redo restore correctly; the mesh with that number is then put in place. All meshes have different numbers,
even those of objects that have the same name one after the other."""

import itertools
import time

import FreeCAD

from . import elements, groups, mesh_properties, up_to_date
from .objects import key_of
from .translations import doc

NUMBER = "MeshNumber"
KEPT = 20  # as many steps of undo as FreeCAD has by default
NODES = 4_000_000  # limit on the nodes of all kept meshes of an object; the last two meshes are kept in any case

_numbers = itertools.count(int(time.time()))  # differs from the numbers of earlier sessions, which files contain
_kept = {}  # by document and object: {number: mesh}, the current one last
_in_place = {}  # by document and object: the object's number when this module last handled its mesh


def add_properties(obj):
    if NUMBER not in obj.PropertiesList:
        text = doc("Number of the mesh that the object has")
        obj.addProperty("App::PropertyInteger", NUMBER, "Base", text, up_to_date.HIDDEN)
        setattr(obj, NUMBER, next(_numbers))
        _in_place[key_of(obj)] = getattr(obj, NUMBER)


def replace(obj, fem_mesh):
    """Gives the object a new mesh, in a way that can be undone."""
    if not obj.Document.UndoMode:
        obj.FemMesh = fem_mesh
        return
    meshes = _kept.setdefault(key_of(obj), {})
    before, number = getattr(obj, NUMBER), next(_numbers)
    kept = meshes.pop(before, None)
    # Other code may have cleared or replaced the mesh.
    meshes[before] = kept if kept is not None and same(kept, obj.FemMesh) else obj.FemMesh.copy()
    meshes[number] = fem_mesh
    while len(meshes) > 2 and (len(meshes) > KEPT or sum(each.NodeCount for each in meshes.values()) > NODES):
        del meshes[next(iter(meshes))]
    obj.FemMesh = fem_mesh
    setattr(obj, NUMBER, number)
    _in_place[key_of(obj)] = number


def same(first, second):
    """Returns whether two meshes are the same, by their counts and some of their nodes, regardless of groups."""
    if any(
        getattr(first, each) != getattr(second, each)
        for each in ("NodeCount", "EdgeCount", "FaceCount", "VolumeCount")
    ):
        return False
    numbers = range(1, first.NodeCount + 1, max(1, first.NodeCount // 100))
    try:
        return all(first.getNodeById(number) == second.getNodeById(number) for number in numbers)
    except ValueError:  # a mesh of another mesher may have gaps in its numbers
        return False


class Observer:
    def slotUndoDocument(self, document):
        for each in document.Objects:
            if not mesh_properties.is_ours(each):
                continue
            number = getattr(each, NUMBER)
            if number != _in_place.get(key_of(each)):  # if equal, this undo step did not change the mesh
                _in_place[key_of(each)] = number
                _put(each, _kept.get(key_of(each), {}).get(number))
            up_to_date.show(each)

    slotRedoDocument = slotUndoDocument

    def slotDeletedDocument(self, document):
        for by_object in (_kept, _in_place):
            for key in [key for key in by_object if key[0] == document.Name]:
                del by_object[key]


def _put(obj, fem_mesh):
    """Gives the object this mesh if it has a different one. Does nothing for None, which stands for a mesh that is no
    longer kept."""
    if fem_mesh is None or same(fem_mesh, obj.FemMesh):
        return
    fem_mesh = fem_mesh.copy()
    if elements.is_there(fem_mesh):
        groups.add_groups(obj, fem_mesh)
    obj.FemMesh = fem_mesh


def observe():
    FreeCAD.addDocumentObserver(Observer())
