"""Representative cells with periodic inclusions: Voronoi grains as .poly, spheres as .brep.

As a program, this file meshes cells of both kinds with and without periodic faces. For each cell it prints the ratios
of tets and of time (with / without), the angles, and the findings. It checks by coordinates alone that points, edges,
triangles and tags of opposite faces are images of each other. It prints the homogenized conductivity of each cell
beside bounds, and checks for grains that the conductivity lies within the bounds.
"""
import argparse
import itertools
import json
import pathlib
import resource
import subprocess
import sys
import tempfile

import numpy as np

DIGITS = 12  # vertices are rounded to this many decimals, so that opposite faces are exact images of each other
ROUNDING = 1e-14  # tolerance of coordinates on faces of the unit cube


def grain_polygons(seeds):
    """Returns the polygons of the periodic Voronoi cells of seeds, cut off at the faces of the unit cube.

    The first result is a dict. Its keys are the sorted vertex numbers of a polygon; its values are pairs of the vertex
    numbers in order and the grains on the two sides (negative: outside). The second result is the vertices, an array of
    shape (n, 3).
    """
    shifts = np.array(list(itertools.product((-1, 0, 1), repeat=3)), float)
    points = np.concatenate([seeds + shift for shift in shifts])
    grain = np.tile(np.arange(len(seeds)), len(shifts))
    vertices, number, polygons = [], {}, {}

    def vertex(p):
        key = tuple(np.round(p, DIGITS) + 0.0)
        if key not in number:
            number[key] = len(vertices)
            vertices.append(key)
        return number[key]

    for i, point in enumerate(points):
        if np.any(point < -0.7) or np.any(point > 1.7):
            continue
        # Half spaces n . x <= d: those of the bisectors to the nearest points, and the cube's. The bisector of two
        # points has, up to the sign, the same rounded n and d from either point.
        near = np.argsort(np.linalg.norm(points - point, axis=1), kind="stable")[1:80]
        planes = [(points[j] - point, 0.5 * (points[j] @ points[j] - point @ point), j) for j in near]
        for axis in range(3):
            n = np.eye(3)[axis]
            planes += [(-n, 0.0, -1 - 2 * axis), (n, 1.0, -2 - 2 * axis)]
        for n, d, other in planes:
            polygon = polygon_of(n, d, [(m, e) for m, e, k in planes if k != other])
            if polygon is None:
                continue
            corners = [vertex(p) for p in polygon]
            corners = [c for k, c in enumerate(corners) if c != corners[k - 1]]
            if len(corners) < 3:
                continue
            sides = (grain[i], other if other < 0 else grain[other])
            polygons.setdefault(tuple(sorted(corners)), (corners, sides))
    return polygons, np.array(vertices)


