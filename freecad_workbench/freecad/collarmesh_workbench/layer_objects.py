"""Boundary layers as objects of the document: thin prisms along faces of a mesh. Works without the GUI."""

import Part

from . import compatibility, inputs, size_objects, views
from .objects import type_of
from .program import MesherError
from .translations import doc, translate

TYPE = "Fem::CollarmeshLayers"
PROPERTY = "MeshLayerList"  # property of a mesh object
COUNT, GROWTH = 3, 1.2
MOST_LAYERS, MOST_GROWTH = 1000, 10  # the program's bounds
# The object's properties: type, name, first value, text.
PROPERTIES = (
    ("App::PropertyLinkSubList", "References", None,
     doc("Faces that get layers; none: all outer faces. With a solid among them, only inside that solid")),
    ("App::PropertyLength", "FirstHeight", 0, doc("Height of the first layer; 0: a tenth of the edges there")),
    ("App::PropertyFloat", "Growth", GROWTH, doc("Ratio of the heights of a layer and the one below it, 1 to 10")),
    ("App::PropertyInteger", "Count", COUNT, doc("Number of layers")),
    ("App::PropertyLength", "Thickness", 0, doc("Height of all layers, in place of the first height; 0: none")),
)


class Layers(compatibility.WithProperties):
    Type = TYPE

    def add_properties(self, obj):
        for kind, name, value, text in PROPERTIES:
            if name not in obj.PropertiesList:
                obj.addProperty(kind, name, "Layers", text)
                if value is not None:
                    setattr(obj, name, value)
        obj.setEditorMode("Placement", 2)

    def execute(self, obj):
        """Shows the faces."""
        shapes = [inputs.shape_of(linked).getElement(name) for linked, name in size_objects.references(obj)
                  if size_objects.kind_and_number(name)[0] == "Face"]
        obj.Shape = Part.Compound(shapes) if shapes else Part.Shape()


def is_ours(obj):
    return type_of(obj) == TYPE


def make(mesh_object, name="BoundaryLayers"):
    """Makes new layers of a mesh object, on all outer faces at first."""
    obj = mesh_object.Document.addObject("Part::FeaturePython", name)
    Layers(obj)
    setattr(mesh_object, PROPERTY, [*getattr(mesh_object, PROPERTY), obj])
    views.show(TYPE, obj)
    obj.recompute()
    return obj


def mesh_object_of(obj):
    """Returns the mesh object that the layers belong to; None if there is none."""
    return next((each for each in obj.InList if obj in getattr(each, PROPERTY, [])), None)


def words_of(mesh_object):
    """Returns the program's text for each object of layers: faces and settings. Faces have FreeCAD's numbers.
    Raises MesherError."""
    part = compatibility.meshed_object(mesh_object)
    return [word_of(obj, part) for obj in getattr(mesh_object, PROPERTY) if not compatibility.is_suppressed(obj)]


def word_of(obj, part):
    faces, solids = subshapes(obj, part)
    if len(solids) > 1:
        raise MesherError(translate("collarmesh", "{label}: layers are on both sides of a face, or inside one solid; "
                                                  "{count} are chosen."), label=obj.Label, count=len(solids))
    settings = [f"growth={checked(obj, 'Growth', 1, MOST_GROWTH)!r}", f"count={checked(obj, 'Count', 1, MOST_LAYERS)}"]
    if obj.Thickness.Value > 0:
        settings.append(f"thickness={obj.Thickness.Value!r}")
    elif obj.FirstHeight.Value > 0:
        settings.append(f"first={obj.FirstHeight.Value!r}")
    settings += [f"region={number}" for number in solids]
    return ",".join(map(str, faces)) + ":" + ",".join(settings) if faces else "all:" + ",".join(settings)


def checked(obj, name, least, most):
    """Returns the value of a property. Raises MesherError if the program does not accept it."""
    value = getattr(obj, name)
    if least <= value <= most:
        return value
    raise MesherError(translate("collarmesh", "{label}: {property} is {value:g}; it has to be {least} to {most}."),
                      label=obj.Label, property=name, value=value, least=least, most=most)


def subshapes(obj, part):
    """Returns the numbers of the object's faces and of its solids. Raises MesherError for other sub-shapes."""
    found = {"Face": [], "Solid": []}
    for kind, number in size_objects.subshapes(
            obj, part, found,
            translate("collarmesh", "{label} refers to {other}, but {part} is meshed; choose its faces."),
            translate("collarmesh", "{label}: {name} is no face."),
            translate("collarmesh", "{label}: {part} has no {name} any more; choose its faces again.")):
        found[kind].append(number)
    return found["Face"], found["Solid"]


def notes(report, order):
    """Returns messages on the layers of a finished mesh, from the program's report."""
    layers = report.get("layers")
    if layers and layers["pyramids"] and order == 2:
        text = translate(
            "collarmesh",
            "The layers end in {count} pyramids, which FreeCAD has as bricks with equal nodes. Those of second "
            "order are inexact in CalculiX: choose tetrahedra in place of prisms, or first order.")
        return [text.format(count=layers["pyramids"])]
    return []
