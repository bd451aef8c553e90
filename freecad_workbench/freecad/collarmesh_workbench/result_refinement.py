"""Adapts the mesh of an object to the error of a result of CalculiX: finer where stresses change, coarser elsewhere.
Works without the GUI."""

import dataclasses
import pathlib

import FreeCAD
import numpy
from feminout import importCcxFrdResults

from . import compatibility, elements, groups, mesh_object, mesh_properties, result_errors, up_to_date
from .program import MesherError
from .translations import translate

SAME_PLACE = 2e-5  # relative to the largest coordinate; CalculiX writes six digits
MOST_INCOMPRESSIBLE = 0.49  # largest Poisson's ratio used; at 0.5 a change of volume has no finite energy
STEEL = (210000.0, 0.3)  # for a mesh without a material; a modulus that is the same everywhere changes no size


def result_of(obj):
    """Returns the last result with displacements in the analysis of a mesh; None if there is none."""
    analysis = groups.analysis_of(obj)
    return next((each for each in reversed(analysis.Group if analysis else ())
                 if each.isDerivedFrom("Fem::FemResultObject") and len(getattr(each, "DisplacementVectors", ()))), None)


def file_of_result(obj):
    """Returns the newest file of results in the working folder of the analysis' solver; None if there is none."""
    analysis = groups.analysis_of(obj)
    folders = [getattr(each, "WorkingDir", "") for each in (analysis.Group if analysis else ())]
    found = [path for folder in folders if folder for path in pathlib.Path(folder).glob("*.frd")]
    return max(found, key=lambda path: path.stat().st_mtime, default=None)


def is_possible(obj):
    """Returns whether there is a mesh of tetrahedra and a result, which may be that of another mesh. Called often."""
    return elements.dimension(obj.FemMesh) == 3 and (result_of(obj) is not None or file_of_result(obj) is not None)


@dataclasses.dataclass
class Plan:
    """The next mesh, as a result suggests it."""

    label: str  # label of the result
    solution: result_errors.Solution
    errors: result_errors.Errors
    sizes: result_errors.Sizes


def plan(obj):
    """Returns the Plan of a mesh. Raises MesherError."""
    if elements.dimension(obj.FemMesh) != 3:
        raise MesherError(
            translate("collarmesh", "{label} has no tetrahedra that a result could refine."), label=obj.Label)
    if not up_to_date.has_shape(compatibility.meshed_object(obj), list(getattr(obj, up_to_date.SHAPE))):
        raise MesherError(
            translate("collarmesh", "The part has changed since the mesh was made: mesh it again and solve it."))
    label, displacements = _displacements(obj)
    solution = _solution(obj, label, displacements)
    try:
        errors = result_errors.estimate(solution)
    except numpy.linalg.LinAlgError:
        raise MesherError(translate("collarmesh",
                                    "The mesh has flat elements, in which there are no strains: mesh the part again.")
                          ) from None
    if errors.energy_norm == 0:
        raise MesherError(translate("collarmesh", "{label}: nothing is deformed, so there is no error to estimate."),
                          label=label)
    return Plan(label, solution, errors, result_errors.Sizes(solution, errors))


def _displacements(obj):
    """Returns the result's label or file, and {node: (place, displacement)}. Raises MesherError."""
    result = result_of(obj)
    if result is not None and result.Mesh is not None:
        places = result.Mesh.FemMesh.Nodes
        return result.Label, {number: (places[number], vector)
                              for number, vector in zip(result.NodeNumbers, result.DisplacementVectors)
                              if number in places}
    path = file_of_result(obj)
    if path is None:
        raise MesherError(
            translate("collarmesh", "The analysis of {label} has no result with displacements: solve it first."),
            label=obj.Label)
    try:
        read = importCcxFrdResults.read_frd_result(str(path))
    except Exception as fault:  # FreeCAD's reader raises whatever its parsing meets
        raise MesherError(translate("collarmesh", "{file} cannot be read ({fault}): solve the analysis again."),
                          file=path.name, fault=fault) from None
    moved = next((step["disp"] for step in reversed(read["Results"]) if step.get("disp")), {})
    return path.name, {number: (read["Nodes"][number], vector)
                       for number, vector in moved.items() if number in read["Nodes"]}


