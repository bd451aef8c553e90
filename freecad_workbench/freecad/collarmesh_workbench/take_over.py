"""Turns a mesh object of Gmsh or Netgen into one of ours, or ours into one of Gmsh. The new object keeps the sizes,
refinements, groups, mesh and place in the analysis. Works without the GUI."""

import math

import ObjectsFem

from . import compatibility, extent, inputs, layer_objects, mesh_object, mesh_properties, size_objects, up_to_date
from .objects import type_of, value_of
from .program import MesherError
from .translations import doc, translate

# Netgen's growth of sizes and number of elements along a radius of curvature, by the names of its levels of fineness.
FINENESS = {
    "VeryCoarse": (0.7, 1),
    "Coarse": (0.5, 1.5),
    "Moderate": (0.3, 2),
    "Fine": (0.2, 3),
    "VeryFine": (0.1, 5),
}
COMMON = ("CharacteristicLengthMax", "CharacteristicLengthMin",
          "MeshSizeFromCurvature", "ElementOrder", "ElementDimension")
KEPT = (size_objects.PROPERTY, layer_objects.PROPERTY)  # our objects, which Gmsh's mesh object keeps for us
# Gmsh's settings that have no counterpart of ours: each property, and the value with which it is not used.
ONLY_GMSH = (
    ("RecombineAll", False),
    ("Recombine3DAll", False),
    ("SecondOrderLinear", False),
)


def can_be_taken_over(obj):
    return mesher_of(obj) in ("Gmsh", "Netgen")


def mesher_of(obj):
    """Returns Gmsh, Netgen, or "" for other objects."""
    kind = type_of(obj)
    if kind == "Fem::FemMeshGmsh":
        return "Gmsh"
    if kind == "Fem::FemMeshNetgen" or obj.TypeId == "Fem::FemMeshShapeNetgenObject":
        return "Netgen"
    return ""


def take_over(old):
    """Replaces a mesh object of Gmsh or Netgen by ours, as one undo step. Returns the new object, and
    sentences on what was lost. Raises MesherError."""
    mesher = mesher_of(old)
    if not mesher:
        raise MesherError(translate("collarmesh", "{label} is no mesh of Gmsh or Netgen."), label=old.Label)
    document = old.Document
    with compatibility.transaction(document, translate("collarmesh", "Take over by collarmesh")):
        new = mesh_object.make(document, compatibility.meshed_object(old))
        notes = (take_gmsh if mesher == "Gmsh" else take_netgen)(old, new)
        refinements = compatibility.refinements_of(old)
        new.MeshRegionList = [each for each in refinements if compatibility.is_plain_refinement(each)]
        new.MeshGroupList = getattr(old, "MeshGroupList", [])
        for name in KEPT:
            setattr(new, name, getattr(old, name, []))
        notes += take_sizes_by_place([each for each in refinements if each not in new.MeshRegionList], new)
        notes += take_layers(getattr(old, "MeshBoundaryLayerList", []), new)
        replace(old, new)
        if new.FemMesh.NodeCount:
            # The mesh was not made by collarmesh, so it is out of date.
            up_to_date.remember(new, up_to_date.State([], mesher))
            up_to_date.show(new)
    return new, notes


def take_gmsh(old, new):
    for name in COMMON:
        if name in old.PropertiesList:
            setattr(new, name, getattr(old, name))
    new.KeepApart = not getattr(old, "CoherenceMesh", True)
    lost = [name for name, unused in ONLY_GMSH if getattr(old, name, unused) != unused]
    return note_on(lost, translate("collarmesh", "Settings of Gmsh that collarmesh does not have: {names}"))


def take_sizes_by_place(refinements, new):
    """Makes size objects of ours from sizes by place that later versions of FreeCAD have for Gmsh, and removes the
    latter. Returns notes on refinements without a counterpart, which stay in the document."""
    lost = []
    for each in refinements:
        wanted = compatibility.size_by_place(each)
        if wanted is None:
            lost.append(each.Label)
            continue
        kind, size, outside, distance, properties = wanted
        made = size_objects.make(new, kind, size)
        for name, value in properties.items():
            setattr(made, name, value)
        made.Growth = max(0, outside - size) / distance if distance > 0 else size_objects.GROWTH
        if compatibility.is_suppressed(each):
            made.addProperty("App::PropertyBool", "Suppressed", "Size")
            made.Suppressed = True
        take_place(made, each)
    return note_on(lost, translate("collarmesh", "Refinements of Gmsh that collarmesh does not have: {names}"))


