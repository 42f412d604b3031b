"""The fields of the JSON reports: their paths from the snapshot that a test holds the program to, their types from what the program prints, their
meaning from the documentation of the structs that it prints.

A path whose value is of several types in these reports says so; `null` stands for "not there", and what was null in all of them says only that.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import tempfile
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SNAPSHOT = ROOT / "crates/catchment-cli/tests/cli/snapshots/cli__wire__fields.snap"

V_FACE = '[connector]\nfamily = "v-face"\naspect_ratio = 1.0\n[alignment]\nrotation_length = 1.0\n'
SEEN = "line,x,pitch,outcome\n1,0.1,0,jammed\n1,0.2,0,aligned\n1,0.9,0,missed\n"
RUN = "run v.toml --resolution 8 --samples 50"
BENCH = "--accuracy x=0.01,pitch=0.01"
#: A report of every kind, small: those of the snapshot (crates/catchment-cli/tests/cli/wire.rs), and more where a field is null in them.
CALLS = {
    "run": [f"{RUN} --method {method}" for method in ("flood --error-sigma x=0.1", "confluence", "partition", "certified")],
    "check": ["check v.toml", "check wrong.toml"],
    "outcome": ["outcome v.toml --poses poses.csv"],
    "trace": ["trace v.toml --pose x=0.2", "trace v.toml --pose x=0.2 --method drop"],
    "kinematic-contact": ["trace x.toml --cor=-0.5 --pose x=0.2,pitch=0.2 --method kinematic"],
    "zraa": ["zraa v.toml"],
    "zraa-faces": ["zraa v.toml x.toml"],
    "window": ["window v.toml --motions 100"],
    "success": ["success v.toml --error-sigma x=0.3 --motions 100"],
    "jams": ["jams v.toml --motions 100 --error-sigma x=0.1"],
    "friction": ["friction v.toml --frictions 0.1 --motions 100"],
    "rests": ["rests v.toml --motions 100"],
    "hold": ["hold v.toml --friction 0.2 --preload 40"],
    "chance": [
        "chance v.toml --draw speed=1 --trials 2 --overall 100 --pose x=0.1 --map x,pitch --cells 2 --times 2",
        "chance v.toml --draw speed=1 --trials 2 --pose x=0.1 --preset gazebo-2014",
    ],
    "plan": [f"plan v.toml --pattern bracket --trials 8 {BENCH}"],
    "validate": [f"validate seen.csv v.toml --estimate-friction {BENCH}"],
    "slices": ["slices v.toml --resolution 8"],
    "convergence": ["run v.toml --converge --time-limit 0.001ms"],
    "sensitivity": ["run v.toml --sensitivity --samples 50"],
    "comparison": ["compare v.toml --methods descent,flood --resolution 8"],
    "methods": [f"{RUN} --method all"],
    "export": ["export v.toml --pose x=0.1 -o trial"],
    "solids": ["solids v.toml"],
    "trials": ["zraa v.toml --beside descent --resolution 4"],
}

#: What stands in reports of their own, and is not computed again here for its type: null elsewhere.
ASKED_FOR = {"run": {".jams": "table", ".window": "table"}}
#: The fields that stand at the top of every report.
HEAD = {
    "schema": "Version of the format.",
    "catchment": "Version of the program.",
    "kind": "Which report this is.",
    "design": "The design, resolved: lengths in D, angles in radians.",
    "warnings": "What speaks against the numbers: a code and a sentence each.",
    "timing": "Wall-clock time and threads; null where nothing is computed for long. Never compared.",
}
#: Said better here, for those who do not know the library.
SAID = {
    "onaa": "The largest box in the proportions of the error box whose cells all dock; null without a grid.",
    "centered": "The largest such box around zero.",
    "settings": "The method's settings, as they were used.",
}
#: Of reports whose structs have no words of their own for it: enums, and what is printed from several places.
SAID_OF = {
    "outcome": {
        "method": "Name of the method that decided.",
        "counts": "How many poses met each outcome.",
        "poses": "Every pose in the order of the table: its error, outcome, where it ends, how high, what touches there.",
    },
    "zraa": {
        "axis": "x or y: the one free translation. With both free the fields are others: `area_d2`, `onaa_center_d`, `polygons_d` …",
        "from_d": "Lower end of the offsets that are corrected.",
        "to_d": "Upper end.",
        "length_d": "From one to the other.",
        "circle_length_d": "Bounds of the length for the circle that a polygon stands for; null where nothing is round.",
        "onaa_d": "The ONAA, counted in D: of one translation the length itself.",
        "nilsson": "Nilsson's bounds; null where the halves do not meet along one profile.",
    },
}


def structs() -> tuple[dict[str, str], dict[str, str]]:
    """Of the library's sources: the body of every struct by its name, those of reports first, and the name of the struct of every kind of report."""
    bodies: dict[str, str] = {}
    kinds: dict[str, str] = {}
    crates = [ROOT / "crates" / name / "src" for name in ("catchment-report", "catchment-core", "catchment-study")]
    files = [file for crate in crates for file in sorted(crate.rglob("*.rs"), key=lambda path: ("figure" in path.parts or "page" in path.parts, str(path)))]
    for path in files:
        text = path.read_text(encoding="utf-8")
        for name, body in re.findall(r"^pub(?:\([a-z]+\))? struct (\w+)(?:<[^>]*>)? \{\n(.*?)^\}", text, re.M | re.S):
            bodies.setdefault(name, body)
        for head, body in re.findall(r"^impl([^\n]*)\{\n(.*?)^\}", text, re.M | re.S):
            if found := re.search(r'const KIND: &\'static str = "([^"]+)"', body):
                kinds.setdefault(found[1], re.search(r"for (?:\w+::)*(\w+)", head)[1])
    return bodies, kinds


