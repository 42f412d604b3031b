"""The licences of third-party code and fonts in the program, the Python wheel and the pages that the program writes.

    .venv/bin/python release/licences.py            writes LICENSE-THIRD-PARTY.txt
    .venv/bin/python release/licences.py --check    checks that the file is up to date

    cargo tree ──▶ linked packages ──▶ their sources, as cargo unpacked them ──▶ one licence of each choice, its text, every NOTICE
    three.js    as npm unpacked it, in viewer/node_modules
    DejaVu      the licence in the font files themselves
    std         of the Rust version in rust-toolchain.toml

Macros that run only at build time are left out. A package without a licence text gets the standard text of its licence, with its authors. An unknown licence,
or a licence without any available text, is an error.
"""

import collections
import json
import re
import struct
import subprocess
import sys
from pathlib import Path

from license_expression import get_spdx_licensing

ROOT = Path(__file__).resolve().parent.parent
WRITTEN = ROOT / "LICENSE-THIRD-PARTY.txt"
#: Packages linked into shipped artefacts.
SHIPPED = ["catchment-cli", "catchment-py", "catchment-wasm"]
#: Accepted licences in order of preference (of a choice, the first one listed here), and the name of the file
#: with the text of each.
TAKEN = {
    "MIT": "mit",
    "Apache-2.0": "apache",
    "BSD-2-Clause": "bsd",
    "BSD-3-Clause": "bsd",
    "ISC": "isc",
    "Zlib": "zlib",
    "BSL-1.0": "bsl|boost",
    "Unicode-3.0": "unicode",
    "Apache-2.0 WITH LLVM-exception": "llvm|apache",
}
#: Texts that do not name a licensor: this repository's copies are used.
COMMON = {"MIT": "LICENSE-MIT", "Apache-2.0": "LICENSE-APACHE"}
#: The licences of SPDX, read once.
SPDX = get_spdx_licensing()
HEAD = """Software of others in catchment
===============================

What is linked into the program, the Python wheel and the pages that the program writes, with the licences that it comes under. Where a package
offers a choice, one is taken. Written by release/licences.py from the sources of the packages: not to be edited.
"""


def output(*words):
    return subprocess.run(words, cwd=ROOT, check=True, capture_output=True, text=True).stdout


def linked():
    """The linked third-party packages, from cargo's metadata, each with the folder of its source."""
    chosen = [word for name in SHIPPED for word in ("-p", name)]
    edges = "normal,no-proc-macro"
    tree = output("cargo", "tree", "--locked", *chosen, "--all-features", "--target=all", "-e", edges, "--prefix=none", "--no-dedupe", "--format={p}")
    found = {tuple(line.split()[:2]) for line in tree.splitlines() if line}
    packages = json.loads(output("cargo", "metadata", "--locked", "--all-features", "--format-version=1"))["packages"]
    return [p for p in packages if p["source"] is not None and (p["name"], f"v{p['version']}") in found]


def taken(stated):
    """The accepted licences of a package's licence expression: one of each choice, in the order of TAKEN."""
    choices = SPDX.dnf(SPDX.parse(stated.replace("/", " OR ")))
    ways = [way.args if isinstance(way, SPDX.AND) else (way,) for way in (choices.args if isinstance(choices, SPDX.OR) else (choices,))]
    known = [[licence.render() for licence in way] for way in ways]
    order = list(TAKEN)
    known = [sorted(way, key=order.index) for way in known if all(licence in TAKEN for licence in way)]
    if not known:
        raise SystemExit(f"licences: {stated} is not among those taken: {', '.join(TAKEN)}")
    return min(known, key=lambda way: (max(map(order.index, way)), way))


def files_of(folder, pattern):
    return sorted(path for path in folder.iterdir() if path.is_file() and re.match(pattern, path.name, re.IGNORECASE))


def text_of(package, licence):
    """The text of a package's licence from its source; this repository's text with the package's authors if the source has no text."""
    folder = Path(package["manifest_path"]).parent
    files = files_of(folder, "licen[cs]e|copying|unlicense")
    if package.get("license_file"):
        files.append(folder / package["license_file"])
    named = [path for path in files if re.search(TAKEN[licence], path.name, re.IGNORECASE)]
    others = "|".join(TAKEN.values())
    plain = [path for path in files if not re.search(others, path.name, re.IGNORECASE)]
    if named or plain:
        return (named or plain)[0].read_text(encoding="utf-8")
    if licence not in COMMON:
        raise SystemExit(f"licences: {package['name']} {package['version']} comes without the text of {licence}")
    text = (ROOT / COMMON[licence]).read_text(encoding="utf-8")
    authors = ", ".join(re.sub(r"\s*<[^>]*>", "", author) for author in package["authors"]) or f"the authors of {package['name']}"
    return re.sub(r"Copyright \(c\) .*", f"Copyright (c) {authors}", text)


