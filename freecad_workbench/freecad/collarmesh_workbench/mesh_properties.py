"""The properties of mesh objects, and the Settings that they represent. Works without the GUI."""

import dataclasses
import re

from . import compatibility, layer_objects, preferences, size_objects
from .objects import type_of, value_of
from .option_table import OPTIONS
from .program import MesherError, Settings
from .translations import doc, translate

TYPE = "Fem::FemMeshCollarmesh"  # the type that FEM's tools check

# First come the names that FreeCAD's Gmsh object has, too, and that macros use. Rows: name, field of Settings, group in
# the property editor, and the text if it is not that of the option.
SIZES, FEATURES, QUALITY, RUN = "Sizes", "Features", "Quality", "Run"
ROWS = (
    ("CharacteristicLengthMax", "size", SIZES),
    ("CharacteristicLengthMin", "size_min", SIZES),
    ("MeshSizeFromCurvature", "elements_per_circle", SIZES),
    ("ElementsAcrossGap", "elements_across_gap", SIZES),
    ("Gradation", "gradation", SIZES),
    ("SurfaceDistance", "distance", FEATURES),
    ("CreaseAngle", "crease_angle", FEATURES),
    ("CollarAngle", "collar_angle", FEATURES),
    ("PlanarTolerance", "planar_tolerance", FEATURES),
    ("WeldTolerance", "weld", FEATURES),
    ("RepairTolerance", "repair_tolerance", FEATURES),
    ("FillHoles", "fill_holes", FEATURES, doc("Make a volume of a surface that is open, by filling its holes")),
    ("KeepApart", "keep_apart", FEATURES,
     doc("Give each solid nodes of its own where solids touch, for contact; otherwise they are glued")),
    ("SplitFaces", "split", FEATURES,
     doc("Inner faces whose nodes are made twice, one for each side, as for cracks: Face7")),
    ("PeriodicFaces", "periodic", FEATURES,
     doc("Pairs of sides that get the same nodes and triangles: x, y, z, Face1=Face2, Face1=Face2:rotation,z,60")),
    ("LayersAsTetrahedra", "layers_tets", QUALITY),
    ("InteriorNode", "interior_node", QUALITY),
    ("Coarsen", "coarsen", QUALITY),
    ("RadiusEdgeRatio", "radius_edge", QUALITY),
    ("ImproveLevel", "improve", QUALITY),
    ("MinDihedralAngle", "min_dihedral", QUALITY),
    ("Seed", "seed", RUN),
    ("TimeLimit", "time_limit", RUN),
)
KIND_OF_UNIT = {"length": "Length", "degrees": "Angle"}
KIND_OF_TYPE = {int: "Integer", float: "Float", bool: "Bool", list: "StringList"}
TYPE_OF_FIELD = {field.name: field.type for field in dataclasses.fields(Settings)}


def _property(name, field, group, text=""):
    """Returns a row of PROPERTIES."""
    option = OPTIONS.get(field)
    kind = KIND_OF_UNIT.get(option.unit if option else "") or KIND_OF_TYPE[TYPE_OF_FIELD[field]]
    return kind, name, field, group, text or option.text


PROPERTIES = tuple(_property(*row) for row in ROWS)  # rows: type, name, field of Settings, group, text

ORDERS = ["1st", "2nd"]
DIMENSIONS = ["From Shape", "1D", "2D", "3D"]  # the same as in Gmsh's object
REPAIRS = {"Automatic": "auto", "None": "none", "Wrap": "wrap"}  # values: the program's words
REFINEMENTS = {"Solid": "solid_sizes", "Face": "face_sizes", "Edge": "edge_sizes"}


def is_ours(obj):
    return type_of(obj) == TYPE


