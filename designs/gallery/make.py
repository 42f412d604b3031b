"""Writes the parts of the gallery that no key of a design file draws: funnels, cups and slots, as OBJ meshes and SVG outlines in mm.

    python3 designs/gallery/make.py

Numbers are rounded to a micrometre, so that every machine writes the same files. What is round has its corners on the circle where it stands out, and its
sides on the circle where it is hollow: nothing reaches into a hole.
"""

from math import cos, pi, radians, sin
from pathlib import Path

HERE = Path(__file__).parent / "meshes"


def revolved(profile, sides):
    """A closed surface around z: `profile` is a closed polygon of (radius, z) off the axis, counter-clockwise with radius to the right and z up."""
    angles = [2 * pi * k / sides for k in range(sides)]
    points = [(r * cos(a), r * sin(a), z) for a in angles for r, z in profile]
    count = len(profile)
    faces = []
    for k in range(sides):
        here, there = k * count, (k + 1) % sides * count
        for i in range(count):
            j = (i + 1) % count
            faces.append((here + i, there + i, there + j, here + j))
    return points, faces


def hollow(radius, sides):
    """The radius of the corners of a polygon whose sides touch a circle."""
    return radius / cos(pi / sides)


def obj(name, bodies):
    """Writes bodies into one file, an object each."""
    lines, first = ["# by designs/gallery/make.py, in mm"], 1
    for number, (points, faces) in enumerate(bodies):
        lines.append(f"o body{number}")
        lines += ["v " + " ".join(f"{round(v, 3) + 0.0:g}" for v in p) for p in points]
        lines += ["f " + " ".join(str(first + k) for k in f) for f in faces]
        first += len(points)
    (HERE / name).write_text("\n".join(lines) + "\n", encoding="utf-8")


def svg(name, width, height, outlines):
    """Writes closed outlines of millimetres, the origin in the middle, as one path: outlines in outlines are holes."""
    path = " ".join("M " + " L ".join(f"{round(x, 3) + 0.0:g},{round(-y, 3) + 0.0:g}" for x, y in o) + " Z" for o in outlines)
    box = f"{-width / 2:g} {-height / 2:g} {width:g} {height:g}"
    (HERE / name).write_text(
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:g}mm" height="{height:g}mm" viewBox="{box}"><path d="{path}"/></svg>\n',
        encoding="utf-8",
    )


def arc(radius, start, end, steps):
    """Points of an arc, degrees."""
    angles = [radians(start + (end - start) * k / steps) for k in range(steps + 1)]
    return [(radius * cos(a), radius * sin(a)) for a in angles]


def funnel(bottom, throat, mouth, depth, rim, sides, floor, narrow=0.0):
    """A funnel with its mouth at z = 0: a socket of `bottom` depth that becomes narrower by `narrow`, below a cone of `depth`, closed by a floor of `floor`."""
    low = -depth - bottom
    # The floor is a disc of its own that the ring stands in.
    wall = [(throat - narrow, low), (rim, low), (rim, 0.0), (mouth, 0.0), (throat, -depth)]
    plate = revolved_solid([(rim, low - floor), (rim, low)], sides)
    return [revolved(wall, sides), plate]


def revolved_solid(levels, sides):
    """A convex body around z: a polygon of this radius at each height, from below."""
    angles = [2 * pi * k / sides for k in range(sides)]
    points = [(r * cos(a), r * sin(a), z) for r, z in levels for a in angles]
    faces = [tuple(reversed(range(sides))), tuple(range((len(levels) - 1) * sides, len(levels) * sides))]
    for level in range(len(levels) - 1):
        for k in range(sides):
            low, high, n = level * sides, (level + 1) * sides, (k + 1) % sides
            faces.append((low + k, low + n, high + n, high + k))
    return points, faces


def cup():
    """The coupler of a trailer: a cup of radius 25.25 about a ball of 50, 20 deep, then a flare."""
    sides, radius = 24, 25.25
    angles = [radians(a) for a in (-75, -55, -35, -15)]
    inner = [(hollow(radius * cos(a), sides), radius * sin(a)) for a in angles]
    inner.append((hollow(38.0, sides), 8.0))
    profile = [(inner[0][0], -34.0), (55.0, -34.0), (55.0, 8.0), *reversed(inner)]
    return [revolved(profile, sides), revolved_solid([(55.0, -40.0), (55.0, -34.0)], sides)]


def rectangle(x, y):
    return [(x, y), (-x, y), (-x, -y), (x, -y)]


def rectangular_funnel(levels, outer, floor):
    """A funnel of rectangles (half x, half y, z) from the throat up, in a block."""
    inner = [[(*corner, z) for corner in rectangle(x, y)] for x, y, z in levels]
    low, high = levels[0][2], levels[-1][2]
    rings = [[(*c, low) for c in rectangle(*outer)], [(*c, high) for c in rectangle(*outer)], *reversed(inner)]
    points = [p for ring in rings for p in ring]
    faces = []
    for ring in range(len(rings)):
        here, there = 4 * ring, 4 * ((ring + 1) % len(rings))
        for k in range(4):
            n = (k + 1) % 4
            faces.append((here + k, here + n, there + n, there + k))
    x, y = outer
    block = [(*c, z) for z in (low - floor, low) for c in rectangle(x, y)]
    sides = [(3, 2, 1, 0), (4, 5, 6, 7)] + [(k, (k + 1) % 4, 4 + (k + 1) % 4, 4 + k) for k in range(4)]
    return [(points, faces), (block, sides)]


