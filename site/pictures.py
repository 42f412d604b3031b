"""The pictures of docs/, each drawn by the command listed here.

    python3 site/pictures.py target/release/catchment                  draws all of them again (minutes)
    python3 site/pictures.py target/release/catchment plan validate    only those whose names begin with these words
    python3 site/pictures.py --check target/debug/catchment [DRAWN]    lists those that the program now draws differently; a PNG of its name in
                                                                       the folder DRAWN saves the drawing where it is the same

site/pictures.json has digests of every picture: of its PNG in docs/, of the SVG that it is drawn from, and of the words in it. A picture is out of date if its
words differ, or more than a thousandth of its pixels: sines of another system's library may differ in their last bits. The pictures of the viewer come from a
browser; this script does not draw them.
"""

import hashlib
import json
import os
import re
import shlex
import struct
import subprocess
import sys
import tempfile
import zlib
from pathlib import Path

from gallery import as_on_the_page

ROOT = Path(__file__).resolve().parent.parent
DOCS = ROOT / "docs"
DIGESTS = ROOT / "site/pictures.json"
#: As a share of its pixels.
CLOSE = 1e-3

#: The commands of a picture, run in a folder that contains only designs/. PICTURE is its file; without PICTURE the last line is its path in a
#: folder.
PICTURES = {
    "catalog": ["catalog -o PICTURE"],
    "chain": ["chain designs/systems/p-sequence.toml -o PICTURE"],
    "chance": [
        "dynamics designs/v-face.toml --draw 'speed=2 ± 0.4' --draw 'drift_x=0 ± 1' --draw height=0.3 --draw friction=0.1..0.3 "
        "--error-sigma 'x=0.2,pitch=20 deg' --times 0.01,0.1,3 --samples 200 --map x,pitch --resolution 10 --trials 6 -o PICTURE"
    ],
    "chance-trace": [
        "trace designs/v-face.toml --pose x=0.45 --method drop --damping 10 --push 20 --speed 2 --drift 1,0 --drop-height 0.3 --friction 0.1 -o PICTURE"
    ],
    "compose": [
        "compose designs/systems/hook.toml designs/systems/loop.toml --keep-out designs/systems/boat.toml,designs/systems/boat.toml "
        "--heading '-20..20 deg' -o PICTURE"
    ],
    "first-dock-pair": [
        "place designs/meshes/grid-baseplate.stl designs/meshes/grid-cup.stl --unit mm --free x,y,yaw -o my.toml --figure PICTURE"
    ],
    "first-dock": [
        "place designs/meshes/grid-baseplate.stl designs/meshes/grid-cup.stl --unit mm --free x,y,yaw -o my.toml",
        "run my.toml -o out",
        "out/sampled",
    ],
    "flooding": [
        "run designs/v-face.toml --aspect-ratio 0.5 --cor=-0.5 --method meyer --resolution 100 --samples 0 -o out",
        "out/watersheds",
    ],
    "friction": ["friction designs/pyramid.toml --samples 500 -o PICTURE"],
    "hold": ["hold designs/x-face-3d.toml --preload 40 --friction 0.2 -o PICTURE"],
    "invert": ["invert designs/pyramid.toml --heights designs/systems/wanted-bowl.csv -o PICTURE"],
    "jams": ["rests designs/v-face.toml --jams -o PICTURE"],
    "latch": ["latch designs/systems/latch.toml -o out", "out/latch"],
    "overview": ["run designs/v-face.toml -o out", "out/overview"],
    "parts": ["check designs/pyramid-assembled.toml -o PICTURE"],
    "place": [
        "place designs/meshes/assembled-socket.obj designs/meshes/assembled-plug.ply --unit mm -o design.toml --figure PICTURE"
    ],
    "plan": [
        "plan designs/bench-pyramid-arc.toml --pattern arc --lever '72.9 mm' --pitch '0..45:2.25 deg' --yaw '0,20 deg' "
        "--repeatability 'x=1.2 mm,pitch=0.5 deg' -o PICTURE"
    ],
    "planar-faces": ["zraa designs/s-face.toml designs/v-face.toml designs/x-face.toml -o PICTURE"],
    "planar-levers": [
        "trace designs/x-face.toml --aspect-ratio 0.5 --cor=-1 --method kinematic --pose 'x=-0.3,pitch=15 deg' -o PICTURE"
    ],
    "rests": ["rests designs/v-face.toml -o PICTURE"],
    "solids-swept": ["solids designs/v-face.toml --free x,pitch --slices 15 --shape swept -o PICTURE"],
    "solids-v-face-pitch": ["solids designs/v-face.toml --free x,pitch --slices 15 -o PICTURE"],
    "solids-v-face": ["solids designs/v-face.toml --free x -o PICTURE"],
    "solids-x-face-3d": ["solids designs/x-face-3d.toml --free x,y -o PICTURE"],
    "success": ["success designs/v-face.toml --error-sigma 'x=0.15,pitch=15 deg' -o PICTURE"],
    "sweep": [
        "sweep designs/v-face.toml --over aspect_ratio=0.25,0.5,1,2,3 --over cor=-1..1/5 --resolution 60 --samples 100 -o out",
        "out/outlines",
    ],
    "trials": ["zraa designs/x-face-3d.toml --beside drop --resolution 11,21 -o PICTURE"],
    "validate": [
        "validate designs/trials/pyramid-arc.csv designs/bench-pyramid-arc.toml --repeatability 'x=1.2 mm,pitch=0.5 deg' -o PICTURE"
    ],
}
#: Pictures that a browser draws.
BROWSER = "viewer-"


