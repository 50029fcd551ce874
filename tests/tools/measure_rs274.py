#!/usr/bin/env python3
"""Measures an NC program of a plate cam by what LinuxCNC's rs274 executes.

Runs `rs274 -g` on the program, takes its canonical calls (or reads them from a file), and measures every closed run
of cuts along the cam against a cam computed here, from the follower's envelope, independently of the compiler:

    measure_rs274.py PROGRAM.ngc --base 20 --roller 8 --cutter 8 --motion D30,R120/20/MS,D60,F120/20/MS,D30 \
        --into 0.01 --out 0.01 --most 100

Follower: translating roller (default; --offset), --flat, --osc ARM,PIVOT (roller), --oscflat PIVOT,OFFSET; lifts of
oscillating followers are degrees. Motion: D dwell, R rise, F return, angle[/lift/law]; laws MS CY SH CA MT P345
P4567. --cclw mirrors the rotation. --leave is stock left on the profile.

Prints one JSON object: for every contour its height, blocks, largest deviation into and out of the part and where.
Exit 1 when one is out of the band (+ --resolution), has more than --most blocks, or is not a whole turn; 2 when
rs274 complains or a curve (NURBS_FEED) can't be measured. rs274 prints four decimals: that is the resolution, 0.0001
mm by default and 0.0036 mm for programs in inches. Only the standard library is used.
"""

import argparse
import json
import math
import re
import subprocess
import sys
import tempfile
from pathlib import Path

INCH = 25.4


# ---- motion laws: s(x), s'(x), s''(x) over 0..1 -------------------------------------------------------------

def zones(bounds, height):
    """The universal curve (Makino): acceleration by zones, integrated in closed form zone by zone."""
    t = [0.0] + list(bounds) + [1.0]
    # sine up, constant, cosine down, zero, minus sine, minus constant, minus cosine back
    def acc(zone, x):
        a, b = t[zone], t[zone + 1]
        q = (x - a) / (b - a) if b > a else 0.0
        w = math.pi / 2
        return {0: math.sin(w * q), 1: 1.0, 2: math.cos(w * q), 3: 0.0,
                4: -math.sin(w * q), 5: -1.0, 6: -math.cos(w * q)}[zone]

    def integrals(zone, x):
        """Velocity and lift gained in a zone from its start to x, for unit amplitude and no speed at its start."""
        a, b = t[zone], t[zone + 1]
        d, q = b - a, x - a
        if d <= 0:
            return 0.0, 0.0
        w = math.pi / (2 * d)
        sign = 1.0 if zone < 3 else -1.0
        kind = zone if zone < 3 else zone - 4
        if zone == 3:
            return 0.0, 0.0
        if kind == 0:
            return sign * (1 - math.cos(w * q)) / w, sign * (q / w - math.sin(w * q) / w ** 2)
        if kind == 1:
            return sign * q, sign * q * q / 2
        return sign * math.sin(w * q) / w, sign * (1 - math.cos(w * q)) / w ** 2

    def run(x):
        s = v = 0.0
        for zone in range(7):
            a, b = t[zone], t[zone + 1]
            if x <= a and zone:
                break
            e = min(x, b)
            dv, ds = integrals(zone, e)
            s += v * (e - a) + ds
            v += dv
        return s, v

    total = run(1.0)[0]

    def law(x):
        s, v = run(x)
        zone = max(i for i in range(7) if t[i] <= x + 1e-15 and (t[i + 1] > t[i]))
        return s / total, v / total, acc(zone, x) / total

    return law


def polynomial(terms):
    def law(x):
        s = sum(c * x ** n for n, c in terms)
        v = sum(n * c * x ** (n - 1) for n, c in terms)
        a = sum(n * (n - 1) * c * x ** (n - 2) for n, c in terms)
        return s, v, a
    return law


LAWS = {
    "MS": zones([1 / 8, 1 / 8, 1 / 2, 1 / 2, 7 / 8, 7 / 8], 1),
    "CY": zones([1 / 4, 1 / 4, 1 / 2, 1 / 2, 3 / 4, 3 / 4], 1),
    "MT": zones([1 / 8, 3 / 8, 1 / 2, 1 / 2, 5 / 8, 7 / 8], 1),
    "CA": zones([0, 1 / 2, 1 / 2, 1 / 2, 1 / 2, 1], 1),
    "SH": lambda x: ((1 - math.cos(math.pi * x)) / 2, math.pi / 2 * math.sin(math.pi * x),
                     math.pi ** 2 / 2 * math.cos(math.pi * x)),
    "P345": polynomial([(3, 10), (4, -15), (5, 6)]),
    "P4567": polynomial([(4, 35), (5, -84), (6, 70), (7, -20)]),
}


