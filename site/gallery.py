"""The gallery: runs every design of designs/gallery and writes its numbers, its picture and the page.

    python3 site/gallery.py target/release/catchment            all of it, again (minutes)
    python3 site/gallery.py target/release/catchment peg-in-hole    one of them
    python3 site/gallery.py --page                              only docs/gallery.md, from the numbers that are stored
    python3 site/gallery.py --check                             lists outdated entries; does not run the program
    python3 site/gallery.py --check target/release/catchment [DRAWN]
                                                                runs all of them, too: their numbers and warnings must equal the stored ones;
                                                                their pictures go into the folder DRAWN/gallery

The numbers are stored in site/gallery.json beside the SHA-256 of their design, and of the files that it names.
"""

import hashlib
import json
import os
import re
import subprocess
import sys
import tempfile
from math import degrees, isclose, prod
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
DESIGNS = ROOT / "designs/gallery"
NUMBERS = ROOT / "site/gallery.json"
PICTURES = ROOT / "docs/gallery"
PAGE = ROOT / "docs/gallery.md"

RUN = ["--samples", "1000"]
CELLS = {1: "200", 2: "60", 3: "20"}
WINDOW = ["--motions", "1000"]
#: Sines of another system's library may differ in their last bits.
CLOSE = 1e-9


def named(text: str) -> list[str]:
    """The meshes and drawings that a design names."""
    return sorted(set(re.findall(r'"(meshes/[^"]+)"', text)))


def digest(design: Path) -> str:
    """The digest of a design file and of the meshes and drawings that it names."""
    text = design.read_text(encoding="utf-8")
    whole = hashlib.sha256(text.encode())
    for name in named(text):
        whole.update((DESIGNS / name).read_bytes())
    return whole.hexdigest()


def call(program: str, command: str, design: Path, *args: str) -> dict:
    """The report of a command."""
    words = [os.path.abspath(program), command, str(design.relative_to(ROOT)), *args, "--json"]
    done = subprocess.run(words, capture_output=True, text=True, cwd=ROOT)
    if done.returncode != 0:
        raise SystemExit(f"{' '.join(words)}\n{done.stderr}")
    return json.loads(done.stdout)


