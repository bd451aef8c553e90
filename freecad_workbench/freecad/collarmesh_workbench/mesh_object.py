"""The mesh object in the document: its properties, and how its mesh is made. Works without the GUI."""

import re

import Fem
import FreeCAD

from . import compatibility, groups, inputs, mesh_undo, preferences, size_objects, up_to_date
from .program import GUARANTEE_MISSED, Job, MesherError, Settings
from .translations import doc, translate

# Names that macros for FreeCAD's Gmsh object use as well come first. Lines: type, name, field of Settings, group in
# the property editor, text.
SIZES, FEATURES, QUALITY, RUN = "Sizes", "Features", "Quality", "Run"
PROPERTIES = (
    (
        "App::PropertyLength",
        "CharacteristicLengthMax",
        "size",
        SIZES,
        doc("Target edge length; 0: 1/20 of the diagonal"),
    ),
    (
        "App::PropertyLength",
        "CharacteristicLengthMin",
        "size_min",
        SIZES,
        doc("Never ask for less than this; 0: none"),
    ),
    (
        "App::PropertyInteger",
        "MeshSizeFromCurvature",
        "elements_per_circle",
        SIZES,
        doc("Elements on a full circle; 0: any"),
    ),
    (
        "App::PropertyInteger",
        "ElementsAcrossGap",
        "elements_across_gap",
        SIZES,
        doc("Elements across thin parts; 0: any"),
    ),
    (
        "App::PropertyFloat",
        "Gradation",
        "gradation",
        SIZES,
        doc("Growth of size per unit length away from finer ones; 0: any"),
    ),
    (
        "App::PropertyLength",
        "SurfaceDistance",
        "distance",
        FEATURES,
        doc(
            "Largest distance of faces and edges of the mesh from the shape; 0: 1/10 of the size, at most 1/200 of "
            "the diagonal (2nd order: 1/550)"
        ),
    ),
    (
        "App::PropertyAngle",
        "CreaseAngle",
        "crease_angle",
        FEATURES,
        doc("Edges and faces that meet below it get a collar"),
    ),
    (
        "App::PropertyAngle",
        "CollarAngle",
        "collar_angle",
        FEATURES,
        doc("Bound on dihedral angles in collars"),
    ),
    (
        "App::PropertyFloat",
        "PlanarTolerance",
        "planar_tolerance",
        FEATURES,
        doc("Faces this near to a plane are planar, relative to the diagonal; 0: 1e-6"),
    ),
    (
        "App::PropertyFloat",
        "WeldTolerance",
        "weld",
        FEATURES,
        doc("Points closer than this are one, relative to the diagonal; 0: 1e-9"),
    ),
    (
        "App::PropertyFloat",
        "RepairTolerance",
        "repair_tolerance",
        FEATURES,
        doc(
            "Where the shape has to be repaired, features below this are noise, relative to the diagonal; 0: 1e-5"
        ),
    ),
    (
        "App::PropertyBool",
        "Coarsen",
        "coarsen",
        QUALITY,
        doc(
            "As few elements as the sizes ask for, thin ones in thin places; else the bound on circumradius / shortest edge "
            "holds everywhere outside collars"
        ),
    ),
    (
        "App::PropertyFloat",
        "RadiusEdgeRatio",
        "radius_edge",
        QUALITY,
        doc("Bound on circumradius / shortest edge"),
    ),
    (
        "App::PropertyInteger",
        "ImproveLevel",
        "improve",
        QUALITY,
        doc("Removal of slivers: 0 none, 1 quick, 2 good, 3 best"),
    ),
    (
        "App::PropertyAngle",
        "MinDihedralAngle",
        "min_dihedral",
        QUALITY,
        doc(
            "Improve elements with smaller dihedral angles; 0: 15, 20 or 30 degrees by the level of improvement"
        ),
    ),
    (
        "App::PropertyInteger",
        "Seed",
        "seed",
        RUN,
        doc("Another number gives another mesh of the same quality"),
    ),
    ("App::PropertyFloat", "TimeLimit", "time_limit", RUN, doc("Give up after so many seconds; 0: never")),
)
ORDERS = ["1st", "2nd"]
REPAIRS = {"Automatic": "auto", "None": "none", "Wrap": "wrap"}  # the program's words
TINY = 0.01  # of the target edge length: edges that hardly anybody means
REFINEMENTS = {"Solid": "solid_sizes", "Face": "face_sizes", "Edge": "edge_sizes"}