def take_layers(layers, new):
    """Makes layers of ours from Gmsh's layers on faces, and removes the latter. Returns notes on Gmsh's other layers,
    which are for meshes of triangles and stay in the document."""
    lost = []
    for each in layers:
        names = [name for _, name in size_objects.references(each)]
        if not names or not all(name.startswith("Face") for name in names):
            lost.append(each.Label)
            continue
        made = layer_objects.make(new)
        made.References = each.References
        made.FirstHeight = each.MinimumThickness
        made.Growth, made.Count = max(1, each.GrowthRate), max(1, each.NumberOfLayers)
        take_place(made, each)
    return note_on(lost,
                   translate("collarmesh", "Boundary layers of Gmsh on edges, which collarmesh does not have: {names}"))


def take_place(made, old):
    """Removes `old` and gives its label to `made`."""
    made.recompute()
    label = old.Label
    old.Document.removeObject(old.Name)
    made.Label = label


def note_on(names, text):
    """Returns the note with these names in it, as a list, which is empty if there are no names."""
    return [text.format(names=", ".join(names))] if names else []


def take_netgen(old, new):
    part = compatibility.meshed_object(new)
    largest = value_of(old, "MaxSize", 0)
    if part is None or largest < extent.bounding_box(part).DiagonalLength:
        new.CharacteristicLengthMax = largest
    new.CharacteristicLengthMin = value_of(old, "MinSize", 0)
    new.ElementOrder = mesh_properties.ORDERS[bool(getattr(old, "SecondOrder", False))]
    radius = value_of(old, "NbSegsPerRadius", 0) or value_of(old, "CurvatureSafety", 0)
    growth, along_radius = FINENESS.get(getattr(old, "Fineness", ""), (value_of(old, "GrowthRate", 0), radius))
    new.Gradation = growth
    new.MeshSizeFromCurvature = round(2 * math.pi * along_radius)
    return []


def hand_over(old):
    """Replaces our object by Gmsh's, as one undo step. Returns the new object, and sentences on what was
    lost."""
    document = old.Document
    notes = []
    with compatibility.transaction(document, translate("collarmesh", "Hand over to Gmsh")):
        new = ObjectsFem.makeMeshGmsh(document, "FEMMeshGmsh")
        setattr(new, compatibility.shape_property(new), compatibility.meshed_object(old))
        for name in COMMON:
            if name in new.PropertiesList:
                setattr(new, name, getattr(old, name))
        if "CoherenceMesh" in new.PropertiesList:
            new.CoherenceMesh = not old.KeepApart
        if "SecondOrderLinear" in new.PropertiesList:
            new.SecondOrderLinear = False
        compatibility.set_refinements(new, old.MeshRegionList)
        new.MeshGroupList = old.MeshGroupList
        notes += keep_for_later(old, new)
        if inputs.triangles_of(compatibility.meshed_object(old) or old) is not None:
            notes.append(translate("collarmesh", "FreeCAD's Gmsh cannot mesh triangle meshes."))
        replace(old, new)
    return new, notes


def keep_for_later(old, new):
    """Keeps our sizes and layers, which Gmsh ignores, in case the mesh is taken over again. Returns notes."""
    kept = []
    for name in KEPT:
        objects = getattr(old, name)
        if objects:
            new.addProperty("App::PropertyLinkList", name, "Base", doc("Sizes and layers of collarmesh"), 4)
            setattr(new, name, objects)
            kept += [each.Label for each in objects]
    return note_on(kept, translate("collarmesh", "Gmsh ignores these sizes and layers: {names}"))


def replace(old, new):
    """Gives `new` the mesh, the label and the place in analyses and groups of `old`, and removes `old`."""
    new.FemMesh = old.FemMesh
    for holder in old.InList:
        if "Group" in holder.PropertiesList and old in holder.Group:
            holder.Group = [new if each is old else each for each in holder.Group]
    if "ViewObject" in dir(old) and old.ViewObject is not None and new.ViewObject is not None:
        new.ViewObject.Visibility = old.ViewObject.Visibility
    label = old.Label
    # Removing an object of some kinds also removes the objects that it lists.
    for name in ("MeshRegionList", "MeshRefinementList", "MeshGroupList", "MeshBoundaryLayerList", *KEPT):
        if name in old.PropertiesList:
            setattr(old, name, [])
    old.Document.removeObject(old.Name)
    new.Label = label
