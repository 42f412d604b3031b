"""Opens the drawings of `catchment latch` with ezdxf and measures them.

    python tests/dxf_measures.py target/debug/catchment designs/systems/latch.toml

Runs the program itself. The part must have the width, overhang, neck, slit depth, slit gap and dowel holes of its design within
0.01 mm; so must the rest of a sheet after a beam as wide as the kerf has run along the cut line. Exits with a message if not.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

import ezdxf

NEAR = 0.01
# Edges within this angle of an axis are upright or level.
STRAIGHT = 1e-6


def read(path: Path, layer: str) -> tuple[list[tuple[float, float]], list[float]]:
    """Corners of the one closed curve on a CAD layer, and diameters of its holes."""
    document = ezdxf.readfile(path)
    audit = document.audit()
    if audit.errors:
        sys.exit(f"{path.name}: {audit.errors}")
    if document.header["$INSUNITS"] != 4:
        sys.exit(f"{path.name}: not in millimetres")
    space = document.modelspace()
    curves = [line for line in space.query("LWPOLYLINE") if line.dxf.layer == layer]
    holes = [2 * circle.dxf.radius for circle in space.query("CIRCLE")]
    if len(curves) != 1 or not curves[0].closed:
        sys.exit(f"{path.name}: it should hold one closed curve")
    return [(x, y) for x, y in curves[0].get_points("xy")], holes


def measure(corners: list[tuple[float, float]], holes: list[float], burnt: float) -> dict[str, float]:
    """Lengths of a front layer after the beam has removed `burnt` mm on either side of the curve."""
    edges = list(zip(corners, corners[1:] + corners[:1]))
    upright = [(a, b) for a, b in edges if abs(a[0] - b[0]) < STRAIGHT and abs(a[1] - b[1]) > 0.5]
    level = [(a, b) for a, b in edges if abs(a[1] - b[1]) < STRAIGHT and abs(a[0] - b[0]) > 0.1]
    xs, ys = [x for x, _ in corners], [y for _, y in corners]
    width = max(xs) - min(xs)
    middle = 0.5 * (max(xs) + min(xs))
    # The two sides of the slit are the longest upright edges strictly inside, right of the middle.
    inside = sorted(
        (e for e in upright if middle + 1 < e[0][0] < max(xs) - 1),
        key=lambda e: -abs(e[0][1] - e[1][1]),
    )
    sides = sorted(inside[:2], key=lambda e: e[0][0])
    near, far = (side[0][0] for side in sides)
    # The underside of the hook is the level edge around the middle at y = 0; the lower edge is far below.
    under = min(level, key=lambda e: abs(0.5 * (e[0][1] + e[1][1])) + abs(0.5 * (e[0][0] + e[1][0]) - middle))
    # The neck's other side: the upright end of the cut-out.
    others = [e[0][0] for e in upright if min(xs) + 1 < e[0][0] < near - STRAIGHT and max(e[0][1], e[1][1]) < min(max(s[0][1], s[1][1]) for s in sides) - 1]
    neck = near - max(others)
    end = min(min(s[0][1], s[1][1]) for s in sides)
    top = max(max(s[0][1], s[1][1]) for s in sides[:1])
    # Material lies left of the near side and right of the far side, so both move towards it during the cut.
    return {
        "width": width - 2 * burnt,
        "overhang": abs(under[0][0] - under[1][0]),
        "neck": neck - 2 * burnt,
        "slit_gap": far - near + 2 * burnt,
        # Measured at the near side, from the face: the slit's corner there shifts with the slope of the face, and its end burns down.
        "slit_depth": top - end + shift(corners, (near, top), burnt),
        "dowel": sum(holes) / len(holes) + 2 * burnt,
        "height": max(ys) - min(ys),
    }


def shift(corners: list[tuple[float, float]], at: tuple[float, float], burnt: float) -> float:
    """The cut's addition to the slit's depth: its end goes down by `burnt`, its upper corner along the mitre of face and
    side."""
    if burnt == 0:
        return 0.0
    k = min(range(len(corners)), key=lambda k: abs(corners[k][0] - at[0]) + abs(corners[k][1] - at[1]))
    # One of the two neighbours is the slit's end, straight below; the other lies on the face.
    face = next(p for p in (corners[k - 1], corners[(k + 1) % len(corners)]) if abs(p[0] - at[0]) > STRAIGHT)
    dx, dy = at[0] - face[0], at[1] - face[1]
    length = (dx * dx + dy * dy) ** 0.5
    # The face's line moved in by `burnt`, met by the side moved left by `burnt`.
    slope = dy / dx
    down = burnt * length / abs(dx)
    corner = at[1] - down - slope * burnt
    return (corner - at[1]) + burnt


def main(program: str, design: str) -> None:
    with tempfile.TemporaryDirectory() as home:
        out = Path(home) / "out"
        done = subprocess.run([program, "latch", design, "-o", out, "--json"], check=True, capture_output=True, text=True)
        report = json.loads(done.stdout)["design"]
        part, holes = read(out / "front.dxf", "PART")
        cut, cut_holes = read(out / "front-cut.dxf", "CUT")
        for name in ("back", "separator"):
            read(out / f"{name}.dxf", "PART")
            read(out / f"{name}-cut.dxf", "CUT")
    wanted = {key: report[key] for key in ("width", "overhang", "neck", "slit_gap", "slit_depth", "dowel")}
    faults, worst = [], {}
    for when, found in (
        ("the part", measure(part, holes, 0.0)),
        ("the cut sheet", measure(cut, cut_holes, 0.5 * report["kerf"])),
    ):
        for key, value in wanted.items():
            off = abs(found[key] - value)
            worst[when] = max(worst.get(when, 0.0), off)
            if off > NEAR:
                faults.append(f"{when}: {key} is {found[key]:.4f} mm, not {value} mm")
    wider = max(x for x, _ in cut) - min(x for x, _ in cut) - report["width"]
    if abs(wider - report["kerf"]) > NEAR:
        faults.append(f"the cut line is {wider:.4f} mm wider than the part, not a kerf")
    if faults:
        sys.exit("\n".join(faults))
    deviations = ", ".join(f"{when} within {off:.5f} mm" for when, off in worst.items())
    print(f"width, overhang, neck, slit gap, slit depth and dowels: {deviations}")


if __name__ == "__main__":
    main(*sys.argv[1:])
