"""Reference points of plate cams, computed apart from the crate: python3 tests/data/cams.py > tests/data/cams.csv

Needs mpmath. The way is another one than the crate's: tangents, normals and curvatures come from differentiating the points
numerically with 40 digits, and so do the velocities that the flat faces need.
"""
from mpmath import mp, mpf, sin, cos, atan2, asin, acos, sqrt, pi, diff

mp.dps = 40
TURN = [(30, 0), (120, 1), (60, 0), (120, -1), (30, 0)]


def universal(zones):
    """Lift of the universal curve: unit pulses, integrated zone by zone, with heights that close it."""
    t = [mpf(0), *zones, mpf(1)]

    # Exact integrals of a pulse over part q of a zone: first (velocity), second (lift).
    def first(i, q):
        w = pi / 2
        return [(1 - cos(w * q)) / w, q, sin(w * q) / w, 0, -(1 - cos(w * q)) / w, -q, -sin(w * q) / w][i]

    def second(i, q):
        w = pi / 2
        return [(q - sin(w * q) / w) / w, q * q / 2, (1 - cos(w * q)) / w**2, 0,
                -(q - sin(w * q) / w) / w, -q * q / 2, -(1 - cos(w * q)) / w**2][i]

    def walk(x, a1, a2):
        s = v = mpf(0)
        for i in range(7):
            length = t[i + 1] - t[i]
            if length <= 0 or x <= t[i]:
                continue
            q = min((x - t[i]) / length, mpf(1))
            a = a1 if i < 3 else a2
            s += v * q * length + a * second(i, q) * length**2
            v += a * first(i, q) * length
        return s, v

    s1, v1 = walk(mpf(1), 1, 0)
    s2, v2 = walk(mpf(1), 0, 1)
    # v1 a1 + v2 a2 = 0 and s1 a1 + s2 a2 = 1
    a1 = -v2 / (v1 * s2 - v2 * s1)
    a2 = v1 / (v1 * s2 - v2 * s1)
    return lambda x: walk(x, a1, a2)[0]


def eighths(*n):
    return [mpf(k) / 8 for k in n]


B = (2 - mpf(6) / 8 + pi / 8) / (2 + pi)
LAWS = {
    "MODSIN": universal(eighths(1, 1, 4, 4, 7, 7)),
    "CYCLO": universal(eighths(2, 2, 4, 4, 6, 6)),
    "MODTRAP": universal(eighths(1, 3, 4, 4, 5, 7)),
    "TRAPEC": universal([mpf(1) / 8, B, B + mpf(1) / 8, B + mpf(1) / 8, B + mpf(1) / 4, B + mpf(1) / 4]),
    "P345": lambda x: x**3 * (10 - 15 * x + 6 * x * x),
    "P4567": lambda x: x**4 * (35 - 84 * x + 70 * x * x - 20 * x**3),
}


def lift(law, h):
    f = LAWS[law]

    def s(t):
        start, level = mpf(0), mpf(0)
        for angle, way in TURN:
            end = start + angle * pi / 180
            if t <= end:
                x = (t - start) / (end - start)
                return level + (way * h * f(x) if way else 0)
            start, level = end, level + way * h
        return level

    return s


def polar(a):
    return mp.matrix([cos(a), sin(a)])


def normal(a):
    return mp.matrix([-sin(a), cos(a)])


def reference(kind, rb, rf, e, ra, rr, side, s):
    """Pitch curve (rollers) or profile (flat faces) as a function of the cam angle, and the face's support."""
    if kind == "tr":
        d0 = sqrt((rb + rf) ** 2 - e * e)
        return lambda t: (d0 + s(t)) * polar(t) - e * normal(t)
    if kind == "or":
        s0 = acos((ra**2 + rr**2 - (rb + rf) ** 2) / (2 * ra * rr))
        return lambda t: ra * polar(t) - rr * polar(t - side * (s0 + s(t)))
    if kind == "tf":
        # The face is the line p.u(t) = rb + s; the contact is where its neighbour cuts it.
        return lambda t: (rb + s(t)) * polar(t) + diff(s, t) * normal(t)
    s0 = asin((rb + e) / ra)

    def face(t):
        # Envelope of p.N = ra sin(psi) - f, N at angle beta: p = h N + (h'/beta') N_left
        beta = lambda t: t - side * (s0 + s(t)) + side * pi / 2
        h = lambda t: ra * sin(s0 + s(t)) - e
        return h(t) * polar(beta(t)) + diff(h, t) / diff(beta, t) * normal(beta(t))

    return face


