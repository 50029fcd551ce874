"""Compares what partwright makes of STEP and IGES files with Open CASCADE, both ways.

Usage: python3 tests/tools/cad_against_occ.py [target/debug/partwright]

Needs `pip install "cadquery-ocp<7.9" numpy` (about 300 MB, therefore no part of `.ci/run`). Surfaces of several degrees,
rational and periodic ones, are written by Open CASCADE as STEP and IGES, in mm and inches, as free surfaces and as
faces; the nets that partwright reads are compared at 1000 places with the surface that Open CASCADE reads. Then every
net is exported and read by Open CASCADE: the same points, a valid shape, and triangles within their tolerance.
"""

import collections
import math
import os
import re
import subprocess
import sys
import tempfile

import numpy as np
from OCP.BRep import BRep_Tool
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.Geom import Geom_BSplineSurface
from OCP.GeomAPI import GeomAPI_ProjectPointOnSurf
from OCP.gp import gp_Pnt
from OCP.IGESControl import IGESControl_Controller, IGESControl_Reader, IGESControl_Writer
from OCP.Interface import Interface_Static
from OCP.STEPControl import STEPControl_AsIs, STEPControl_Reader, STEPControl_Writer
from OCP.TColgp import TColgp_Array2OfPnt
from OCP.TColStd import TColStd_Array1OfInteger, TColStd_Array1OfReal, TColStd_Array2OfReal
from OCP.TopAbs import TopAbs_FACE
from OCP.TopExp import TopExp_Explorer
from OCP.TopoDS import TopoDS

PLACES = 1000
CLOSE = 1e-9
CHORD = 0.01


def line(kind, values):
    array = kind(1, len(values))
    for i, x in enumerate(values):
        array.SetValue(i + 1, x)
    return array


def surface(degree, u, v, point, weight=None, periodic=(False, False)):
    """u and v: (knot, multiplicity) pairs."""
    count = lambda k, p, closed: sum(m for _, m in k) - (k[0][1] if closed else p + 1)
    rows, columns = count(u, degree[0], periodic[0]), count(v, degree[1], periodic[1])
    poles, weights = TColgp_Array2OfPnt(1, rows, 1, columns), TColStd_Array2OfReal(1, rows, 1, columns)
    for i in range(rows):
        for j in range(columns):
            poles.SetValue(i + 1, j + 1, gp_Pnt(*point(i, j)))
            weights.SetValue(i + 1, j + 1, weight(i, j) if weight else 1.0)
    knots = [line(TColStd_Array1OfReal, [float(t) for t, _ in k]) for k in (u, v)]
    often = [line(TColStd_Array1OfInteger, [m for _, m in k]) for k in (u, v)]
    return Geom_BSplineSurface(poles, weights, *knots, *often, *degree, *periodic)


def wavy(i, j):
    return (10.0 * i + 0.3 * j, 8.0 * j - 0.2 * i, 3 * math.sin(1.3 * i + 0.7 * j) + 0.5 * i - 0.1 * j * j)


def ring(i, j):
    radius, angle = 30 + 2 * j, i * math.pi / 4
    return (radius * math.cos(angle), radius * math.sin(angle), 4.0 * j + math.sin(i))


SURFACES = {
    "bicubic": surface((3, 3), [(0, 4), (0.4, 1), (1.1, 1), (2, 1), (3, 4)], [(0, 4), (1, 2), (2.5, 4)], wavy),
    "low": surface((2, 1), [(0, 3), (1, 1), (3, 3)], [(0, 2), (1, 1), (4, 2)], wavy),
    "high": surface((5, 4), [(0, 6), (1, 2), (1.5, 6)], [(0, 5), (0.3, 1), (0.7, 1), (1, 5)], wavy),
    "single": surface((7, 7), [(0, 8), (1, 8)], [(0, 8), (1, 8)], wavy),
    "rational": surface(
        (3, 2), [(0, 4), (1, 1), (2, 1), (3, 4)], [(0, 3), (1, 1), (2, 1), (3, 3)], wavy,
        lambda i, j: 1 + 0.5 * ((3 * i + j) % 4),
    ),
    "periodic": surface((3, 3), [(k, 1) for k in range(9)], [(0, 4), (1, 1), (2, 4)], ring, None, (True, False)),
}


def write_all(name, shape):
    for unit in ("MM", "INCH"):
        Interface_Static.SetCVal_s("write.step.unit", unit)
        writer = STEPControl_Writer()
        writer.Transfer(shape, STEPControl_AsIs)
        writer.Write(f"{name}_{unit}.stp")
        yield "STEP", f"{name}_{unit}.stp"
        IGESControl_Controller.Init_s()
        for mode in (0, 1):
            writer = IGESControl_Writer(unit, mode)
            writer.AddShape(shape)
            writer.ComputeModel()
            writer.Write(f"{name}_{unit}_{mode}.igs")
            yield "IGES", f"{name}_{unit}_{mode}.igs"


def read(kind, file):
    reader = STEPControl_Reader() if kind == "STEP" else IGESControl_Reader()
    reader.ReadFile(file)
    reader.TransferRoots()
    shape = reader.OneShape()
    faces = TopExp_Explorer(shape, TopAbs_FACE)
    return shape, BRep_Tool.Surface_s(TopoDS.Face_s(faces.Current()))


