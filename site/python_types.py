"""Writes the types of reports in Python from their JSON schema:

    site/python_types.py [--check]

One TypedDict for every object of crates/catchment-report/reports.schema.json that a report of the package
contains, in crates/catchment-py/python/catchment/reports.py. With --check it compares and writes nothing.
"""

from __future__ import annotations

import keyword
import re
import sys
from typing import Any

from report_fields import DEFINITIONS, ROOT, meaning

TARGET = ROOT / "crates/catchment-py/python/catchment/reports.py"
#: The kinds of reports that the package returns.
KINDS = ["run", "window", "jams", "trace", "zraa", "methods", "comparison"]
NAMES = {"number": "float", "integer": "int", "string": "str", "boolean": "bool", "null": "None", "object": "dict[str, Any]"}
HEAD = '''"""Types of the JSON reports, for editors and type checkers: what `Report.to_dict()` returns.

Made from the JSON schema of reports by site/python_types.py; do not edit. Lengths are in D and angles in radians.
"""

from __future__ import annotations

import sys
from typing import Any, Literal, TypedDict

if sys.version_info >= (3, 11):
    from typing import NotRequired
else:
    from typing import Optional as NotRequired
'''


def class_name(name: str) -> str:
    """Converts `kinematic-contact` to `KinematicContact`."""
    return "".join(part[0].upper() + part[1:] for part in re.split(r"[-_]", name)) + ("Report" if name in KINDS else "")


class Types:
    def __init__(self) -> None:
        self.text: dict[str, str] = {}

    def of(self, node: Any, name: str) -> str:
        """The type of a schema node; `name` is the name of an object without its own title."""
        if not isinstance(node, dict):
            return "Any"
        if "$ref" in node:
            return self.named(node["$ref"].removeprefix("#/$defs/"))
        if "const" in node:
            return f"Literal[{node['const']!r}]"
        if "enum" in node:
            return f"Literal[{', '.join(repr(word) for word in node['enum'])}]"
        for key in ("anyOf", "oneOf"):
            if key in node:
                return self.union([self.of(one, name) for one in node[key]])
        listed = node.get("type")
        kinds = [listed] if isinstance(listed, str) else listed or []
        return self.union([self.one(kind, node, name) for kind in kinds]) if kinds else "Any"

    def union(self, of: list[str]) -> str:
        unique = list(dict.fromkeys(of))
        if all(one.startswith("Literal[") for one in unique) and len(unique) > 1:
            return f"Literal[{', '.join(one[8:-1] for one in unique)}]"
        return " | ".join([one for one in unique if one != "None"] + ["None"] * ("None" in unique))

    def one(self, kind: str, node: dict[str, Any], name: str) -> str:
        if kind == "array":
            items = node.get("items") or (node.get("prefixItems") or [True])[0]
            return f"list[{self.of(items, name)}]"
        if kind == "object" and "properties" in node:
            return self.object(class_name(name), node)
        if kind == "object" and isinstance(node.get("additionalProperties"), dict):
            return f"dict[str, {self.of(node['additionalProperties'], name)}]"
        return NAMES[kind]

    def named(self, name: str) -> str:
        node = DEFINITIONS[name]
        if "properties" in node and not {"oneOf", "anyOf", "allOf"} & node.keys():
            return self.object(class_name(name), node)
        if any("properties" in one for key in ("oneOf", "anyOf", "allOf") for one in node.get(key, [])):
            return "dict[str, Any]"
        return self.of(node, name)

    def object(self, name: str, node: dict[str, Any]) -> str:
        if name in self.text:
            return name
        self.text[name] = ""
        required = set(node.get("required", []))
        fields = []
        for field, inner in node["properties"].items():
            of = self.of(inner, f"{name}_{field}")
            fields.append((field, of if field in required else f"NotRequired[{of}]", meaning(inner)))
        if any(keyword.iskeyword(field) or not field.isidentifier() for field, *_ in fields):
            body = "".join(f'        "{field}": {of},\n' for field, of, _ in fields)
            # Evaluated at its definition: the types it uses must be defined above it.
            self.text[name] = f'{name} = TypedDict(\n    "{name}",\n    {{\n{body}    }},\n)\n'
        else:
            body = "".join(f"{comment(words)}    {field}: {of}\n" for field, of, words in fields)
            doc = meaning(node).replace("\\", "") or "An object of the report."
            self.text[name] = f'class {name}(TypedDict):\n    """{doc}"""\n\n{body}'
        # In the order of completion: each type comes after the types it uses.
        self.text[name] = self.text.pop(name)
        return name


def comment(words: str) -> str:
    return f"    #: {words}\n" if words else ""


def module() -> str:
    types = Types()
    for kind in KINDS:
        name, of = class_name(kind), types.named(kind)
        if of != name:
            types.text[name] = f"#: Its fields depend on the design.\n{name} = {of}\n"
    return HEAD + "".join(f"\n\n{text}" for text in types.text.values())


def main() -> None:
    if sys.argv[1:] not in ([], ["--check"]):
        raise SystemExit(__doc__)
    text = module()
    if sys.argv[1:] == []:
        TARGET.write_text(text, encoding="utf-8")
    elif TARGET.read_text(encoding="utf-8") != text:
        raise SystemExit(f"site/python_types.py: {TARGET} is stale; run site/python_types.py")


if __name__ == "__main__":
    main()
