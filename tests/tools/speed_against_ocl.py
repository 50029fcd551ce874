#!/usr/bin/env python3
"""Times one finishing job side by side: this compiler from source to proven program, and OpenCAMLib's drop cutter.

    pip install opencamlib
    tests/tools/speed_against_ocl.py [target/release/partwright] [--lines N] [--error MM]

The job: 201 zigzag lines over one bicubic patch of 100 mm by 100 mm, ball of radius 5 mm, OUTTOL 0.01. OpenCAMLib sees
triangles that leave the patch by --error at most (0.001 mm), and drops the ball at 65 points a line, on both
threads; it is slow there, so that it does N of the 201 lines (10), spread evenly, and its time is multiplied. Its
triangles are made before the clock starts, and it neither fits, writes nor checks anything. Times are worth nothing by
themselves; the ratio is printed.
"""
import argparse
import os
import subprocess
import tempfile
import time

import opencamlib as ocl

SIZE, RADIUS, LINES, POINTS = 100.0, 5.0, 201, 65
Z = [[0, 10, 5, 0], [8, 25, 20, 6], [4, 18, 25, 12], [0, 6, 10, 3]]


def bernstein(t):
    s = 1 - t
    return s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t


def height(u, v):
    bu, bv = bernstein(u), bernstein(v)
    return sum(bu[i] * bv[j] * Z[i][j] for i in range(4) for j in range(4))


def program():
    poles = ", ".join(
        f"$\n({SIZE * i / 3!r}, {SIZE * j / 3!r}, {Z[i][j]})" for i in range(4) for j in range(4)
    )
    step = SIZE / (LINES - 1)
    return (
        f"UNITS/ MM\nMACHIN/ LINUXCNC\nN1 = NET/ 4, 4, {poles}\nT1 = CUTTER/ BALL, {2 * RADIUS}, NUMBER, 1\n"
        f"LOADTL/ T1\nSPINDL/ 8000, CLW\nFEDRAT/ 900, MMPM\nINTOL/ 0\nOUTTOL/ 0.01\nCLEARP/ 40\n"
        f"SURFAC/ N1, ZIGZAG, U, STEP, {step}\nFINI\n"
    )


def off(parts):
    """How far the triangles of a grid leave the patch, mm, at the middles of their longest edges."""
    worst = 0.0
    probe = max(1, parts // 40)
    for i in range(0, parts, probe):
        for j in range(0, parts, probe):
            a, b = height(i / parts, j / parts), height((i + 1) / parts, (j + 1) / parts)
            middle = height((i + 0.5) / parts, (j + 0.5) / parts)
            worst = max(worst, abs(middle - 0.5 * (a + b)))
    return worst


def triangles(error):
    parts = 16
    while off(parts) > error:
        parts = parts * 9 // 8
    z = [[height(i / parts, j / parts) for j in range(parts + 1)] for i in range(parts + 1)]
    point = lambda i, j: ocl.Point(SIZE * i / parts, SIZE * j / parts, z[i][j])
    surface = ocl.STLSurf()
    for i in range(parts):
        for j in range(parts):
            a, b, c, d = point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)
            surface.addTriangle(ocl.Triangle(a, b, c))
            surface.addTriangle(ocl.Triangle(a, c, d))
    return surface, 2 * parts * parts


def theirs(surface, lines):
    drop = ocl.BatchDropCutter()
    drop.setSTL(surface)
    drop.setCutter(ocl.BallCutter(2 * RADIUS, 50))
    drop.setThreads(os.cpu_count() or 1)
    for k in range(lines):
        y = SIZE * (k + 0.5) / lines
        for i in range(POINTS):
            drop.appendPoint(ocl.CLPoint(SIZE * i / (POINTS - 1), y, -50))
    start = time.perf_counter()
    drop.run()
    return time.perf_counter() - start


def ours(binary, folder, runs):
    source = os.path.join(folder, "job.apt")
    with open(source, "w") as file:
        file.write(program())
    best = float("inf")
    for _ in range(runs):
        start = time.perf_counter()
        subprocess.run([binary, "build", source, "-o", os.path.join(folder, "job.ngc")], check=True, capture_output=True)
        best = min(best, time.perf_counter() - start)
    return best


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("binary", nargs="?", default="target/release/partwright")
    parser.add_argument("--lines", type=int, default=10)
    parser.add_argument("--error", type=float, default=1e-3)
    options = parser.parse_args()
    surface, count = triangles(options.error)
    with tempfile.TemporaryDirectory() as folder:
        own = ours(options.binary, folder, 5)
        other = theirs(surface, options.lines)
        own = min(own, ours(options.binary, folder, 5))
    whole = other * LINES / options.lines
    print(f"triangles: {count}, off the patch by {options.error} mm at most")
    print(f"OpenCAMLib: {POINTS * options.lines / other:.0f} points a second, {whole:.1f} s for {LINES} lines")
    print(f"partwright: {own:.3f} s, whole process, proof included")
    print(f"ratio: {whole / own:.0f}")


if __name__ == "__main__":
    main()
