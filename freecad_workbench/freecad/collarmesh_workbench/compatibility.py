"""Differences between FreeCAD's versions."""

import contextlib
import importlib
import types

import FreeCAD
import ObjectsFem
from femmesh import meshtools

from .objects import type_of


class Stateless:
    """A proxy that saves nothing."""

    def dumps(self):
        return None

    def loads(self, _state):
        return None

    __getstate__, __setstate__ = dumps, loads  # FreeCAD 0.20 calls these


class WithProperties(Stateless):
    """A proxy that adds the properties that its object lacks, when it is made and when an older document is opened."""

    def __init__(self, obj):
        obj.Proxy = self
        self.add_properties(obj)

    def onDocumentRestored(self, obj):
        self.add_properties(obj)


def add_mesh_object(document, name):
    """Adds an empty mesh object with a Python proxy. FreeCAD 1.0 and later have a base class that links the meshed
    object."""
    try:
        return document.addObject("Fem::FemMeshShapeBaseObjectPython", name)
    except (RuntimeError, TypeError):
        return document.addObject("Fem::FemMeshObjectPython", name)


def shape_property(mesh_object):
    """Returns the property that links the meshed object: `Shape` from FreeCAD 1.0 on, `Part` before."""
    return "Shape" if "Shape" in mesh_object.PropertiesList else "Part"


def meshed_object(mesh_object):
    return getattr(mesh_object, shape_property(mesh_object))


REFINEMENT_LISTS = ("MeshRegionList", "MeshRefinementList")  # later versions use the second name


def refinements_of(mesh_object):
    return next(
        (getattr(mesh_object, name) for name in REFINEMENT_LISTS if name in mesh_object.PropertiesList), []
    )


def set_refinements(mesh_object, refinements):
    name = next(name for name in REFINEMENT_LISTS if name in mesh_object.PropertiesList)
    setattr(mesh_object, name, refinements)


def is_suppressed(obj):
    """Returns whether the user has suppressed the object, which FreeCAD 1.0 and later permit for objects of
    an analysis."""
    return bool(getattr(obj, "Suppressed", False))


def is_plain_refinement(obj):
    """Returns whether the object is a size on sub-shapes. From FreeCAD 1.1 on, lists of refinements contain
    other kinds, too."""
    kind = type_of(obj)
    return not kind.startswith("Fem::Mesh") or kind in ("Fem::MeshRegion", "Fem::MeshRefinement")


def size_by_place(obj):
    """Converts a refinement by place of FreeCAD 1.1 to one of ours: returns (kind, size, size far away, distance over
    which the first size grows to the second, properties); None for other objects."""
    kind = type_of(obj)
    if kind == "Fem::MeshDistance":
        between = obj.DistanceMaximum.Value - obj.DistanceMinimum.Value
        return "Distance", obj.SizeMinimum.Value, obj.SizeMaximum.Value, between, {
            "References": obj.References, "Within": obj.DistanceMinimum.Value}
    if kind != "Fem::MeshShape" or obj.ShapeType not in ("Sphere", "Box"):
        return None
    sizes = obj.SizeIn.Value, obj.SizeOut.Value, obj.Thickness.Value
    if obj.ShapeType == "Sphere":
        return "Sphere", *sizes, {"Radius": obj.SphereRadius.Value,
                                  "Placement": FreeCAD.Placement(obj.SphereCenter, FreeCAD.Rotation())}
    lengths = [getattr(obj, f"Box{name}").Value for name in ("Length", "Width", "Height")]
    corner = FreeCAD.Placement(obj.BoxCenter - FreeCAD.Vector(*lengths) / 2, FreeCAD.Rotation())
    return "Box", *sizes, {**dict(zip(("Length", "Width", "Height"), lengths)), "Placement": corner}


def mesh_objects(document):
    """Returns FEM's mesh objects, of all meshers."""
    return document.findObjects("Fem::FemMeshObject")


def make_refinement(document, mesh_object):
    """Makes FreeCAD's object for a size on sub-shapes, which later versions call a refinement."""
    make = getattr(ObjectsFem, "makeMeshRegion", None) or ObjectsFem.makeMeshRefinement
    return make(document, mesh_object)


_in_transaction = set()  # names of documents with an open transaction


@contextlib.contextmanager
def transaction(document, name):
    """Makes the enclosed changes one undo step; an exception undoes them. A nested transaction is part of the outer
    one. First closes a transaction of FreeCAD's that scripts or deletions have left open."""
    if document.Name in _in_transaction:
        yield
        return
    if document.HasPendingTransaction:
        document.commitTransaction()
    document.openTransaction(name)
    _in_transaction.add(document.Name)
    try:
        yield
    except BaseException:
        document.abortTransaction()
        raise
    else:
        document.commitTransaction()
    finally:
        _in_transaction.discard(document.Name)


