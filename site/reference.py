"""Generates the reference pages from the program itself.

    python3 site/reference.py target/debug/catchment            writes docs/reference/*.md
    python3 site/reference.py target/debug/catchment --check    lists those that differ from the program's current output

    cli.md           the --help text of every command
    design-file.md   every key of a design file, from `catchment schema`, which is generated from the one table of keys
    fields.md        every field of the JSON reports with its type (site/report_fields.py)
    python.md        every public name of the Python package, from its files (site/python_reference.py)
    measurements.md  rates that the benches stored (crates/catchment-core/benches/rates.json)
"""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import python_reference
import report_fields

ROOT = Path(__file__).resolve().parent.parent
PAGES = ROOT / "docs/reference"
MADE = "<!-- Written by site/reference.py; ./check compares it. -->\n\n"


def output(program: str, *args: str) -> str:
    """The program's output, independent of the terminal."""
    env = {**os.environ, "NO_COLOR": "1", "COLUMNS": "100"}
    done = subprocess.run([program, *args], capture_output=True, text=True, check=True, env=env)
    return "\n".join(line.rstrip() for line in done.stdout.splitlines()).strip() + "\n"


def cli(program: str) -> str:
    whole = output(program, "--help")
    names = re.findall(r"^  ([a-z]\w*)  ", whole, re.M)
    text = f"# Command line\n\n{MADE}```text\n{whole}```\n"
    for name in names:
        if name != "help":
            text += f"\n## catchment {name}\n\n```text\n{output(program, name, '--help')}```\n"
    return text


def cell(text: str) -> str:
    return " ".join(text.split()).replace("|", "\\|").replace("<", "&lt;")


def value_of(key: dict) -> str:
    """The permitted values of a key, in words."""
    if "enum" in key:
        return ", ".join(f"`{value}`" for value in key["enum"])
    if "anyOf" in key:
        return " or ".join(dict.fromkeys(value_of(one) for one in key["anyOf"]))
    kind = key.get("type", "")
    if kind == "string":
        units = re.search(r"\\s\*\(([^()]*\|[^()]*)\)\\s\*\$$", key.get("pattern", ""))
        names = units[1].split("|") if units else []
        return f'text such as `"5 {"mm" if "mm" in names else names[0]}"`' if names else "text"
    if kind in ("number", "integer"):
        low, high = key.get("minimum"), key.get("maximum")
        name = "whole number" if kind == "integer" else "number"
        return name if low is None else f"{name}, {low:g} to {high:g}"
    if kind == "array":
        least, most = key.get("minItems"), key.get("maxItems")
        items = value_of(key["items"]) if isinstance(key.get("items"), dict) else ""
        count = f"{least} × " if least and least == most else ""
        return f"list of {count}{items}" if items else "list"
    return {"boolean": "`true` or `false`", "object": "table"}.get(kind, kind)


def rows(table: dict, path: str) -> list[str]:
    found = []
    for name, key in table.get("properties", {}).items():
        words = cell(key.get("description", ""))
        found.append(f"| `{path}{name}` | {cell(value_of(key))} | {words} |")
        items = key.get("items", {})
        found += rows(key, f"{path}{name}.")
        if isinstance(items, dict):
            found += rows(items, f"{path}{name}[].")
    return found


def design_file(program: str) -> str:
    schema = json.loads(output(program, "schema"))
    text = f"""# Design file

{MADE}A design is a TOML file. `catchment new pyramid` prints a commented one, `catchment check` lists every error in one, each with its place, and
`#:schema` in its first line lets an editor check it while it is written (`catchment schema -o schema.json`, [the same here](../../designs/schema.json)). Numbers without a unit are in D (lengths) and radians
(angles); with one they are text: `"5 mm"`, `"10 deg"`. [Parts as their files have them](../parts.md) shows the keys of halves at work.
"""
    for name, key in schema["properties"].items():
        if key.get("type") != "object":
            continue
        text += f"\n## [{name}]\n\n{key.get('description', '')}\n\n| key | value | meaning |\n|---|---|---|\n"
        text += "\n".join(rows(key, f"{name}.")) + "\n"
    top = {"properties": {name: key for name, key in schema["properties"].items() if key.get("type") != "object"}}
    return text + "\n## Beside the tables\n\n| key | value | meaning |\n|---|---|---|\n" + "\n".join(rows(top, "")) + "\n"


def fields() -> str:
    return f"""# Fields of the JSON reports

{MADE}Every command with `--json` prints one object with the same head: `schema` (the version of the format), `catchment` (of the program) and `kind`. Lengths are in D and angles in
radians. [Versions](../versions.md) lists what may change. `[]` stands for the entries of a list and `*` for any name; *number* is a float, and *null* a missing value. The same as a
[JSON schema](../../crates/catchment-report/reports.schema.json), for validators and code generators; that of [design files](../../designs/schema.json) is another one.
""" + report_fields.sections()


def measurements() -> str:
    stored = json.loads((ROOT / "crates/catchment-core/benches/rates.json").read_text(encoding="utf-8"))
    text = f"""# Measurements

{MADE}Rates that the last `cargo bench -- --store` stored, in a table per bench, with the machine and the commit. `cargo bench` prints current rates beside the stored ones, and every
bench asserts its result before the rate counts. For the error of the methods see [accuracy](../accuracy.md) and [coverage](../accuracy-coverage.md);
for the guarantees that no method gives see [limits](../limits.md).
"""
    for name, bench in stored.items():
        text += f"\n## {name}\n\n{bench['machine']}, {bench['date']}, commit {bench['commit']}\n\n| benchmark | per second |\n|---|---:|\n"
        for what, rate in bench["per_second"].items():
            grouped = f"{rate:,.0f}".replace(",", " ")
            text += f"| {cell(what)} | {grouped} |\n"
    return text


def main() -> None:
    if len(sys.argv) not in (2, 3) or sys.argv[2:] not in ([], ["--check"]):
        raise SystemExit(__doc__)
    program = sys.argv[1]
    pages = {
        "cli.md": cli(program),
        "design-file.md": design_file(program),
        "fields.md": fields(),
        "python.md": python_reference.page(MADE),
        "measurements.md": measurements(),
    }
    if sys.argv[2:]:
        def stored(name: str) -> str:
            page = PAGES / name
            return page.read_text(encoding="utf-8") if page.exists() else ""

        if stale := [name for name, text in pages.items() if stored(name) != text]:
            raise SystemExit(f"docs/reference: {', '.join(stale)}: out of date; python3 site/reference.py {program}")
        print(f"reference: {len(pages)} pages as the program writes them")
        return
    PAGES.mkdir(exist_ok=True)
    for name, text in pages.items():
        (PAGES / name).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
