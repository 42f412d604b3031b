"""STEP files through the program, with OpenCASCADE as it is installed, against closed forms:

    .venv/bin/python tests/step_meshes.py target/debug/catchment

Volumes and tightness of the meshes, mated pose of the halves, captured offsets, and files: of several bodies, in inches, without a solid,
truncated.
"""

import json
import math
import os
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

here = Path(__file__).parent
sys.path.insert(0, str(here / "step"))
script = (here.parent / "crates/catchment-connector/src/step/mesh.py").read_text()
catchment = Path(sys.argv[1]).resolve()
environment = {**os.environ, "CATCHMENT_PYTHON": sys.executable, "NO_COLOR": "1"}


def meshed(path, deflection):
    """For every body the volume in mm^3, the area in mm^2, and the number of edges without exactly one triangle on
    each side."""
    arguments = [sys.executable, "-c", script, str(deflection), "200000", str(8 << 30), "600"]
    answer = subprocess.run(arguments, stdin=path.open("rb"), capture_output=True, check=True).stdout
    head, _, numbers = answer.partition(b"\n")
    head = json.loads(head)
    assert "error" not in head, head
    assert head["reached"] <= head["deflection"], head
    at, bodies = 0, []
    for count, triangles in head["bodies"]:
        corners = [struct.unpack_from("<3d", numbers, at + 24 * k) for k in range(count)]
        at += 24 * count
        edges, volume, area = {}, 0.0, 0.0
        for k in range(triangles):
            ids = struct.unpack_from("<3I", numbers, at + 12 * k)
            a, b, c = (corners[i] for i in ids)
            u, v = ([q - p for p, q in zip(a, end)] for end in (b, c))
            normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
            volume += sum(p * n for p, n in zip(a, normal)) / 6
            area += math.hypot(*normal) / 2
            for i in range(3):
                edge = ids[i], ids[(i + 1) % 3]
                edges[edge] = edges.get(edge, 0) + 1
        at += 12 * triangles
        loose = sum(n != 1 or edges.get(edge[::-1]) != 1 for edge, n in edges.items())
        bodies.append((volume, area, loose))
    assert at == len(numbers)
    return bodies


def close(path, deflection, *volumes):
    """Every facet deviates by at most the deflection: so the volume deviates by at most that times the
    area."""
    bodies = meshed(path, deflection)
    assert len(bodies) == len(volumes), bodies
    for (volume, area, loose), exact in zip(bodies, volumes):
        assert loose == 0, f"{path}: {loose} loose edges"
        assert abs(volume - exact) <= deflection * area, f"{path}: {volume}, not {exact}"


def run(folder, *arguments):
    return subprocess.run([catchment, *arguments], cwd=folder, env=environment, capture_output=True, text=True)


def output_of(folder, *arguments):
    ran = run(folder, *arguments)
    assert ran.returncode == 0, ran.stderr
    return ran.stdout


# The fillet reduces the pin to the radius 3 + sqrt(4 - u^2), u above its beginning: the removed volume is the integral of pi
# (25 - r^2).
PEG = math.pi * 25 * 20 - math.pi * (24 + 8 / 3 - 6 * math.pi) + 24 * 24 * 4
CONE = math.pi * 4 / 3 * (5.2**2 + 5.2 * 9.2 + 9.2**2)
SOCKET = 30**3 - math.pi * 5.2**2 * 14 - CONE

for deflection in (0.05, 0.005):
    close(here / "step/peg.step", deflection, PEG)
    close(here / "step/socket.step", deflection, SOCKET)

DESIGN = """
[connector]
unit = "mm"
fixed = { mesh = "socket.step", deflection = "0.05 mm" }
moving = { mesh = "peg.step", deflection = "0.05 mm" }
[alignment]
free = ["x", "y"]
"""

with tempfile.TemporaryDirectory() as home:
    home = Path(home)
    for part in ("peg.step", "socket.step"):
        (home / part).write_bytes((here / "step" / part).read_bytes())
    (home / "design.toml").write_text(DESIGN)
    # The pin, 20 long, stands in a hole 18 deep: the face centre is half way up to the mouth. It touches with its rounded end, 10 wide.
    output = " ".join(output_of(home, "check", "design.toml").split())
    assert "face centre of the mating face: fixed half (0, 0, -9) mm, moving half (0, 0, 11) mm; they coincide when mated" in output, output
    assert "off by at most 0.05 mm (deflection, as written), by OCP " in output, output
    assert "mm, the larger lateral extent of the facets that can touch" in output, output
    # Its flat end, radius 3, slides off the mouth, radius 9.2, up to an offset of 6.2, less the area that polygons cut off
    # both.
    poses = [(e * math.cos(k), e * math.sin(k), e < 6.2) for e in (1.0, 5.0, 6.05, 6.35, 7.5) for k in range(8)]
    (home / "poses.csv").write_text("x_mm,y_mm\n" + "".join(f"{x},{y}\n" for x, y, _ in poses))
    rows = output_of(home, "outcome", "design.toml", "--poses", "poses.csv").splitlines()[1:]
    for (x, y, aligned), row in zip(poses, rows, strict=True):
        assert (row.split(",")[2] == "aligned") == aligned, (x, y, row)
    # The same parts, as a proposal.
    output_of(home, "place", "socket.step", "peg.step", "-o", "placed.toml")
    assert 'facing = "+z"' in (home / "placed.toml").read_text()

    import make
    from OCP.Interface import Interface_Static

    # A ball and a bar that overlap are two bodies, also in a file in inches.
    for unit in ("MM", "INCH"):
        Interface_Static.SetCVal_s("write.step.unit", unit)
        ball = make.BRepPrimAPI_MakeCone(make.axis(0), 5, 0, 5).Shape()
        make.write(home / "two.step", ball, make.block((4, -1, -1), (20, 1, 1)))
        close(home / "two.step", 0.01, math.pi * 25 * 5 / 3, 64)
    Interface_Static.SetCVal_s("write.step.unit", "MM")
    # A face is no solid, half a file is no file.
    face = make.TopExp_Explorer(make.block((0, 0, 0), (1, 1, 1)), __import__("OCP.TopAbs").TopAbs.TopAbs_FACE).Current()
    make.write(home / "face.step", face)
    whole = (home / "peg.step").read_bytes()
    (home / "half.step").write_bytes(whole[: len(whole) // 2])
    for name, complaint in (("face", "the file holds no solid"), ("half", "half.step")):
        (home / "bad.toml").write_text(DESIGN.replace("peg.step", f"{name}.step"))
        ran = run(home, "check", "bad.toml")
        message = " ".join(ran.stderr.replace("│", " ").split())
        assert ran.returncode == 4 and complaint in message, ran.stderr
        assert "panicked" not in message and not ran.stdout, ran.stderr

print("STEP files: volumes, heights, captured offsets, bodies and refusals as they must be")
