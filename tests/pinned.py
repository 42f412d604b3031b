"""Checks that a release is built from pinned inputs: actions by commit, containers by digest, one Rust
version.

    .venv/bin/python tests/pinned.py

Workflow files must also be valid YAML. The head of .github/workflows/release.yml lists the unpinned inputs.
"""

import re
import sys
import tomllib
from pathlib import Path

import yaml

ROOT = Path(__file__).resolve().parent.parent


def values(node, key):
    """Every text under a key, at any depth."""
    if isinstance(node, dict):
        for name, value in node.items():
            if name == key and isinstance(value, str):
                yield value
            yield from values(value, key)
    elif isinstance(node, list):
        for value in node:
            yield from values(value, key)


def loose(name, workflow):
    for action in values(workflow, "uses"):
        if not re.fullmatch(r"[\w./-]+@[0-9a-f]{40}", action):
            yield f"{name}: {action} is not named by its commit"
    images = [image for key in ("container", "image") for image in values(workflow, key)]
    for image in images:
        if image and not image.startswith("${{") and not re.search(r"@sha256:[0-9a-f]{64}$", image):
            yield f"{name}: {image} is not named by its digest"


def complaints():
    for path in sorted((ROOT / ".github/workflows").glob("*.yml")):
        yield from loose(path.name, yaml.safe_load(path.read_text(encoding="utf-8")))
    read = lambda name: tomllib.loads((ROOT / name).read_text(encoding="utf-8"))
    channel, oldest = read("rust-toolchain.toml")["toolchain"]["channel"], read("Cargo.toml")["workspace"]["package"]["rust-version"]
    if not re.fullmatch(rf"{re.escape(oldest)}\.\d+", channel):
        yield f"rust-toolchain.toml: Rust {channel} is no release of {oldest}, the rust-version of Cargo.toml"


def main():
    found = list(complaints())
    for complaint in found:
        print(f"pinned: {complaint}", file=sys.stderr)
    print(f"actions, containers and Rust: {len(found)} complaints")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
