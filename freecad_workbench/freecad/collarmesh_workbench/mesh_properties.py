"""The properties of mesh objects, and the Settings that they represent. Works without the GUI."""

import re

from . import compatibility, layer_objects, preferences, size_objects
from .program import MesherError, Settings
from .translations import doc, translate

TYPE = "Fem::FemMeshCollarmesh"  # the type that FEM's tools check

# First come the names that FreeCAD's Gmsh object has, too, and that macros use. Rows: type, name, field of
# Settings, group in the property editor, text.
SIZES, FEATURES, QUALITY, RUN = "Sizes", "Features", "Quality", "Run"
PROPERTIES = (
    ("Length", "CharacteristicLengthMax", "size", SIZES, doc("Target edge length; 0: 1/20 of the diagonal")),
    ("Length", "CharacteristicLengthMin", "size_min", SIZES, doc("Never ask for less than this; 0: none")),
    ("Integer", "MeshSizeFromCurvature", "elements_per_circle", SIZES, doc("Elements on a full circle; 0: any")),
    ("Integer", "ElementsAcrossGap", "elements_across_gap", SIZES, doc("Elements across thin parts; 0: any")),
    ("Float", "Gradation", "gradation", SIZES, doc("Growth of size per unit length away from finer ones; 0: any")),
    ("Length", "SurfaceDistance", "distance", FEATURES,
     doc("Largest distance of faces and edges of the mesh from the shape; 0: 1/10 of the size, at most 1/200 "
         "of the diagonal (2nd order: 1/550)")),
    ("Angle", "CreaseAngle", "crease_angle", FEATURES, doc("Edges and faces that meet below it get a collar")),
    ("Angle", "CollarAngle", "collar_angle", FEATURES, doc("Bound on dihedral angles in collars")),
    ("Float", "PlanarTolerance", "planar_tolerance", FEATURES,
     doc("Faces this near to a plane are planar, relative to the diagonal; 0: 1e-6")),
    ("Float", "WeldTolerance", "weld", FEATURES,
     doc("Points closer than this are one, relative to the diagonal; 0: 1e-9")),
    ("Float", "RepairTolerance", "repair_tolerance", FEATURES,
     doc("Where the shape has to be repaired, features below this are noise, relative to the diagonal; 0: 1e-5")),
    ("Bool", "FillHoles", "fill_holes", FEATURES,
     doc("Make a volume of a surface that is open, by filling its holes")),
    ("Bool", "KeepApart", "keep_apart", FEATURES,
     doc("Give each solid nodes of its own where solids touch, for contact; otherwise they are glued")),
    ("StringList", "SplitFaces", "split", FEATURES,
     doc("Inner faces whose nodes are made twice, one for each side, as for cracks: Face7")),
    ("StringList", "PeriodicFaces", "periodic", FEATURES,
     doc("Pairs of sides that get the same nodes and triangles: x, y, z, Face1=Face2, Face1=Face2:rotation,z,60")),
    ("Bool", "LayersAsTetrahedra", "layers_tets", QUALITY, doc("Tetrahedra in place of prisms in boundary layers")),
    ("Bool", "InteriorNode", "interior_node", QUALITY, doc("Each element has a node that is on no face")),
    ("Bool", "Coarsen", "coarsen", QUALITY,
     doc("As few elements as the sizes ask for, thin ones in thin places; else the bound on circumradius / "
         "shortest edge holds everywhere outside collars")),
    ("Float", "RadiusEdgeRatio", "radius_edge", QUALITY, doc("Bound on circumradius / shortest edge")),
    ("Integer", "ImproveLevel", "improve", QUALITY, doc("Removal of slivers: 0 none, 1 quick, 2 good, 3 best")),
    ("Angle", "MinDihedralAngle", "min_dihedral", QUALITY,
     doc("Improve elements with smaller dihedral angles; 0: 15, 20 or 30 degrees by the level of improvement")),
    ("Integer", "Seed", "seed", RUN, doc("Another number gives another mesh of the same quality")),
    ("Float", "TimeLimit", "time_limit", RUN, doc("Give up after this many seconds; 0: never")),
)

ORDERS = ["1st", "2nd"]
DIMENSIONS = ["From Shape", "1D", "2D", "3D"]  # the same as in Gmsh's object
REPAIRS = {"Automatic": "auto", "None": "none", "Wrap": "wrap"}  # values: the program's words
REFINEMENTS = {"Solid": "solid_sizes", "Face": "face_sizes", "Edge": "edge_sizes"}


def is_ours(obj):
    return compatibility.type_of(obj) == TYPE


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
        value = compatibility.value_of(obj, name)
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
    size = compatibility.value_of(region, "CharacteristicLength")
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
