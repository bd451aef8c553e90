"""The mesh: arrays of numpy, and conversions to other programs."""

import os
from typing import Any, Dict, List, Mapping, Optional, Tuple

import numpy

from . import _core
from ._html import table_of
from ._inputs import Array, ArrayLike, Path, integers, one_for_each, reals
from ._types import MeshInfo, PeriodicFaces

_ARRAYS = {
    "points": (numpy.float64, 3),
    "tets": (numpy.int64, 4),
    "tet_region": (numpy.int64, 1),
    "tet_tag": (numpy.int64, 1),
    "tet_collar": (numpy.uint8, 1),
    "tet_thin": (numpy.uint8, 1),
    "tet_crease": (numpy.int64, 1),
    "tet_partition": (numpy.int64, 1),
    "tet_mid_nodes": (numpy.int64, 6),
    "faces": (numpy.int64, 3),
    "face_regions": (numpy.int64, 2),
    "face_tag": (numpy.int64, 1),
    "face_patch": (numpy.int64, 1),
    "face_mid_nodes": (numpy.int64, 3),
    "edges": (numpy.int64, 2),
    "edge_tag": (numpy.int64, 1),
    "edge_curve": (numpy.int64, 1),
    "edge_mid_nodes": (numpy.int64, 1),
    "feature_dimension": (numpy.uint8, 1),
    "feature": (numpy.int64, 1),
    "prisms": (numpy.int64, 6),
    "prism_region": (numpy.int64, 1),
    "prism_tag": (numpy.int64, 1),
    "prism_layer": (numpy.int64, 1),
    "prism_mid_nodes": (numpy.int64, 9),
    "pyramids": (numpy.int64, 5),
    "pyramid_region": (numpy.int64, 1),
    "pyramid_tag": (numpy.int64, 1),
    "pyramid_layer": (numpy.int64, 1),
    "pyramid_mid_nodes": (numpy.int64, 8),
    "quads": (numpy.int64, 4),
    "quad_regions": (numpy.int64, 2),
    "quad_tag": (numpy.int64, 1),
    "quad_patch": (numpy.int64, 1),
    "quad_mid_nodes": (numpy.int64, 4),
    "tet_layer": (numpy.int64, 1),
}
# Arrays that meshes saved by earlier versions lack.
_LATER = ("tet_partition", *(name for name in _ARRAYS if name.startswith(("prism", "pyramid", "quad"))), "tet_layer")
# The names of cells in meshio, and their numbers in VTK, by order. Tetrahedra of second order have, in both, the
# corners, then the mid-edge nodes of ab, bc, ca, ad, bd, cd, as here.
_MESHIO_CELLS = {
    1: {"tets": "tetra", "faces": "triangle", "edges": "line", "prisms": "wedge", "pyramids": "pyramid",
        "quads": "quad"},
    2: {"tets": "tetra10", "faces": "triangle6", "edges": "line3", "prisms": "wedge15", "pyramids": "pyramid13",
        "quads": "quad8"},
}
_VTK_CELLS = {1: {"tets": 10, "prisms": 13, "pyramids": 14}, 2: {"tets": 24, "prisms": 26, "pyramids": 27}}
# For each node of a VTK wedge, its position in our prisms: the normal of a wedge's first triangle points away from the
# second triangle, the normal of ours towards it.
_VTK_WEDGE = [0, 2, 1, 3, 5, 4, 8, 7, 6, 11, 10, 9, 12, 14, 13]


# By order: for each node of a cell of dolfinx, its position in our cells.
_DOLFINX_TETS = {1: [0, 1, 2, 3], 2: [0, 1, 2, 3, 9, 8, 5, 7, 6, 4]}
_DOLFINX_TRIANGLES = {1: [0, 1, 2], 2: [0, 1, 2, 4, 5, 3]}
# The triangles of a tetrahedron as seen from outside, with their mid-edge nodes.
_SIDES = [[1, 2, 3, 5, 9, 8], [0, 3, 2, 7, 9, 6], [0, 1, 3, 4, 8, 7], [0, 2, 1, 6, 5, 4]]