class Motion:
    """Lift and its two derivatives with respect to the cam angle."""

    def __init__(self, text, unit):
        self.segments = []
        at = level = 0.0
        for part in text.split(","):
            fields = part[1:].split("/")
            angle = math.radians(float(fields[0]))
            lift = float(fields[1]) * unit if len(fields) > 1 else 0.0
            law = LAWS[fields[2]] if len(fields) > 2 else None
            sign = {"D": 0.0, "R": 1.0, "F": -1.0}[part[0]]
            self.segments.append((at, angle, level, sign * lift, law))
            at += angle
            level += sign * lift
        if abs(at - 2 * math.pi) > 1e-9:
            sys.exit(f"the motion's angles add up to {math.degrees(at)} degrees")

    def __call__(self, t):
        t %= 2 * math.pi
        for at, angle, level, lift, law in self.segments:
            if t <= at + angle:
                if not law:
                    return level, 0.0, 0.0
                s, v, a = law(min(1.0, max(0.0, (t - at) / angle)))
                return level + lift * s, lift * v / angle, lift * a / angle ** 2
        return self(0.0)


# ---- the cutter's centre path -------------------------------------------------------------------------------

def centre_path(o, motion):
    """t -> point, outward normal: the cutter's centre in contact, the cam turning clockwise (or its mirror)."""
    rc = o.cutter + o.leave
    side = -1.0 if o.cclw else 1.0

    def translating(t):
        s, v, _ = motion(t)
        u, n = (math.cos(t), math.sin(t)), (-math.sin(t), math.cos(t))
        if o.flat:
            r = o.base + s
            return (r * u[0] + v * n[0], r * u[1] + v * n[1]), u, 0.0
        d0 = math.sqrt((o.base + o.roller) ** 2 - o.offset ** 2)
        y = d0 + s
        c = (y * u[0] - o.offset * n[0], y * u[1] - o.offset * n[1])
        d = ((v + o.offset) * u[0] + y * n[0], (v + o.offset) * u[1] + y * n[1])
        m = math.hypot(*d)
        return c, (d[1] / m, -d[0] / m), o.roller

    def oscillating(t):
        s, v, _ = motion(t)
        ra = o.pivot
        u = (math.cos(t), math.sin(t))
        if o.arm:
            rr = o.arm
            s0 = math.acos((ra ** 2 + rr ** 2 - (o.base + o.roller) ** 2) / (2 * ra * rr))
            psi = s0 + s
            w = (math.cos(t - psi), math.sin(t - psi))
            c = (ra * u[0] - rr * w[0], ra * u[1] - rr * w[1])
            d = (-ra * u[1] + rr * (1 - v) * w[1], ra * u[0] - rr * (1 - v) * w[0])
            m = math.hypot(*d)
            return c, (d[1] / m, -d[0] / m), o.roller
        psi = math.asin((o.base + o.offset) / ra) + s
        w = (math.cos(t - psi), math.sin(t - psi))
        # The face's outward normal, away from the cam.
        n = (w[1], -w[0])
        length = ra * math.cos(psi) / (1 - v)
        p = (ra * u[0] - length * w[0], ra * u[1] - length * w[1])
        if p[0] * n[0] + p[1] * n[1] < 0:
            n = (-n[0], -n[1])
        return (p[0] - o.offset * n[0], p[1] - o.offset * n[1]), n, 0.0

    contact = oscillating if o.pivot else translating

    def at(t):
        p, n, roller = contact(t)
        k = rc - roller
        return (p[0] + k * n[0], side * (p[1] + k * n[1])), (n[0], side * n[1])

    return at


# ---- canonical calls ----------------------------------------------------------------------------------------

CALL = re.compile(r"([A-Z_0-9]+)\((.*)\)")


