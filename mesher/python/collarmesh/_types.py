"""The types of the dicts that functions return; they match the JSON of the command line."""

from typing import Dict, List, Optional, TypedDict

from ._inputs import Array


class PeriodicFaces(TypedDict):
    """Two groups of patches. The mesh of the second group is the image of that of the first.

    first, second: tags of patches.
    rotation, shift: (3, 3) and (3,); the motion takes a point p of the first to rotation @ p + shift.
    nodes: (k, 2), rows of `points`: a node of the first group and its image, mid-edge nodes included.
    """

    first: Array
    second: Array
    rotation: Array
    shift: Array
    nodes: Array


class Region(TypedDict):
    region: int
    tag: int
    name: Optional[str]
    input: str
    colour: Optional[str]
    volume: float


class Patch(TypedDict):
    tag: int
    name: Optional[str]
    colour: Optional[str]
    patches: int
    planar: bool
    area: float
    where: List[float]


class CreaseInfo(TypedDict):
    kind: str
    angle: float
    where: List[float]
    message: str


class Warned(TypedDict):
    message: str
    where: Optional[List[float]]


class ComplexFigures(TypedDict):
    points: int
    triangles: int
    vertices: int
    curves: int
    straight_curves: int
    patches: int
    planar_patches: int
    bounds: List[List[float]]
    diagonal: float
    smallest_angle: float
    shortest_segment: Optional[float]
    spread: Optional[float]
    planar_tolerance: float
    largest_deviation: float
    regions: List[Region]
    patch_list: List[Patch]
    creases: List[CreaseInfo]
    warnings: List[Warned]


class RepairFigures(TypedDict):
    repaired: bool
    wrapped: bool
    tolerance: float
    largest_distance: float
    largest_distance_of_input: float
    messages: List[str]


class Histogram(TypedDict):
    bin_width: float
    tets: List[int]


class Partitions(TypedDict):
    count: int
    smallest: int
    largest: int
    imbalance: float
    cut_faces: int


class MeshFigures(TypedDict):
    points: int
    tets: int
    faces: int
    edges: int
    prisms: int
    pyramids: int
    quads: int
    min_dihedral: float
    max_dihedral: float
    max_radius_edge: float
    max_thin_radius_edge: float
    max_collar_radius_edge: float
    region_volumes: Dict[str, float]
    region_names: Dict[str, str]
    partitions: Optional[Partitions]
    histograms: Dict[str, Histogram]
    median_edge: float


class MeshInfo(TypedDict):
    mesh: MeshFigures


class Info(TypedDict, total=False):
    """A surface has "complex" and "repair", a mesh has "mesh"."""

    complex: ComplexFigures
    repair: RepairFigures
    mesh: MeshFigures


class Prediction(TypedDict):
    size: float
    tets: float
    seconds: float