def meanings(bodies: dict[str, str], name: str) -> dict[str, str]:
    """What the documentation of a struct says of its fields; what is flattened into it counts as its own."""
    found: dict[str, str] = {}
    for block in re.findall(r"((?:^    (?:///|#\[)[^\n]*\n)*)^    (?:pub(?:\([a-z]+\))? )?(r#)?(\w+): ([^\n]+),$", bodies.get(name, ""), re.M):
        above, _, field, of = block
        if "flatten" in above:
            found |= meanings(bodies, re.findall(r"\w+", of)[-1])
            continue
        if renamed := re.search(r'rename = "(\w+)"', above):
            field = renamed[1]
        said = " ".join(line.strip()[4:] for line in above.splitlines() if line.strip().startswith("///"))
        found[field] = re.sub(r"\[`([^`\]]+)`\](?:\([^)]*\))?", r"`\1`", said)
    return found


def json_type(value: object) -> str:
    if value is None:
        return "null"
    if isinstance(value, bool):
        return "bool"
    if isinstance(value, int):
        return "integer"
    return {float: "number", str: "text", list: "list", dict: "table"}[type(value)]


def walk(value: object, path: str) -> Iterator[tuple[str, str]]:
    """Path and type of everything in a report; of `settings` only that it is there."""
    if isinstance(value, dict):
        for name, inner in value.items():
            yield f"{path}.{name}", json_type(inner)
            if name != "settings":
                yield from walk(inner, f"{path}.{name}")
    elif isinstance(value, list):
        for inner in value:
            yield f"{path}[]", json_type(inner)
            yield from walk(inner, f"{path}[]")


def reports(program: str, calls: dict[str, list[str]]) -> dict[str, list[object]]:
    with tempfile.TemporaryDirectory() as home:
        folder = Path(home)
        (folder / "v.toml").write_text(V_FACE)
        (folder / "wrong.toml").write_text(V_FACE.replace("v-face", "v-fac"))
        (folder / "x.toml").write_text((ROOT / "designs/x-face.toml").read_text(encoding="utf-8"))
        (folder / "poses.csv").write_text("x,pitch\n0.1,0.2\n")
        (folder / "seen.csv").write_text(SEEN)

        def report(words: str) -> object:
            done = subprocess.run([os.path.abspath(program), *words.split(), "--json"], capture_output=True, text=True, cwd=folder, check=False)
            if not done.stdout:
                raise SystemExit(f"site/report_fields.py: {words}\n{done.stderr}")
            return json.loads(done.stdout)

        with ThreadPoolExecutor(os.cpu_count()) as pool:
            said = {words: pool.submit(report, words) for kind in calls.values() for words in kind}
        return {kind: [said[words].result() for words in every] for kind, every in calls.items()}


def snapshot() -> dict[str, list[str]]:
    """The paths of every kind; of a kind that is printed twice those of both."""
    listed = SNAPSHOT.read_text(encoding="utf-8").split("---\n", 2)[2].rstrip()
    paths: dict[str, list[str]] = {}
    for block in re.split(r"\n(?=\S)", listed):
        kind, *below = (line.strip() for line in block.splitlines())
        found = paths.setdefault(kind, [])
        found += [path for path in below if path not in found]
    return paths


def named(types: dict[str, set[str]], path: str) -> str:
    """Types of a path's values; an integer among numbers is a number."""
    found = set(types.get(path, ()))
    if {"integer", "number"} <= found:
        found.remove("integer")
    inner = named(types, f"{path}[]") if "list" in found and f"{path}[]" in types else ""
    words = sorted(found - {"null"}) + (["null"] if "null" in found else [])
    return ", ".join(f"list of {inner}" if word == "list" and inner else word for word in words)


def sections(program: str) -> str:
    """A table of the top and a list of everything below, for every kind."""
    text = ""
    unsaid = []
    found = reports(program, CALLS)
    bodies, kinds = structs()
    for kind, paths in snapshot().items():
        types: dict[str, set[str]] = {}
        for report in found[kind]:
            for path, of in walk(report, ""):
                types.setdefault(path, set()).add(of)
        for path, of in ASKED_FOR.get(kind, {}).items():
            types.setdefault(path, set()).add(of)
        said = meanings(bodies, kinds.get(kind, "")) | SAID | SAID_OF.get(kind, {}) | HEAD
        text += f"\n## {kind}\n\n| field | type | what it says |\n|---|---|---|\n"
        for path in paths:
            name = path[1:]
            if re.fullmatch(r"\w+", name):
                meaning = said.get(name, "").replace("|", "\\|")
                if not meaning:
                    unsaid.append(f"{kind}.{name}")
                text += f"| `{name}` | {named(types, path)} | {meaning} |\n"
        text += '\n??? note "Every field"\n\n    ```text\n'
        width = max(len(path) for path in paths)
        for path in paths:
            of = named(types, path)
            if not of:
                unsaid.append(f"{kind}{path} (type)")
            text += f"    {path.ljust(width)}  {of}\n"
        text += "    ```\n"
    if unsaid:
        raise SystemExit(f"site/report_fields.py says nothing of {', '.join(unsaid)}")
    return text