def canonical(text):
    """Moves as (kind, z0, z1, x->point, length, block): points in mm in the part's frame."""
    unit, here = 1.0, None
    moves = []
    for line in text.splitlines():
        call = CALL.search(line)
        if not call:
            continue
        name, args = call.groups()
        if name == "USE_LENGTH_UNITS":
            new = INCH if "INCHES" in args else 1.0
            unit = new
            continue
        if name == "NURBS_FEED":
            sys.exit("NURBS_FEED: rs274 does not print the curve")
        if name not in ("STRAIGHT_FEED", "STRAIGHT_TRAVERSE", "ARC_FEED"):
            continue
        v = [float(a) for a in args.split(",")]
        if name == "ARC_FEED":
            to = (v[0] * unit, v[1] * unit, v[5] * unit, v[8])
            centre, turns = (v[2] * unit, v[3] * unit), int(v[4])
            moves.append(("arc", here, to, centre, turns))
        else:
            to = (v[0] * unit, v[1] * unit, v[2] * unit, v[5])
            moves.append(("feed" if name == "STRAIGHT_FEED" else "rapid", here or to, to, None, 0))
        here = to
    return moves


def tracer(move, reverse):
    """x in 0..1 -> point in the part, and the length."""
    kind, a, b, centre, turns = move
    if kind == "arc":
        r0, r1 = math.dist(a[:2], centre), math.dist(b[:2], centre)
        t0 = math.atan2(a[1] - centre[1], a[0] - centre[0])
        t1 = math.atan2(b[1] - centre[1], b[0] - centre[0])
        sweep = t1 - t0
        if turns > 0:
            while sweep <= 1e-6:
                sweep += 2 * math.pi
            sweep += 2 * math.pi * (turns - 1)
        else:
            while sweep >= -1e-6:
                sweep -= 2 * math.pi
            sweep -= 2 * math.pi * (-turns - 1)

        def at(x):
            r, t = r0 + (r1 - r0) * x, t0 + sweep * x
            return centre[0] + r * math.cos(t), centre[1] + r * math.sin(t)
        return at, abs(sweep) * (r0 + r1) / 2

    def at(x):
        px, py = a[0] + (b[0] - a[0]) * x, a[1] + (b[1] - a[1]) * x
        c = math.radians(a[3] + (b[3] - a[3]) * x) * (-1 if reverse else 1)
        return px * math.cos(c) - py * math.sin(c), px * math.sin(c) + py * math.cos(c)
    steps = [at(i / 16) for i in range(17)]
    return at, sum(math.dist(p, q) for p, q in zip(steps, steps[1:]))


# ---- measuring ----------------------------------------------------------------------------------------------

class Foot:
    """Foot of a point on the closed curve, followed from point to point."""

    def __init__(self, curve):
        self.curve = curve
        self.table = [curve(2 * math.pi * i / 2000)[0] for i in range(2000)]

    def nearest(self, q):
        i = min(range(2000), key=lambda i: math.dist(q, self.table[i]))
        return self.refine(q, 2 * math.pi * i / 2000)

    def refine(self, q, t):
        h = 1e-5
        for _ in range(60):
            p, n = self.curve(t)
            (ax, ay), (bx, by) = self.curve(t - h)[0], self.curve(t + h)[0]
            d = ((bx - ax) / (2 * h), (by - ay) / (2 * h))
            m = math.hypot(*d)
            residue = ((q[0] - p[0]) * d[0] + (q[1] - p[1]) * d[1]) / m
            step = residue / m
            t += max(-0.05, min(0.05, step))
            if abs(step) < 1e-11:
                break
        p, n = self.curve(t)
        return t, (q[0] - p[0]) * n[0] + (q[1] - p[1]) * n[1], math.dist(q, p)


def extreme(at, foot, t, x0, x1, sign):
    """Golden section for the largest sign * deviation between x0 and x1."""
    g = (math.sqrt(5) - 1) / 2
    f = lambda x: sign * foot.refine(at(x), t)[1]
    a, b = x0, x1
    c, d = b - g * (b - a), a + g * (b - a)
    fc, fd = f(c), f(d)
    for _ in range(40):
        if fc > fd:
            b, d, fd = d, c, fc
            c = b - g * (b - a)
            fc = f(c)
        else:
            a, c, fc = c, d, fd
            d = a + g * (b - a)
            fd = f(d)
    x = (a + b) / 2
    return f(x), at(x)


def contours(moves, foot, reverse, near):
    """Runs of cuts that begin and end on the cam and do not leave it."""
    run, runs = [], []
    for move in moves:
        kind, a, b = move[0], move[1], move[2]
        at, length = tracer(move, reverse) if a else (None, 0.0)
        along = kind != "rapid" and a and length > 0 and abs(a[2] - b[2]) < 1e-9
        if along:
            along = all(foot.nearest(at(x))[2] <= near for x in (0.0, 0.5, 1.0))
        if along:
            run.append((move, at, length))
        elif run:
            runs.append(run)
            run = []
    return runs + ([run] if run else [])


