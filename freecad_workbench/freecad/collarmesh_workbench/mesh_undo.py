"""Undo and redo of a meshing.

FreeCAD 0.20 writes a new mesh into the very mesh that its undo remembers, so that undo brings the new one back. Here
the meshes of an object are kept by number. The number is a property, which undo and redo get right, and whose mesh is
put in place then."""

import FreeCAD

from . import groups
from .translations import doc

NUMBER = "MeshNumber"
KEPT = 20  # as many steps of undo as FreeCAD has by default
NODES = 4_000_000  # in all that is kept of an object, but the last two meshes are kept in any case

_kept = {}  # by document and object: {number: mesh}


def add_properties(obj):
    if NUMBER not in obj.PropertiesList:
        obj.addProperty(
            "App::PropertyInteger", NUMBER, "Base", doc("Which of its meshes the object has"), 4 + 16
        )


def replace(obj, fem_mesh):
    """Give the object a new mesh, in a way that can be undone."""
    if not obj.Document.UndoMode:
        obj.FemMesh = fem_mesh
        return
    meshes = _kept.setdefault((obj.Document.Name, obj.Name), {})
    before = getattr(obj, NUMBER)
    for undone in [number for number in meshes if number > before]:
        del meshes[undone]
    if before not in meshes:
        meshes[before] = obj.FemMesh.copy()
    number = before + 1
    meshes[number] = fem_mesh
    while len(meshes) > 2 and (len(meshes) > KEPT or sum(each.NodeCount for each in meshes.values()) > NODES):
        del meshes[min(meshes)]
    obj.FemMesh = fem_mesh
    setattr(obj, NUMBER, number)


def same(first, second):
    """Is it the same mesh? Groups do not count."""
    if any(
        getattr(first, each) != getattr(second, each)
        for each in ("NodeCount", "EdgeCount", "FaceCount", "VolumeCount")
    ):
        return False
    numbers = range(1, first.NodeCount + 1, max(1, first.NodeCount // 100))
    try:
        return all(first.getNodeById(number) == second.getNodeById(number) for number in numbers)
    except ValueError:  # a mesh of another mesher, with gaps in its numbers
        return False


class Observer:
    def slotUndoDocument(self, document):
        self._put_right(document)

    def slotRedoDocument(self, document):
        self._put_right(document)

    def _put_right(self, document):
        from . import mesh_object, up_to_date

        for each in document.Objects:
            if not mesh_object.is_ours(each):
                continue
            fem_mesh = _kept.get((document.Name, each.Name), {}).get(getattr(each, NUMBER))
            if fem_mesh is not None and not same(fem_mesh, each.FemMesh):
                fem_mesh = fem_mesh.copy()
                if fem_mesh.VolumeCount:
                    groups.add_groups(each, fem_mesh)
                each.FemMesh = fem_mesh
            up_to_date.show(each)

    def slotDeletedDocument(self, document):
        for key in [key for key in _kept if key[0] == document.Name]:
            del _kept[key]


def observe():
    FreeCAD.addDocumentObserver(Observer())
