"""Inputs of the mesher: files, surfaces of arrays, complexes with holes and regions; and the values of options."""

import inspect
import os
from typing import TYPE_CHECKING, Any, Callable, Dict, List, Mapping, Optional, Sequence, Tuple, Union

import numpy

from ._core import OptionError

if TYPE_CHECKING:  # importing numpy.typing takes long
    import numpy.typing

    Array = numpy.typing.NDArray[Any]
    ArrayLike = numpy.typing.ArrayLike
else:
    Array = ArrayLike = Any
Path = Union[str, "os.PathLike[str]"]
Surface = Tuple[Array, Array, Array]
SizeField = Union[
    Path,
    Mapping[str, Any],
    Tuple[Any, ArrayLike],
    Tuple[ArrayLike, ArrayLike, ArrayLike],
    Callable[[float, float, float], float],
    Callable[[Array], ArrayLike],
]


def reals(values: ArrayLike, what: str, columns: int) -> Array:
    """Returns an array of shape (n, columns), float64."""
    array = numpy.asarray(values)
    if array.size == 0:
        return numpy.empty((0, columns))
    if array.dtype.kind not in "fiu":
        raise OptionError(f"{what} must be numbers, not {array.dtype}")
    if array.ndim != 2 or array.shape[1] != columns:
        raise OptionError(f"{what} must be an array of shape (n, {columns}), not {array.shape}")
    return numpy.ascontiguousarray(array, dtype=numpy.float64)


def integers(values: ArrayLike, what: str, columns: Optional[int] = None) -> Array:
    """Returns an array of int64, of shape (n, columns), or (n,) without columns. Numbers with a fraction are
    not accepted."""
    array = numpy.asarray(values)
    shape = "(n,)" if columns is None else f"(n, {columns})"
    if array.size == 0:
        return numpy.empty(0 if columns is None else (0, columns), dtype=numpy.int64)
    if array.dtype.kind not in "iu":
        raise OptionError(f"{what} must be integers, not {array.dtype}")
    if array.ndim != (1 if columns is None else 2) or (columns is not None and array.shape[1] != columns):
        raise OptionError(f"{what} must be an array of shape {shape}, not {array.shape}")
    if array.dtype.kind == "u" and array.max() > numpy.iinfo(numpy.int64).max:
        raise OptionError(f"{what} must be integers of 64 bits with a sign")
    return numpy.ascontiguousarray(array, dtype=numpy.int64)


def one_for_each(values: Array, count: int, what: str, of: str) -> Array:
    """Checks that there is one value for each item, and returns the values."""
    if len(values) != count:
        raise OptionError(f"{what} must have one entry for each {of}: {count}, not {len(values)}")
    return values


def _polygons(facet: Any) -> List[Sequence[int]]:
    """Returns the polygons of a facet, which is one polygon or several polygons in one plane."""
    several = len(facet) > 0 and hasattr(facet[0], "__len__")
    return list(facet) if several else [facet]


class Complex:
    """A piecewise-linear complex: facets that bound regions, with holes and facets inside.

    points: (n, 3), any unit of length.
    facets: a sequence of facets. A facet is a polygon, given by three or more rows of `points` in either
        orientation; or a sequence of polygons in one plane. In such a sequence a polygon with two corners is a
        segment inside the facet, and a polygon with one corner is a point inside it.
    facet_tags: (f,), integers that the faces of the mesh get as tags; default: facets are numbered.
    facet_holes: {row of `facets`: (k, 3)}, a point in each hole that is cut out of that facet, in its plane.
    segments: (s, 2), rows of `points`: edges that the mesh must have; segment_tags: (s,).
    holes: (h, 3), a point in each region that stays empty.
    regions: a sequence of (point, tag) or (point, tag, size): gives the region around the point this tag, and
        this target edge length.
    names: names of facet tags, {3: "inlet"}. name: the complex's name in messages.

    Raises OptionError for wrong shapes and for indices that are no integers or out of range.
    """

    def __init__(
        self,
        points: ArrayLike,
        facets: Sequence[Any],
        *,
        facet_tags: Optional[ArrayLike] = None,
        facet_holes: Optional[Mapping[int, ArrayLike]] = None,
        segments: Optional[ArrayLike] = None,
        segment_tags: Optional[ArrayLike] = None,
        holes: Optional[ArrayLike] = None,
        regions: Sequence[Tuple[Any, ...]] = (),
        names: Optional[Mapping[int, str]] = None,
        name: str = "complex",
    ) -> None:
        corners: List[Any] = []
        polygon_ends: List[int] = []
        facet_ends: List[int] = []
        for facet in facets:
            for polygon in _polygons(facet):
                corners.extend(polygon)
                polygon_ends.append(len(corners))
            facet_ends.append(len(polygon_ends))
        self.arrays: Dict[str, Any] = {
            "name": name,
            "points": reals(points, f"the points of {name}", 3),
            "corners": integers(corners, f"the facets of {name}"),
            "polygon_ends": integers(polygon_ends, "ends"),
            "facet_ends": integers(facet_ends, "ends"),
            "names": {2: {int(tag): str(text) for tag, text in (names or {}).items()}},
        }
        if facet_tags is not None:
            tags = integers(facet_tags, f"the tags of {name}")
            self.arrays["facet_tags"] = one_for_each(tags, len(facet_ends), f"the tags of {name}", "facet")
        if segments is not None:
            self.arrays["segments"] = integers(segments, f"the segments of {name}", 2)
        if segment_tags is not None:
            tags = integers(segment_tags, "segment_tags")
            self.arrays["segment_tags"] = one_for_each(
                tags, len(self.arrays.get("segments", ())), "segment_tags", "segment"
            )
        if holes is not None:
            self.arrays["holes"] = reals(holes, f"the holes of {name}", 3)
        rows = [(*region[0], region[1], region[2] if len(region) > 2 else 0) for region in regions]
        self.arrays["regions"] = reals(rows, f"the regions of {name}", 5)
        cut_out = []
        for facet_row, places in (facet_holes or {}).items():
            if not 0 <= facet_row < len(facet_ends):
                raise OptionError(
                    f"facet_holes has the facet {facet_row}, but the facets are 0 to {len(facet_ends) - 1}")
            cut_out += [(facet_row, *place) for place in reals(places, f"facet_holes[{facet_row}]", 3)]
        self.arrays["facet_holes"] = reals(cut_out, "facet_holes", 4)


