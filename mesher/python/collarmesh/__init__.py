"""Tetrahedral meshes of surfaces, complexes and CAD shapes, each with a certificate; arrays of numpy in and out.

    import collarmesh
    mesh = collarmesh.mesh("part.step", size=2.5)
    mesh.points, mesh.tets, mesh.face_tag
    mesh.write("part.vtu")

Options have the names of the command line with `_` for `-`. Lengths are absolute, in the unit of the input
(millimetres for CAD files), unless they are said to be relative to the diagonal of the bounding box; angles are
degrees. What is left out, or None, has the command line's default.

Errors: every fault of the input is an `Error`: OptionError for options that are out of range or contradict each
other and for arrays of the wrong shape or kind, ReadError and WriteError for files, ComplexError for surfaces that
are no valid complex and cannot be repaired, BudgetError when vertices, memory or time are spent, CancelledError when
`progress` cancels. Ctrl-C is KeyboardInterrupt, within a second in every stage.
"""

import os
from typing import Any, Callable, Dict, List, Mapping, Optional, Sequence, Tuple, Union

import numpy

from . import _core
from ._core import (
    BudgetError,
    CancelledError,
    ComplexError,
    Error,
    OptionError,
    ReadError,
    WriteError,
    __version__,
)
from ._inputs import Array, ArrayLike, Complex, Input, Path, inputs, integers, reals
from ._mesh import Mesh

__all__ = [
    "BudgetError",
    "CancelledError",
    "Complex",
    "ComplexError",
    "Error",
    "Mesh",
    "OptionError",
    "ReadError",
    "WriteError",
    "__version__",
    "check",
    "convert",
    "info",
    "mesh",
    "read",
    "repair",
]

SizeField = Union[
    Path, Mapping[str, Any], Tuple[ArrayLike, ArrayLike, ArrayLike], Callable[[float, float, float], float]
]
Surface = Tuple[Array, Array, Array]


def _given(options: Dict[str, Any]) -> Dict[str, Any]:
    return {name: value for name, value in options.items() if value is not None}


def _size_field(field: SizeField) -> Any:
    """A path, a dict, a callable, or the arrays of a mesh with values on its points."""
    if isinstance(field, (str, os.PathLike)):
        return os.fspath(field)
    if callable(field) or isinstance(field, Mapping):
        return dict(field) if isinstance(field, Mapping) else field
    if not isinstance(field, tuple) or len(field) != 3:
        raise OptionError("size_field must be a path, a dict, a callable or a tuple (points, tets, values)")
    points = reals(field[0], "the points of size_field", 3)
    values = reals([[value] for value in field[2]], "the values of size_field", 1).ravel()  # type: ignore
    if len(values) != len(points):
        raise OptionError(f"size_field has {len(values)} values for {len(points)} points")
    return {"points": points, "tets": integers(field[1], "the tets of size_field", 4), "values": values,
            "cad_names": False}


