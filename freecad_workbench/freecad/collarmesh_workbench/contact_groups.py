"""Groups of the faces and edges at which solids touch, and elements for constraints on them. Works without
the GUI."""

import re

from . import compatibility, contacts, mesh_properties, mesh_undo, up_to_date
from .groups import name_in, named

SIDES = ("_minus", "_plus")  # the program's suffixes for the two sides of a face


def add(shape, fem_mesh, apart):
    """Gives each face and edge of touching solids its group. The program writes a common part only into the group with
    the smallest number or, if solids are kept apart (`apart`), into a group for each of its two sides."""
    here = contacts.of(shape)
    owners = _Owners(here, fem_mesh) if apart else None
    for kind, find in (("Face", fem_mesh.getFacesByFace), ("Edge", fem_mesh.getEdgesByEdge)):
        elements_of_tag = _elements_of_tags(fem_mesh, kind)
        for number in here.numbers(kind) if apart else here.in_contact(kind):
            elements = set()
            for tag in here.tags(kind, number):
                found = elements_of_tag.get(tag, set())
                if found and not here.has_all(kind, tag, number):
                    found = found & set(find(shape.getElement(f"{kind}{number}")))
                elements |= found
            _set_group(fem_mesh, f"{kind}{number}", kind, owners.own(kind, number, elements) if apart else elements)
            if apart and len(here.solids(kind, number)) == 1:
                for side in SIDES:
                    _set_group(fem_mesh, f"{kind}{number}{side}", kind, ())


def elements_of(fem_mesh, obj, name):
    """Returns the elements of a face, an edge or a solid in a mesh that keeps solids apart: there, nodes of two solids
    lie at the same place, so a search by place would mix them. None for other meshes."""
    for mesh_object in filter(mesh_properties.is_ours, compatibility.mesh_objects(obj.Document)):
        part = compatibility.meshed_object(mesh_object)
        if part is not None and up_to_date.is_kept_apart(mesh_object) and mesh_undo.same(mesh_object.FemMesh, fem_mesh):
            group = named(fem_mesh).get(name_in(part, obj, name))
            return None if group is None else fem_mesh.getGroupElements(group)
    return None


class _Owners:
    """The solids to which elements belong, by their nodes."""

    def __init__(self, here, fem_mesh):
        self.here, self.fem_mesh = here, fem_mesh
        self._solids = {name: fem_mesh.getGroupElements(number) for name, number in named(fem_mesh).items()
                        if re.fullmatch(r"Solid\d+", name)}
        self._nodes = {}

    def own(self, kind, number, elements):
        """Returns the elements whose nodes all belong to one of the solids that have this face or edge."""
        nodes = [self._nodes_of(solid) for solid in self.here.solids(kind, number)]
        return {each for each in elements if any(set(self.fem_mesh.getElementNodes(each)) <= those for those in nodes)}

    def _nodes_of(self, solid):
        if solid not in self._nodes:
            elements = self._solids.get(f"Solid{solid}", ())
            self._nodes[solid] = {node for each in elements for node in self.fem_mesh.getElementNodes(each)}
        return self._nodes[solid]


def _elements_of_tags(fem_mesh, kind):
    """Returns the elements of each face or edge, by its number in the mesh; both sides of a face are combined."""
    found = {}
    for name, number in named(fem_mesh).items():
        match = re.fullmatch(rf"{kind}(\d+)({'|'.join(SIDES)})?", name)
        if match:
            found.setdefault(int(match[1]), set()).update(fem_mesh.getGroupElements(number))
    return found


def _set_group(fem_mesh, name, kind, elements):
    before = named(fem_mesh).get(name)
    if before is not None:
        fem_mesh.removeGroup(before)
    if elements:
        fem_mesh.addGroupElements(fem_mesh.addGroup(name, kind), sorted(elements))
