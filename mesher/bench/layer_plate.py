#!/usr/bin/python3
"""Computes the flow along a flat plate in OpenFOAM, on meshes with and without layers of cells, and compares its
velocity profile with Blasius' solution.

    layer_plate.py PROGRAM MODELS [--viscosity 0.001]

Air enters a box of 3 x 2 x 1 with speed 1; the floor is the plate, the end is open, ceiling and sides slip. Where x
is from 1.5 to 2.5, speeds are divided by the speed outside of the boundary layer at the same x, and the quotients are
compared with Blasius' solution. The division is necessary because Blasius' solution assumes a constant speed outside,
but the layer displaces air, so the flow outside gets some percent faster along the plate."""

import argparse
import json
import os
import pathlib
import re
import subprocess
import tempfile

import numpy as np

from tables import table

names = {"patches": {"walls": 2, "sides": [1, 3, 5], "inlet": 6, "outlet": 4}}
files = {
    "system/controlDict": "endTime 400; deltaT 1; writeControl timeStep; writeInterval 400;",
    "system/fvSchemes": "ddtSchemes { default steadyState; } gradSchemes { default leastSquares; limited cellLimited "
                        "leastSquares 1; } divSchemes { default none; div(phi,U) bounded Gauss linearUpwindV limited; "
                        "div((nuEff*dev2(T(grad(U))))) Gauss linear; } "
                        "laplacianSchemes { default Gauss linear corrected; } interpolationSchemes { default linear; } "
                        "snGradSchemes { default corrected; }",
    "system/fvSolution": "SIMPLE { consistent yes; nNonOrthogonalCorrectors 1; residualControl { p 1e-4; U 1e-4; } } "
                         "solvers { p { solver PCG; preconditioner DIC; tolerance 1e-10; relTol 0.01; } "
                         "U { solver PBiCGStab; preconditioner DILU; tolerance 1e-10; relTol 0.01; } } "
                         "relaxationFactors { fields { p 0.5; } equations { U 0.6; } }",
    "constant/turbulenceProperties": "simulationType laminar;",
    "0/p": "dimensions [0 2 -2 0 0 0 0]; internalField uniform 0; boundaryField { "
           'outlet { type fixedValue; value uniform 0; } ".*" { type zeroGradient; } }',
    "0/U": "dimensions [0 1 -1 0 0 0 0]; internalField uniform (1 0 0); boundaryField { walls { type noSlip; } "
           "sides { type slip; } inlet { type fixedValue; value uniform (1 0 0); } "
           "outlet { type zeroGradient; } }",
}
kinds = {"0/p": "volScalarField", "0/U": "volVectorField"}


def blasius():
    """Returns values of the similarity variable at equal steps, and f' there, by f''' = -f f'' / 2."""
    step, state = 0.005, np.array([0.0, 0.0, 0.332057336])
    slope = lambda s: np.array([s[1], s[2], -0.5 * s[0] * s[2]])  # noqa: E731
    at, found = [0.0], [0.0]
    while at[-1] < 12:
        a = slope(state)
        b = slope(state + 0.5 * step * a)
        c = slope(state + 0.5 * step * b)
        d = slope(state + step * c)
        state = state + step / 6 * (a + 2 * b + 2 * c + d)
        at.append(at[-1] + step)
        found.append(state[1])
    return np.array(at), np.array(found)


def field(path, what="internalField"):
    values = path.read_text().split(what)[1].split("boundaryField")[0]
    return np.array(values[values.index("\n(") + 2:values.rindex(")")].replace("(", " ").replace(")", " ").split(),
                    float)


def flow(case, viscosity):
    """Runs the case. Returns the folder of the result, or None if it did not converge."""
    environment = {**os.environ, "WM_PROJECT_DIR": "/usr/share/openfoam", "FOAM_ETC": "/usr/share/openfoam/etc"}
    told = {**files, "constant/transportProperties": f"transportModel Newtonian; nu [0 2 -1 0 0 0 0] {viscosity};"}
    for name, text in told.items():
        (case / name).parent.mkdir(exist_ok=True)
        (case / name).write_text(f"FoamFile {{ version 2.0; format ascii; class {kinds.get(name, 'dictionary')}; "
                                 f"object {pathlib.Path(name).name}; }}\n{text}\n")
    said = subprocess.run(["simpleFoam"], cwd=case, env=environment, capture_output=True, text=True).stdout
    if "solution converged" not in said:
        return None
    subprocess.run(["postProcess", "-func", "writeCellCentres", "-latestTime"], cwd=case, env=environment, check=True,
                   stdout=subprocess.DEVNULL)
    return max((f for f in case.iterdir() if re.fullmatch(r"\d+", f.name)), key=lambda f: int(f.name))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("models", type=pathlib.Path)
    parser.add_argument("--viscosity", type=float, default=0.001)
    arguments = parser.parse_args()
    eta, slope = blasius()
    rows = []
    for title, size, options in (("one size", 0.25, ()), ("one size", 0.15, ()), ("layers", 0.25, ("count=10",)),
                                 ("layers", 0.15, ("count=10",))):
        with tempfile.TemporaryDirectory() as folder:
            case = pathlib.Path(folder)
            (case / "constant" / "polyMesh").mkdir(parents=True)
            (case / "names.json").write_text(json.dumps(names))
            layers = ("--layers", "walls:first=0.012,growth=1.15,count=10") if options else ()
            subprocess.run([arguments.program, str(arguments.models / "box.off"), "-o",
                            str(case / "constant/polyMesh/boundary"), "--format", "polymesh", "--size", str(size),
                            "--names", str(case / "names.json"), "-q", *layers],
                           check=True)
            result = flow(case, arguments.viscosity)
            if result is None:
                rows.append([title, str(size), "", "not converged", "", ""])
                continue
            x, _, z = field(result / "C").reshape(-1, 3).T
            u = field(result / "U").reshape(-1, 3)[:, 0]
            chosen = (x > 1.5) & (x < 2.5)
            at = z[chosen] / np.sqrt(arguments.viscosity * x[chosen])
            outside = np.polyfit(x[(x > 1) & (z > 0.5)], u[(x > 1) & (z > 0.5)], 2)
            error = u[chosen] / np.polyval(outside, x[chosen]) - np.interp(at, eta, slope)
            inside = at < 5
            rows.append([title, str(size), str(len(x)), str(int(inside.sum())),
                         f"{100 * np.sqrt((error[inside]**2).mean()):.1f}", f"{100 * np.abs(error[inside]).max():.1f}"])
    print(table(["mesh", "size", "cells", "of them inside 5 sqrt(nu x / U)", "error there, % of the speed", "largest"],
                rows))


if __name__ == "__main__":
    main()
