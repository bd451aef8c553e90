"""Sizes as objects of the document: in a sphere, a box or a cylinder, and near faces and edges. Works without the
GUI."""

import re

import FreeCAD
import Part

from . import compatibility, contacts, extent, inputs, views
from .objects import type_of
from .program import MesherError
from .translations import doc, translate

GROWTH = 0.3
DEFAULT_SHARE = 0.1  # radius of a new sphere, relative to the part's diagonal
TURNED = 1e-9  # rad; a box turned by less is parallel to the axes


class Size(compatibility.WithProperties):
    """The common part of all size objects: the size inside, and its growth outside."""

    lengths = ()  # lengths of the body: name, first value relative to DEFAULT_SHARE of the diagonal, text

    def add_properties(self, obj):
        have = obj.PropertiesList
        own = [("App::PropertyLength", name, text) for name, _, text in self.lengths]
        for kind, name, text in (
            ("App::PropertyLength", "Size", doc("Target edge length inside")),
            ("App::PropertyFloat", "Growth", doc("Growth of size per unit length away from there")),
            *own,
        ):
            if name not in have:
                obj.addProperty(kind, name, "Size", text)
                if name == "Growth":
                    obj.Growth = GROWTH

    def place(self, obj, part):
        """Sets first lengths of the body, and puts it in the middle of a part."""
        bounds = extent.bounding_box(part)
        length = DEFAULT_SHARE * bounds.DiagonalLength
        for name, share, _ in self.lengths:
            setattr(obj, name, share * length)
        obj.Placement.Base = bounds.Center - self.middle(obj)

    def middle(self, _obj):
        return FreeCAD.Vector()

    def sources(self, obj, _part):
        """Returns the object's sources for the program's size field. Raises MesherError."""
        for name in ("Size", *(name for name, _, _ in self.lengths)):
            if getattr(obj, name).Value <= 0:
                raise MesherError(translate("collarmesh", "{label}: {property} is {value}, but must be positive."),
                                  label=obj.Label, property=name, value=getattr(obj, name).UserString)
        if obj.Growth < 0:
            raise MesherError(translate("collarmesh", "{label}: Growth is {value}, but must be 0 or more."),
                              label=obj.Label, value=f"{obj.Growth:g}")
        return [{"size": obj.Size.Value, "growth": obj.Growth, **body} for body in self.bodies(obj)]


class Sphere(Size):
    Type = "Fem::CollarmeshSizeSphere"
    lengths = (("Radius", 1, doc("Radius of the sphere")),)

    def execute(self, obj):
        obj.Shape = Part.makeSphere(max(obj.Radius.Value, 1e-6))

    def bodies(self, obj):
        return [{"ball": {"centre": list(obj.Placement.Base), "radius": obj.Radius.Value}}]


class Box(Size):
    Type = "Fem::CollarmeshSizeBox"
    lengths = (
        ("Length", 2, doc("Length of the box along its x axis")),
        ("Width", 2, doc("Width of the box along its y axis")),
        ("Height", 2, doc("Height of the box along its z axis")),
    )

    def execute(self, obj):
        obj.Shape = Part.makeBox(*(max(getattr(obj, name).Value, 1e-6) for name, _, _ in self.lengths))

    def middle(self, obj):
        return FreeCAD.Vector(obj.Length.Value, obj.Width.Value, obj.Height.Value) / 2

    def bodies(self, obj):
        corner = obj.Placement.Base
        lengths = [getattr(obj, name).Value for name, _, _ in self.lengths]
        if abs(obj.Placement.Rotation.Angle) < TURNED:
            return [{"box": {"min": list(corner), "max": list(corner + FreeCAD.Vector(*lengths))}}]
        axes = (FreeCAD.Vector(1, 0, 0), FreeCAD.Vector(0, 1, 0), FreeCAD.Vector(0, 0, 1))
        edges = [list(obj.Placement.Rotation.multVec(axis * length)) for axis, length in zip(axes, lengths)]
        return [{"box": {"corner": list(corner), "edges": edges}}]


class Cylinder(Size):
    Type = "Fem::CollarmeshSizeCylinder"
    lengths = (
        ("Radius", 1, doc("Radius of the cylinder")),
        ("Height", 2, doc("Height of the cylinder along its z axis")),
    )

    def execute(self, obj):
        obj.Shape = Part.makeCylinder(max(obj.Radius.Value, 1e-6), max(obj.Height.Value, 1e-6))

    def middle(self, obj):
        return FreeCAD.Vector(0, 0, obj.Height.Value / 2)

    def bodies(self, obj):
        top = obj.Placement.multVec(FreeCAD.Vector(0, 0, obj.Height.Value))
        return [{"cylinder": {"from": list(obj.Placement.Base), "to": list(top), "radius": obj.Radius.Value}}]