def _triangles(surface: Tuple[Any, ...], name: str) -> Dict[str, Any]:
    if len(surface) not in (2, 3):
        raise OptionError(f"{name} must be a tuple (points, triangles) or (points, triangles, tags)")
    triangles = integers(surface[1], f"the triangles of {name}", 3)
    count = len(triangles)
    arrays: Dict[str, Any] = {
        "name": name,
        "points": reals(surface[0], f"the points of {name}", 3),
        "corners": triangles.ravel(),
        "polygon_ends": 3 * numpy.arange(1, count + 1),
        "facet_ends": numpy.arange(1, count + 1),
    }
    if len(surface) == 3:
        tags = integers(surface[2], f"the tags of {name}")
        arrays["facet_tags"] = one_for_each(tags, count, f"the tags of {name}", "triangle")
    return arrays


Input = Union[Path, Complex, Tuple[ArrayLike, ArrayLike], Tuple[ArrayLike, ArrayLike, ArrayLike]]


def inputs(given: Sequence[Input]) -> List[Any]:
    """Converts inputs for the compiled part: paths, and dicts of arrays."""
    if not given:
        raise OptionError("there is nothing to mesh: give files, surfaces (points, triangles) or complexes")
    result: List[Any] = []
    for number, each in enumerate(given, 1):
        if isinstance(each, Complex):
            result.append(each.arrays)
        elif isinstance(each, (str, os.PathLike)):
            result.append(os.fspath(each))
        elif isinstance(each, (tuple, list)):
            result.append(_triangles(tuple(each), f"surface {number}"))
        else:
            raise OptionError(f"input {number} must be a path, a tuple (points, triangles) or a Complex, not {each!r}")
    return result