def polygon_of(n, d, others):
    """Returns the polygon in which the plane n . x = d meets all half spaces m . x <= e of `others`; None if it is
    empty or tiny."""
    length = np.linalg.norm(n)
    n, d = n / length, d / length
    u = np.cross(n, np.eye(3)[np.argmin(np.abs(n))])
    u /= np.linalg.norm(u)
    v = np.cross(n, u)
    polygon = [d * n + 4 * (a * u + b * v) for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    for m, e in others:
        heights = [m @ p - e for p in polygon]
        cut = []
        for k, p in enumerate(polygon):
            q, hp, hq = polygon[k - 1], heights[k], heights[k - 1]
            if (hp > 1e-12) != (hq > 1e-12):
                cut.append(q + (p - q) * (hq / (hq - hp)))
            if hp <= 1e-12:
                cut.append(p)
        polygon = cut
        if len(polygon) < 3:
            return None
    area = np.linalg.norm(sum(np.cross(p, q) for p, q in zip(polygon, polygon[1:] + polygon[:1]))) / 2
    return polygon if area > 1e-10 else None


def write_grains(path, grains, seed):
    """Writes a unit cube of `grains` grains, periodic in all directions, as a complex. All regions of a grain have
    the same tag."""
    rng = np.random.default_rng(seed)
    seeds = rng.random((grains, 3))
    polygons, vertices = grain_polygons(seeds)
    lines = [f"{len(vertices)} 3 0 0"] + [f"{k} {x!r} {y!r} {z!r}" for k, (x, y, z) in enumerate(vertices.tolist())]
    lines.append(f"{len(polygons)} 1")
    for number, (corners, sides) in enumerate(polygons.values(), 1):
        lines += [f"1 0 {number}", f"{len(corners)} " + " ".join(map(str, corners))]
    lines.append("0")
    shifts = np.array(list(itertools.product((-1, 0, 1), repeat=3)), float)
    regions = []
    for k, point in enumerate(seeds):
        # A grain that crosses faces of the cube has several regions: one for each periodic image in the cube.
        for shift in shifts:
            inside = region_point(point + shift, np.concatenate([seeds + s for s in shifts]))
            if inside is not None:
                regions.append((*inside, k + 1))
    lines.append(str(len(regions)))
    lines += [f"{k} {x!r} {y!r} {z!r} {tag}" for k, (x, y, z, tag) in enumerate(regions)]
    pathlib.Path(path).write_text("\n".join(lines) + "\n")


def region_point(point, points):
    """Returns a point in the cube that is nearer to `point` than to all others of `points`. Picks the random sample
    that is farthest from the borders of the cube and of the grain. Returns None if no sample is in both."""
    rng = np.random.default_rng(1)
    samples = np.concatenate([[point], np.clip(point, 0.01, 0.99) + 0.15 * rng.standard_normal((400, 3))])
    best, most = None, 0.0
    for p in samples:
        if np.any(p < 0.002) or np.any(p > 0.998):
            continue
        distances = np.linalg.norm(points - p, axis=1)
        own = np.linalg.norm(point - p)
        others = distances[distances > own + 1e-12]
        room = min((others.min() - own) / 2 if distances.min() >= own - 1e-12 else -1, p.min(), (1 - p).min())
        if room > most:
            best, most = p.tolist(), room
    return best


def write_spheres(path, spheres, radius, seed):
    """Writes a periodic unit cube with `spheres` spheres of equal radius, which do not touch, as a CAD shape."""
    import gmsh

    rng = np.random.default_rng(seed)
    shifts = np.array(list(itertools.product((-1, 0, 1), repeat=3)), float)
    centres = []
    while len(centres) < spheres:
        p = rng.random(3)
        # Reject spheres that nearly touch a face, an edge or a corner of the cube: they would leave slivers of
        # material there.
        walls = np.minimum(p, 1 - p)
        edges = [np.hypot(walls[a], walls[b]) for a, b in ((0, 1), (1, 2), (2, 0))]
        if any(abs(d - radius) < 0.15 * radius for d in (*walls, *edges, np.linalg.norm(walls))):
            continue
        if all(np.linalg.norm(q + s - p) > 2.2 * radius for q in centres for s in shifts):
            centres.append(p)
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    occ = gmsh.model.occ
    box = occ.addBox(0, 0, 0, 1, 1, 1)
    balls = []
    for p in centres:
        for shift in shifts:
            q = p + shift
            if np.linalg.norm(q - np.clip(q, 0, 1)) < radius:
                balls.append((3, occ.addSphere(*q, radius)))
    inside, _ = occ.intersect(balls, [(3, box)], removeObject=True, removeTool=False)
    occ.fragment([(3, box)], inside)
    occ.synchronize()
    gmsh.write(str(path))
    gmsh.finalize()


class Mesh:
    """Points of a .msh file, and the nodes and tags of its tetrahedra, triangles and lines of first or second order."""

    def __init__(self, path):
        import meshio

        read = meshio.read(path)
        self.points = read.points
        self.cells = {}
        for block, tags in zip(read.cells, read.cell_data["gmsh:physical"]):
            nodes, numbers = self.cells.setdefault(block.type.rstrip("0123456789"), ([], []))
            nodes.append(block.data)
            numbers.append(tags)
        self.cells = {kind: (np.concatenate(nodes), np.concatenate(tags)) for kind, (nodes, tags) in self.cells.items()}

    def images(self, axis):
        """Returns a dict from the nodes at the low end of an axis to their images at the high end. Fails if an image
        is missing."""
        at = [np.flatnonzero(np.abs(self.points[:, axis] - end) < ROUNDING) for end in (0.0, 1.0)]
        others = [k for k in range(3) if k != axis]
        keys = [{tuple(np.round(self.points[v, others], 11) + 0.0): v for v in nodes} for nodes in at]
        assert len(keys[0]) == len(at[0]) and len(keys[1]) == len(at[1]), "two nodes at one place"
        assert set(keys[0]) == set(keys[1]), f"axis {axis}: {len(set(keys[0]) ^ set(keys[1]))} nodes have no image"
        return {keys[0][key]: keys[1][key] for key in keys[0]}


def verify(mesh):
    """Checks, by coordinates alone, that opposite faces of the unit cube have the same points, edges and
    triangles, and that their tags correspond one to one."""
    for axis in range(3):
        image = mesh.images(axis)
        for kind in ("triangle", "line"):
            if kind not in mesh.cells:
                continue
            nodes, tags = mesh.cells[kind]
            low, high = (np.all(np.abs(mesh.points[nodes][:, :, axis] - end) < ROUNDING, axis=1) for end in (0.0, 1.0))
            moved = {frozenset(image[v] for v in cell): tag for cell, tag in zip(nodes[low], tags[low])}
            there = {frozenset(cell.tolist()): tag for cell, tag in zip(nodes[high], tags[high])}
            assert set(moved) == set(there), f"axis {axis}: {len(set(moved) ^ set(there))} {kind}s have no image"
            tag_of = {}
            for cell, tag in moved.items():
                assert tag_of.setdefault(tag, there[cell]) == there[cell], f"axis {axis}: tag {tag} has several images"
            assert len(set(tag_of.values())) == len(tag_of), f"axis {axis}: tags have one image"


def conductivity(mesh, of_tag):
    """Returns the homogenized conductivity of a cell (3 x 3) by elements of first order, its lower bound (Reuss), its
    upper bound (Voigt), and the volumes and conductivities of the tets. `of_tag` maps a region's tag to its
    conductivity."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components
    from scipy.sparse.linalg import spsolve

    pairs = np.array([pair for axis in range(3) for pair in mesh.images(axis).items()])
    tets, tags = mesh.cells["tetra"]
    tets = tets[:, :4]
    used = np.unique(tets)
    number = np.full(len(mesh.points), -1)
    number[used] = np.arange(len(used))
    pairs = number[pairs[np.all(number[pairs] >= 0, axis=1)]]
    links = coo_matrix((np.ones(len(pairs)), pairs.T), shape=(len(used),) * 2)
    unknowns, unknown_of = connected_components(links, directed=False)
    corners = mesh.points[tets]
    edges = corners[:, 1:] - corners[:, :1]
    volumes = np.abs(np.linalg.det(edges)) / 6
    gradients = np.linalg.inv(edges).transpose(0, 2, 1)
    gradients = np.concatenate([-gradients.sum(axis=1, keepdims=True), gradients], axis=1)
    conducts = np.array([of_tag(tag) for tag in tags])
    weights = volumes * conducts
    cells = unknown_of[number[tets]]
    local = weights[:, None, None] * (gradients @ gradients.transpose(0, 2, 1))
    rows, columns = np.repeat(cells, 4, axis=1).ravel(), np.tile(cells, 4).ravel()
    matrix = coo_matrix((local.ravel(), (rows, columns)), shape=(unknowns, unknowns)).tocsc()
    load = np.zeros((unknowns, 3))
    np.add.at(load, cells.ravel(), (weights[:, None, None] * gradients).reshape(-1, 3))
    repeating = np.zeros((unknowns, 3))
    repeating[1:] = spsolve(matrix[1:, 1:], -load[1:])
    made = (weights.sum() * np.eye(3) + load.T @ repeating) / volumes.sum()
    voigt, reuss = weights.sum() / volumes.sum(), volumes.sum() / (volumes / conducts).sum()
    return made, reuss, voigt, volumes, conducts


def hashin_shtrikman(share, inclusion, matrix):
    """Returns the lower and the upper Hashin-Shtrikman bound on the conductivity of a matrix with inclusions.
    `inclusion`, `matrix`: the conductivities (different ones); `share`: the inclusions' share of the volume."""
    low, high = sorted((inclusion, matrix))
    share_of_high = share if high == inclusion else 1 - share
    return (low + share_of_high / (1 / (high - low) + (1 - share_of_high) / (3 * low)),
            high + (1 - share_of_high) / (1 / (low - high) + share_of_high / (3 * high)))


def homogenize(kind, mesh):
    """Returns the homogenized conductivity, its lower and upper bound, and its eigenvalues. The conductivity is 10 in
    spheres and 1 around them; each grain has a conductivity from 1 to 10."""
    if kind == "grains":
        made, low, high, _, _ = conductivity(mesh, lambda tag: 1 + 9 * (tag * 7 % 12) / 11)
    else:
        matrix = mesh.cells["tetra"][1].max()
        made, _, _, volumes, conducts = conductivity(mesh, lambda tag: 1 if tag == matrix else 10)
        low, high = hashin_shtrikman(volumes[conducts > 1].sum() / volumes.sum(), 10, 1)
    eigenvalues = np.linalg.eigvalsh(made)
    return made, low, high, eigenvalues


def run(program, path, *options):
    """Returns the report of a run (empty if there is none), its CPU seconds, the ended process with its exit code and
    messages, and the mesh (None if there is none)."""
    with tempfile.TemporaryDirectory() as folder:
        report = pathlib.Path(folder) / "report.json"
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        done = subprocess.run([program, path, "-o", f"{folder}/mesh.msh", "--report", report, "-q", *options],
                              check=False, capture_output=True, text=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        data = json.loads(report.read_text()) if report.exists() else {}
        mesh = Mesh(f"{folder}/mesh.msh") if pathlib.Path(f"{folder}/mesh.msh").exists() else None
    return data, seconds, done, mesh


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program")
    parser.add_argument("--cells", type=int, default=10, help="of each kind")
    parser.add_argument("--kinds", nargs="+", default=["grains", "spheres"])
    parser.add_argument("--size", default="0.1")
    parser.add_argument("--order", default="1")
    options = parser.parse_args()
    common = ["--size", options.size, "--order", options.order, "--threads", "1"]
    print("| cell | tets | periodic / without | angles without | periodic | findings | CPU periodic / without | exit | "
          "conductivity | bounds |")
    print("|---|---|---|---|---|---|---|---|---|---|")
    diagonals = {"grains": [], "spheres": []}
    with tempfile.TemporaryDirectory() as folder:
        for kind, seed in itertools.product(options.kinds, range(options.cells)):
            path = f"{folder}/{kind}_{seed}." + ("poly" if kind == "grains" else "brep")
            if kind == "grains":
                write_grains(path, 12, seed)
            else:
                write_spheres(path, 6, 0.2, seed)
            plain, seconds, _, _ = run(options.program, path, *common)
            made, more, done, mesh = run(options.program, path, *common, *(x for a in "xyz" for x in ("--periodic", a)))
            if not plain or mesh is None:
                print(f"| {kind} {seed} | | | | | | | {done.returncode} {done.stderr.strip()[-300:]} | | |", flush=True)
                continue
            verify(mesh)
            tensor, low, high, eigenvalues = homogenize(kind, mesh)
            assert kind == "spheres" or low < eigenvalues[0] <= eigenvalues[-1] < high
            diagonals[kind].append(np.diag(tensor))
            angles = ["{min_dihedral:.1f} to {max_dihedral:.1f}".format(**data["check"]) for data in (plain, made)]
            tets = [data["check"]["tets"] for data in (plain, made)]
            print(f"| {kind} {seed} | {tets[1]} | {tets[1] / tets[0]:.2f} | {angles[0]} | {angles[1]} | "
                  f"{made['check']['findings_total']} | {more / seconds:.2f} | {done.returncode} | "
                  f"{eigenvalues[0]:.3f} to {eigenvalues[-1]:.3f} | {low:.3f} to {high:.3f} |", flush=True)
    for kind, values in diagonals.items():
        if len(values) > 1:
            mean, error = np.mean(values, axis=0), np.std(values, axis=0, ddof=1) / np.sqrt(len(values))
            print(f"\n{kind}: mean conductivity along the axes {mean.round(3)}, standard errors {error.round(3)}")


if __name__ == "__main__":
    sys.exit(main())
