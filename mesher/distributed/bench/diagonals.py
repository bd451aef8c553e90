"""python3 diagonals.py MESH.h5...: dihedral angles after refinement with several rules for the inner diagonal.

No vertex moves onto the shape. The meshes come from collarmesh-mpi with --levels 0. Prints the extreme angles outside
collars and, if there are collars, in them: of the coarse mesh | after one level | after two levels.
"""

import itertools
import sys

import h5py
import numpy

ARRANGEMENTS = [(0, 1, 2, 3), (1, 2, 0, 3), (2, 0, 1, 3)]


def dihedrals(tets):
    """Returns the six dihedral angles of each tet in degrees."""
    found = []
    for i, j in itertools.combinations(range(4), 2):
        k, m = (x for x in range(4) if x not in (i, j))
        edge = tets[:, j] - tets[:, i]
        u, v = (numpy.cross(edge, tets[:, x] - tets[:, i]) for x in (k, m))
        sine = numpy.linalg.norm(numpy.cross(u, v), axis=1)
        found.append(numpy.arctan2(sine, numpy.einsum("ij,ij->i", u, v)))
    return numpy.degrees(numpy.array(found))


def children(p):
    """Returns the eight children of each tet in the order of PETSc, whose inner diagonal joins the middles of the
    edges 01 and 23."""
    x = [p[:, k] for k in range(4)]
    a, b, c, d, e, f = ((x[i] + x[j]) / 2 for i, j in ((0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)))
    tets = [(x[0], a, c, d), (a, x[1], b, e), (c, b, x[2], f), (d, e, f, x[3]),
            (c, d, a, f), (e, b, a, f), (f, a, c, b), (f, a, e, d)]
    return numpy.stack([numpy.stack(tet, 1) for tet in tets], 1)


def goodness(p):
    inner = dihedrals(children(p)[:, 4:].reshape(-1, 4, 3)).reshape(6, len(p), 4)
    return numpy.minimum(inner.min((0, 2)), 180 - inner.max((0, 2)))


def shortness(p):
    return -numpy.linalg.norm(p[:, 0] + p[:, 1] - p[:, 2] - p[:, 3], axis=1)


def arranged(p, rule, level):
    if rule == "fixed" or (rule == "best, then Bey" and level > 0):
        return p
    choices = [p[:, list(arrangement)] for arrangement in ARRANGEMENTS]
    scores = numpy.array([(shortness if rule == "shortest" else goodness)(choice) for choice in choices])
    return numpy.stack(choices, 1)[numpy.arange(len(p)), scores.argmax(0)]


for path in sys.argv[1:]:
    with h5py.File(path) as file:
        coarse = file["xdmf/points"][()][file["xdmf/mesh/topology"][()][:, [0, 2, 1, 3]]]
        in_collar = file["xdmf/mesh/collar"][()].ravel() > 0
    for rule in "fixed", "shortest", "best", "best, then Bey":
        tets, collar, told = coarse, in_collar, []
        for level in range(3):
            angles = dihedrals(tets)
            kinds = [angles[:, kind] for kind in (~collar, collar) if kind.any()]
            told.append(" ".join(f"{kind.min():.2f}-{kind.max():.2f}" for kind in kinds))
            tets = children(arranged(tets, rule, level)).reshape(-1, 4, 3)
            collar = numpy.repeat(collar, 8)
        print(f"{path} ({len(coarse)} tets), {rule}: {' | '.join(told)}", flush=True)