def _cells_with_nodes(cells: ArrayLike, what: str, columns: Tuple[int, int]) -> Array:
    """Converts cells of first or second order; the number of columns of `cells` decides which."""
    array = numpy.asarray(cells)
    return integers(array, what, columns[1] if array.ndim == 2 and array.shape[1] == columns[1] else columns[0])


def _sides_between_tags(tets: Array, tags: Array) -> Tuple[Array, Array]:
    """Returns the triangles on the outside and between tets with different tags, and new tags for them: one for each
    pair of tags, and one for each tag with the outside."""
    if len(tets) == 0:
        return tets[:, :3], tags
    columns = [side[: 3 if tets.shape[1] == 4 else 6] for side in _SIDES]
    sides = tets[:, columns].reshape(4 * len(tets), -1)
    order = numpy.lexsort(numpy.sort(sides[:, :3], axis=1).T)
    corners = numpy.sort(sides[order, :3], axis=1)
    twice = numpy.append((corners[1:] == corners[:-1]).all(axis=1), False)
    first = numpy.flatnonzero(~numpy.insert(twice[:-1], 0, False))
    tag = tags[order // 4]
    other = numpy.where(twice[first], tag[numpy.minimum(first + 1, len(order) - 1)], 0)
    kept = ~twice[first] | (other != tag[first])
    pairs = numpy.sort(numpy.column_stack([tag[first], other]), axis=1)[kept]
    pairs = numpy.column_stack([pairs, twice[first][kept]])  # 0 is a valid tag
    numbers = numpy.unique(pairs, axis=0, return_inverse=True)[1].reshape(-1) + 1
    return sides[order[first[kept]]], numbers.astype(numpy.int64)


def _beside(regions: Array) -> Array:
    """Returns the region behind each face, or in front of it if none is behind."""
    behind, before = regions.T
    return numpy.where(behind > 0, behind, before)


def _empty(name: str) -> Array:
    kind, columns = _ARRAYS[name]
    return numpy.empty(0 if columns == 1 else (0, columns), dtype=kind)


def _layer_cells(
    kind: str, cells: ArrayLike, tags: Optional[ArrayLike], columns: Tuple[int, int], order: int
) -> Dict[str, Array]:
    """Returns the arrays of prisms, pyramids or quads."""
    nodes = _cells_with_nodes(cells, f"{kind}s", columns)
    if len(nodes) > 0 and nodes.shape[1] != columns[order - 1]:
        raise _core.OptionError(f"{kind}s: rows have {nodes.shape[1]} nodes, but those of order {order} have "
                                f"{columns[order - 1]}")
    tag = numpy.full(len(nodes), 0 if kind == "quad" else 1, dtype=numpy.int64)
    if tags is not None:
        tag = one_for_each(integers(tags, f"{kind}_tags"), len(nodes), f"{kind}_tags", kind)
    arrays = {f"{kind}s": nodes[:, :columns[0]], f"{kind}_tag": tag}
    if order == 2:
        arrays[f"{kind}_mid_nodes"] = nodes[:, columns[0]:]
    return arrays


class Mesh:
    """A tetrahedral mesh. Its arrays are read-only; indices are int64 and refer to rows of `points`.

    `collarmesh.mesh` and `collarmesh.read` make meshes. `Mesh(points, tets, tags)` makes one from arrays, to check,
    convert or write the mesh of another program.

    points: (n, 3), float64, in the unit of the input.
    tets: (m, 4), positive volume.
    tet_region: (m,), numbers of regions, from 1; tet_tag: (m,), tags of these regions.
    tet_collar: (m,), 0 outside of collars, 1 star, 2 book; tet_crease: (m,), the tag of the collar's crease.
    tet_thin: (m,), 1 for thin tetrahedra, which exceed radius_edge; (0,) if unknown.
    tet_partition: (m,), the rank of each tetrahedron, from 0; (0,) if the mesh is not partitioned.
    faces: (k, 3), triangles on boundaries, interfaces and internal facets.
    face_regions: (k, 2), regions behind and in front of the triangle; 0: none.
    face_tag: (k,), tags of the surfaces' triangles or, if these had none, numbers of patches.
    face_patch: (k,), indices of the complex's patches; -1: unknown.
    edges: (j, 2), edges on feature curves; edge_tag, edge_curve: (j,).
    tet_mid_nodes (m, 6), face_mid_nodes (k, 3), edge_mid_nodes (j,): mid-edge nodes of ab, bc, ca, ad, bd, cd;
        empty for first order.
    feature_dimension, feature: (n,), the kind (0 vertex, 1 curve, 2 patch) and the index of the feature that a point is
        on; 3 and -1: none.
    prisms: (p, 6), of boundary layers: corners a, b, c of the triangle at the wall or nearer to it, then those above
        them; pyramids: (q, 5), corners of the base, counterclockwise as seen from the apex, then the apex.
    prism_region, prism_tag, pyramid_region, pyramid_tag: as for tetrahedra. prism_layer, pyramid_layer: numbers of
        layers, from 1 at the wall; 0: not known. tet_layer: (m,), numbers of layers of tetrahedra, 0 in no layer;
        (0,) if none is in a layer.
    quads: (s, 4), quadrangles on boundaries, interfaces and internal facets, with quad_regions (s, 2), quad_tag and
        quad_patch as for faces.
    prism_mid_nodes (p, 9): mid-edge nodes of ab, bc, ca, de, ef, fd, ad, be, cf; pyramid_mid_nodes (q, 8): of ab, bc,
        cd, da, ae, be, ce, de; quad_mid_nodes (s, 4): of ab, bc, cd, da.
    names: names of tags by dimension, {2: {3: "inlet"}} for patch 3; 1 curves, 3 regions. Solids of STEP files have
        the names of their products.
    colours: colours of tags by dimension, of a mesh made from a STEP file: {2: {3: "#ff0000"}}.
    periodic: a dict for each pair of `periodic=`: "first" and "second", tags of patches; "rotation" (3, 3) and "shift"
        (3,), which take a point p of the first group to rotation @ p + shift; "nodes" (k, 2), each node of the first
        group with its image, mid-edge nodes included.
    """

    points: Array
    tets: Array
    tet_region: Array
    tet_tag: Array
    tet_collar: Array
    tet_thin: Array
    tet_crease: Array
    tet_partition: Array
    tet_mid_nodes: Array
    faces: Array
    face_regions: Array
    face_tag: Array
    face_patch: Array
    face_mid_nodes: Array
    edges: Array
    edge_tag: Array
    edge_curve: Array
    edge_mid_nodes: Array
    feature_dimension: Array
    feature: Array
    prisms: Array
    prism_region: Array
    prism_tag: Array
    prism_layer: Array
    prism_mid_nodes: Array
    pyramids: Array
    pyramid_region: Array
    pyramid_tag: Array
    pyramid_layer: Array
    pyramid_mid_nodes: Array
    quads: Array
    quad_regions: Array
    quad_tag: Array
    quad_patch: Array
    quad_mid_nodes: Array
    tet_layer: Array
    names: Dict[int, Dict[int, str]]
    colours: Dict[int, Dict[int, str]]
    periodic: List[PeriodicFaces]

    def __init__(
        self,
        points: ArrayLike,
        tets: ArrayLike,
        tags: Optional[ArrayLike] = None,
        *,
        faces: Optional[ArrayLike] = None,
        face_tags: Optional[ArrayLike] = None,
        edges: Optional[ArrayLike] = None,
        edge_tags: Optional[ArrayLike] = None,
        prisms: Optional[ArrayLike] = None,
        prism_tags: Optional[ArrayLike] = None,
        pyramids: Optional[ArrayLike] = None,
        pyramid_tags: Optional[ArrayLike] = None,
        quads: Optional[ArrayLike] = None,
        quad_tags: Optional[ArrayLike] = None,
        names: Optional[Mapping[int, Mapping[int, str]]] = None,
    ) -> None:
        """Make a mesh from arrays. Cells refer to rows of `points`. Cells of second order have their mid-edge nodes
        after the corners, in the order ab, bc, ca, ad, bd, cd.

        points: (n, 3). tets: (m, 4) or (m, 10), reversed if most volumes are negative. tags: (m,), integers; each
            tag makes a region; default 1.
        faces: (k, 3) or (k, 6), triangles on boundaries and interfaces; face_tags: (k,). Default: the boundary of
            the tetrahedra with each tag, and a tag for each pair of tags that are neighbours.
        edges: (j, 2) or (j, 3), edges on curves; edge_tags: (j,).
        prisms: (p, 6) or (p, 15), pyramids: (q, 5) or (q, 13), with their tags, default 1; quads: (s, 4) or (s, 8),
            quadrangles on boundaries and interfaces. Their nodes are in the order of the attributes `prisms`,
            `pyramids` and `quads`, then of their `..._mid_nodes`. With prisms or pyramids, faces are to be given.
        names: names of tags by dimension, {2: {3: "inlet"}}.

        Raises OptionError for wrong shapes and kinds and for indices out of range.
        """
        nodes = _cells_with_nodes(tets, "tets", (4, 10))
        tet_tag = numpy.ones(len(nodes), dtype=numpy.int64)
        if tags is not None:
            tet_tag = one_for_each(integers(tags, "tags"), len(nodes), "tags", "tetrahedron")
        if faces is None:
            triangles, face_tag = _sides_between_tags(nodes, tet_tag)
        else:
            triangles, face_tag = _cells_with_nodes(faces, "faces", (3, 6)), numpy.empty(0, dtype=numpy.int64)
        if face_tags is not None:
            face_tag = one_for_each(integers(face_tags, "face_tags"), len(triangles), "face_tags", "triangle")
        lines = _cells_with_nodes(() if edges is None else edges, "edges", (2, 3))
        given = {
            "points": reals(points, "points", 3), "tets": nodes[:, :4], "tet_tag": tet_tag,
            "faces": triangles[:, :3], "face_tag": face_tag, "edges": lines[:, :2],
            "names": {kind: dict(by_tag) for kind, by_tag in (names or {}).items()}, "cad_names": False,
        }
        order = 2 if nodes.shape[1] == 10 else 1
        if faces is None and (prisms is not None or pyramids is not None):
            raise _core.OptionError("faces: needed with prisms or pyramids; give the triangles and quads on boundaries")
        for kind, cells, its_tags, columns in (
            ("prism", prisms, prism_tags, (6, 15)), ("pyramid", pyramids, pyramid_tags, (5, 13)),
            ("quad", quads, quad_tags, (4, 8)),
        ):
            if cells is not None:
                given.update(_layer_cells(kind, cells, its_tags, columns, order))
        if edge_tags is not None:
            given["edge_tag"] = one_for_each(integers(edge_tags, "edge_tags"), len(lines), "edge_tags", "edge")
        if nodes.shape[1] == 10:
            given["tet_mid_nodes"] = nodes[:, 4:]
            given.update({"face_mid_nodes": triangles[:, 3:]} if triangles.shape[1] == 6 else {})
            given.update({"edge_mid_nodes": lines[:, 2]} if lines.shape[1] == 3 else {})
        elif triangles.shape[1] == 6 or lines.shape[1] == 3:
            raise _core.OptionError("tets of first order have no faces and edges of second order")
        self.__setstate__(_core.complete(given))

    @classmethod
    def _of(cls, arrays: Dict[str, Any]) -> "Mesh":
        """Makes a mesh from the result of the compiled part."""
        mesh = cls.__new__(cls)
        mesh.__setstate__(arrays)
        return mesh

    def __getstate__(self) -> Dict[str, Any]:
        return {**self._arrays(), "check": self._check, "colours": self.colours, **self._said}

    def __setstate__(self, state: Dict[str, Any]) -> None:
        arrays = {**{name: _empty(name) for name in _LATER}, **state}
        for name in _ARRAYS:
            array = arrays[name]
            array.setflags(write=False)  # pickle makes arrays writable
            setattr(self, name, array)
        self.names = state["names"]
        self.colours = state.get("colours", {})
        self.periodic = state.get("periodic", [])
        self._cad_names = bool(state["cad_names"])
        self._check: Optional[Dict[str, Any]] = state.get("check")
        self._said = {key: state.get(key, []) for key in ("repairs", "notes", "warnings")}
        self._said["status_message"] = state.get("status_message", "")
        self._said["split"] = state.get("split")

    def _arrays(self) -> Dict[str, Any]:
        arrays: Dict[str, Any] = {name: getattr(self, name) for name in _ARRAYS}
        return {**arrays, "names": self.names, "periodic": self.periodic, "cad_names": self._cad_names}

    @property
    def order(self) -> int:
        """The order of the elements: 1, or 2 if they have mid-edge nodes."""
        return 2 if any(len(nodes) for nodes in (self.tet_mid_nodes, self.face_mid_nodes, self.edge_mid_nodes)) else 1

    @property
    def report(self) -> Dict[str, Any]:
        """The certificate as `collarmesh check --json` prints it; empty for a mesh that was read."""
        return dict(self._check or {})

    @property
    def passed(self) -> bool:
        """Does every guarantee hold? False for a mesh that was read: use `collarmesh.check`."""
        return bool(self._check and self._check["passed"]) and not self._said["status_message"]

    @property
    def findings(self) -> List[str]:
        """The violated guarantees: sentences with places."""
        told = [f"{f['guarantee']}: {f['message']}" for f in (self._check or {}).get("findings", [])]
        return ([self._said["status_message"]] if self._said["status_message"] else []) + told

    @property
    def split(self) -> Optional[Dict[str, Any]]:
        """The results of `split=` and `keep_apart=`, as in reports: "patches" with the tags of their sides ("minus",
        "plus"), "triangles", "area" and "where"; "split_nodes", "junction_nodes", "new_nodes", "front_nodes". None
        without these options."""
        found: Optional[Dict[str, Any]] = self._said["split"]
        return found

    @property
    def repairs(self) -> List[str]:
        """The changes that made surfaces a valid complex: sentences with places."""
        return list(self._said["repairs"])

    @property
    def warnings(self) -> List[str]:
        """Parts of the input that have no effect or contradict other parts: sentences."""
        return list(self._said["warnings"])

    @property
    def notes(self) -> List[str]:
        """The changes to CAD shapes: sentences."""
        return list(self._said["notes"])

    @property
    def min_dihedral(self) -> float:
        """Smallest dihedral angle outside of collars, degrees; nan for a mesh that was read."""
        return float((self._check or {}).get("min_dihedral", numpy.nan))

    @property
    def max_dihedral(self) -> float:
        """Largest dihedral angle outside of collars, degrees; nan for a mesh that was read."""
        return float((self._check or {}).get("max_dihedral", numpy.nan))

    def name(self, dimension: int, tag: int) -> str:
        """Returns the name of a tag in formats with names: patches have dimension 2, regions 3, curves 1."""
        given = self.names.get(dimension, {}).get(tag)
        if given is not None:
            return given
        ours = ("vertex_", "curve_", "patch_", "region_")
        kinds = ("Vertex", "Edge", "Face", "Solid") if self._cad_names else ours
        return f"{kinds[dimension]}{tag}"

    def adapt(self, size: Any = None, **options: Any) -> "Mesh":
        """Return a mesh with other edge lengths, finer or coarser, and better tetrahedra, by `collarmesh.remesh`.

        size: a length; lengths for each point or each tetrahedron, as `sizes_from_errors` returns them; or a size
            field, as in `collarmesh.mesh`. options: those of `collarmesh.remesh`.
        """
        from ._functions import remesh

        return remesh(self, size, **options)

    def partitioned(self, partitions: int) -> "Mesh":
        """Return this mesh with its tetrahedra divided evenly among ranks, with few shared faces.

        partitions: number of ranks, 1 to the number of tetrahedra. Raises OptionError for other numbers, and if the
        library Scotch, which divides them, is missing.
        """
        whole = isinstance(partitions, (int, numpy.integer)) and not isinstance(partitions, bool)
        if not whole or not 1 <= partitions <= len(self.tets):
            raise _core.OptionError(
                f"partitions must be a whole number from 1 to {len(self.tets)}, the number of tetrahedra, "
                f"not {partitions!r}")
        state = self.__getstate__()
        return Mesh._of({**state, "tet_partition": _core.partition(state, int(partitions))})

    def write(self, path: Path, format: str = "", scale: float = 1, ghost_cells: bool = False) -> None:
        """Write a file.

        path: its extension gives the format (.vtu, .msh, .inp ...), unless `format` does (".vtu").
        scale: factor of the coordinates, 0.001 to convert millimetres to metres.
        ghost_cells: write with each partition the tetrahedra of other partitions that share a vertex with it, in .msh
            and .pvtu.
        Raises WriteError, also for ghost cells in other formats; OptionError for ghost cells of a mesh that is not
        partitioned.
        """
        arrays = self._arrays()
        if scale != 1:
            arrays["points"] = scale * self.points
            arrays["periodic"] = [{**faces, "shift": scale * faces["shift"]} for faces in self.periodic]
        _core.write_mesh(arrays, os.fspath(path), format, ghost_cells)

    def info(self) -> MeshInfo:
        """Return counts, angles, volumes and histograms, as `collarmesh info --json` prints them."""
        return _core.measures(self._arrays())

    def interpolate(self, values: ArrayLike, points: ArrayLike, outside: str = "nan") -> Array:
        """Interpolate a field of this mesh at other points: linearly in tetrahedra of first order, quadratically in
        those of second order.

        values: (n,) or (n, k), a row for each point of the mesh; or a row for each tetrahedron, constant in it.
        points: (p, 3), the places, such as the points of another mesh.
        outside: the result at points outside of the mesh: "nan", or "nearest" for the value at the nearest point of
            the mesh, which needs values on points.

        Returns (p,) or (p, k). Raises OptionError for wrong shapes, and for a mesh with prisms or pyramids.
        """
        given = numpy.asarray(values, dtype=numpy.float64)
        on_points = given.ndim > 0 and len(given) == len(self.points)
        if given.ndim not in (1, 2) or not (on_points or len(given) == len(self.tets)):
            raise _core.OptionError(f"values must have a row for each of the {len(self.points)} points or "
                                    f"{len(self.tets)} tetrahedra, but they have the shape {given.shape}")
        if outside not in ("nan", "nearest") or (outside == "nearest" and not on_points):
            raise _core.OptionError('outside must be "nan" or, if the values are given on points, "nearest"')
        self._require_tets_alone("interpolate")
        where = {"name": "points", "points": reals(points, "points", 3)}
        tet, shares, nearest = _core.locate(self._arrays(), where)
        inside = tet >= 0
        if on_points:
            weights = self._weights(shares[inside])
            nodes = self._cells("tets")[tet[inside]]
            found = (given[nodes] * weights.reshape(*weights.shape, *[1] * (given.ndim - 1))).sum(axis=1)
        else:
            found = given[tet[inside]]
        result = numpy.full((len(tet), *given.shape[1:]), numpy.nan)
        result[inside] = found
        if outside == "nearest":
            result[~inside] = given[nearest[~inside]]
        return result

    def _require_tets_alone(self, what: str) -> None:
        if len(self.prisms) + len(self.pyramids) > 0:
            raise _core.OptionError(f"{what}: the mesh has {len(self.prisms)} prisms and {len(self.pyramids)} "
                                    "pyramids, for which this is not supported; make layers of tetrahedra")

    def _surface(self) -> Tuple[List[Any], Array]:
        """Returns the triangles and quadrangles with their tags."""
        return [*self.faces, *self.quads], numpy.concatenate([self.face_tag, self.quad_tag])

    def _weights(self, shares: Array) -> Array:
        """Returns the weights of a tetrahedron's nodes at places with these barycentric coordinates."""
        if self.order == 1:
            return shares
        amid = [4 * shares[:, i] * shares[:, j] for i, j in ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))]
        return numpy.column_stack([shares * (2 * shares - 1), *amid])

    def _cells(self, cells: str) -> Array:
        nodes: Array = getattr(self, cells)
        if self.order == 1:
            return nodes
        singular = cells[:-1]
        amid: Array = getattr(self, f"{singular}_mid_nodes")
        return numpy.hstack([nodes, amid.reshape(len(nodes), -1)])

    def to_meshio(self) -> Any:
        """Return a meshio.Mesh of tetrahedra, triangles and lines, then prisms, pyramids and quadrangles if there are
        any, with the data "tag" and "region" and a cell set for each name. Raises ImportError without meshio."""
        import meshio

        blocks = [("tets", 3, self.tet_tag, self.tet_region), ("faces", 2, self.face_tag, _beside(self.face_regions)),
                  ("edges", 1, self.edge_tag, numpy.zeros(len(self.edges), dtype=numpy.int64))]
        of_layers = [("prisms", 3, self.prism_tag, self.prism_region),
                     ("pyramids", 3, self.pyramid_tag, self.pyramid_region),
                     ("quads", 2, self.quad_tag, _beside(self.quad_regions))]
        blocks += [block for block in of_layers if len(block[2]) > 0]
        cells = [(_MESHIO_CELLS[self.order][name], self._cells(name)) for name, *_ in blocks]
        tags, regions = [block[2] for block in blocks], [block[3] for block in blocks]
        sets: Dict[str, List[Array]] = {}
        for place, (_, dimension, tag_of_cell, _) in enumerate(blocks):
            for tag in numpy.unique(tag_of_cell):
                nothing = [numpy.empty(0, dtype=numpy.int64)] * len(blocks)
                members = sets.setdefault(self.name(dimension, int(tag)), nothing)
                members[place] = numpy.flatnonzero(tag_of_cell == tag)
        return meshio.Mesh(self.points, cells, cell_data={"tag": tags, "region": regions}, cell_sets=sets)

    def to_dolfinx(self, comm: Any = None) -> Tuple[Any, Any, Any]:
        """Return a dolfinx mesh of the same order, and its tags: (mesh, cell_tags, facet_tags), from `tet_tag` and
        `face_tag`.

        comm: of mpi4py, COMM_WORLD by default. The first rank's mesh is divided among all; the meshes of other ranks
        are ignored. Raises ImportError without dolfinx, OptionError for a mesh with prisms or pyramids.
        """
        from ._dolfinx import mesh_and_tags

        self._require_tets_alone("dolfinx")
        tets = self._cells("tets")[:, _DOLFINX_TETS[self.order]]
        faces = self._cells("faces")[:, _DOLFINX_TRIANGLES[self.order]]
        return mesh_and_tags(comm, self.points, self.order, (tets, self.tet_tag), (faces, self.face_tag))

    def to_pyvista(self) -> Any:
        """Return a pyvista.UnstructuredGrid of the tetrahedra with the data "tag", "region", "collar"; then prisms and
        pyramids if there are any, with the data "layer".

        Raises ImportError without pyvista.
        """
        import pyvista

        numbers = _VTK_CELLS[self.order]
        prisms, pyramids = self._cells("prisms"), self._cells("pyramids")
        cells = {numbers["tets"]: self._cells("tets")}
        if len(prisms) > 0:
            cells[numbers["prisms"]] = prisms[:, _VTK_WEDGE[:prisms.shape[1]]]
        if len(pyramids) > 0:
            cells[numbers["pyramids"]] = pyramids
        grid = pyvista.UnstructuredGrid(cells, numpy.array(self.points))
        none = numpy.zeros(len(prisms) + len(pyramids), dtype=self.tet_collar.dtype)
        grid.cell_data["tag"] = numpy.concatenate([self.tet_tag, self.prism_tag, self.pyramid_tag])
        grid.cell_data["region"] = numpy.concatenate([self.tet_region, self.prism_region, self.pyramid_region])
        grid.cell_data["collar"] = numpy.concatenate([self.tet_collar, none])
        if len(none) > 0 or len(self.tet_layer) > 0:
            of_tets = self.tet_layer if len(self.tet_layer) > 0 else numpy.zeros(len(self.tets), dtype=numpy.int64)
            grid.cell_data["layer"] = numpy.concatenate([of_tets, self.prism_layer, self.pyramid_layer])
        return grid

    def plot(self, axes: Any = None, *, labels: bool = True, curves: bool = False) -> Any:
        """Draw the boundary with matplotlib, in the colours of the STEP file or with one colour for each tag. Draws on
        `axes` of three dimensions, or on new ones, and returns them. Raises ImportError without matplotlib.

        labels: show the names or numbers of faces.
        curves: show the names or numbers of edges.
        """
        import matplotlib.colors
        import matplotlib.pyplot
        from mpl_toolkits.mplot3d.art3d import Poly3DCollection

        if axes is None:
            axes = matplotlib.pyplot.figure().add_subplot(projection="3d")
        polygons, face_tag = self._surface()
        tags, colour = numpy.unique(face_tag, return_inverse=True)
        colours = matplotlib.pyplot.get_cmap("tab20")(colour % 20)
        for tag, given in self.colours.get(2, {}).items():
            colours[face_tag == tag] = matplotlib.colors.to_rgba(given)
        corners = [self.points[polygon] for polygon in polygons]
        axes.add_collection3d(Poly3DCollection(corners, facecolors=colours, edgecolors="k", linewidths=0.2))
        low, high = self.points.min(axis=0), self.points.max(axis=0)
        axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
        axes.set_box_aspect(numpy.maximum(high - low, 1e-6 * (high - low).max()))
        if labels:
            self._label(axes, 2, numpy.array([each.mean(axis=0) for each in corners]), face_tag)
        if curves:
            self._label(axes, 1, self.points[self.edges].mean(axis=1), self.edge_tag)
        return axes

    def _label(self, axes: Any, dimension: int, centres: Array, tags: Array) -> None:
        """Writes the name of each tag, or its number, at the middle one of the tag's triangles or edges."""
        for tag in numpy.unique(tags):
            here = centres[tags == tag]
            middle = here[numpy.linalg.norm(here - here.mean(axis=0), axis=1).argmin()]
            given = self.names.get(dimension, {}).get(int(tag), str(tag))
            axes.text(*middle, given, color="k" if dimension == 2 else "b", fontsize=8, ha="center", va="center",
                      zorder=1e6, bbox={"boxstyle": "round,pad=0.15", "facecolor": "w", "edgecolor": "none",
                                        "alpha": 0.7})

    def _repr_html_(self) -> str:
        """Return HTML for notebooks: the certificate and figures of the mesh."""
        return table_of(self.passed if self._check else None, self.findings, self.repairs, self.info()["mesh"],
                        self._check or {})

    def __repr__(self) -> str:
        layers = "".join(f" {len(cells)} {name},"
                         for name, cells in (("prisms", self.prisms), ("pyramids", self.pyramids))
                         if len(cells) > 0)
        return f"<collarmesh.Mesh: {len(self.tets)} tets,{layers} {len(self.points)} points>"
