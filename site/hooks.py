"""What mkdocs puts beside the pages: designs of the gallery with their meshes, and the JSON schemas, as files to take.

In the repository pages link to them where they lie, one folder up; on the site they lie below its root.
"""

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


def on_page_markdown(markdown, page, **_):
    up = "../" * page.file.src_uri.count("/")
    for folder in ("designs/", "crates/catchment-report/"):
        markdown = markdown.replace(f"]({up}../{folder}", f"]({up}{folder}")
    return markdown