def profile(kind, rf, curve, flank):
    if rf == 0:
        return curve

    def p(t):
        d = [diff(lambda x, k=k: curve(x)[k], t) for k in (0, 1)]
        phi = atan2(-d[0], d[1])  # direction of the outward normal of the counter-clockwise curve
        return curve(t) + (rf if flank == "outer" else -rf) * polar(phi)

    return p


def curvature(curve, t):
    d1 = [diff(lambda x, k=k: curve(x)[k], t) for k in (0, 1)]
    d2 = [diff(lambda x, k=k: curve(x)[k], t, 2) for k in (0, 1)]
    return (d1[0] * d2[1] - d1[1] * d2[0]) / (d1[0] ** 2 + d1[1] ** 2) ** mpf("1.5")


CAMS = [  # name, kind, base, roller, offset, pivot, arm, side, lift, law, flank, turns
    ("paper", "tr", 20, 8, 0, 0, 0, 0, 20, "MODSIN", "inner", "clw"),
    ("offset", "tr", 30, 8, 5, 0, 0, 0, 18, "CYCLO", "inner", "clw"),
    ("offset back", "tr", 28, 6, -4, 0, 0, 0, 12, "P4567", "inner", "cclw"),
    ("groove in", "tr", 35, 8, 0, 0, 0, 0, 15, "TRAPEC", "inner", "clw"),
    ("groove out", "tr", 35, 8, 0, 0, 0, 0, 15, "TRAPEC", "outer", "clw"),
    ("flat", "tf", 60, 0, 0, 0, 0, 0, 15, "P345", "inner", "clw"),
    ("arm right", "or", 30, 8, 0, 80, 70, 1, "0.35", "MODSIN", "inner", "clw"),
    ("arm left", "or", 30, 8, 0, 80, 70, -1, "0.3", "MODTRAP", "inner", "clw"),
    ("arm groove", "or", 40, 7, 0, 90, 75, -1, "0.2", "CYCLO", "outer", "cclw"),
    ("face right", "of", 50, 0, 0, 110, 0, 1, "0.17", "CYCLO", "inner", "clw"),
    ("face left", "of", 50, 0, 6, 110, 0, -1, "0.17", "P345", "inner", "cclw"),
]


def main():
    print("cam,kind,base,roller,offset,pivot,arm,side,lift,law,flank,turns,angle,s,x,y,normal_x,normal_y,curvature")
    for cam in CAMS:
        name, kind, rb, rf, e, ra, rr, side, h, law, flank, turns = cam
        s = lift(law, mpf(h))
        curve = reference(kind, mpf(rb), mpf(rf), mpf(e), mpf(ra), mpf(rr), side, s)
        p = profile(kind, rf, curve, flank)
        flip = -1 if turns == "cclw" else 1
        for degrees in range(7, 360, 15):
            t = degrees * pi / 180
            point = p(t)
            d = [diff(lambda x, k=k: p(x)[k], t) for k in (0, 1)]
            n = mp.matrix([d[1], -d[0]]) / sqrt(d[0] ** 2 + d[1] ** 2)
            row = [s(t), point[0], flip * point[1], n[0], flip * n[1], curvature(p, t)]
            values = ",".join(mp.nstr(v, 17, min_fixed=-30, max_fixed=30) for v in row)
            print(",".join(str(v) for v in cam) + f",{degrees},{values}")


main()