def commands() -> dict[str, list[str]]:
    """The pictures of docs/ and of the gallery."""
    known = dict(PICTURES)
    for design in sorted((ROOT / "designs/gallery").glob("*.toml")):
        options = " ".join(as_on_the_page(design))
        known[f"gallery/{design.stem}"] = [f"run designs/gallery/{design.name} {options} -o out", "out/overview"]
    return known


def drawn(program: str, steps: list[str], kind: str) -> bytes:
    """A picture as `png` or `svg`."""
    with tempfile.TemporaryDirectory() as home:
        folder = Path(home)
        (folder / "designs").symlink_to(ROOT / "designs")
        file = folder / f"picture.{kind}"
        for step in steps:
            if step.startswith("out/"):
                file = folder / f"{step}.{kind}"
            else:
                call(program, step.replace("PICTURE", file.name), folder)
        # A design with one free error has no map, and so no overview.
        return (file if file.exists() else file.with_name(f"solids.{kind}")).read_bytes()


def call(program: str, command: str, folder: Path) -> None:
    words = [os.path.abspath(program), *shlex.split(command)]
    done = subprocess.run(words, capture_output=True, text=True, cwd=folder, check=False)
    # 1: a verdict.
    if done.returncode not in (0, 1):
        raise SystemExit(f"{command}: exit {done.returncode}\n{done.stderr}")


def digest(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()[:16]


def words_of(svg: bytes) -> str:
    """A digest of all text in a picture."""
    return digest(b"\n".join(re.findall(rb"<text [^>]*>([^<]*)</text>", svg)))


def pixels(png: bytes) -> tuple[int, int, list[bytes]]:
    """Width, height and rows of an 8-bit PNG without interlacing, four channels."""
    width, height, depth, colour = struct.unpack(">IIBB", png[16:26])
    if (depth, colour) != (8, 6):
        raise SystemExit("a picture is no PNG of 8 bits and four channels")
    data, at = b"", 8
    while at < len(png):
        length, kind = struct.unpack(">I4s", png[at : at + 8])
        data += png[at + 8 : at + 8 + length] if kind == b"IDAT" else b""
        at += 12 + length
    raw, stride = zlib.decompress(data), 4 * width
    rows, above = [], bytearray(stride)
    for y in range(height):
        kind, row = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1 : (y + 1) * (stride + 1)])
        for x in range(stride) if kind else ():
            left, up, corner = (row[x - 4], above[x], above[x - 4]) if x >= 4 else (0, above[x], 0)
            if kind == 1:
                guess = left
            elif kind == 2:
                guess = up
            elif kind == 3:
                guess = (left + up) // 2
            else:
                guess = min((left, up, corner), key=lambda value: abs(left + up - corner - value))
            row[x] = (row[x] + guess) & 255
        rows.append(bytes(row))
        above = row
    return width, height, rows


