"""The console blocks of the README and the guides, from the program itself.

    python3 site/transcripts.py target/debug/catchment            writes the blocks of the guides again (PAGES)
    python3 site/transcripts.py target/debug/catchment --check    lists those that differ from what the program prints; without the slow ones
    python3 site/transcripts.py target/debug/catchment --check all    with those, too

A block ```console that begins with `$ catchment` holds a command and what it prints, stderr among it. The commands run one after another, page after page,
in a folder that holds the two STL files of the repository and, in designs/, its design files. A line that is only … stands for lines that are left out: as many as
it takes that the block keeps its lines above it and below.
"""

import difflib
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PAGES = [ROOT / "README.md", ROOT / "docs/first-dock.md", ROOT / "docs/budget-to-window.md", ROOT / "docs/source-and-findings.md"]
PARTS = [ROOT / "designs/meshes/grid-baseplate.stl", ROOT / "designs/meshes/grid-cup.stl"]
#: Thousands of motions of meshes.
LONG = ("window",)
BLOCK = re.compile(r"^```console\n\$ (catchment [^\n]*)\n(.*?)^```$", re.M | re.S)


def printed(program: str, folder: Path, command: str) -> list[str]:
    words = [os.path.abspath(program), *shlex.split(command)[1:]]
    env = {**os.environ, "NO_COLOR": "1", "COLUMNS": "80"}
    done = subprocess.run(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, cwd=folder, env=env, check=False)
    if done.returncode != 0:
        raise SystemExit(f"{command}: exit {done.returncode}\n{done.stdout}")
    # How long a command takes is the machine's.
    return [line.rstrip() for line in done.stdout.rstrip().splitlines() if not line.startswith("progress: ")]


def cut(said: list[str], shown: list[str]) -> list[str]:
    """What is printed, with as many lines left out as the page leaves out."""
    gaps = [k for k, line in enumerate(shown) if line.strip() == "…"]
    if not gaps:
        return said
    above, below = gaps[0], len(shown) - gaps[-1] - 1
    if above + below >= len(said):
        return said
    return said[:above] + [shown[gaps[0]]] + (said[-below:] if below else [])


def main() -> None:
    if len(sys.argv) not in (2, 3, 4) or sys.argv[2:] not in ([], ["--check"], ["--check", "all"]):
        raise SystemExit(__doc__)
    program, compares, every = sys.argv[1], len(sys.argv) > 2, sys.argv[2:] != ["--check"]
    known: dict[str, list[str]] = {}
    wrong: list[str] = []
    left_out = 0
    with tempfile.TemporaryDirectory() as home:
        for part in PARTS:
            shutil.copy(part, home)
        (Path(home) / "designs").mkdir()
        for design in sorted((ROOT / "designs").glob("*.toml")):
            shutil.copy(design, Path(home) / "designs")
        for page in PAGES:
            def again(block: re.Match) -> str:
                nonlocal left_out
                command, shown = block[1], block[2].rstrip().splitlines()
                if command.split()[1] in LONG and not every:
                    left_out += 1
                    return block[0]
                if command not in known:
                    known[command] = printed(program, Path(home), command)
                said = cut(known[command], shown)
                if said != shown:
                    lines = difflib.unified_diff(shown, said, f"{page.name}: $ {command}", "what it prints", lineterm="", n=1)
                    wrong.append("\n".join(lines))
                return "\n".join(["```console", f"$ {command}", *said, "```"])

            text = page.read_text(encoding="utf-8")
            whole = BLOCK.sub(again, text)
            if not compares:
                page.write_text(whole, encoding="utf-8")
    if compares and wrong:
        raise SystemExit("\n".join([*wrong, f"python3 site/transcripts.py {program}"]))
    print(f"transcripts: {len(known)} commands of the guides, {left_out} long blocks left out" + ("" if compares else f", {len(wrong)} blocks changed"))


if __name__ == "__main__":
    main()