LUGS = [(72.21, 53.45), (60.78, 58.65), (56.39, 58.52)]


def bayonet():
    """The mount of a lens: slots half a degree wider than the lugs to either side, and the lugs with a lead-in of 3 degrees."""
    hole, lugs, start = [], [], -0.5 * 72.21
    for lug, gap in LUGS:
        end = start + lug
        hole += arc(hollow(23.2, 24), start - 0.5, end + 0.5, 6)
        hole += arc(hollow(22.1, 24), end + 0.5, end + gap - 0.5, 4)
        # The moving half is turned over about x, which turns angles over.
        points, faces = [], []
        for less, z in ((0.0, 3.2), (0.0, 3.55), (3.0, 4.6)):
            points += [(*p, z) for p in arc(23.1, -(end - less), -(start + less), 6)] + [(*p, z) for p in [(8.0 * cos(radians(-0.5 * (start + end))), 8.0 * sin(radians(-0.5 * (start + end))))]]
        n = 8
        faces += [tuple(reversed(range(n))), tuple(range(2 * n, 3 * n))]
        for level in range(2):
            for k in range(n):
                m = (k + 1) % n
                faces.append((level * n + k, level * n + m, (level + 1) * n + m, (level + 1) * n + k))
        lugs.append((points, faces))
        start = end + gap
    svg("bayonet-mount.svg", 62, 62, [arc(30.0, 0, 345, 23), hole])
    obj("bayonet-lugs.obj", lugs)


def petals():
    """Three petals of the docking ring: 160 mm inwards and 160 high at 45 degrees on a bore of 1200, 36 degrees wide at the tip."""
    bodies = []
    for middle in (90.0, 210.0, 330.0):
        points = []
        for z, outer, wide in ((0.0, 598.0, 29.5), (160.0, 440.0, 18.0)):
            ring = [(outer, -wide), (outer, 0.0), (outer, wide), (outer - 15.0, wide), (outer - 15.0, 0.0), (outer - 15.0, -wide)]
            points += [(r * cos(radians(middle + a)), r * sin(radians(middle + a)), z) for r, a in ring]
        n = 6
        faces = [(5, 4, 1, 0), (4, 3, 2, 1), (6, 7, 10, 11), (7, 8, 9, 10)]
        faces += [(k, (k + 1) % n, n + (k + 1) % n, n + k) for k in range(n)]
        bodies.append((points, faces))
    ring = [(600.0, -60.0), (680.0, -60.0), (680.0, 0.0), (600.0, 0.0)]
    obj("petal-ring.obj", [revolved(ring, 24), *bodies])


def main():
    HERE.mkdir(exist_ok=True)
    n = 32
    # Radius 6.499 below, 7.5 at the mouth, 1.001 deep; a floor 20 below.
    obj("industreal-hole.obj", funnel(18.999, hollow(6.499, n), hollow(7.5, n), 1.001, 12.0, n, 2.0))
    n = 24
    obj("drogue.obj", funnel(90.0, hollow(62.0, n), hollow(400.0, n), 338.0, 550.0, n, 20.0, 7.0))
    n = 16
    obj("pad-funnel.obj", funnel(1.0, hollow(4.5, n), hollow(22.4, n), 17.9, 26.0, n, 2.0))
    # Radius 5.25 for a pin of 5; the mouth is 3 wider and 3 deep.
    obj("bushing.obj", funnel(9.0, hollow(5.25, n), hollow(8.25, n), 3.0, 14.0, n, 2.0, 0.2))
    obj("trihedral.obj", [revolved([(0.3, -3.45), (14.0, -3.45), (14.0, 0.0), (7.2, 0.0)], 3), revolved_solid([(14.0, -10.0), (14.0, -3.45)], 3)])
    obj("ball-coupler.obj", cup())
    obj("dock-funnel.obj", rectangular_funnel([(56, 56, 0), (56, 56, 20), (110, 90, 100)], (130, 110), 10))
    # Across flats 6.06 in the socket, 5.98 of the key.
    flats = [6.06, 7.2]
    throat, mouth = [f / 3**0.5 for f in flats]
    obj("hex-socket.obj", [revolved([(throat, -4.0), (6.5, -4.0), (6.5, 0.0), (mouth, 0.0), (throat, -0.57)], 6), revolved_solid([(6.5, -8.0), (6.5, -4.0)], 6)])
    key, tip = [f / 3**0.5 for f in (5.98, 5.2)]
    obj("hex-key.obj", [revolved_solid([(key, -12.0), (key, -0.4), (tip, 0.0)], 6)])
    hole = [arc(hollow(31.75, 24), start, start + 165, 11) for start in (-82.5, 97.5)]
    svg("corner-hole.svg", 180, 164, [[(89, 81), (-89, 81), (-89, -81), (89, -81)],
        [(x + 30.25, y) for x, y in hole[0]] + [(x - 30.25, y) for x, y in hole[1]]])
    bayonet()
    petals()


main()