def difference(old: bytes, new: bytes) -> float:
    """The share of pixels that differ; 1 for different sizes."""
    if old == new:
        return 0.0
    (width, height, a), (other_width, other_height, b) = pixels(old), pixels(new)
    if (width, height) != (other_width, other_height):
        return 1.0
    rows = ((p, q) for p, q in zip(a, b) if p != q)
    differ = sum(p[x : x + 4] != q[x : x + 4] for p, q in rows for x in range(0, 4 * width, 4))
    return differ / (width * height)


def kept_digests() -> dict[str, dict[str, str]]:
    return json.loads(DIGESTS.read_text(encoding="utf-8")) if DIGESTS.exists() else {}


def doubt(program: str, name: str, steps: list[str], stored: dict[str, str], already: Path | None) -> str | None:
    """The reasons why a picture is out of date."""
    kept = (DOCS / f"{name}.png").read_bytes()
    if digest(kept) != stored.get("png"):
        return "is not the one that was drawn"
    if already and already.exists() and already.read_bytes() == kept:
        return None
    svg = drawn(program, steps, "svg")
    if digest(svg) == stored["svg"]:
        return None
    if words_of(svg) != stored["words"]:
        return "has other words now"
    share = difference(kept, drawn(program, steps, "png"))
    return f"has other pixels now, {100 * share:.1f} %" if share > CLOSE else None


def check(program: str, drawn_already: Path | None) -> None:
    known, stored = commands(), kept_digests()
    there = {str(path.relative_to(DOCS).with_suffix("")) for path in DOCS.rglob("*.png") if not path.name.startswith(BROWSER)}
    wrong = [f"docs/{name}.png: no command draws it; write one into site/pictures.py" for name in sorted(there - set(known))]
    wrong += [f"docs/{name}.png is missing: python3 site/pictures.py {program} {name}" for name in sorted(set(known) - there)]
    names = sorted(there & set(known))
    for name in names:
        already = drawn_already and drawn_already / f"{name}.png"
        if reason := doubt(program, name, known[name], stored.get(name, {}), already):
            wrong.append(f"docs/{name}.png {reason}: python3 site/pictures.py {program} {name}")
    if wrong:
        raise SystemExit("\n".join(wrong))
    print(f"pictures: {len(names)} are as the program draws them")


def main() -> None:
    args = sys.argv[1:]
    if args[:1] == ["--check"] and len(args) in (2, 3):
        check(args[1], Path(args[2]) if len(args) == 3 else None)
        return
    if not args or args[0].startswith("-"):
        raise SystemExit(__doc__)
    stored = kept_digests()
    for name, steps in commands().items():
        if len(args) > 1 and not any(name.startswith(begin) for begin in args[1:]):
            continue
        png, svg = drawn(args[0], steps, "png"), drawn(args[0], steps, "svg")
        (DOCS / f"{name}.png").write_bytes(png)
        stored[name] = {"png": digest(png), "svg": digest(svg), "words": words_of(svg)}
        DIGESTS.write_text(json.dumps(stored, indent=1, sort_keys=True) + "\n", encoding="utf-8")
        print(name, flush=True)


if __name__ == "__main__":
    main()