def knots(s):
    u0, u1, v0, v1 = s.Bounds()
    inside = lambda all, a, b: np.array(sorted({round(t, 12) for t in all if a - 1e-9 <= t <= b + 1e-9}))
    return (
        inside([s.UKnot(i + 1) for i in range(s.NbUKnots())], u0, u1),
        inside([s.VKnot(i + 1) for i in range(s.NbVKnots())], v0, v1),
    )


def places(u, v):
    """Random spans with places in them."""
    random = np.random.default_rng(1)
    for _ in range(PLACES):
        i, j = random.integers(len(u) - 1), random.integers(len(v) - 1)
        yield i, j, *random.random(2)


def bernstein(n, t):
    return np.array([math.comb(n, k) * t**k * (1 - t) ** (n - k) for k in range(n + 1)])


def net(program):
    text = subprocess.run([PARTWRIGHT, "build", program, "--emit", "ir"], capture_output=True, text=True, check=True).stdout
    found = re.search(r"^net #0 \S+ (\d+) x (\d+) patches; (.*)$", text, re.M)
    patches = []
    for part in found[3].split("  @ ")[0].split("; "):
        head = re.match(r"degree (\d+) (\d+)", part)
        p, q = int(head[1]), int(head[2])
        poles = re.findall(r"\(([^)]*)\)(?:\*(\S+))?", part)
        points = np.array([[float(x) for x in a.split(",")] for a, _ in poles]).reshape(p + 1, q + 1, 3)
        weights = np.array([float(w or 1) for _, w in poles]).reshape(p + 1, q + 1)
        patches.append((p, q, points, weights))
    return (int(found[1]), int(found[2])), patches


def compare_net(s, size, patches):
    u, v = knots(s)
    assert size == (len(u) - 1, len(v) - 1), (size, len(u), len(v))
    worst = 0.0
    for i, j, x, y in places(u, v):
        p, q, points, weights = patches[i * size[1] + j]
        basis = np.outer(bernstein(p, x), bernstein(q, y)) * weights
        ours = np.tensordot(basis, points, axes=([0, 1], [0, 1])) / basis.sum()
        theirs = s.Value(u[i] + (u[i + 1] - u[i]) * x, v[j] + (v[j + 1] - v[j]) * y)
        worst = max(worst, np.linalg.norm(ours - [theirs.X(), theirs.Y(), theirs.Z()]))
    return worst


def compare_surfaces(a, b):
    (u, v), (s, t) = knots(a), knots(b)
    at = lambda k, i, x: k[i] + (k[i + 1] - k[i]) * x
    return max(a.Value(at(u, i, x), at(v, j, y)).Distance(b.Value(at(s, i, x), at(t, j, y))) for i, j, x, y in places(u, v))


def triangles(file, s):
    """Number, edges that more than one triangle uses in the same sense, largest distance."""
    data = open(file, "rb").read()
    number = int.from_bytes(data[80:84], "little")
    rows = np.frombuffer(data[84:], dtype=[("n", "<f4", 3), ("v", "<f4", (3, 3)), ("a", "<u2")], count=number)["v"]
    edges = collections.Counter()
    for corners in rows:
        keys = [c.tobytes() for c in corners]
        edges.update((keys[k], keys[(k + 1) % 3]) for k in range(3))
    random, worst = np.random.default_rng(0), 0.0
    for k in random.integers(number, size=300):
        p = GeomAPI_ProjectPointOnSurf(gp_Pnt(*map(float, random.dirichlet([1, 1, 1]) @ rows[k])), s)
        worst = max(worst, p.LowerDistance() if p.NbPoints() else 0.0)
    return number, sum(n > 1 for n in edges.values()), worst


def main():
    failed = 0
    for name, s in SURFACES.items():
        shape = BRepBuilderAPI_MakeFace(s, 1e-7).Face()
        for kind, file in write_all(name, shape):
            with open("a.apt", "w") as program:
                program.write(f"UNITS/ MM\nN1 = NET/ {kind}, '{file}'\nFINI\n")
            worst = compare_net(read(kind, file)[1], *net("a.apt"))
            failed += worst > CLOSE
            print(f"{file:24} {worst:.1e} mm apart")
        with open("a.apt", "w") as program:
            program.write(f"UNITS/ MM\nN1 = NET/ STEP, '{name}_MM.stp'\nFINI\n")
        for extension in ("stp", "stl"):
            subprocess.run([PARTWRIGHT, "export", "a.apt", "-o", f"out.{extension}"], check=True, capture_output=True)
        theirs, (back, ours) = read("STEP", f"{name}_MM.stp")[1], read("STEP", "out.stp")
        worst, valid = compare_surfaces(theirs, ours), BRepCheck_Analyzer(back).IsValid()
        number, doubled, chord = triangles("out.stl", ours)
        failed += worst > CLOSE or not valid or doubled > 0 or chord > CHORD + 1e-5
        print(f"{name + ', exported':24} {worst:.1e} mm apart, valid: {valid}; {number} triangles within {chord:.5f} mm")
    print("FAILED" if failed else "all within", CLOSE, "mm")
    return failed > 0


PARTWRIGHT = os.path.abspath(sys.argv[1] if len(sys.argv) > 1 else "target/debug/partwright")
with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    sys.exit(main())
