"""Decides whether a mesh still belongs to its shape, its sizes and its settings. Hidden properties of a mesh
object record from what its mesh was made. Nothing here makes a mesh."""

import dataclasses
import json
import math

import numpy

from . import compatibility, inputs, mesh_properties
from .program import Settings
from .translations import doc

SHAPE, SETTINGS = "MeshedShape", "MeshedSettings"
MARKS = 8  # number of weighted sums that identify a shape
SAME_PLACE = 1e-9  # relative to the largest coordinate; FreeCAD's files keep 16 digits
DIGITS = 10  # digits of a setting that are compared
HIDDEN = 4 | 16  # for addProperty: Prop_Hidden, and Prop_NoRecompute because it changes no mesh
WITHOUT_EFFECT = ("time_limit",)


@dataclasses.dataclass
class State:
    """The shape and the settings from which a mesh was made: identifying numbers of the shape, and a text of
    the settings."""

    shape: list
    settings: str


def add_properties(obj):
    for kind, name, text in (("App::PropertyFloatList", SHAPE, doc("The shape that the mesh was made from")),
                             ("App::PropertyString", SETTINGS, doc("The settings that the mesh was made with"))):
        if name not in obj.PropertiesList:
            obj.addProperty(kind, name, "Base", text, HIDDEN)


def shape_numbers(part):
    """Returns numbers that change with the shape of an object, or with the numbers of its faces and edges."""
    mesh = inputs.triangles_of(part)
    if mesh is not None:
        points, triangles = mesh.Topology
        return marks(numpy.array([tuple(p) for p in points]), numpy.array(triangles), inputs.segments(mesh))
    shape = inputs.shape_of(part)
    counts = [len(each) for each in (shape.Solids, shape.Faces, shape.Edges, shape.Vertexes)]
    return marks(numpy.array([tuple(p) for p in sample(shape)]), numpy.array(counts))


def sample(shape):
    """Returns points on every vertex, edge and face."""
    for vertex in shape.Vertexes:
        yield vertex.Point
    inside = (0.11, 0.5, 0.83)  # positions in the range of parameters, not symmetric
    for edge in shape.Edges:
        if not edge.Degenerated:
            first, last = edge.ParameterRange
            yield from (edge.valueAt(first + share * (last - first)) for share in inside)
    for face in shape.Faces:
        u0, u1, v0, v1 = face.ParameterRange
        yield from (face.valueAt(u0 + s * (u1 - u0), v0 + t * (v1 - v0)) for s in inside for t in inside)


def marks(points, *numbers):
    """Returns sums of all coordinates and numbers, with weights that depend on their positions in the arrays; then the
    largest coordinate and the number of points, which determine how exact the sums are."""
    sums = numpy.zeros(MARKS)
    frequencies = numpy.sqrt(numpy.arange(2, 2 + MARKS))
    for values in (points, *numbers):
        flat = numpy.ravel(values).astype(float)
        places = numpy.arange(1, len(flat) + 1)
        sums += [math.fsum(flat * numpy.cos(frequency * places)) for frequency in frequencies]
    return [*sums.tolist(), float(numpy.abs(points).max(initial=0)), float(len(points))]


def same_shape(first, second):
    if len(first) != len(second) or first[-1] != second[-1]:
        return False
    tolerance = SAME_PLACE * max(first[-2], second[-2]) * math.sqrt(first[-1])
    return all(abs(a - b) <= tolerance for a, b in zip(first[:-1], second[:-1]))


def has_shape(part, numbers):
    """Returns whether the object has the shape with these numbers. False for shapes that cannot be read."""
    try:
        return same_shape(numbers, shape_numbers(part))
    except Exception:  # OpenCASCADE's exceptions, too: a shape that cannot be read cannot be meshed
        return False


def settings_text(settings, groups):
    """Returns the settings as text. `groups`: for each group object its name and sub-shapes."""
    values = {
        name: value for name, value in dataclasses.asdict(settings).items() if name not in WITHOUT_EFFECT
    }
    return json.dumps({**values, "groups": groups}, sort_keys=True)


def same_settings(first, second):
    """Compares settings. If only one of the two has a setting, the other is of an older version, and counts
    as having the default."""
    if not (first.startswith("{") and second.startswith("{")):
        return first == second
    defaults = json.loads(settings_text(Settings(), []))
    return rounded({**defaults, **json.loads(first)}) == rounded({**defaults, **json.loads(second)})


def rounded(value):
    if isinstance(value, dict):
        return {key: rounded(each) for key, each in value.items()}
    if isinstance(value, list):
        return [rounded(each) for each in value]
    return float(f"{value:.{DIGITS}g}") if isinstance(value, float) else value


def state_of(obj):
    """Returns the State that a new mesh of the object would have. Raises MesherError."""
    part = mesh_properties.part_to_mesh(obj)
    groups = [
        [group.Name, [[linked.Name, list(names)] for linked, names in group.References]]
        for group in obj.MeshGroupList if not compatibility.is_suppressed(group)
    ]
    return State(shape_numbers(part), settings_text(mesh_properties.settings_of(obj), groups))


def remember(obj, state):
    setattr(obj, SHAPE, state.shape)
    setattr(obj, SETTINGS, state.settings)


def is_kept_apart(obj):
    """Returns whether the mesh was made with separate nodes for touching solids."""
    made_with = getattr(obj, SETTINGS, "")
    return made_with.startswith("{") and json.loads(made_with).get("keep_apart", False)


def is_out_of_date(obj):
    """Returns whether shape or settings have changed since the mesh was made. False without a mesh."""
    made_with = getattr(obj, SETTINGS, "")
    if not made_with or obj.FemMesh.NodeCount == 0:
        return False
    try:
        now = state_of(obj)
    except Exception:  # OpenCASCADE's exceptions, too: a shape that cannot be read cannot be meshed
        return True
    return not (same_settings(made_with, now.settings) and same_shape(list(getattr(obj, SHAPE)), now.shape))


def show(obj):
    """Marks the object in the tree if it is out of date."""
    proxy = getattr(getattr(obj, "ViewObject", None), "Proxy", None)
    if hasattr(proxy, "show_out_of_date"):
        proxy.show_out_of_date(is_out_of_date(obj))