def _solution(obj, label, displacements):
    """Returns the Solution. Raises MesherError if the result is of another mesh, or the mesh has prisms."""
    fem_mesh = obj.FemMesh
    numbers = sorted(fem_mesh.Volumes)
    nodes = [fem_mesh.getElementNodes(number) for number in numbers]
    if any(len(element) not in (4, 10) for element in nodes):
        raise MesherError(translate("collarmesh",
                                    "The mesh has prisms of boundary layers, which are not refined: let the layers "
                                    "be tetrahedra, mesh and solve again."))
    nodes = numpy.array(nodes)
    used, tets = numpy.unique(nodes, return_inverse=True)
    of_mesh = fem_mesh.Nodes
    points = numpy.array([tuple(of_mesh[node]) for node in used.tolist()])
    found = [displacements.get(node) for node in used.tolist()]
    is_same = len(displacements) == len(used) and all(each is not None for each in found)
    if is_same:
        places = numpy.array([tuple(place) for place, _ in found])
        is_same = abs(places - points).max() <= SAME_PLACE * abs(points).max()
    if not is_same:
        raise MesherError(translate("collarmesh", "{label} is the result of another mesh: solve the analysis again."),
                          label=label)
    materials, moduli = _materials(obj, numbers)
    return result_errors.Solution(points, tets.reshape(nodes.shape),
                                  numpy.array([tuple(vector) for _, vector in found]), materials, moduli)


def _materials(obj, numbers):
    """Returns the number of each element's material, and the moduli by that number."""
    of_element, moduli = numpy.zeros(len(numbers), dtype=int), [STEEL]
    for material in groups.materials_of(groups.analysis_of(obj)):
        names = groups.names_in(compatibility.meshed_object(obj), material.References)
        _, members = groups.elements_of(obj.FemMesh, compatibility.meshed_object(obj), names)
        here = numpy.isin(numbers, members) if names else of_element == 0
        of_element[here] = len(moduli)
        moduli.append(_moduli(material.Material))
    return of_element, numpy.array(moduli)


def _moduli(card):
    """Returns Young's modulus in MPa and Poisson's ratio from a material card."""
    modulus = FreeCAD.Units.Quantity(card["YoungsModulus"]).getValueAs(
        "MPa").Value if "YoungsModulus" in card else STEEL[0]
    try:
        ratio = float(card.get("PoissonRatio", STEEL[1]))
    except ValueError:
        raise MesherError(translate("collarmesh", "Poisson's ratio {text} of the material is no number: correct it."),
                          text=card["PoissonRatio"]) from None
    return modulus, min(ratio, MOST_INCOMPRESSIBLE)


def start(obj, made, factors):
    """Returns a Job that is ready to run. `factors`: ratios of the next edge lengths to the present ones, from the
    sizes of the Plan `made`. Raises MesherError."""
    lengths = made.sizes.at_points(factors)
    is_corner = ~numpy.isnan(lengths)
    settings = dataclasses.replace(mesh_properties.settings_of(obj), order=made.solution.order)
    adapting = settings.for_adapting()
    state = up_to_date.State(list(getattr(obj, up_to_date.SHAPE)), getattr(obj, up_to_date.SETTINGS))
    if adapting is None:
        settings = dataclasses.replace(settings, size_field=None, size=float(lengths[is_corner].max()))
    job = mesh_object.prepare(obj, adapting or settings, state, adapts=adapting is not None)
    try:
        obj.FemMesh.write(job.before)
        renumbered = numpy.cumsum(is_corner) - 1
        job.use_sizes(made.solution.points[is_corner], renumbered[made.solution.corners], lengths[is_corner])
    except BaseException:
        job.__exit__()
        raise
    return job


def refine(obj, elements=None, error=None, progress=None):
    """Refines the mesh and waits. Aims at a number of elements, or at an error relative to the energy norm (0 to 1).
    Returns the program's report. If it fails, raises MesherError, and the object keeps its mesh."""
    if (elements is None) == (error is None) or not (elements or error or 0) > 0:
        raise MesherError(translate("collarmesh", "Give either a number of elements or an error, more than 0."))
    made = plan(obj)
    factors = made.sizes.for_elements(elements) if error is None else made.sizes.for_error(error)
    with start(obj, made, factors) as job:
        return mesh_object.finish(obj, job, job.run(progress))
