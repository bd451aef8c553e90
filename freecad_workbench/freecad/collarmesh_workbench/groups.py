"""Groups of elements with the names of FEM's objects, made from the groups of faces, edges and solids. Without such a
group, FreeCAD finds the elements of a material by the places of their nodes, which loses some elements where solids
touch; it prefers a volume group called `<material>_...`. A document observer makes the groups again when a material's
references or the members of the analysis change. Constraints need no groups, because their nodes lie on the exact
faces."""

import re

import FreeCAD
from femmesh import meshtools

from . import compatibility, contacts, elements, inputs, mesh_properties
from .objects import type_of
from .translations import translate

KINDS = {"Solid": "Volume", "Face": "Face", "Edge": "Edge"}


def named(fem_mesh):
    """Returns the numbers of the groups by name."""
    return {fem_mesh.getGroupName(number): number for number in fem_mesh.Groups}


def analysis_of(mesh_object):
    """Returns the analysis that contains the mesh; None if there is none."""
    return next((each for each in mesh_object.InList if each.isDerivedFrom("Fem::FemAnalysis")), None)


def materials_of(analysis):
    return [each for each in (analysis.Group if analysis else ())
            if each.Name and type_of(each) == "Fem::MaterialCommon"]


def elements_of(fem_mesh, part, subshapes):
    """Returns the kind of group, and the elements on sub-shapes with names like Face7. Searches for a face or an edge
    by place if the mesh has no group for it."""
    groups, kind, elements = named(fem_mesh), "", set()
    for name in subshapes:
        kind = next((value for key, value in KINDS.items() if name.startswith(key)), "")
        if kind and name in groups:
            elements.update(fem_mesh.getGroupElements(groups[name]))
        elif kind == "Face":
            elements.update(fem_mesh.getFacesByFace(inputs.shape_of(part).getElement(name)))
        elif kind == "Edge":
            elements.update(fem_mesh.getEdgesByEdge(inputs.shape_of(part).getElement(name)))
    return kind, sorted(elements)


def names_in(part, references):
    """Returns the names that the sub-shapes of references have in a part, if it has all of them, else
    nothing. FreeCAD would look for them by place, and take the first of two that coincide."""
    names = [name_in(part, obj, name) for obj, subshapes in references for name in subshapes]
    return sorted(names) if all(names) else []


def name_in(part, obj, name):
    """Returns the name that a sub-shape of an object, such as a compound, has in a part; "" if the part does not have
    it."""
    if obj is part:
        return name
    kind, number = re.fullmatch(r"([A-Za-z]*)(\d*)", name).groups()
    of_object, of_part = (getattr(inputs.shape_of(each), kind + "s", ()) for each in (obj, part))
    if not number or int(number) > len(of_object):
        return ""
    wanted_one = of_object[int(number) - 1]
    return next((f"{kind}{i}" for i, each in enumerate(of_part, 1) if _is_same(each, wanted_one)), "")


def _is_same(first, second):
    """Returns whether both are the same sub-shape at the same place."""
    near = contacts.SAME_PLACE * second.BoundBox.DiagonalLength
    return first.isPartner(second) and first.BoundBox.Center.distanceToPoint(second.BoundBox.Center) <= near


def wanted(mesh_object, fem_mesh):
    """Returns the groups that the mesh must have besides those of sub-shapes: [(name, kind, elements)]."""
    part = compatibility.meshed_object(mesh_object)
    if inputs.triangles_of(part) is not None:  # its segments already are groups
        return []
    references = {}
    for group in mesh_object.MeshGroupList:
        if compatibility.is_suppressed(group):
            continue
        references.update({key: names_in(part, group.References) or names
                           for key, names in meshtools.get_mesh_group_elements(group, part).items()})
    analysis = analysis_of(mesh_object)
    materials = materials_of(analysis)
    if len(inputs.shape_of(part).Solids) > 1 and materials:
        of_analysis = meshtools.get_analysis_group_elements(analysis, part)
        references.update({each.Name: of_analysis.get(each.Name, ()) for each in materials})
    groups = []
    for name, subshapes in references.items():
        kind, elements = elements_of(fem_mesh, part, subshapes)
        if elements:
            groups.append((f"{name}_{kind}s", kind, elements))
    return groups


def materials_elsewhere(mesh_object):
    """Returns messages on materials that have no elements because they refer to solids that the meshed part does not
    have."""
    part = compatibility.meshed_object(mesh_object)
    if part is None or inputs.triangles_of(part) is not None:
        return []
    shape = inputs.shape_of(part)
    text = translate(
        "collarmesh", "{material} has no elements: {part} has none of its solids ({names}); choose solids of {part}.")
    messages = []
    for each in materials_of(analysis_of(mesh_object)):
        found = meshtools.get_reference_group_elements(
            each, part)[1] if each.References and len(shape.Solids) > 1 else True
        if not found:
            names = ", ".join(f"{linked.Label}: {name}" for linked, subs in each.References for name in subs)
            messages.append(text.format(material=each.Label, part=part.Label, names=names))
    return messages


def add_groups(mesh_object, fem_mesh):
    """Updates the groups of `fem_mesh`. Returns True if any had to be changed."""
    made = {f"{name}_{kind}s" for name in names_of_owners(mesh_object) for kind in KINDS.values()}
    groups = wanted(mesh_object, fem_mesh)
    have = named(fem_mesh)
    stale = {name: number for name, number in have.items() if name in made}
    if {name: elements for name, _, elements in groups} == {
        name: sorted(fem_mesh.getGroupElements(number)) for name, number in stale.items()
    }:
        return False
    for number in stale.values():
        fem_mesh.removeGroup(number)
    for name, kind, elements in groups:
        fem_mesh.addGroupElements(fem_mesh.addGroup(name, kind), elements)
    return True


def names_of_owners(mesh_object):
    """Returns the names of all objects for which groups are made, including former members of the analysis."""
    document = mesh_object.Document
    return {name for each in document.Objects for name in (each.Name, each.Label) if hasattr(each, "References")}


class Observer:
    """An observer of the objects from which groups are made."""

    def slotChangedObject(self, changed, name):
        if name not in ("References", "Group"):
            return
        analyses = [changed] if name == "Group" else changed.InList
        for analysis in analyses:
            if analysis.isDerivedFrom("Fem::FemAnalysis") and not changed.Document.Restoring:
                self.refresh(analysis)

    def slotDeletedObject(self, deleted):
        if not hasattr(deleted, "References") or deleted.Document.Restoring:
            return
        names = {f"{name}_{kind}s" for name in (deleted.Name, deleted.Label) for kind in KINDS.values()}
        for each in meshes_among(deleted.Document.Objects):
            if names & named(each.FemMesh).keys():
                fem_mesh = each.FemMesh.copy()
                for name, number in named(fem_mesh).items():
                    if name in names:
                        fem_mesh.removeGroup(number)
                each.FemMesh = fem_mesh

    def refresh(self, analysis):
        for each in meshes_among(analysis.Group):
            fem_mesh = each.FemMesh.copy()
            if add_groups(each, fem_mesh):
                each.FemMesh = fem_mesh


def meshes_among(objects):
    """Returns our mesh objects that have a mesh and a part."""
    return [each for each in objects if mesh_properties.is_ours(each) and elements.is_there(each.FemMesh)
            and compatibility.meshed_object(each) is not None]


def observe():
    FreeCAD.addDocumentObserver(Observer())
