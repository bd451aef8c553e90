"""The mesh: arrays of numpy, and the ways to other programs."""

import os
from typing import Any, Dict, List, Optional

import numpy

from . import _core
from ._inputs import Array, Path

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
}
# The places of our nodes amid edges in meshio's and VTK's cells of second order: corners, then ab, bc, ca,
# ad, bd, cd.
_MESHIO_CELLS = {1: ("tetra", "triangle", "line"), 2: ("tetra10", "triangle6", "line3")}
_VTK_CELLS = {1: 10, 2: 24}


class Mesh:
    """A tetrahedral mesh. Its arrays are not to be written to; indices are int64, rows of `points`.

    points: (n, 3), float64, in the unit of the input.
    tets: (m, 4), positive volume.
    tet_region: (m,), numbers of regions, from 1; tet_tag: (m,), the tags of these.
    tet_collar: (m,), 0 outside of collars, 1 star, 2 book; tet_crease: (m,), the tag of its crease there.
    tet_thin: (m,), 1 for thin tetrahedra, which exceed radius_edge; (0,) where that is not known.
    tet_partition: (m,), the rank that each tetrahedron is given to, from 0; (0,) where the mesh is not
        partitioned.
    faces: (k, 3), triangles on boundaries, interfaces and internal facets.
    face_regions: (k, 2), regions behind and before the triangle; 0: none.
    face_tag: (k,), tags of the surfaces' triangles, or numbers of patches where these had none.
    face_patch: (k,), rows of the complex's patches; -1: not known.
    edges: (j, 2), edges on feature curves; edge_tag, edge_curve: (j,).
    tet_mid_nodes (m, 6), face_mid_nodes (k, 3), edge_mid_nodes (j,): nodes amid the edges ab, bc, ca, ad, bd, cd;
        empty for first order.
    feature_dimension, feature: (n,), the vertex (0), curve (1) or patch (2) that a point is on; 3, -1: none.
    names: names of tags by dimension, {2: {3: "inlet"}} for patch 3; 1 curves, 3 regions.
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
    names: Dict[int, Dict[int, str]]

    def __init__(self, arrays: Dict[str, Any]) -> None:
        """Use `collarmesh.mesh` or `collarmesh.read`."""
        self.__setstate__(arrays)

    def __getstate__(self) -> Dict[str, Any]:
        return {**self._arrays(), "check": self._check, **self._said}

    def __setstate__(self, state: Dict[str, Any]) -> None:
        arrays = {"tet_partition": numpy.empty(0, dtype=numpy.int64), **state}  # earlier versions had none
        for name in _ARRAYS:
            array = arrays[name]
            array.setflags(write=False)  # pickle gives arrays that can be written to
            setattr(self, name, array)
        self.names = state["names"]
        self._cad_names = bool(state["cad_names"])
        self._check: Optional[Dict[str, Any]] = state.get("check")
        self._said = {key: state.get(key, []) for key in ("repairs", "notes", "warnings")}
        self._said["status_message"] = state.get("status_message", "")

    def _arrays(self) -> Dict[str, Any]:
        arrays: Dict[str, Any] = {name: getattr(self, name) for name in _ARRAYS}
        return {**arrays, "names": self.names, "cad_names": self._cad_names}

    @property
    def order(self) -> int:
        """1, or 2 for ten nodes to a tetrahedron."""
        return 2 if len(self.tet_mid_nodes) else 1

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
        """What does not hold: sentences with places."""
        told = [f"{f['guarantee']}: {f['message']}" for f in (self._check or {}).get("findings", [])]
        return ([self._said["status_message"]] if self._said["status_message"] else []) + told

    @property
    def repairs(self) -> List[str]:
        """What was done to surfaces that were no valid complex: sentences with places."""
        return list(self._said["repairs"])

    @property
    def warnings(self) -> List[str]:
        """What the input has that is of no effect or contradicts something else."""
        return list(self._said["warnings"])

    @property
    def notes(self) -> List[str]:
        """What was done to CAD shapes."""
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
        """What a tag is called in formats with names: patches have dimension 2, regions 3, curves 1."""
        given = self.names.get(dimension, {}).get(tag)
        if given is not None:
            return given
        ours = ("vertex_", "curve_", "patch_", "region_")
        kinds = ("Vertex", "Edge", "Face", "Solid") if self._cad_names else ours
        return f"{kinds[dimension]}{tag}"

    def partitioned(self, partitions: int) -> "Mesh":
        """The same mesh with its tetrahedra divided among so many ranks, evenly and with few shared faces.

        partitions: 1 to the number of tetrahedra. Raises OptionError for others, and where Scotch, which
        divides them, is not there.
        """
        whole = isinstance(partitions, (int, numpy.integer)) and not isinstance(partitions, bool)
        if not whole or not 1 <= partitions <= len(self.tets):
            raise _core.OptionError(
                f"partitions must be a whole number from 1 to {len(self.tets)}, as many as there are "
                f"tetrahedra, not {partitions!r}")
        state = self.__getstate__()
        return Mesh({**state, "tet_partition": _core.partition(state, int(partitions))})

    def write(self, path: Path, format: str = "", scale: float = 1, ghost_cells: bool = False) -> None:
        """Write a file.

        path: its extension gives the format (.vtu, .msh, .inp ...), unless `format` does (".vtu").
        scale: coordinates are multiplied by this, 0.001 for metres of millimetres.
        ghost_cells: with each partition the tetrahedra of others that share a vertex with it; .msh, .pvtu.
        Raises WriteError, also for ghost cells in other formats; OptionError for those of a mesh that is not
        partitioned.
        """
        arrays = self._arrays()
        if scale != 1:
            arrays["points"] = scale * self.points
        _core.write_mesh(arrays, os.fspath(path), format, ghost_cells)

    def info(self) -> Dict[str, Any]:
        """Counts, angles, volumes and histograms, as `collarmesh info --json` prints them."""
        return _core.measures(self._arrays())

    def _cells(self, cells: str) -> Array:
        nodes: Array = getattr(self, cells)
        if self.order == 1:
            return nodes
        singular = cells[:-1]
        amid: Array = getattr(self, f"{singular}_mid_nodes")
        return numpy.hstack([nodes, amid.reshape(len(nodes), -1)])

    def to_meshio(self) -> Any:
        """A meshio.Mesh of tetrahedra, triangles and lines, with the data "tag" and "region" and a cell set for
        each name. Raises ImportError without meshio."""
        import meshio

        tet, triangle, line = _MESHIO_CELLS[self.order]
        cells = [(tet, self._cells("tets")), (triangle, self._cells("faces")), (line, self._cells("edges"))]
        tags = [self.tet_tag, self.face_tag, self.edge_tag]
        sets: Dict[str, List[Array]] = {}
        for block, (dimension, tag_of_cell) in enumerate(zip((3, 2, 1), tags)):
            for tag in numpy.unique(tag_of_cell):
                members = [numpy.empty(0, dtype=numpy.int64)] * 3
                members[block] = numpy.flatnonzero(tag_of_cell == tag)
                sets[self.name(dimension, int(tag))] = members
        behind, before = self.face_regions.T
        beside = numpy.where(behind > 0, behind, before)
        regions = [self.tet_region, beside, numpy.zeros(len(self.edges), dtype=numpy.int64)]
        return meshio.Mesh(self.points, cells, cell_data={"tag": tags, "region": regions}, cell_sets=sets)

    def to_pyvista(self) -> Any:
        """A pyvista.UnstructuredGrid of the tetrahedra with the data "tag", "region", "collar".

        Raises ImportError without pyvista.
        """
        import pyvista

        grid = pyvista.UnstructuredGrid({_VTK_CELLS[self.order]: self._cells("tets")}, numpy.array(self.points))
        grid.cell_data["tag"] = self.tet_tag
        grid.cell_data["region"] = self.tet_region
        grid.cell_data["collar"] = self.tet_collar
        return grid

    def plot(self, axes: Any = None) -> Any:
        """Draw the boundary with matplotlib, a colour for each tag; on `axes` of three dimensions, or new ones,
        which are returned. Raises ImportError without matplotlib."""
        import matplotlib.pyplot
        from mpl_toolkits.mplot3d.art3d import Poly3DCollection

        if axes is None:
            axes = matplotlib.pyplot.figure().add_subplot(projection="3d")
        tags, colour = numpy.unique(self.face_tag, return_inverse=True)
        colours = matplotlib.pyplot.get_cmap("tab20")(colour % 20)
        triangles = self.points[self.faces]
        axes.add_collection3d(Poly3DCollection(triangles, facecolors=colours, edgecolors="k", linewidths=0.2))
        low, high = self.points.min(axis=0), self.points.max(axis=0)
        axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
        axes.set_box_aspect(numpy.maximum(high - low, 1e-6 * (high - low).max()))
        return axes

    def __repr__(self) -> str:
        return f"<collarmesh.Mesh: {len(self.tets)} tets, {len(self.points)} points>"