def mesh(
    *surfaces: Input,
    size: Optional[float] = None,
    size_min: Optional[float] = None,
    region_size: Optional[Mapping[int, float]] = None,
    patch_size: Optional[Mapping[int, float]] = None,
    curve_size: Optional[Mapping[int, float]] = None,
    size_field: Optional[SizeField] = None,
    elements_per_circle: Optional[float] = None,
    elements_across_gap: Optional[float] = None,
    gradation: Optional[float] = None,
    radius_edge: Optional[float] = None,
    vertex_ratio: Optional[float] = None,
    coarsen: Optional[bool] = None,
    thin_angle: Optional[float] = None,
    improve: Optional[int] = None,
    min_dihedral: Optional[float] = None,
    order: Optional[int] = None,
    partitions: Optional[int] = None,
    collar_angle: Optional[float] = None,
    collar_creation: Optional[str] = None,
    theta: Optional[float] = None,
    distance: Optional[float] = None,
    seed: Optional[int] = None,
    feature_angle: Optional[float] = None,
    planar_tolerance: Optional[float] = None,
    weld: Optional[float] = None,
    repair: Optional[str] = None,
    repair_tolerance: Optional[float] = None,
    wrap_offset: Optional[float] = None,
    overlap: Optional[str] = None,
    crease_angle: Optional[float] = None,
    names: Union[Path, Mapping[str, Any], None] = None,
    input_format: Optional[str] = None,
    max_vertices: Optional[int] = None,
    max_memory: Union[int, str, None] = None,
    time_limit: Optional[float] = None,
    threads: Optional[int] = None,
    progress: Optional[Callable[[str, float], Optional[bool]]] = None,
) -> Mesh:
    """Mesh what surfaces bound, and certify the result.

    surfaces: paths of files, CAD shapes included; tuples (points, triangles) or (points, triangles, tags) with
        points of shape (n, 3), triangles of shape (m, 3), rows of points, oriented outwards, and tags of shape (m,),
        integers by which the faces of the mesh are found again; and `Complex`es. Several are several regions of one
        mesh, numbered from 1; one inside another and oriented inwards is a cavity.
    size: target edge length everywhere; default 1/20 of the diagonal.
    size_min: never ask for less than this.
    region_size, patch_size, curve_size: lengths by tag, {3: 0.1}.
    size_field: sizes by place, never above `size`: the path of a .json, .vtu or .msh; a dict as in such a .json; a
        tuple (points, tets, values), a mesh with lengths on its points; or a callable of x, y, z that gives a length.
    elements_per_circle: finer where smooth faces curve: so many elements on a full circle.
    elements_across_gap: finer in thin parts: so many elements between opposite faces.
    gradation: growth of size per unit length away from finer features.
    radius_edge: bound on circumradius / shortest edge of a tetrahedron that is not thin; default 2.
    vertex_ratio: bound on largest circumradius / shortest edge at a vertex, more than 2 sqrt 2.
    coarsen: True, the default: as few tetrahedra as the sizes ask for; False: radius_edge holds everywhere.
    thin_angle: smallest dihedral angle of thin tetrahedra, degrees; default 8.
    improve: removal of slivers, 0 none to 3 best; default 2.
    min_dihedral: improve tetrahedra with smaller dihedral angles, degrees, in place of the level's.
    order: 1 or 2, ten nodes to a tetrahedron.
    partitions: divide the tetrahedra among so many ranks, `Mesh.tet_partition`; None: they are not divided.
    collar_angle: bound on dihedral angles in collars, degrees, 100 to 175; default 150.
    collar_creation: "in-pass" or "up-front".
    theta: warp to input within this times a gap ball's radius, 0 to below 0.45; default 0.3.
    distance: largest distance from smooth surfaces and curves; default 1/10 of the size, at most 1/200 of the
        diagonal (1/550 for order 2).
    seed: of the pseudo-random offsets: same input, options and seed, same mesh.
    feature_angle: edges that deviate more than this from flat are kept, degrees; default 30.
    planar_tolerance: facets within this of one plane are one, relative to the diagonal; default 1e-6.
    weld: points closer than this are one, relative to the diagonal; default 1e-9.
    repair: "auto", "none" (what is no valid complex is an error) or "wrap" (a closed surface around what cannot be
        repaired, or meshed afterwards); repair_tolerance and wrap_offset are relative to the diagonal, defaults 1e-5 and 5e-3.
    overlap: what solids of a CAD file have in common: "first" or "region".
    crease_angle: features that meet below this angle form a crease, degrees, 0 to 90; default 60.
    names: names of patches, curves and regions, by number or by a point on them: the path of a JSON file, or its
        content, {"patches": {"inlet": 3, "walls": [1, {"at": [0, 0, 1]}]}}.
    input_format: extension in place of the files' own, ".stl".
    max_vertices: budget. max_memory: bytes, or text as "1.5G"; default half of the machine's; 0: none.
    time_limit: seconds, for everything from reading on.
    threads: at most, of improvement and certificate; 0: as many as there are cores. They change no result.
    progress: called with the stage and the fraction, 0 to 1, that is done of everything; False cancels.

    Returns a `Mesh`; its `passed` says whether every guarantee holds. Raises the subclasses of `Error` that the
    description of the package lists.
    """
    options = _given({name: value for name, value in locals().items() if name not in ("surfaces", "progress")})
    if names is not None:
        options["names"] = dict(names) if isinstance(names, Mapping) else os.fspath(names)
    if size_field is not None:
        options["size_field"] = _size_field(size_field)
    for name in ("region_size", "patch_size", "curve_size"):
        if name in options:
            tags = integers(list(options[name]), f"the tags of {name}")
            options[name] = {int(tag): length for tag, length in zip(tags, options[name].values())}
    return Mesh(_core.mesh(inputs(surfaces), options, progress))