def sampled_sizes(
    function: Callable[[Array, Array, Array], ArrayLike], low: ArrayLike, high: ArrayLike, spacing: float
) -> Tuple[Array, Array, Array]:
    """Make a size field for `collarmesh.mesh` from a function that takes arrays. The function is called once, for all
    samples; sizes between samples are interpolated linearly. This is much faster than a callable of one place, which
    would be called millions of times.

    function: takes x, y, z, arrays of shape (n,); returns lengths, an array of that shape or one number.
    low, high: (3,), corners of the sampled box; a place outside gets the size of the nearest point of the box.
    spacing: largest distance between samples, absolute.

    Raises OptionError, with the place, if the function returns a length that is not positive.
    """
    corners = reals(numpy.array([low, high]), "low and high", 3)
    extent = corners[1] - corners[0]
    if not (spacing > 0 and (extent > 0).all()):
        raise OptionError(
            f"sampled_sizes needs a positive spacing and low below high, not {spacing!r}, {low!r}, {high!r}")
    counts = numpy.maximum(numpy.ceil(extent / spacing).astype(numpy.int64), 1) + 1
    axes = [numpy.linspace(first, last, count) for first, last, count in zip(*corners, counts)]
    points = numpy.stack(numpy.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    lengths = numpy.asarray(function(*points.T.copy()), dtype=numpy.float64)
    if lengths.shape not in ((), (len(points),)):
        raise OptionError(f"the function gave an array of shape {lengths.shape} for {len(points)} points")
    lengths = numpy.broadcast_to(lengths, len(points))
    wrong = numpy.flatnonzero(~(numpy.isfinite(lengths) & (lengths > 0)))
    if len(wrong):
        raise OptionError(f"the function gave {lengths[wrong[0]]} at {tuple(points[wrong[0]].tolist())}; it must give "
                          "positive lengths")
    numbers = numpy.arange(len(points)).reshape(counts)
    cell = numbers[:-1, :-1, :-1].reshape(-1, 1)
    step = (counts[1] * counts[2], counts[2], 1)
    paths = [(0, 1, 2), (1, 2, 0), (2, 0, 1), (0, 2, 1), (2, 1, 0), (1, 0, 2)]  # six tetrahedra
    tets = []
    for number, path in enumerate(paths):
        ends = numpy.cumsum([0, *(step[axis] for axis in path)])
        tets.append(cell + (ends if number < 3 else ends[[0, 2, 1, 3]]))
    return points, numpy.vstack(tets), lengths


def takes_arrays(function: Callable[..., Any]) -> bool:
    """Returns whether a size field takes one argument, places of shape (n, 3), rather than x, y and z."""
    try:
        parameters = inspect.signature(function).parameters.values()
    except (TypeError, ValueError):  # compiled functions have no signature
        return False
    needed = [each for each in parameters if each.kind in (each.POSITIONAL_ONLY, each.POSITIONAL_OR_KEYWORD)
              and each.default is each.empty]
    return len(needed) == 1 and all(each.kind != each.VAR_POSITIONAL for each in parameters)


def _on_points(tets: Array, values: Array, count: int) -> Array:
    """Returns, for each point, the smallest value of the tetrahedra around it; for points without a tetrahedron, the
    smallest of all values."""
    found = numpy.full(count, values.min() if len(values) else 0.0)
    found[tets.ravel()] = numpy.inf
    numpy.minimum.at(found, tets.ravel(), numpy.repeat(values, tets.shape[1]))
    return found


def _size_field(field: SizeField) -> Any:
    """Converts a size field: a path, a dict, a callable, or the arrays of a mesh with values on its points."""
    if isinstance(field, (str, os.PathLike)):
        return os.fspath(field)
    if callable(field) or isinstance(field, Mapping):
        return dict(field) if isinstance(field, Mapping) else field
    arrays: Any = field
    if isinstance(arrays, tuple) and len(arrays) == 2 and hasattr(arrays[0], "tets"):
        arrays = (arrays[0].points, arrays[0]._cells("tets"), arrays[1])
    if not isinstance(arrays, tuple) or len(arrays) != 3:
        raise OptionError("size_field must be a path, a dict, a callable, a tuple (mesh, values) or a tuple (points, "
                          "tets, values)")
    points = reals(arrays[0], "the points of size_field", 3)
    cells = numpy.asarray(arrays[1])
    tets = integers(cells, "the tets of size_field", 10 if cells.ndim == 2 and cells.shape[1] == 10 else 4)
    values = reals(numpy.reshape(arrays[2], (-1, 1)), "the values of size_field", 1).ravel()
    if len(values) not in (len(points), len(tets)):
        raise OptionError(f"size_field has {len(values)} values, but must have one for each of {len(points)} points "
                          f"or {len(tets)} tets")
    if tets.size and not (0 <= tets.min() and tets.max() < len(points)):
        raise OptionError(f"the tets of size_field have corners from {tets.min()} to {tets.max()}; its points are "
                          f"numbered from 0 to {len(points) - 1}")
    if len(values) != len(points):
        values = _on_points(tets, values, len(points))
    return {"points": points, "tets": tets[:, :4], "values": values, "cad_names": False}


def given(options: Mapping[str, Any]) -> Dict[str, Any]:
    """Converts options for the compiled part, leaving out those that are None."""
    found = {name: value for name, value in options.items() if value is not None}
    if "names" in found:
        names = found["names"]
        found["names"] = dict(names) if isinstance(names, Mapping) else os.fspath(names)
    if "size_field" in found:
        found["size_field"] = _size_field(found["size_field"])
    for name in ("region_size", "patch_size", "curve_size"):
        if name in found:
            tags = integers(list(found[name]), f"the tags of {name}")
            found[name] = {int(tag): length for tag, length in zip(tags, found[name].values())}
    return found


def sized(options: Mapping[str, Any]) -> Dict[str, Any]:
    """Converts the options of `remesh`: reads the mesh, and turns a size that is not a number into a size field."""
    found = dict(options)
    if isinstance(found["mesh"], (str, os.PathLike)):
        from ._functions import read

        found["mesh"] = read(found["mesh"])
    size = found["size"]
    if size is None or isinstance(size, (int, float, numpy.number)):
        return found
    if found.get("size_field") is not None:
        raise OptionError("size and size_field both give a size field; give only one of them")
    known = isinstance(size, (str, os.PathLike, Mapping, tuple)) or callable(size)
    return {**found, "size": None, "size_field": size if known else (found["mesh"], size)}


def triangles(soup: Dict[str, Any]) -> Surface:
    """Returns the triangles of a soup; polygons of four and more corners are cut into fans."""
    corners: List[Tuple[int, int, int]] = []
    tags: List[int] = []
    begin = 0
    ends = soup["polygon_ends"]
    first = 0
    for facet, last in enumerate(soup["facet_ends"]):
        for polygon in range(first, last):
            a, *rest = soup["corners"][begin : ends[polygon]]
            begin = ends[polygon]
            for b, c in zip(rest, rest[1:]):
                corners.append((a, b, c))
                tags.append(soup["facet_tags"][facet])
        first = last
    return soup["points"], integers(corners, "triangles", 3), integers(tags, "tags")