def write_constraints_on(*finders):
    """Changes how FreeCAD's writers for solvers find the nodes of constraints. Each finder is called with (mesh,
    object, name of a face) until one returns elements; the writers then use the nodes of these elements. If all return
    None, they look for nodes by place, as FreeCAD does without this function."""
    by_place, loads_by_place = meshtools.get_femnodes_by_refshape, meshtools.get_force_obj_face_nodeload_table

    def elements_of(*reference):
        return next((found for found in (find(*reference) for find in finders) if found is not None), None)

    def nodes(fem_mesh, reference):
        found = []
        for name in reference[1]:
            elements = elements_of(fem_mesh, reference[0], name)
            if elements is None:
                found += by_place(fem_mesh, (reference[0], (name,)))
            else:
                found += sorted({node for each in elements for node in fem_mesh.getElementNodes(each)})
        return found

    def loads(fem_mesh, element_table, nodes_of_mesh, force):
        faces = [(obj, name) for obj, names in force.References for name in names]
        elements = [elements_of(fem_mesh, *face) for face in faces]
        others = [face for face, found in zip(faces, elements) if found is None]
        if len(others) == len(faces):
            return loads_by_place(fem_mesh, element_table, nodes_of_mesh, force)
        table = {each: fem_mesh.getElementNodes(each) for each in set().union(*filter(None, elements))}
        areas = meshtools.get_ref_shape_node_sum_geom_table(meshtools.get_ref_facenodes_areas(nodes_of_mesh, table))
        area_of_others = sum(obj.Shape.getElement(name).Area for obj, name in others)
        area = sum(areas.values()) + area_of_others
        per_area = force_of(force) / area
        found = [("node loads on groups of the mesh", {node: part * per_area for node, part in areas.items()})]
        if others:
            on_others = types.SimpleNamespace(
                Name=force.Name, Force=force.Force, References=[(obj, (name,)) for obj, name in others])
            for title, of_nodes in loads_by_place(fem_mesh, element_table, nodes_of_mesh, on_others):
                found.append((title, {node: load * (area_of_others / area) for node, load in of_nodes.items()}))
        return found

    meshtools.get_femnodes_by_refshape, meshtools.get_force_obj_face_nodeload_table = nodes, loads


def force_of(constraint):
    """Returns the force in N: a number before FreeCAD 0.21, a quantity from then on, because FreeCAD's writer requires
    the type of the property."""
    force = constraint.Force
    return FreeCAD.Units.Quantity(force.getValueAs("N")) if hasattr(force, "getValueAs") else force


def extend_context_menus(fill):
    """Adds entries to the context menus of FreeCAD's own mesh objects, by calling `fill(menu, object)`. Their view
    providers must be classes in Python: Gmsh's always is, Netgen's only from FreeCAD 1.0 on."""
    for module, name in (("view_mesh_gmsh", "VPMeshGmsh"), ("view_mesh_netgen", "VPMeshNetgen")):
        try:
            provider = getattr(importlib.import_module("femviewprovider." + module), name)
        except (ImportError, AttributeError):
            continue
        _extend(provider, fill)


def _extend(provider, fill):
    before = getattr(provider, "setupContextMenu", None)

    def setup_context_menu(self, view, menu):
        fill(menu, view.Object)
        return before(self, view, menu) if before else None

    provider.setupContextMenu = setup_context_menu


class Manipulator:
    """An object with the methods that FreeCAD 1.0 and later call when a workbench builds its bars."""

    def __init__(self, places):
        """`places`: for each command, FreeCAD's command after which it is put. Commands with the same
        place keep their order."""
        self.places = places

    def modifyToolBars(self):
        return [{"insert": command, "toolItem": place} for command, place in self.places.items()]

    def modifyMenuBar(self):
        # Each command is put directly after its place, so of commands with the same place the last one is put first.
        return [{"insert": command, "menuItem": place, "after": ""} for command, place in reversed(self.places.items())]


def add_to_bars(places):
    """Puts commands into FreeCAD's toolbars and menus. Returns False if FreeCAD, before 1.0, does not support
    that."""
    import FreeCADGui

    if not hasattr(FreeCADGui, "addWorkbenchManipulator"):
        return False
    FreeCADGui.addWorkbenchManipulator(Manipulator(places))
    return True


def as_number(button):
    """Returns standard buttons of panels in the type that FreeCAD requires; in PySide6 (FreeCAD 1.x) they are
    an enumeration."""
    return button.value if hasattr(button, "value") else int(button)