def names_in(font):
    """The name records of a TrueType font, by their numbers: 0 is the copyright, 13 the licence."""
    tables = struct.unpack(">H", font[4:6])[0]
    entries = (struct.unpack(">4sIII", font[12 + 16 * k : 28 + 16 * k]) for k in range(tables))
    start = next(offset for tag, _, offset, _ in entries if tag == b"name")
    _, count, strings = struct.unpack(">HHH", font[start : start + 6])
    records = (struct.unpack(">6H", font[start + 6 + 12 * k : start + 18 + 12 * k]) for k in range(count))
    windows = 3
    at = start + strings
    return {name: font[at + place : at + place + size].decode("utf-16-be") for system, _, _, name, size, place in records if system == windows}


def sections():
    """The shipped components and their licence texts: pairs of a heading and a text."""
    packages = linked()
    for package in packages:
        heading = f"{package['name']} {package['version']}"
        stated = package["license"]
        if not stated:
            raise SystemExit(f"licences: {heading} states none")
        ways = taken(stated)
        offered = "" if stated == " AND ".join(ways) else f", of {stated}"
        for licence in ways:
            yield f"{heading} ({licence}{offered})", text_of(package, licence)
        for notice in files_of(Path(package["manifest_path"]).parent, "notice"):
            yield f"{heading} ({notice.name})", notice.read_text(encoding="utf-8")
    fonts = next(package for package in packages if package["name"] == "dejavu")
    font = next(Path(fonts["manifest_path"]).parent.glob("assets/**/DejaVuSans.ttf"))
    yield "DejaVu fonts 2.37 (Bitstream Vera, Arev)", names_in(font.read_bytes())[13]
    toolchain = re.search(r'channel = "(.*)"', (ROOT / "rust-toolchain.toml").read_text(encoding="utf-8"))[1]
    text = (ROOT / COMMON["MIT"]).read_text(encoding="utf-8")
    yield f"std {toolchain} (MIT, of MIT OR Apache-2.0)", re.sub(r"Copyright \(c\) .*", "Copyright (c) The Rust Project Developers", text)
    three = ROOT / "viewer/node_modules/three"
    if not (three / "LICENSE").is_file():
        raise SystemExit("licences: the viewer's packages are missing: npm ci in viewer/")
    version = json.loads((three / "package.json").read_text(encoding="utf-8"))["version"]
    locked = json.loads((ROOT / "viewer/package-lock.json").read_text(encoding="utf-8"))["packages"]["node_modules/three"]["version"]
    if version != locked:
        raise SystemExit(f"licences: three {version} lies in viewer/node_modules, and {locked} is locked: npm ci in viewer/")
    yield f"three {version} (MIT)", (three / "LICENSE").read_text(encoding="utf-8")


def tidy(text):
    """A text without foreign line breaks, trailing blanks and surrounding empty lines."""
    lines = [line.rstrip() for line in text.replace("\r\n", "\n").replace("\f", "").replace("\ufeff", "").split("\n")]
    return "\n".join(lines).strip("\n")


def document():
    """Merges equal texts under the names of all their components."""
    together = collections.defaultdict(list)
    for heading, text in sections():
        together[tidy(text)].append(heading)
    parts = sorted((sorted(headings, key=str.lower), text) for text, headings in together.items())
    rule = "-" * 80
    blocks = [f"{rule}\n{chr(10).join(headings)}\n{rule}\n\n{text}\n" for headings, text in parts]
    return HEAD + "\n" + "\n".join(blocks)


def main():
    new = document()
    if sys.argv[1:] != ["--check"]:
        WRITTEN.write_text(new, encoding="utf-8")
        return 0
    old = WRITTEN.read_text(encoding="utf-8") if WRITTEN.is_file() else ""
    if old == new:
        print(f"{WRITTEN.name} is what release/licences.py writes")
        return 0
    headings = [set(re.findall(r"^\S.* \(.*\)$", text, re.MULTILINE)) for text in (old, new)]
    for sign, names in (("-", headings[0] - headings[1]), ("+", headings[1] - headings[0])):
        for name in sorted(names):
            print(f"licences: {sign} {name}", file=sys.stderr)
    print(f"licences: {WRITTEN.name} is not what is shipped: run release/licences.py", file=sys.stderr)
    return 1


if __name__ == "__main__":
    sys.exit(main())
