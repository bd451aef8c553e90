"""The functions that take options. When the package is built, write_functions.py replaces each line `# options of ...`
by the options that the command takes: by parameters in a signature, by text in a description."""

import os
from typing import Any, Callable, Dict, List, Mapping, Optional, Sequence, Tuple, Union

from . import _core
from ._inputs import ArrayLike, Input, Path, SizeField, Surface, given, inputs, sized, triangles
from ._mesh import Mesh
from ._progress import watching
from ._types import Info, Prediction


def mesh(
    *surfaces: Input,
    # options of mesh
    input_format: Optional[str] = None,
    progress: Union[bool, Callable[[str, float], Optional[bool]], None] = None,
) -> Mesh:
    """Mesh the solids that surfaces bound, and certify the result.

    surfaces: paths of files, CAD shapes included; tuples (points, triangles) or (points, triangles, tags); and
        `Complex`es. Points have shape (n, 3); triangles have shape (m, 3), contain rows of points and are oriented
        outwards; tags have shape (m,) and are integers that the faces of the mesh get, too. Each surface bounds a
        region, numbered from 1; a surface inside another one that is oriented inwards bounds a cavity.
    # options of mesh
    input_format: extension that replaces the files' own, ".stl".
    progress: True for a bar on standard error; or a callable that is called with the stage and the fraction of the
        whole run that is done, up to 1; if it returns False, the run is cancelled.

    Returns a `Mesh`; its `passed` says whether every guarantee holds. Raises the subclasses of `Error` that the
    description of the package lists.
    """
    options = given(locals())
    with watching(progress) as told:
        return Mesh._of(_core.mesh(inputs(surfaces), options, told))


def remesh(
    mesh: Union[Mesh, Path],
    size: Union[float, SizeField, ArrayLike, None] = None,
    against: Union[Input, Sequence[Input], None] = None,
    # options of remesh
    progress: Union[bool, Callable[[str, float], Optional[bool]], None] = None,
) -> Mesh:
    """Adapt a mesh to target edge lengths, finer or coarser, and certify the result. Keeps its regions, surfaces,
    edges, names and tags. The result follows the mesh's own surface; the certificate bounds the change of volumes.

    mesh: a `Mesh`, of this or another program, or the path of one. A mesh of second order is remeshed by its corners;
        with `order=2` the result is of second order again.
    size: a length; lengths for each point or each tetrahedron of the mesh, as `sizes_from_errors` returns them; or a
        size field, as `size_field` in `collarmesh.mesh`. None: improve tetrahedra and keep the lengths.
    against: the input that the mesh was made of, or a list of its surfaces, as in `collarmesh.mesh`. The result follows
        this input, or the exact faces if it is a CAD shape, and not the triangles of the mesh. It is certified against
        the input.
    # options of remesh
    progress: as in `collarmesh.mesh`.

    Returns a `Mesh`; its `passed` says whether every guarantee holds. Raises `Error`; ComplexError for a mesh that
    is not conforming or does not cover `against`.
    """
    options = given(sized(locals()))
    shape = options.pop("against", None)
    shapes = [] if shape is None else inputs(shape if isinstance(shape, list) else [shape])
    with watching(progress) as told:
        return Mesh._of(_core.remesh(options.pop("mesh")._arrays(), shapes, options, told))


def predict(
    *surfaces: Input,
    sizes: Sequence[float],
    # options of mesh
    input_format: Optional[str] = None,
) -> List[Prediction]:
    """Predict how large meshes will be and how long they will take, without making them.

    surfaces, options: as in `collarmesh.mesh`.
    sizes: target edge lengths, in place of `size`.

    Returns a dict for each size, as `collarmesh info --predict --json` prints it: "size", "tets", and "seconds", the
    time of all stages from the refinement to the certificate. Raises `Error`.
    """
    return _core.predict(inputs(surfaces), [float(size) for size in sizes], given(locals()))


def read(path: Path, format: str = "") -> Mesh:
    """Read a tetrahedral mesh.

    path: the file. format: an extension such as ".vtu" that replaces the file's own. Raises ReadError.
    """
    return Mesh._of(_core.read_mesh(os.fspath(path), format))


def check(
    mesh: Union[Mesh, Path],
    *against: Input,
    # options of check
) -> Dict[str, Any]:
    """Certify a mesh, of this or another program, against the surfaces that it was made from.

    mesh: a `Mesh` or the path of one.
    against: the surfaces, as in `collarmesh.mesh`.
    # options of check

    Give the options with which the mesh was made. Returns a dict, as `collarmesh check --json` prints it: "passed",
    "findings", angles, volumes. Raises `Error`.
    """
    options = given(locals())
    subject = mesh if isinstance(mesh, Mesh) else read(mesh)
    return _core.check(subject._arrays(), inputs(against), options)


def info(
    *of: Union[Input, Mesh],
    # options of repair
) -> Info:
    """Describe surfaces (patches with numbers and names, regions, creases, angles) or a mesh.

    of: surfaces as in `collarmesh.mesh`, or one mesh. Options: as in `collarmesh.mesh`.

    Returns a dict, as `collarmesh info --json` prints it. Raises `Error`.
    """
    options = given(locals())
    if len(of) == 1 and isinstance(of[0], Mesh):
        return {"mesh": of[0].info()["mesh"]}
    if len(of) == 1 and isinstance(of[0], (str, os.PathLike)):
        arrays = _core.read_mesh_if_there(os.fspath(of[0]), "")
        if arrays is not None:
            return {"mesh": Mesh._of(arrays).info()["mesh"]}
    return _core.info(inputs(of), options)  # type: ignore[arg-type]


def repair(
    *surfaces: Input,
    output: Optional[Path] = None,
    # options of repair
    input_format: Optional[str] = None,
) -> Tuple[List[Surface], List[str]]:
    """Return the surfaces that would be meshed: repaired if they do not form a valid complex.

    surfaces, options: as in `collarmesh.mesh`.
    output: a file to which the surfaces are also written.

    Returns a list of (points, triangles, tags), one for each surface, with the shapes of `collarmesh.mesh`, and a list
    of the changes: sentences with places. Polygons of valid surfaces are divided into fans of triangles. Raises
    `Error`.
    """
    messages: List[str] = []
    soups = _core.repaired(inputs(surfaces), given(locals()), messages)
    if output is not None:
        _core.convert_surfaces(soups, os.fspath(output), {})
    return [triangles(soup) for soup in soups], messages
