"""The mesh object in the document, and how to make its mesh. Works without the GUI."""

import dataclasses

import Fem
import FreeCAD

from . import (compatibility, constraint_faces, contact_groups, contacts, elements, groups, inputs, layer_objects,
               mesh_properties, mesh_undo, open_shape, preferences, size_check, size_objects, up_to_date, views)
from .program import GUARANTEE_MISSED, Job, MesherError
from .translations import translate

TINY = 0.01  # edges shorter than this, relative to the target edge length, are probably unintended


class MeshProxy(compatibility.WithProperties):
    """The Python part of the object. FEM's tools check `Type`."""

    Type = mesh_properties.TYPE

    def add_properties(self, obj):
        for each in (mesh_properties, up_to_date, mesh_undo):
            each.add_properties(obj)

    def execute(self, obj):
        """Handles a recompute by FreeCAD: keeps the mesh, and marks it if it is out of date."""
        up_to_date.show(obj)


def make(document, part=None, name="FEMMeshCollarmesh"):
    """Makes a new, empty mesh object for the shape of `part`."""
    obj = compatibility.add_mesh_object(document, name)
    MeshProxy(obj)
    if part is not None:
        setattr(obj, compatibility.shape_property(obj), part)
    views.show(mesh_properties.TYPE, obj)
    return obj


def start(obj, program="", settings=None):
    """Returns a Job that is ready to run, with the shape written. `settings` replaces the object's own.
    Raises MesherError."""
    return prepare(obj, settings or mesh_properties.settings_of(obj), up_to_date.state_of(obj),
                   size_objects.sources_of(obj), program)


def prepare(obj, settings, state, sources=(), program="", adapts=False):
    """Returns a Job as `start` does. `state`: the State that the object records for the mesh of the Job; `sources`: the
    sizes by place, with their labels; `adapts`: see Job. Raises MesherError."""
    part = mesh_properties.part_to_mesh(obj)
    size_check.check(settings, sources, part)
    asked = settings.dimension
    settings = dataclasses.replace(settings, dimension=open_shape.dimension(part, asked, settings.fill_holes))
    open_shape.check(part, settings.dimension, settings.fill_holes)
    if settings.dimension < 3:
        settings = dataclasses.replace(settings, keep_apart=False, split=[],
                                       periodic=[], interior_node=False, layers=[])
    shape = inputs.shape_of(part)
    is_to_be_apart = settings.keep_apart
    settings = contacts.in_mesh_numbers(settings, shape)
    job = Job(settings, program or preferences.program(), preferences.threads(), inputs.file_name(part), adapts)
    try:
        inputs.write(part, job.shape)
    except Exception:
        job.__exit__()
        raise
    job.messages += tiny_edges(shape, settings.size)
    job.dimension, job.word = settings.dimension, "" if asked else open_shape.word(part, settings.dimension)
    job.apart = settings.keep_apart
    if is_to_be_apart and not job.apart:
        job.messages.append("warning: " + translate("collarmesh",
                            "No two solids touch, so there is nothing to keep apart."))
    job.state = state
    labels = [label for label, _ in sources]
    job.explain = lambda text: size_objects.with_labels(text, labels)
    job.meshed = shape
    if not shape.isNull():
        job.names = contacts.of(shape).name
    return job


def tiny_edges(shape, size):
    """Returns a warning for each edge much shorter than the target edge length (mm; 0: the default)."""
    if shape.isNull():
        return []
    default = shape.BoundBox.DiagonalLength / 20
    size = min(size, 4 * default) or default
    text = translate("collarmesh", "{edge} at {place} is only {length} mm long, so the mesh becomes very fine there: "
                                   "remove the edge if it is not meant (Part: Defeaturing)")
    warnings = []
    for number, edge in enumerate(shape.Edges, 1):
        if not edge.Degenerated and edge.Length < TINY * size:
            place = "({:.6g}, {:.6g}, {:.6g})".format(*edge.CenterOfMass)
            told = text.format(edge=f"Edge{number}", place=place, length=f"{edge.Length:.3g}")
            warnings.append("warning: " + told)
    return warnings


def finish(obj, job, exit_code=0):
    """Puts the mesh of a completed job into the object. Raises MesherError; the object keeps its mesh then."""
    job.require_success(exit_code)
    fem_mesh = Fem.read(job.mesh)
    if elements.dimension(fem_mesh) != job.dimension:
        raise MesherError(
            translate("collarmesh", "The mesher wrote a mesh without elements of the chosen dimension; please report "
                                    "this, with the shape."))
    contact_groups.add(job.meshed, fem_mesh, job.apart)
    groups.add_groups(obj, fem_mesh)
    report = job.report()
    report["notes"] += layer_objects.notes(report, elements.order(fem_mesh))
    report["notes"] += groups.materials_elsewhere(obj) + ([job.word] if job.word else [])
    with compatibility.transaction(obj.Document, translate("collarmesh", "Mesh by collarmesh")):
        mesh_undo.replace(obj, fem_mesh)
        up_to_date.remember(obj, job.state)
        report["notes"] += constraint_faces.refresh(obj)
    up_to_date.show(obj)
    said = job.messages if exit_code == GUARANTEE_MISSED else [*job.warnings(), *report["notes"]]
    if said:
        FreeCAD.Console.PrintWarning("collarmesh: " + "\n".join(said) + "\n")
    return report


def remesh(obj, progress=None):
    """Makes the object's mesh again and waits. Returns the program's report. Raises MesherError."""
    with start(obj) as job:
        exit_code = job.run(progress)
        return finish(obj, job, exit_code)


def mesh(shape_or_object, document, analysis, name, settings):
    """Makes a mesh object, see `collarmesh_workbench.mesh`."""
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
        mesh_properties.apply_settings(obj, settings)
        with start(obj, settings=settings) as job:
            finish(obj, job, job.run())
    except Exception:
        for each in reversed(added):
            document.removeObject(each.Name)
        raise
    if analysis is not None:
        analysis.addObject(obj)
    return obj