def read(path: Path, format: str = "") -> Mesh:
    """Read a tetrahedral mesh.

    path: the file. format: an extension such as ".vtu", in place of the file's own. Raises ReadError.
    """
    return Mesh(_core.read_mesh(os.fspath(path), format))


def check(
    mesh: Union[Mesh, Path],
    *against: Input,
    radius_edge: Optional[float] = None,
    thin_angle: Optional[float] = None,
    collar_angle: Optional[float] = None,
    distance: Optional[float] = None,
    findings: Optional[int] = None,
    threads: Optional[int] = None,
    feature_angle: Optional[float] = None,
    planar_tolerance: Optional[float] = None,
    weld: Optional[float] = None,
    repair: Optional[str] = None,
    repair_tolerance: Optional[float] = None,
    wrap_offset: Optional[float] = None,
    overlap: Optional[str] = None,
    crease_angle: Optional[float] = None,
    time_limit: Optional[float] = None,
) -> Dict[str, Any]:
    """Certify a mesh, of this or another program, against the surfaces it was made of.

    mesh: a `Mesh` or the path of one.
    against: the surfaces, as in `collarmesh.mesh`.
    thin_angle: as in `collarmesh.mesh`; 0 asks for radius_edge everywhere.
    distance: largest distance from smooth surfaces and curves; default 1/200 of the diagonal.
    findings: how many violations of each kind are listed; default 20.
    Other options: as in `collarmesh.mesh`. Give those with which the mesh was made.

    Returns a dict, as `collarmesh check --json` prints it: "passed", "findings", angles, volumes. Raises `Error`.
    """
    options = _given({name: value for name, value in locals().items() if name not in ("mesh", "against")})
    subject = mesh if isinstance(mesh, Mesh) else read(mesh)
    return _core.check(subject._arrays(), inputs(against), options)


def info(
    *of: Union[Input, Mesh],
    feature_angle: Optional[float] = None,
    planar_tolerance: Optional[float] = None,
    weld: Optional[float] = None,
    repair: Optional[str] = None,
    repair_tolerance: Optional[float] = None,
    wrap_offset: Optional[float] = None,
    overlap: Optional[str] = None,
    crease_angle: Optional[float] = None,
) -> Dict[str, Any]:
    """Describe surfaces (patches with numbers and names, regions, creases, angles) or a mesh.

    of: surfaces as in `collarmesh.mesh`, or one mesh. Options: as in `collarmesh.mesh`.

    Returns a dict, as `collarmesh info --json` prints it. Raises `Error`.
    """
    options = _given({name: value for name, value in locals().items() if name != "of"})
    if len(of) == 1 and isinstance(of[0], Mesh):
        return of[0].info()
    if len(of) == 1 and isinstance(of[0], (str, os.PathLike)):
        arrays = _core.read_mesh_if_there(os.fspath(of[0]), "")
        if arrays is not None:
            return Mesh(arrays).info()
    return _core.info(inputs(of), options)  # type: ignore[arg-type]


def _triangles(soup: Dict[str, Any]) -> Surface:
    """A soup of triangles, with polygons of four and more corners cut into fans."""
    triangles: List[Tuple[int, int, int]] = []
    tags: List[int] = []
    begin = 0
    ends = soup["polygon_ends"]
    first = 0
    for facet, last in enumerate(soup["facet_ends"]):
        for polygon in range(first, last):
            a, *rest = soup["corners"][begin : ends[polygon]]
            begin = ends[polygon]
            for b, c in zip(rest, rest[1:]):
                triangles.append((a, b, c))
                tags.append(soup["facet_tags"][facet])
        first = last
    return soup["points"], integers(triangles, "triangles", 3), integers(tags, "tags")