class MeshProxy(compatibility.Stateless):
    """The Python side of the object. `Type` is what FEM's tools ask for."""

    Type = "Fem::FemMeshCollarmesh"

    def __init__(self, obj):
        obj.Proxy = self
        add_properties(obj)

    def onDocumentRestored(self, obj):
        add_properties(obj)

    def execute(self, obj):
        """FreeCAD recomputes the object: its mesh stays, and is marked if it is out of date."""
        up_to_date.show(obj)


def is_ours(obj):
    return getattr(getattr(obj, "Proxy", None), "Type", "") == MeshProxy.Type


def add_properties(obj):
    """Add the properties that the object does not have yet, with their defaults."""
    defaults = Settings(improve=preferences.improve_level())
    have = obj.PropertiesList
    if "Shape" not in have and "Part" not in have:
        obj.addProperty("App::PropertyLink", "Part", "FEM Mesh", doc("The object whose shape is meshed"))
    for kind, name, field, group, text in PROPERTIES:
        if name not in have:
            obj.addProperty(kind, name, group, text)
            setattr(obj, name, getattr(defaults, field))
    if "ElementOrder" not in have:
        obj.addProperty("App::PropertyEnumeration", "ElementOrder", QUALITY, doc("Order of the elements"))
        obj.ElementOrder = ORDERS
        obj.ElementOrder = ORDERS[preferences.second_order()]
    if "Repair" not in have:
        obj.addProperty(
            "App::PropertyEnumeration",
            "Repair",
            FEATURES,
            doc(
                "What to do with triangles of the shape that intersect or leave holes. Automatic: "
                "repair them; None: refuse them; Wrap: where repair fails, mesh a closed surface "
                "around everything"
            ),
        )
        obj.Repair = list(REPAIRS)
        obj.Repair = "Automatic"
    for name, text in (
        ("MeshRegionList", doc("Finer parts of the mesh")),
        ("MeshGroupList", doc("Groups of the mesh")),
        (size_objects.PROPERTY, doc("Sizes in spheres, boxes and cylinders and near faces and edges")),
    ):
        if name not in have:
            obj.addProperty("App::PropertyLinkList", name, "Base", text)
    up_to_date.add_properties(obj)
    mesh_undo.add_properties(obj)


def make(document, part=None, name="FEMMeshCollarmesh"):
    """A new mesh object, empty, for the shape of `part`."""
    obj = compatibility.add_mesh_object(document, name)
    MeshProxy(obj)
    if part is not None:
        setattr(obj, compatibility.shape_property(obj), part)
    if compatibility.has_gui():
        from .view_provider import MeshViewProvider

        MeshViewProvider(obj.ViewObject)
    return obj


def settings_of(obj):
    """The Settings that the object's properties ask for. Raises MesherError."""
    values = {}
    for _kind, name, field, _group, _text in PROPERTIES:
        value = getattr(obj, name)
        values[field] = getattr(value, "Value", value)
    settings = Settings(order=ORDERS.index(obj.ElementOrder) + 1, repair=REPAIRS[obj.Repair], **values)
    for region in obj.MeshRegionList:
        add_refinement(region, compatibility.meshed_object(obj), settings)
    settings.size_field = size_objects.field_of(obj)
    return settings


def apply_settings(obj, settings):
    """The other way round; sizes by sub-shape have no property."""
    for _kind, name, field, _group, _text in PROPERTIES:
        setattr(obj, name, getattr(settings, field))
    obj.ElementOrder = ORDERS[settings.order - 1]
    obj.Repair = next(name for name, word in REPAIRS.items() if word == settings.repair)


def add_refinement(region, part, settings):
    """The sizes of a mesh region object; the smallest counts where several have one."""
    size = getattr(region.CharacteristicLength, "Value", region.CharacteristicLength)
    if not size:
        return
    for linked, names in region.References:
        if part is not None and linked is not part:
            raise MesherError(
                translate(
                    "collarmesh", "{label} refers to {other}, but {part} is meshed; choose its sub-shapes."
                ).format(label=region.Label, other=linked.Label, part=part.Label)
            )
        for name in (names,) if isinstance(names, str) else names:
            kind, number = re.fullmatch(r"([A-Za-z]*)(\d*)", name).groups()
            if kind not in REFINEMENTS or not number:
                raise MesherError(
                    translate("collarmesh", "{label}: {name} cannot have a size of its own.").format(
                        label=region.Label, name=name or translate("collarmesh", "the whole object")
                    )
                )
            sizes = getattr(settings, REFINEMENTS[kind])
            sizes[int(number)] = min(size, sizes.get(int(number), size))


