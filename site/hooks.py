"""mkdocs hooks for the pages: extra files, and the glossary.

Designs of the gallery with their meshes, and the JSON schemas, lie one folder up in the repository and below the root on the site. Every page links to the glossary, and
shows the definitions of its terms as tooltips. Only terms of several words and abbreviations get tooltips, since "rest" or "play" may be plain English.
"""

import re
from pathlib import Path

from mkdocs.structure.files import File

ROOT = Path(__file__).resolve().parent.parent
TAKEN = ("crates/catchment-report/reports.schema.json", "designs/schema.json", "designs/gallery/*.toml", "designs/gallery/meshes/*", "designs/meshes/*.stl")


def on_files(files, config):
    for pattern in TAKEN:
        for path in sorted(ROOT.glob(pattern)):
            name = path.relative_to(ROOT).as_posix()
            files.append(File.generated(config, name, abs_src_path=str(path)))
    return files


def terms():
    """The terms of the glossary with their definitions as plain text."""
    for line in (ROOT / "docs/glossary.md").read_text(encoding="utf-8").splitlines():
        found = re.match(r"- \*\*(.+?)\*\*: (.+?)(?: \*Source:.*)?$", line)
        if not found:
            continue
        meaning = re.sub(r" Formerly .*", "", found[2])
        meaning = re.sub(r"\[([^]]*)\]\([^)]*\)|`([^`]*)`|[*]", lambda m: m[1] or m[2] or "", meaning)
        for name in re.split(r", | \(|\)", found[1]):
            if " " in name or (name.isupper() and len(name) > 1):
                yield name, meaning


def on_page_markdown(markdown, page, **_):
    up = "../" * page.file.src_uri.count("/")
    for folder in ("designs/", "crates/catchment-report/"):
        markdown = markdown.replace(f"]({up}../{folder}", f"]({up}{folder}")
    if page.file.src_uri == "glossary.md":
        return markdown
    tooltips = "\n".join(f"*[{name}]: {meaning}" for name, meaning in terms())
    return f"{markdown}\n\n---\n\nTerms: [glossary]({up}glossary.md)\n\n{tooltips}\n"
