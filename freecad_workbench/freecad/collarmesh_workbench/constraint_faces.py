"""Faces that can be chosen for constraints on an FEM mesh that was made from a triangle mesh, which has no faces of its
own to choose. A separate object has a planar face for each group of faces of the FEM mesh, and FEM's panels accept
these like faces of a part. Face1 belongs to the first group, Face2 to the second one, and so on; groups that are not
planar have further faces after all these. Each face stands for its whole group: a solver gets the nodes of the
group."""

import FreeCAD
import numpy
import Part

from . import compatibility, elements, inputs, planar_pieces, views
from .objects import type_of
from .program import MesherError
from .translations import doc, translate

TYPE = "Collarmesh::ConstraintFaces"
MESH, GROUPS = "MeshObject", "Groups"
REFERENCES = "References"


class Proxy(compatibility.Stateless):
    Type = TYPE

    def __init__(self, obj):
        obj.Proxy = self
        for kind, name, text in (("App::PropertyLink", MESH, doc("The mesh whose groups these faces stand for")),
                                 ("App::PropertyStringList", GROUPS, doc("The group of each face"))):
            obj.addProperty(kind, name, "Base", text)
            obj.setEditorMode(name, 1)  # read-only

    def execute(self, _obj):
        """Does nothing: the faces change only with the mesh."""


def is_ours(obj):
    return type_of(obj) == TYPE


def can_be_made(mesh_object):
    """Returns whether the object is an FEM mesh with elements that was made from a triangle mesh."""
    part = compatibility.meshed_object(mesh_object)
    return part is not None and elements.is_there(mesh_object.FemMesh) and inputs.triangles_of(part) is not None


def of(mesh_object):
    """Returns the object with the faces of a mesh; None if there is none."""
    return next((each for each in mesh_object.InList if is_ours(each)), None)


def make(mesh_object):
    """Returns the object with the faces; makes it if necessary. Raises MesherError."""
    if not can_be_made(mesh_object):
        raise MesherError(translate("collarmesh", "{label}: faces for constraints need a mesh with elements that was "
                                                  "made from a triangle mesh."), label=mesh_object.Label)
    there = of(mesh_object)
    if there is not None:
        return there
    document, part = mesh_object.Document, compatibility.meshed_object(mesh_object)
    with compatibility.transaction(document, translate("collarmesh", "Faces for constraints")):
        obj = document.addObject("Part::FeaturePython", "ConstraintFaces")
        Proxy(obj)
        obj.Label = translate("collarmesh", "Faces of {part}").format(part=part.Label)
        views.show(TYPE, obj)
        setattr(obj, MESH, mesh_object)
        _fill(obj, mesh_object.FemMesh)
    return obj


def references(mesh_object, names):
    """Returns the `References` of a constraint on the groups with these names. Raises MesherError."""
    obj = make(mesh_object)
    groups = getattr(obj, GROUPS)
    for name in names:
        if name not in groups:
            raise MesherError(translate("collarmesh", "{label} has no group of faces called {name}; it has {names}."),
                              label=mesh_object.Label, name=name, names=", ".join(dict.fromkeys(groups)))
    return [(obj, tuple(_face_of(groups, name) for name in names))]


def refresh(mesh_object):
    """Updates the faces after the mesh was made again; constraints stay on their groups. Returns messages on
    constraints whose group is gone."""
    obj = of(mesh_object)
    if obj is None:
        return []
    before, messages = getattr(obj, GROUPS), []
    _fill(obj, mesh_object.FemMesh)
    groups = getattr(obj, GROUPS)
    text = translate(
        "collarmesh", "{constraint} is on the group {name}, which the new mesh does not have; choose another one.")
    for constraint in _constraints_on(obj):
        kept = []
        for linked, names in constraint.References:
            wanted = [_group_of(before, name) if linked is obj else None for name in names]
            messages += [text.format(constraint=constraint.Label, name=name)
                         for name in wanted if name and name not in groups]
            names = [name if group is None else _face_of(groups, group) for name, group in zip(names, wanted)
                     if group is None or group in groups]
            kept += [(linked, tuple(names))] if names else []
        _set_references(constraint, kept)
    return messages


def _fill(obj, fem_mesh):
    """Makes the faces of a mesh's groups, and stores them in the object."""
    nodes = fem_mesh.Nodes
    numbers = numpy.array(sorted(nodes))
    points = numpy.array([tuple(nodes[number]) for number in numbers.tolist()])
    first, further = [], []
    for name, elements in _groups_of_faces(fem_mesh).items():
        triangles = numpy.array([fem_mesh.getElementNodes(each)[:3] for each in elements])
        faces = planar_pieces.faces(points, numpy.searchsorted(numbers, triangles))
        first.append((name, faces[0]))
        further += [(name, face) for face in faces[1:]]
    obj.Shape = Part.makeCompound([face for _, face in first + further])
    setattr(obj, GROUPS, [name for name, _ in first + further])


def _groups_of_faces(fem_mesh):
    found = {}
    for number in fem_mesh.Groups:
        if fem_mesh.getGroupElementType(number) == "Face" and fem_mesh.getGroupElements(number):
            found[fem_mesh.getGroupName(number)] = fem_mesh.getGroupElements(number)
    return found


def _face_of(groups, name):
    """Returns the name of a group's first face. Constraints on the group refer to it, whichever of the group's faces
    was chosen."""
    return f"Face{groups.index(name) + 1}"


def _group_of(groups, face):
    """Returns the group of a face; None for edges and vertices."""
    number = int(face[4:]) if face.startswith("Face") else 0
    return groups[number - 1] if 0 < number <= len(groups) else None


def _constraints_on(obj):
    return [each for each in obj.InList
            if _has_references(each) and any(linked is obj for linked, _ in each.References)]


def _has_references(obj):
    """Returns whether the object has references to sub-shapes, as constraints do. Other add-ons may use the name
    `References` for properties of another type."""
    return (REFERENCES in obj.PropertiesList
            and obj.getTypeIdOfProperty(REFERENCES).startswith("App::PropertyLinkSubList"))


def _set_references(constraint, wanted):
    if wanted != [(linked, tuple(names)) for linked, names in constraint.References]:
        constraint.References = wanted


def elements_of(fem_mesh, obj, name):
    """Returns the face elements of the group that a face stands for; None for other objects and edges, and if
    the mesh has no such group."""
    if not is_ours(obj):
        return None
    group = _group_of(getattr(obj, GROUPS), name)
    return None if group is None else _groups_of_faces(fem_mesh).get(group)


class _Observer:
    """An observer that makes each constraint refer to a group once, by the group's first face."""

    def slotChangedObject(self, changed, name):
        document = changed.Document
        if name != REFERENCES or document.Restoring or document.Transacting:
            return
        if not _has_references(changed) or not any(is_ours(linked) for linked, _ in changed.References):
            return
        wanted = []
        for linked, names in changed.References:
            if is_ours(linked):
                groups = getattr(linked, GROUPS)
                of_groups = [(name, _group_of(groups, name)) for name in names]
                names = dict.fromkeys(name if group is None else _face_of(groups, group) for name, group in of_groups)
            wanted.append((linked, tuple(names)))
        _set_references(changed, wanted)


def observe():
    FreeCAD.addDocumentObserver(_Observer())
