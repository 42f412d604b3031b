"""Checks the dependencies against the RustSec advisory database.

    .venv/bin/python tests/advisories.py FOLDER         a clone of https://github.com/rustsec/advisory-db

Reads both lock files, that of the workspace and that of the fuzzer. Leaves out advisories that deny.toml ignores with a reason, and withdrawn advisories.
Prints the age of the database: an old one lacks recent advisories.
"""

import re
import subprocess
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
LOCKS = ["Cargo.lock", "fuzz/Cargo.lock"]


def version(text):
    """A version as comparable numbers; a pre-release sorts before its release."""
    plain, _, before = text.split("+")[0].partition("-")
    numbers = [int(part) for part in plain.split(".")]
    words = [(0, int(word), "") if word.isdigit() else (1, 0, word) for word in before.split(".")] if before else [(2, 0, "")]
    return (numbers + [0, 0])[:3], words


def meets(requirement, found):
    """Whether a version satisfies a requirement of cargo, such as `>= 1.2, < 2` or `^0.3.1`."""
    return all(meets_one(part.strip(), version(found)) for part in requirement.split(","))


def meets_one(comparator, found):
    sign, written = re.fullmatch(r"([<>=^~]*)\s*(\S+)", comparator).groups()
    if written == "*":
        return True
    least, parts = version(written), len(written.split("-")[0].split("."))
    if sign in ("<", "<=", ">", ">="):
        return {"<": found < least, "<=": found <= least, ">": found > least, ">=": found >= least}[sign]
    if sign == "=":
        return found[0][:parts] == least[0][:parts] and (parts < 3 or found == least)
    # `^`, also the meaning of a bare version: up to the first number that is not 0. `~`: up to the one before
    # the last.
    first = next((k for k, number in enumerate(least[0]) if number), parts - 1)
    kept = max(1, min(parts - 1, 2)) if sign == "~" else first + 1
    return found >= least and found[0][:kept] == least[0][:kept]


def advisory(text):
    """The head of an advisory: the TOML block at the beginning of its page."""
    return tomllib.loads(re.match(r"```toml\n(.*?)\n```", text, re.DOTALL)[1])


def complaints(database):
    ignored = {entry["id"] for entry in tomllib.loads((ROOT / "deny.toml").read_text(encoding="utf-8"))["advisories"]["ignore"]}
    locked = {}
    for lock in LOCKS:
        for package in tomllib.loads((ROOT / lock).read_text(encoding="utf-8"))["package"]:
            if "source" in package:
                locked.setdefault(package["name"], set()).add(package["version"])
    met = set()
    for name, versions in sorted(locked.items()):
        for page in sorted((database / "crates" / name).glob("*.md")):
            known = advisory(page.read_text(encoding="utf-8"))
            about, safe = known["advisory"], known.get("versions", {})
            safe = [*safe.get("patched", []), *safe.get("unaffected", [])]
            for found in sorted(versions):
                if "withdrawn" in about or any(meets(requirement, found) for requirement in safe):
                    continue
                met.add(about["id"])
                if about["id"] not in ignored:
                    yield f"{name} {found}: {about['id']} ({about.get('informational', 'vulnerability')}), safe: {', '.join(safe) or 'no version'}"
    for name in sorted(ignored - met):
        yield f"deny.toml ignores {name}, which nothing here meets"


def main():
    database = Path(sys.argv[1])
    if not (database / "crates").is_dir():
        raise SystemExit(f"advisories: {database} is no clone of the RustSec database")
    found = list(complaints(database))
    for complaint in found:
        print(f"advisories: {complaint}", file=sys.stderr)
    last = subprocess.run(["git", "-C", str(database), "log", "-1", "--format=%cs"], capture_output=True, text=True, check=False).stdout.strip()
    print(f"RustSec database of {last or 'unknown age'}: {len(found)} complaints")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