def add_properties(obj):
    """Adds the properties that the object does not have yet, with their defaults."""
    defaults = Settings(improve=preferences.improve_level())
    have = obj.PropertiesList
    if "Shape" not in have and "Part" not in have:
        obj.addProperty("App::PropertyLink", "Part", "FEM Mesh", doc("The object whose shape is meshed"))
    for kind, name, field, group, text in PROPERTIES:
        if name not in have:
            obj.addProperty("App::Property" + kind, name, group, text)
            setattr(obj, name, getattr(defaults, field))
    for name, words, default, group, text in (
        ("ElementOrder", ORDERS, ORDERS[preferences.second_order()], QUALITY, doc("Order of the elements")),
        ("ElementDimension", DIMENSIONS, DIMENSIONS[0], QUALITY,
         doc("Dimension of the elements. 3D: tetrahedra in solids; 2D: triangles on faces, for shells; 1D: lines on "
             "edges, for beams; From Shape: by what the shape encloses")),
        ("Repair", list(REPAIRS), "Automatic", FEATURES,
         doc("What to do with triangles of the shape that intersect or leave holes. Automatic: "
             "repair them; None: refuse them; Wrap: where repair fails, mesh a closed surface "
             "around everything")),
    ):
        if name not in have:
            obj.addProperty("App::PropertyEnumeration", name, group, text)
            setattr(obj, name, words)
            setattr(obj, name, default)
    for name, text in (
        ("MeshRegionList", doc("Finer parts of the mesh")),
        ("MeshGroupList", doc("Groups of the mesh")),
        (size_objects.PROPERTY, doc("Sizes in spheres, boxes and cylinders and near faces and edges")),
        (layer_objects.PROPERTY, doc("Boundary layers along faces")),
    ):
        if name not in have:
            obj.addProperty("App::PropertyLinkList", name, "Base", text)


def settings_of(obj):
    """Returns the Settings that the object's properties represent. Raises MesherError."""
    values = {}
    for _kind, name, field, _group, _text in PROPERTIES:
        value = value_of(obj, name)
        values[field] = list(value) if isinstance(value, (list, tuple)) else value
    settings = Settings(
        order=ORDERS.index(obj.ElementOrder) + 1,
        dimension=DIMENSIONS.index(obj.ElementDimension),
        repair=REPAIRS[obj.Repair],
        **values,
    )
    for region in obj.MeshRegionList:
        if compatibility.is_suppressed(region):
            continue
        add_refinement(region, compatibility.meshed_object(obj), settings)
    settings.size_field = size_objects.field_of(obj)
    settings.layers = layer_objects.words_of(obj)
    return settings


def apply_settings(obj, settings):
    """Sets the properties from Settings, except sizes by sub-shape and layers, which have no property."""
    for _kind, name, field, _group, _text in PROPERTIES:
        setattr(obj, name, getattr(settings, field))
    obj.ElementOrder = ORDERS[settings.order - 1]
    obj.ElementDimension = DIMENSIONS[settings.dimension]
    obj.Repair = next(name for name, word in REPAIRS.items() if word == settings.repair)


def add_refinement(region, part, settings):
    """Adds the sizes of a mesh region object. If several objects give a size to a sub-shape, the smallest
    counts."""
    size = value_of(region, "CharacteristicLength")
    if not size:
        return
    for linked, names in region.References:
        if part is not None and linked is not part:
            raise MesherError(
                translate("collarmesh", "{label} refers to {other}, but {part} is meshed; choose its sub-shapes."),
                label=region.Label, other=linked.Label, part=part.Label)
        for name in (names,) if isinstance(names, str) else names:
            kind, number = re.fullmatch(r"([A-Za-z]*)(\d*)", name).groups()
            if kind not in REFINEMENTS or not number:
                raise MesherError(translate("collarmesh", "{label}: {name} cannot have a size of its own."),
                                  label=region.Label, name=name or translate("collarmesh", "the whole object"))
            sizes = getattr(settings, REFINEMENTS[kind])
            sizes[int(number)] = min(size, sizes.get(int(number), size))


def part_to_mesh(obj):
    """Returns the object to mesh. Raises MesherError."""
    part = compatibility.meshed_object(obj)
    if part is None:
        raise MesherError(translate("collarmesh", "{label}: no object is chosen to be meshed."), label=obj.Label)
    return part