class Distance(Size):
    """A size near faces and edges of the meshed object."""

    Type = "Fem::CollarmeshSizeDistance"
    TAGS = {
        "Face": "patches",
        "Edge": "curves",
    }  # names in the program's size field, whose tags are FreeCAD's numbers

    def add_properties(self, obj):
        super().add_properties(obj)
        if "References" not in obj.PropertiesList:
            obj.addProperty("App::PropertyLinkSubList", "References", "Size",
                            doc("Faces and edges near which the size holds"))
            obj.addProperty("App::PropertyLength", "Within", "Size",
                            doc("The size holds up to this distance and grows beyond"))
            obj.setEditorMode("Placement", 2)

    def place(self, obj, part):
        """Does nothing: the place follows from the faces and edges."""

    def execute(self, obj):
        shapes = [inputs.shape_of(linked).getElement(name) for linked, name in references(obj) if name]
        obj.Shape = Part.Compound(shapes) if shapes else Part.Shape()

    def sources(self, obj, part):
        self.check(obj, part)
        return super().sources(obj, part)

    def check(self, obj, part):
        shape = inputs.shape_of(part)
        for kind, number in subshapes(
                obj, part, self.TAGS,
                translate("collarmesh", "{label} refers to {other}, but {part} is meshed; choose its faces and edges."),
                translate("collarmesh", "{label}: {name} is no face and no edge."),
                translate("collarmesh", "{label}: {part} has no {name} any more; choose its faces and edges again.")):
            if kind == "Edge" and contacts.is_seam(shape, shape.Edges[number - 1]):
                raise MesherError(
                    translate("collarmesh", "{label}: {name} is the seam of a face, which the mesh does not have; "
                                            "choose the face."), label=obj.Label, name=f"{kind}{number}")
        if not references(obj):
            raise MesherError(translate("collarmesh", "{label} has no faces and edges; choose some, or delete it."),
                              label=obj.Label)

    def bodies(self, obj):
        tags = {}
        for _linked, name in references(obj):
            kind, number = kind_and_number(name)
            tags.setdefault(self.TAGS[kind], []).append(number)
        return [{kind: numbers, "within": obj.Within.Value} for kind, numbers in tags.items()]


def references(obj):
    """Returns [(object, name of a face or edge)]."""
    return [(linked, name) for linked, names in obj.References
            for name in ((names,) if isinstance(names, str) else names)]


def kind_and_number(name):
    """Returns ("Face", 7) for Face7; ("", 0) for other names."""
    match = re.fullmatch(r"([A-Za-z]+)([1-9]\d*)", name)
    return (match[1], int(match[2])) if match else ("", 0)


def subshapes(obj, part, kinds, other_part, other_kind, gone):
    """Yields the kind and the number of each sub-shape in an object's references. Raises MesherError for
    a sub-shape that is of another part, of another kind, or gone, with the text for this case."""
    shape = inputs.shape_of(part)
    for linked, name in references(obj):
        kind, number = kind_and_number(name)
        wrong = ""
        if linked is not part:
            wrong = other_part
        elif kind not in kinds:
            wrong = other_kind
        elif number > len(getattr(shape, kind + "s")):
            wrong = gone
        if wrong:
            raise MesherError(wrong, label=obj.Label, other=linked.Label, part=part.Label,
                              name=name or translate("collarmesh", "the whole object"))
        yield kind, number


KINDS = {"Sphere": Sphere, "Box": Box, "Cylinder": Cylinder, "Distance": Distance}
PROPERTY = "MeshSizeList"  # property of a mesh object


def kind_of(obj):
    """Returns the object's key in KINDS; None for other objects."""
    its_type = type_of(obj)
    return next((kind for kind, proxy in KINDS.items() if proxy.Type == its_type), None)


def make(mesh_object, kind, size=0, name=""):
    """Makes a new size object of a mesh object, in the middle of its part.

    `kind`: Sphere, Box, Cylinder or Distance; `size`: target edge length, mm; 0: a quarter of the mesh's own.
    """
    document = mesh_object.Document
    obj = document.addObject("Part::FeaturePython", name or f"Size{kind}")
    proxy = KINDS[kind](obj)
    part = compatibility.meshed_object(mesh_object)
    if part is not None:
        proxy.place(obj, part)
        if not size:
            own_size = mesh_object.CharacteristicLengthMax.Value or extent.bounding_box(part).DiagonalLength / 20
            size = own_size / 4
    obj.Size = size
    setattr(mesh_object, PROPERTY, [*getattr(mesh_object, PROPERTY), obj])
    views.show(proxy.Type, obj)
    obj.recompute()
    return obj


def sources_of(mesh_object):
    """Returns the sources of a mesh object's size objects: [(label, source of the program's size field)].
    Raises MesherError."""
    part = compatibility.meshed_object(mesh_object)
    objects = [obj for obj in getattr(mesh_object, PROPERTY) if not compatibility.is_suppressed(obj)]
    return [(obj.Label, source) for obj in objects for source in obj.Proxy.sources(obj, part)]


def field_of(mesh_object):
    """Returns the program's size field for a mesh object's size objects; None if there are none. Raises
    MesherError."""
    found = [source for _, source in sources_of(mesh_object)]
    return {"sources": found} if found else None


def with_labels(message, labels):
    """Rewrites the program's messages on its size field so that they name the objects. `labels` are those of
    the sources."""
    match = re.search(
        r"\S*: size field: sources\[(\d+)\](?:\.(patches|curves): no \w+ have the tag (\d+))?", message
    )
    if not match:
        return message
    label = labels[int(match[1])]
    if not match[2]:
        return message.replace(match[0], label)
    text = translate(
        "collarmesh",
        "{label}: the mesh has nothing of {name}: it lies inside another solid, or repair has removed it; choose "
        "others.",
    )
    kind = next(kind for kind, tags in Distance.TAGS.items() if tags == match[2])
    return text.format(label=label, name=f"{kind}{match[3]}")