def measure(run, foot, step):
    start = foot.nearest(run[0][1](0.0))
    t = start[0]
    worst = {1: (-1e9, None), -1: (-1e9, None)}
    for move, at, length in run:
        n = max(4, int(length / step))
        values = []
        for i in range(n + 1):
            t, d, _ = foot.refine(at(i / n), t)
            values.append((t, d))
        for sign in (1, -1):
            i = max(range(n + 1), key=lambda i: sign * values[i][1])
            best = sign * values[i][1], at(i / n)
            if best[0] > worst[sign][0] - 0.001:
                polished = extreme(at, foot, values[i][0], max(0, i - 1) / n, min(n, i + 1) / n, sign)
                best = max(best, polished, key=lambda v: v[0])
            if best[0] > worst[sign][0]:
                worst[sign] = best
    return {
        "z": run[0][0][1][2],
        "blocks": len(run),
        "turns": (t - start[0]) / (2 * math.pi),
        "out": worst[1][0], "out_at": worst[1][1],
        "into": worst[-1][0], "into_at": worst[-1][1],
    }


def execute(program):
    with tempfile.TemporaryDirectory() as folder:
        # LinuxCNC's tool table is in inches whatever the program says.
        table = Path(folder, "tool.tbl")
        table.write_text("".join(f"T{n} P{n} Z0 D0.3\n" for n in range(1, 100)))
        command = ["rs274", "-g", "-t", str(table), "-v", str(Path(folder, "rs274.var")), str(program)]
        # Two rs274 at a time get in each other's way now and then: a death by signal is not an answer.
        for _ in range(20):
            done = subprocess.run(command, capture_output=True, text=True, stdin=subprocess.DEVNULL)
            if done.returncode >= 0:
                break
    if done.returncode != 0:
        sys.stderr.write(done.stderr)
        print(f"rs274 refuses {program}", file=sys.stderr)
        sys.exit(2)
    return done.stdout


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("program", type=Path)
    p.add_argument("--canonical", action="store_true", help="PROGRAM holds rs274's output already")
    p.add_argument("--base", type=float, default=20.0)
    p.add_argument("--roller", type=float, default=8.0)
    p.add_argument("--offset", type=float, default=0.0)
    p.add_argument("--flat", action="store_true")
    p.add_argument("--osc", help="ARM,PIVOT")
    p.add_argument("--oscflat", help="PIVOT,OFFSET")
    p.add_argument("--cutter", type=float, default=8.0, help="cutter radius, mm")
    p.add_argument("--leave", type=float, default=0.0)
    p.add_argument("--motion", default="D30,R120/20/MS,D60,F120/20/MS,D30")
    p.add_argument("--cclw", action="store_true")
    p.add_argument("--reverse-table", action="store_true")
    p.add_argument("--into", type=float, default=0.01)
    p.add_argument("--out", type=float, default=0.01)
    p.add_argument("--most", type=int, help="most blocks of a contour")
    p.add_argument("--contours", type=int, help="how many contours there must be (default: one at least)")
    p.add_argument("--resolution", type=float, help="mm that rounding of rs274's output may add")
    p.add_argument("--step", type=float, default=0.05, help="sampling step before refinement, mm")
    o = p.parse_args()
    o.arm = o.pivot = None
    if o.osc:
        o.arm, o.pivot = map(float, o.osc.split(","))
    if o.oscflat:
        o.pivot, o.offset = map(float, o.oscflat.split(","))
    text = o.program.read_text() if o.canonical else execute(o.program)
    resolution = o.resolution or (0.0036 if "CANON_UNITS_INCHES" in text else 0.0001)
    motion = Motion(o.motion, math.radians(1.0) if o.pivot else 1.0)
    foot = Foot(centre_path(o, motion))
    near = 5 * max(o.into, o.out) + resolution
    found = [measure(run, foot, o.step) for run in contours(canonical(text), foot, o.reverse_table, near)]
    found = [f for f in found if abs(f["turns"]) > 0.5]
    wanted = len(found) >= 1 if o.contours is None else len(found) == o.contours
    good = wanted and all(
        f["into"] <= o.into + resolution and f["out"] <= o.out + resolution
        and abs(abs(f["turns"]) - 1) < 1e-3 and (o.most is None or f["blocks"] <= o.most) for f in found)
    json.dump({"program": str(o.program), "good": good, "resolution": resolution, "contours": found}, sys.stdout, indent=1)
    print()
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
