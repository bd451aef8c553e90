"""Tetrahedral meshes of surfaces, complexes and CAD shapes, each with a certificate; arrays of numpy in and out.

    import collarmesh
    mesh = collarmesh.mesh("part.step", size=2.5)
    mesh.points, mesh.tets, mesh.face_tag
    mesh.write("part.vtu")

Options have the names of the command line with `_` for `-`. Lengths are absolute, in the unit of the input
(millimetres for CAD files), unless they are said to be relative to the diagonal of the bounding box; angles are
degrees. Options that are left out, or None, have the command line's default.

Errors: every fault of the input raises a subclass of `Error`. OptionError: options that are out of range or contradict
each other, arrays of the wrong shape or kind. ReadError and WriteError: files. ComplexError: surfaces that cannot be
repaired to form a valid complex. BudgetError: vertices, memory or time are spent. CancelledError: `progress`
cancelled. Ctrl-C raises KeyboardInterrupt within a second, in every stage.
"""

import os
from typing import Any, List, Optional, Sequence, Union

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
from ._errors import estimated_errors, sizes_from_errors
from ._functions import check, info, mesh, predict, read, remesh, repair
from ._inputs import Complex, Input, Path, given, inputs, sampled_sizes
from ._mesh import Mesh
from ._results import read_frd

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
    "estimated_errors",
    "info",
    "mesh",
    "predict",
    "read",
    "read_frd",
    "remesh",
    "repair",
    "sampled_sizes",
    "sizes_from_errors",
]


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
    """Convert surfaces, complexes and meshes into each other. If the output is a mesh, a surface is meshed.

    source: a surface as in `collarmesh.mesh`, a list of surfaces, which are joined, or a mesh.
    output: the file to write.
    format, input_format: extensions that replace the files' own.
    partitions: number of ranks to divide the tetrahedra among. ghost_cells: as in `Mesh.write`.
    options: those of `collarmesh.mesh`.

    Raises `Error`; OptionError also if the output format cannot store partitions or ghost cells.
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
        found = None if arrays is None else Mesh._of(arrays)
    if found is not None:
        if not to_surface:
            divided = found if partitions is None else found.partitioned(partitions)
            divided.write(target, kind, ghost_cells=ghost_cells)
            return
        polygons, tags = found._surface()
        by_tag = numpy.argsort(tags, kind="stable")  # sorted for formats that number patches
        if len(found.quads) == 0:
            source = (found.points, found.faces[by_tag], tags[by_tag])
        else:
            source = Complex(found.points, [polygons[i] for i in by_tag], facet_tags=tags[by_tag])
    surfaces: Sequence[Any] = source if isinstance(source, list) else [source]
    if to_surface:
        named = given({"format": format, "input_format": input_format, **options})
        _core.convert_surfaces(inputs(surfaces), target, named)
    else:
        if ghost_cells and partitions is None:
            raise OptionError("ghost_cells: needs partitions; say how many with partitions")
        made = mesh(*surfaces, input_format=input_format, partitions=partitions, **options)
        made.write(target, kind, ghost_cells=ghost_cells)
