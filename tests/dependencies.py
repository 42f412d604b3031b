"""Checks the dependencies against deny.toml (licences, duplicate versions, unwanted crates, sources), and that
each is compiled once.

    .venv/bin/python tests/dependencies.py

Replaces `cargo deny check licenses bans sources` on machines without cargo-deny: reads Cargo.lock through cargo, and the same deny.toml. Licences are those
that crates declare. It does not verify that the texts are of these licences; cargo-deny does.

The wheel of ./check shares the compiled dependencies of the tests only if each has the same features.
"""

import collections
import json
import subprocess
import sys
import tomllib
from pathlib import Path

from license_expression import AND, OR, get_spdx_licensing

ROOT = Path(__file__).resolve().parent.parent
REGISTRY = "registry+https://github.com/rust-lang/crates.io-index"


def is_allowed(expression, allowed):
    """Whether the list allows all licences of an expression, with one of each choice."""
    if isinstance(expression, OR):
        return any(is_allowed(part, allowed) for part in expression.args)
    if isinstance(expression, AND):
        return all(is_allowed(part, allowed) for part in expression.args)
    return expression.render() in allowed


def licences(packages, allowed):
    spdx = get_spdx_licensing()
    for package in packages:
        # Before 2018 a slash separated the choices.
        stated = (package["license"] or "").replace("/", " OR ")
        if not stated or not is_allowed(spdx.parse(stated), allowed):
            yield f"licence of {called(package)}: {stated or 'none is stated'}"


def doubles(packages, skipped):
    """Crates in several versions of which fewer than all but one are listed; and unused entries of the list."""
    versions = collections.defaultdict(set)
    for package in packages:
        versions[package["name"]].add(package["version"])
    for listed in skipped:
        name, _, wanted = listed.partition("@")
        found = {version for version in versions[name] if f"{version}.".startswith(f"{wanted}.")}
        if not found or len(versions[name]) == 1:
            yield f"{listed} is no second version any more"
        versions[name] -= found
    for name, left in versions.items():
        if len(left) > 1:
            yield f"{name} in versions {', '.join(sorted(left))}"


def unwanted(packages, denied):
    for package in packages:
        if package["name"] in denied:
            yield f"{called(package)} is not wanted"
        for needed in package["dependencies"]:
            if needed["req"] == "*" and not needed.get("path") and package["source"] is None:
                yield f"{called(package)} takes any version of {needed['name']}"
        if package["source"] not in (None, REGISTRY):
            yield f"{called(package)} is from {package['source']}"


def called(package):
    return f"{package['name']} {package['version']}"


def cargo(*words):
    return subprocess.run(["cargo", *words], cwd=ROOT, check=True, capture_output=True, text=True).stdout


def compiled():
    """The packages compiled on at least one system. cargo's metadata hold more: optional dependencies of features that no crate enables."""
    tree = cargo("tree", "--locked", "--workspace", "--all-features", "--target=all", "--prefix=none", "--no-dedupe", "--format={p}")
    found = {tuple(line.split()[:2]) for line in tree.splitlines() if line}
    packages = json.loads(cargo("metadata", "--locked", "--all-features", "--format-version=1"))["packages"]
    return [package for package in packages if (package["name"], f"v{package['version']}") in found]


def features(*selection):
    """Every compiled dependency, as `name version [features]`."""
    tree = cargo("tree", "--locked", "--prefix=none", "--no-dedupe", "--format={p} [{f}]", *selection)
    lines = {line.replace(" (proc-macro)", "") for line in tree.splitlines() if line}
    return {line for line in lines if not line.startswith("catchment")}


def compiled_again():
    """Dependencies of the wheel that the tests have not compiled with the same features."""
    of_tests = features("--workspace", "--all-features", "--edges=normal,build,dev")
    of_wheel = features("--package=catchment-py", "--features=extension-module,as-tests", "--edges=normal,build")
    for line in sorted(of_wheel - of_tests):
        yield f"the wheel compiles {line} a second time"


def main():
    rules = tomllib.loads((ROOT / "deny.toml").read_text(encoding="utf-8"))
    packages = compiled()
    bans = rules["bans"]
    complaints = [
        *licences(packages, rules["licenses"]["allow"]),
        *doubles(packages, [entry["crate"] for entry in bans["skip"]]),
        *unwanted(packages, {entry["crate"] for entry in bans["deny"]}),
        *compiled_again(),
    ]
    for complaint in complaints:
        print(f"dependencies: {complaint}", file=sys.stderr)
    print(f"{len(packages)} packages, {len(complaints)} complaints")
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
