"""The fields of the JSON reports, from their JSON schema: crates/catchment-report/reports.schema.json, which a test derives from the types that the
program serialises.

The design and the settings, which many reports contain, are described once.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
SCHEMA = ROOT / "crates/catchment-report/reports.schema.json"
Node = dict[str, Any]

DEFINITIONS: dict[str, Node] = json.loads(SCHEMA.read_text(encoding="utf-8"))["$defs"]
#: Described once, in separate sections.
SHARED = {"design": "Design"}
NAMES = {"number": "number", "integer": "integer", "string": "text", "boolean": "bool", "object": "table", "null": "null"}


def kinds() -> list[str]:
    """The kinds of reports, each by the name of its definition."""
    return sorted(name for name, node in DEFINITIONS.items() if {"schema", "catchment", "kind"} <= node.get("properties", {}).keys())


def is_report(node: Any) -> bool:
    """Whether a schema node holds a whole report, which has its own section."""
    return any("kind" in one.get("properties", {}) and "timing" in one.get("properties", {}) for one in alternatives(node))


def alternatives(node: Any, depth: int = 0) -> Iterator[Node]:
    """The permitted content of a schema node, with references resolved."""
    if not isinstance(node, dict) or depth > 32:
        return
    inner = [DEFINITIONS[node["$ref"].removeprefix("#/$defs/")]] if "$ref" in node else []
    inner += [choice for key in ("anyOf", "oneOf", "allOf") for choice in node.get(key, [])]
    if not inner or "properties" in node:
        yield node
    for choice in inner:
        yield from alternatives(choice, depth + 1)


def types(node: Any) -> str:
    """The types of a schema node: `list of number, null`."""
    found: list[str] = []
    for one in alternatives(node):
        listed = one.get("type", "string" if "const" in one or "enum" in one else [])
        for of in [listed] if isinstance(listed, str) else listed:
            items = one.get("items") or (one.get("prefixItems") or [{}])[0]
            name = f"list of {types(items)}" if of == "array" else NAMES[of]
            if name not in found:
                found.append(name)
    return ", ".join([name for name in found if name != "null"] + ["null"] * ("null" in found)) or "any"


def below(node: Any) -> Iterator[tuple[str, Any]]:
    """The fields of a schema node with their names; those of a map under `*`."""
    seen: set[str] = set()
    for one in alternatives(node):
        for name, inner in one.get("properties", {}).items():
            if name not in seen:
                seen.add(name)
                yield name, inner
        for inner in [*one.get("patternProperties", {}).values(), one.get("additionalProperties")]:
            if isinstance(inner, dict) and "*" not in seen:
                seen.add("*")
                yield "*", inner


def walk(node: Any, path: str, depth: int = 0) -> Iterator[tuple[str, str]]:
    """Path and types of every field below a schema node; a shared object appears only by its path."""
    for name, inner in below(node):
        here = f"{path}.{name}"
        yield here, types(inner)
        if name in (*SHARED, "settings") or is_report(inner):
            continue
        yield from within(inner, here, depth)


def within(node: Any, path: str, depth: int) -> Iterator[tuple[str, str]]:
    yield from walk(node, path, depth + 1)
    for one in alternatives(node):
        items = one.get("items")
        if isinstance(items, dict) and list(below(items)):
            yield from walk(items, f"{path}[]", depth + 1)


def meaning(node: Any) -> str:
    """The first paragraph of a description, without Rust links."""
    description = node.get("description", "") if isinstance(node, dict) else ""
    words = re.sub(r"\[`([^`\]]+)`\](?:\([^)]*\))?", r"`\1`", description.split("\n\n")[0].replace("\n", " "))
    return words.replace("|", "\\|")


def table(node: Any, heading: str) -> str:
    """A table of the top-level fields and a list of all fields below."""
    text = f"\n## {heading}\n\n| field | type | meaning |\n|---|---|---|\n"
    silent = []
    for name, inner in below(node):
        shown = f"see [{name}](#{name})" if name in SHARED and heading != name else meaning(inner)
        if not shown:
            silent.append(f"{heading}.{name}")
        text += f"| `{name}` | {types(inner)} | {shown} |\n"
    if silent:
        raise SystemExit(f"site/report_fields.py: no documentation of {', '.join(silent)}")
    paths = list(walk(node, ""))
    width = max(len(path) for path, _ in paths)
    listed = "\n".join(f"    {path.ljust(width)}  {of}" for path, of in paths)
    return text + f'\n??? note "Every field"\n\n    ```text\n{listed}\n    ```\n'


def sections() -> str:
    """A section for every kind of report, and one for their shared objects."""
    text = "".join(table(DEFINITIONS[kind], kind) for kind in kinds())
    return text + "".join(table(DEFINITIONS[name], key) for key, name in SHARED.items())
