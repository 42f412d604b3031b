"""Measures the memory use of every command, on every design, against the program's own estimate.

    python3 tests/memory.py PROGRAM [DESIGN…]

Designs are those of `designs`, of its gallery, and those of its systems that are connectors; the other systems have their own commands.

The program gets 1 byte of memory, refuses, and prints its requirement; it gets that amount, and so on until it runs, and the system
reports its peak. The memory of checking the same design is subtracted. Fails if a command takes more than BESIDE above its estimate:
the estimates do not include threads, tables of the report and the allocator's own memory. Unix, Python's own library alone.
"""

import os
import re
import signal
import subprocess
import sys
import tempfile
import threading
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
BESIDE = 48  # MiB
LONGEST = 180  # s; a command over this limit is reported with its peak so far
UNITS = {"B": 1, "KiB": 1 << 10, "MiB": 1 << 20, "GiB": 1 << 30, "TiB": 1 << 40}
COMMANDS = [
    "run --method transport",
    "run --method descent",
    "run --method flood --resolution 24",
    "run --method steepest --resolution 24",
    "run --method meyer --resolution 16",
    "run --method partition --free x,pitch",
    "run --method kinematic --resolution 300",
    "run --method drop --resolution 4 --trials 1",
    "run --free x,pitch --method flood --resolution 3000",
    "run --free x,pitch --method flood --resolution 2000 -o out",
    "run --free x,pitch --method flood --resolution 2000 --figures out",
    "run --method flood --resolution 24 -o out.zarr",
    "run --sensitivity --samples 200",
    "slices --resolution 60",
    "slices --resolution 60 -o out",
    "compare --methods flood,meyer --resolution 12",
    "compare --methods flood,meyer --resolution 12 -o out",
    "outcome --poses poses.csv",
    "outcome --poses poses.csv --json",
    "zraa",
    "zraa -o out.png",
    "check",
    "window --motions 20",
    "success --error-sigma x=0.1 --motions 100",
    "jams --motions 20 --examine 1",
    "jams --motions 20 --examine 1 --resolution 24 -o out.png",
    "friction --motions 20 --frictions 0.1",
    "rests --motions 20 --examine 1",
    "hold",
    "chance --push 1 --pose x=0.1 --trials 1",
    "plan --accuracy x=0.01 --pattern grid --steps x=3",
    "solids --slices 8 -o out.obj",
    "classify",
    "invert",
    "report --resolution 8 --leave-out window -o out.html",
    "sweep --over cor=0,1 --resolution 8 --samples 0 -o out",
]
# Commands on systems above the connector, or on two parts: the whole command line; {} is the folder of
# designs.
SYSTEMS = [
    "compose {}/systems/hook.toml {}/systems/loop.toml -o out.png",
    "compose {}/systems/boat.toml {}/systems/block.toml",
    "chain {}/systems/chain.toml --chains 100",
    "chain {}/systems/o-ring.toml --chains 10",
    "chain {}/systems/p-sequence.toml --chains 10",
    "place {}/meshes/assembled-socket.obj {}/meshes/assembled-plug.ply --unit mm --drawn assembled --figure out.png",
    "invert {}/pyramid.toml --heights {}/systems/wanted-bowl.csv -o out.toml",
    "validate {}/trials/pyramid-arc.csv {}/bench-pyramid-arc.toml --accuracy x=0.5mm,y=0.5mm",
    "catalog --figure 4.2 -o out.png",
]
# These commands have no budget, or use only part of it.
WITHOUT = {"check", "classify", "validate", "latch"}


def measured(program, args, folder):
    """Exit code (None if it was killed), peak in MiB, and the output."""
    with tempfile.TemporaryFile() as stderr, open(os.devnull, "w") as null:
        child = subprocess.Popen([program, *args], cwd=folder, stdout=null, stderr=stderr)
        late = threading.Timer(LONGEST, child.kill)
        late.start()
        _, status, usage = os.wait4(child.pid, 0)
        late.cancel()
        child.returncode = os.waitstatus_to_exitcode(status)
        stderr.seek(0)
        code = None if child.returncode == -signal.SIGKILL else child.returncode
        return code, usage.ru_maxrss / 1024, re.sub(r"\s*\n\s*│?\s*", " ", stderr.read().decode())


def weighed(program, args, folder):
    """Exit code, peak in MiB, and the MiB that the program states for its largest part; None if it requests no memory."""
    budget, needs = 1, None
    while True:
        code, most, message = measured(program, [*args, "--memory", f"{budget}B"], folder)
        refused = re.search(r"needs ([\d.]+) (\w+) of memory", message)
        if code != 5 or not refused:
            return code, most, needs
        part = float(refused[1]) * UNITS[refused[2]]
        needs = max(needs or 0.0, part / (1 << 20))
        # The printed value is rounded.
        budget = max(2 * budget, int(1.1 * part))


def main():
    program = str(Path(sys.argv[1]).resolve())
    designs = [Path(path) for path in sys.argv[2:]]
    whole = not designs
    for folder in ("", "gallery", "systems"):
        found = sorted((ROOT / "designs" / folder).glob("*.toml")) if whole else []
        designs += [path for path in found if "\n[connector]" in f"\n{path.read_text()}" and "\n[chain]" not in path.read_text()]
    worst, failed, ran = {}, [], 0

    def record(stem, command, args, base, folder):
        nonlocal ran
        code, most, needs = (*measured(program, args, folder)[:2], None) if args[0] in WITHOUT else weighed(program, args, folder)
        if code not in (0, 2, None):
            failed.append(f"{stem}: {command}: it ended with {code}")
        if code not in (0, None):
            print(f"{stem:20} {command:62} not for this design", flush=True)
            return
        ran += 1
        took = max(most - base, 0.0)
        shown = "-" if needs is None else f"{needs:.1f}"
        print(f"{stem:20} {command:62} expected {shown:>8} MiB, took {took:7.1f} MiB{' in the first minutes' if code is None else ''}", flush=True)
        beside = took - (needs or 0.0)
        worst[command] = max(worst.get(command, (float("-inf"),)), (beside, took, needs or 0.0, stem))
        if beside > BESIDE:
            failed.append(f"{stem}: {command}: {took:.0f} MiB, expected {shown}")

    for design in designs:
        _, base, _ = measured(program, ["check", str(design.resolve())], ".")
        for command in COMMANDS:
            name, *options = command.split()
            with tempfile.TemporaryDirectory() as folder:
                (Path(folder) / "poses.csv").write_text("x\n" + "0.01\n" * 20_000)
                record(design.stem, command, [name, str(design.resolve()), *options], base, folder)
    _, base, _ = measured(program, ["check", str(ROOT / "designs/v-face.toml")], ".")
    for command in SYSTEMS if whole else []:
        with tempfile.TemporaryDirectory() as folder:
            record("-", command.replace("{}/", ""), [word.replace("{}", str(ROOT / "designs")) for word in command.split()], base, folder)
    print("\n| command | most beside what was expected | expected | took | design |\n|---|---|---|---|---|")
    for command, (beside, took, needs, stem) in worst.items():
        print(f"| `{command}` | {beside:+.0f} MiB | {needs:.1f} MiB | {took:.1f} MiB | {stem} |")
    print(f"{ran} runs, {len(failed)} of them beyond {BESIDE} MiB")
    sys.exit("\n".join(["too much memory:", *failed]) if failed else 0)


if __name__ == "__main__":
    main()
