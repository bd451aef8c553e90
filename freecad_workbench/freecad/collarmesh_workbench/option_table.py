"""The program's options that are settings of the add-on. Written by make_option_table.py: see there."""

import dataclasses

from .translations import doc


@dataclasses.dataclass(frozen=True)
class Option:
    """An option of the program."""

    type: type
    default: object  # a number 0 leaves the value to the program
    unit: str  # "length", "degrees", "diagonal", "seconds" or none
    counts: bool  # whether predictions pass it to `collarmesh info`; `size` is passed apart
    text: str  # what it does; empty if the add-on has its own text


OPTIONS = {
    "size": Option(
        float, 0.0, "length", False,
        doc("Target edge length everywhere; 0: 1/20 of the diagonal")),
    "size_min": Option(
        float, 0.0, "length", True,
        doc("Smallest target edge length; smaller local sizes are raised to it; 0: none")),
    "elements_per_circle": Option(
        int, 0, "", True,
        doc("Refine where smooth surfaces and edges curve: N elements per full circle; 0: none")),
    "elements_across_gap": Option(
        int, 0, "", True,
        doc("Refine where surfaces face each other across a thin part: N elements between them; 0: none")),
    "gradation": Option(
        float, 0.0, "", True,
        doc("Growth of size per unit length away from finer features; 0: unlimited")),
    "radius_edge": Option(
        float, 2.0, "", False,
        doc("Bound on circumradius / shortest edge of a tetrahedron that is not thin")),
    "crease_angle": Option(
        float, 60.0, "degrees", True,
        doc("Features that meet below this angle form a crease and get a collar")),
    "collar_angle": Option(
        float, 150.0, "degrees", False,
        doc("Bound on dihedral angles in collars, the tetrahedra that touch a crease")),
    "distance": Option(
        float, 0.0, "length", True,
        doc("Largest distance from smooth surfaces and curves; 0: 1/10 of the size, less where the part is thin")),
    "planar_tolerance": Option(
        float, 0.0, "diagonal", True,
        doc("Neighbouring facets within this distance of one plane form one patch, relative to the diagonal; 0: "
            "1e-06")),
    "weld": Option(
        float, 0.0, "diagonal", True,
        doc("Points closer than this are merged, relative to the diagonal; 0: 1e-09")),
    "repair_tolerance": Option(
        float, 0.0, "diagonal", True,
        doc("Repair treats features smaller than this as noise, relative to the diagonal; 0: 1e-05")),
    "min_dihedral": Option(
        float, 0.0, "degrees", False,
        doc("Improve tetrahedra with smaller dihedral angles; 0: 15, 20, 30 by level")),
    "seed": Option(
        int, 0, "", False,
        doc("Seed of the pseudo-random offsets")),
    "time_limit": Option(
        float, 0.0, "seconds", False,
        doc("Maximum wall time in seconds, from reading to writing; 0: none")),
    "improve": Option(
        int, 2, "", False,
        doc("Removal of slivers: 0 none; 1 quick: angles below 15 degrees, vertices stay; 2 good: below 20; 3 "
            "best: below 30")),
    "coarsen": Option(
        bool, True, "", False,
        doc("on: as few tetrahedra as the sizes ask for, thin ones in thin places; off: the bound on circumradius"
            " / shortest edge holds everywhere outside collars")),
    "order": Option(int, 1, "", True, ""),
    "dimension": Option(int, 3, "", False, ""),
    "repair": Option(str, 'auto', "", True, ""),
    "keep_apart": Option(bool, False, "", False, ""),
    "split": Option(list, [], "", False, ""),
    "periodic": Option(list, [], "", False, ""),
    "interior_node": Option(
        bool, False, "", False,
        doc("Insert nodes so that no tetrahedron has all corners on boundaries, interfaces or internal patches")),
    "layers": Option(list, [], "", False, ""),
    "layers_tets": Option(
        bool, False, "", False,
        doc("Divide the prisms and pyramids of layers into tetrahedra")),
}