def as_on_the_page(design: Path) -> list[str]:
    """The options of `run` for the numbers of the page."""
    free = re.search(r"^free = \[(.*)\]", design.read_text(encoding="utf-8"), re.M)[1]
    return ["--resolution", CELLS[free.count('"') // 2], *RUN]


def ran(program: str, design: Path, pictures: Path) -> dict:
    """The numbers of a run; saves its picture in a folder."""
    with tempfile.TemporaryDirectory() as home:
        run = call(program, "run", design, *as_on_the_page(design), "-o", f"{home}/out")
        for kind in ("overview", "solids"):
            picture = Path(home) / f"out/{kind}.png"
            if picture.exists():
                (pictures / f"{design.stem}.png").write_bytes(picture.read_bytes())
                break
    return keep(run)


def measured(program: str, design: Path) -> dict:
    """The program's results for a design; saves its picture in docs/gallery."""
    run, window = ran(program, design, PICTURES), call(program, "window", design, *WINDOW)
    return {"digest": digest(design), "run": run, "window": keep_window(window)}


def keep(run: dict) -> dict:
    found = run["acceptance"]
    names = ["sum", "sum_ci95", "fraction", "cells", "outcomes"]
    return {
        "name": run["design"]["name"],
        "width": run["design"]["width"],
        "unit": run["design"]["unit"],
        "box": {axis["axis"]: axis["hi"] for axis in run["axes"]},
        "measure": prod(axis["hi"] - axis["lo"] for axis in run["axes"]),
        **{name: found[name] for name in names},
        "alone": {
            side["axis"]: [
                min(side["minus"], side["plus"]),
                side["minus_reaches_border"] and side["plus_reaches_border"],
            ]
            for side in run["tolerances"]
        },
        "warnings": [warning["message"] for warning in run["warnings"]],
    }


def keep_window(window: dict) -> dict:
    worst = window["worst"]
    return {
        "half_widths": {side["axis"]: side["half_width"] for side in window["sides"]},
        "tightest": window["tightest"],
        "worst": None if worst is None else worst["outcome"],
        "motions": window["certificate"]["motions"],
        "failing_at_most": window["certificate"]["failing_at_most"],
    }


ENDS = {"jammed": "jams", "missed": "misses", "undecided": "could not be followed to its end"}


def plus_minus(value: float, axis: str, width: float, unit: str) -> str:
    """A length in the unit of the design, an angle in degrees."""
    if axis in ("x", "y"):
        return f"±{value * width:.3g} {unit}"
    return f"±{degrees(value):.3g}°"


def entry(stem: str, design: Path, found: dict) -> str:
    run, window = found["run"], found["window"]
    width, unit = run["width"], run["unit"]
    text = design.read_text(encoding="utf-8")
    comment = []
    for line in text.splitlines():
        if line.startswith("# "):
            comment.append(line[2:])
        elif not line.startswith("#:"):
            break
    words = " ".join(comment)
    about, _, source = words.partition(" Source: ")
    rows = []
    for axis, (least, reaches) in run["alone"].items():
        at_border = "*" if reaches else ""
        whole = plus_minus(window["half_widths"][axis], axis, width, unit)
        tried = plus_minus(run["box"][axis], axis, width, unit)
        rows.append(f"| {axis} | {tried} | {plus_minus(least, axis, width, unit)}{at_border} | {whole} |")
    low, high = (100 * bound / run["measure"] for bound in run["sum_ci95"])
    counts = run["outcomes"]
    share = lambda name: f"{100 * counts[name] / run['cells']:.0f} %"
    worst = window["worst"]
    ends = "" if worst is None else (
        f" The nearest pose beyond it {ENDS[worst]}; the tightest error is {window['tightest']}.")
    warnings = "".join(f"\n\n    {' '.join(warning.split())}" for warning in run["warnings"])
    note = f"\n\n!!! note \"What the program adds\"{warnings}" if warnings else ""
    files = "".join(f", [{name}](../designs/gallery/{name})" for name in named(text))
    return f"""## {run["name"][0].upper() + run["name"][1:]}

{about}

*Source:* {source.replace("(docs/field.md)", "([docks in the field](field.md))").replace("(docs/field.md;", "([docks in the field](field.md);").replace("docs/field.md)", "[docks in the field](field.md))") if source else "typical."}

![{run["name"]}: both halves, the accepted set, heights of first contact](gallery/{stem}.png)

| error | tried up to | docks alone up to | all at once |
|---|---|---|---|
{chr(10).join(rows)}

{100 * run["sum"] / run["measure"]:.1f} % of the error box docks ({low:.1f} to {high:.1f} %, 95 %); of its cells {share("jammed")} jam and {share("missed")} miss. *All at once* up to the last column all of {f'{window["motions"]:,}'.replace(",", " ")} random poses docked: at
most {100 * window["failing_at_most"]:.1f} % of the poses in there fail, 95 %.{ends}{note}

[The design file](../designs/gallery/{stem}.toml){files}

??? example "designs/gallery/{stem}.toml"

    ```toml
{chr(10).join("    " + line if line else "" for line in text.rstrip().splitlines())}
    ```
"""


HEAD = """# Gallery

How much do connectors that you know forgive? Fifteen of them, each with its design file, its picture and its numbers. `site/gallery.py` writes this page from the program's
output: `run` with 20 cells per axis (60 of two, 200 of one) and 1 000 random poses, `window` with 1 000. Dimensions are real where a source is named, and typical where the source reads *typical*;
none of them is a maker's drawing. Everything here is without friction and without play in the approach: what docks here may stick in the field
([friction](friction.md)). A star marks an error that reaches the border of what was tried; *alone* means that the other errors are zero. All of them are in `designs/gallery/`. Terms: [glossary](glossary.md):

```console
$ catchment run designs/gallery/peg-in-hole.toml -o out
```
"""


def page(stored: dict) -> str:
    parts = [HEAD]
    for design in sorted(DESIGNS.glob("*.toml")):
        if design.stem not in stored:
            raise SystemExit(f"{design.stem} has no numbers yet: python3 site/gallery.py PROGRAM {design.stem}")
        parts.append(entry(design.stem, design, stored[design.stem]))
    return "\n".join(parts)


def stale(stored: dict) -> list[str]:
    """The outdated entries."""
    designs = {design.stem: design for design in DESIGNS.glob("*.toml")}
    wrong = [f"{stem}: there is no such design" for stem in stored if stem not in designs]
    for stem, design in designs.items():
        if stored.get(stem, {}).get("digest") != digest(design):
            wrong.append(f"{stem}: its numbers are of another design")
        if not (PICTURES / f"{stem}.png").exists():
            wrong.append(f"{stem}: it has no picture")
    if len(designs) < 15:
        wrong.append(f"{len(designs)} designs of fifteen")
    if not wrong and PAGE.read_text(encoding="utf-8") != page(stored):
        wrong.append("docs/gallery.md is another page: python3 site/gallery.py --page")
    return wrong


def others(stored: dict, program: str, pictures: Path) -> list[str]:
    """Designs whose results have changed."""
    pictures.mkdir(parents=True, exist_ok=True)
    wrong = []
    for stem in sorted(stored):
        now, then = ran(program, DESIGNS / f"{stem}.toml", pictures), stored[stem]["run"]
        again = f"python3 site/gallery.py {program} {stem}"
        if now["outcomes"] != then["outcomes"] or not isclose(now["sum"], then["sum"], rel_tol=CLOSE):
            wrong.append(f"{stem}: Sum {then['sum']:.6g}, {then['outcomes']} are stored, and the program computes "
                         f"{now['sum']:.6g}, {now['outcomes']}: {again}")
        if now["warnings"] != then["warnings"]:
            wrong.append(f"{stem}: its warnings have other words or numbers now: {again}")
    return wrong


def check(stored: dict, program: str | None, drawn: str | None) -> None:
    wrong = stale(stored)
    if program and not wrong:
        with tempfile.TemporaryDirectory() as home:
            wrong = others(stored, program, Path(drawn or home) / "gallery")
    if wrong:
        raise SystemExit("\n".join(wrong))
    print(f"gallery: {len(stored)} designs with their numbers, pictures and page{', all run again' if program else ''}")


def main() -> None:
    args = sys.argv[1:]
    stored = json.loads(NUMBERS.read_text(encoding="utf-8")) if NUMBERS.exists() else {}
    if args[:1] == ["--check"]:
        check(stored, *(args[1:] + [None, None])[:2])
        return
    if args != ["--page"]:
        if not args or args[0].startswith("-"):
            raise SystemExit(__doc__)
        PICTURES.mkdir(exist_ok=True)
        for design in sorted(DESIGNS.glob("*.toml")):
            if len(args) == 1 or design.stem in args[1:]:
                stored[design.stem] = measured(args[0], design)
                text = json.dumps(stored, indent=1, sort_keys=True, ensure_ascii=False)
                NUMBERS.write_text(text + "\n", encoding="utf-8")
                print(design.stem, flush=True)
    if len(args) == 1:
        # In the order of the stored numbers.
        PAGE.write_text(page(json.loads(NUMBERS.read_text(encoding="utf-8"))), encoding="utf-8")


if __name__ == "__main__":
    main()