def part_to_mesh(obj):
    """The object that is to be meshed. Raises MesherError."""
    part = compatibility.meshed_object(obj)
    if part is None:
        raise MesherError(
            translate("collarmesh", "{label}: no object is chosen to be meshed.").format(label=obj.Label)
        )
    return part


def start(obj, program="", settings=None):
    """A Job with the shape written, to be run; `settings` in place of the object's own. Raises MesherError."""
    part = part_to_mesh(obj)
    state = up_to_date.state_of(obj)
    settings = settings or settings_of(obj)
    job = Job(settings, program or preferences.program(), preferences.threads(), inputs.file_name(part))
    try:
        inputs.write(part, job.shape)
    except Exception:
        job.__exit__()
        raise
    job.messages += tiny_edges(inputs.shape_of(part), settings.size)
    job.state = state
    labels = [label for label, _ in size_objects.sources_of(obj)]
    job.explain = lambda text: size_objects.with_labels(text, labels)
    return job


def tiny_edges(shape, size):
    """Warnings, one for each edge much shorter than the target edge length (mm; 0: the default)."""
    if shape.isNull():
        return []
    size = size or shape.BoundBox.DiagonalLength / 20
    text = translate(
        "collarmesh",
        "{edge} at {place} is only {length} mm long, the mesh becomes very fine there: remove the edge if it is not "
        "meant (Part: Defeaturing)",
    )
    return [
        "warning: "
        + text.format(
            edge=f"Edge{number}",
            place=f"({place.x:.6g}, {place.y:.6g}, {place.z:.6g})",
            length=f"{edge.Length:.3g}",
        )
        for number, edge in enumerate(shape.Edges, 1)
        if not edge.Degenerated and edge.Length < TINY * size
        for place in [edge.CenterOfMass]
    ]


def finish(obj, job, exit_code=0):
    """Put the mesh of a job that ended into the object. Raises MesherError; the object keeps its mesh then."""
    job.require_success(exit_code)
    fem_mesh = Fem.read(job.mesh)
    if fem_mesh.VolumeCount == 0:
        raise MesherError(
            translate(
                "collarmesh", "The mesher wrote a mesh without elements; please report it with the shape."
            )
        )
    groups.add_groups(obj, fem_mesh)
    report = job.report()
    with compatibility.transaction(obj.Document, translate("collarmesh", "Mesh by collarmesh")):
        mesh_undo.replace(obj, fem_mesh)
        up_to_date.remember(obj, job.state)
    up_to_date.show(obj)
    said = job.messages if exit_code == GUARANTEE_MISSED else [*job.warnings(), *report["notes"]]
    if said:
        FreeCAD.Console.PrintWarning("collarmesh: " + "\n".join(said) + "\n")
    return report


def remesh(obj, progress=None):
    """Make the object's mesh anew and wait; returns the program's report. Raises MesherError."""
    with start(obj) as job:
        exit_code = job.run(progress)
        return finish(obj, job, exit_code)


def mesh(shape_or_object, document, analysis, name, settings):
    """See `collarmesh_workbench.mesh`."""
    part = shape_or_object if hasattr(shape_or_object, "Document") else None
    document = document or (part.Document if part else FreeCAD.ActiveDocument) or FreeCAD.newDocument()
    added = []
    try:
        if part is None:
            part = document.addObject("Part::Feature", "Shape")
            added.append(part)
            part.Shape = shape_or_object
        obj = make(document, part, name)
        added.append(obj)
        apply_settings(obj, settings)
        with start(obj, settings=settings) as job:
            finish(obj, job, job.run())
    except Exception:
        for each in reversed(added):
            document.removeObject(each.Name)
        raise
    if analysis is not None:
        analysis.addObject(obj)
    return obj


groups.observe()
mesh_undo.observe()
