"""Regenerates the console blocks of the README and of docs/ from the program itself.

    python3 site/transcripts.py target/release/catchment           writes all blocks again
    python3 site/transcripts.py target/debug/catchment --check [DRAWN]
                                                                   lists those that differ from the program's output; the PNG files
                                                                   that the commands write go into the folder DRAWN

A block ```console whose first line begins with `$ catchment`, `$ printf` or `$ sed` holds commands and their output, including stderr. A command continues on the next line after `\\`.
The commands of a page run one after another in the page's own folder (budget-to-window continues in that of first-dock). The folder holds two STL files of the repository, its design files in designs/,
and every block ```toml whose first line is `# NAME.toml`, under that name. A line with only … stands for omitted lines: as many as needed to keep the block's lines above and below it. A command without
output in its block runs, but its output is not compared.
"""

import difflib
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
#: Pages in reading order; each list shares a folder.
DOCK = [ROOT / "docs/first-dock.md", ROOT / "docs/budget-to-window.md"]
PAGES = [DOCK, [ROOT / "README.md"], *([page] for page in sorted((ROOT / "docs").glob("*.md")) if page not in DOCK)]
PARTS = [ROOT / "designs/meshes/grid-baseplate.stl", ROOT / "designs/meshes/grid-cup.stl"]
#: The words that begin a command that is run. The program reads the output of `printf`; `sed` changes a design file.
RUN = ("catchment ", "printf ", "sed ")
BLOCK = re.compile(r"^```(console|toml)\n(.*?)^```$", re.M | re.S)


def printed(program: str, folder: Path, command: str) -> list[str]:
    program = os.path.abspath(program)
    words = [program, *shlex.split(command)[1:]]
    if not command.startswith("catchment ") or " | " in command:
        words = ["sh", "-c", command]
    path = f"{os.path.dirname(program)}:{os.environ['PATH']}"
    env = {**os.environ, "NO_COLOR": "1", "COLUMNS": "80", "PATH": path}
    done = subprocess.run(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, cwd=folder, env=env, check=False)
    if done.returncode != 0:
        raise SystemExit(f"{command}: exit {done.returncode}\n{done.stdout}")
    # The run time of a command depends on the machine.
    return [line.rstrip() for line in done.stdout.rstrip().splitlines() if not line.startswith("progress: ")]


def cut(output: list[str], shown: list[str]) -> list[str]:
    """The output, with the lines omitted that the page omits."""
    gaps = [k for k, line in enumerate(shown) if line.strip() == "…"]
    if not gaps:
        return output
    above, below = gaps[0], len(shown) - gaps[-1] - 1
    if above + below >= len(output):
        return output
    return output[:above] + [shown[gaps[0]]] + (output[-below:] if below else [])


def commands(block: str) -> list[tuple[list[str], list[str]]]:
    """The commands of a block, each as its lines and the lines below it."""
    found: list[tuple[list[str], list[str]]] = []
    goes_on = False
    for line in block.splitlines():
        if goes_on or line.startswith("$ "):
            if not goes_on:
                found.append(([], []))
            found[-1][0].append(line)
            goes_on = line.endswith("\\")
        elif found:
            found[-1][1].append(line)
    return found


class Transcripts:
    def __init__(self, program: str) -> None:
        self.program = program
        self.folder = Path()
        self.ran = 0
        self.wrong: list[str] = []

    def again(self, page: Path, block: re.Match) -> str:
        """A block regenerated from the program's output."""
        if block[1] == "toml":
            named = re.match(r"# (\S+\.toml)\n", block[2])
            if named:
                (self.folder / named[1]).write_text(block[2], encoding="utf-8")
            return block[0]
        if not block[2].startswith(tuple(f"$ {word}" for word in RUN)):
            return block[0]
        lines: list[str] = []
        for typed, shown in commands(block[2]):
            command = "".join(line.removeprefix("$ ").removesuffix("\\") for line in typed)
            lines += [*typed, *self.output(page, " ".join(command.split()) if "'" not in command else command, shown)]
        return "\n".join(["```console", *lines, "```"])

    def output(self, page: Path, command: str, shown: list[str]) -> list[str]:
        if not command.startswith(RUN):
            return shown
        begun = time.monotonic()
        printed_lines = printed(self.program, self.folder, command)
        self.ran += 1
        if time.monotonic() - begun > 5:
            print(f"{time.monotonic() - begun:.0f} s: {command}", file=sys.stderr)
        if not shown:
            return shown
        trimmed = cut(printed_lines, shown)
        if trimmed != shown:
            lines = difflib.unified_diff(shown, trimmed, f"{page.name}: $ {command}", "what it prints", lineterm="", n=1)
            self.wrong.append("\n".join(lines))
        return trimmed


def main() -> None:
    if len(sys.argv) not in (2, 3, 4) or sys.argv[2:3] not in ([], ["--check"]):
        raise SystemExit(__doc__)
    program, compares = sys.argv[1], len(sys.argv) > 2
    drawn = Path(sys.argv[3]) if len(sys.argv) == 4 else None
    transcripts = Transcripts(program)
    for pages in PAGES:
        with tempfile.TemporaryDirectory() as home:
            transcripts.folder = Path(home)
            for part in PARTS:
                shutil.copy(part, home)
            shutil.copytree(ROOT / "designs", Path(home) / "designs")
            for page in pages:
                text = page.read_text(encoding="utf-8")
                whole = BLOCK.sub(lambda block, page=page: transcripts.again(page, block), text)
                if not compares and whole != text:
                    page.write_text(whole, encoding="utf-8")
            if drawn:
                drawn.mkdir(exist_ok=True)
                for picture in Path(home).glob("*.png"):
                    shutil.copy(picture, drawn)
    if compares and transcripts.wrong:
        raise SystemExit("\n".join([*transcripts.wrong, f"python3 site/transcripts.py {program}"]))
    changed = "" if compares else f", {len(transcripts.wrong)} blocks changed"
    print(f"transcripts: {transcripts.ran} commands of {sum(map(len, PAGES))} pages{changed}")


if __name__ == "__main__":
    main()