def repair(
    *surfaces: Input,
    output: Optional[Path] = None,
    feature_angle: Optional[float] = None,
    planar_tolerance: Optional[float] = None,
    weld: Optional[float] = None,
    repair: Optional[str] = None,
    repair_tolerance: Optional[float] = None,
    wrap_offset: Optional[float] = None,
    overlap: Optional[str] = None,
    input_format: Optional[str] = None,
    time_limit: Optional[float] = None,
) -> Tuple[List[Surface], List[str]]:
    """The surfaces that would be meshed: repaired where they are no valid complex.

    surfaces, options: as in `collarmesh.mesh`.
    output: a file to which they are written as well.

    Returns a list of (points, triangles, tags), one for each surface, with the shapes of `collarmesh.mesh`, and a list
    of what was done, in sentences with places. Polygons of valid surfaces are divided into fans of triangles. Raises
    `Error`.
    """
    options = _given({name: value for name, value in locals().items() if name not in ("surfaces", "output")})
    messages: List[str] = []
    soups = _core.repaired(inputs(surfaces), options, messages)
    if output is not None:
        _core.convert_surfaces(soups, os.fspath(output), {})
    return [_triangles(soup) for soup in soups], messages


def _require_place(extension: str, option: str, what: str, formats: List[str]) -> None:
    if extension not in formats:
        known = " ".join(formats)
        raise OptionError(f"{option}: {extension or 'the output'} has no place for {what}; use {known}")


def convert(
    source: Union[Input, Mesh, Sequence[Input]],
    output: Path,
    *,
    format: Optional[str] = None,
    input_format: Optional[str] = None,
    partitions: Optional[int] = None,
    ghost_cells: bool = False,
    **options: Any,
) -> None:
    """Convert surfaces, complexes and meshes into each other; a surface into a mesh by meshing it.

    source: a surface as in `collarmesh.mesh`, a list of surfaces, which become one, or a mesh.
    output: the file to write.
    format, input_format: extensions in place of the files' own.
    partitions: divide the tetrahedra among so many ranks. ghost_cells: as in `Mesh.write`.
    options: those of `collarmesh.mesh`.

    Raises `Error`; OptionError also where the output has no place for partitions or ghost cells.
    """
    target, kind, from_kind = os.fspath(output), format or "", input_format or ""
    extension = kind or os.path.splitext(target)[1].lower()
    if partitions is not None:
        _require_place(extension, "partitions", "partitions", _core.formats_with_partitions())
    if ghost_cells:
        _require_place(extension, "ghost_cells", "ghost cells", _core.formats_with_ghost_cells())
    to_surface = _core.is_surface_format(target, kind)
    found = source if isinstance(source, Mesh) else None
    if isinstance(source, (str, os.PathLike)):
        arrays = _core.read_mesh_if_there(os.fspath(source), from_kind)
        found = None if arrays is None else Mesh(arrays)
    if found is not None:
        if not to_surface:
            divided = found if partitions is None else found.partitioned(partitions)
            divided.write(target, kind, ghost_cells=ghost_cells)
            return
        by_tag = numpy.argsort(found.face_tag, kind="stable")  # formats without tags number patches as they come
        source = (found.points, found.faces[by_tag], found.face_tag[by_tag])
    surfaces: Sequence[Any] = source if isinstance(source, list) else [source]
    if to_surface:
        given = _given({"format": format, "input_format": input_format, **options})
        _core.convert_surfaces(inputs(surfaces), target, given)
    else:
        if ghost_cells and partitions is None:
            raise OptionError("ghost_cells: is of partitions; say how many with partitions")
        made = mesh(*surfaces, input_format=input_format, partitions=partitions, **options)
        made.write(target, kind, ghost_cells=ghost_cells)
