"""Mutated designs, tables, stored results and command lines through the real program, under a memory limit.

    python3 tests/storm.py PROGRAM [COUNT] [--seed SEED] [--from NUMBER] [--mib 1024] [--longest 20] [--keep FOLDER]

Every subcommand has its generator; if the program has a subcommand that is neither here nor in LEFT_OUT, the script runs nothing. Every run must end with
exit code 0 to 5, 130 or 143, print something for 2 to 5, print no terminal control characters, report no bug and leave no unfinished file. A run that
takes more than --longest seconds of CPU time is interrupted, must react to that, and is counted. The same seed and number give the same run; a failure is
reported with both, and kept with --keep. Unix, Python's own library alone.
"""

import argparse
import collections
import os
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
ALLOWED = {0, 1, 2, 3, 4, 5, 130, 143}
DEAF = 30.0  # seconds from an interrupt to the end, on a busy machine
NUMBERS = "0 -0 -1 1 2 3 0.5 1e308 -1e308 1e-320 1e999 nan inf 0.1 255 65536 4294967295 18446744073709551616 1e-9 100 -100".split()
PIECES = [b"\0", b"\x1b[2J", b"\xff\xfe", b"\xef\xbb\xbf", b"\n", b"\r", b",", b'"', b"[", b"{", b"}", b"=", b" mm", b" deg",
          b"null", b"\xe2\x80\xae", b"\xc2\x9b", b"////////", b"true", b"[[", b"#", b";"]
METHODS = "transport descent flood steepest meyer partition kinematic drop all".split()
AXES = "x y roll pitch yaw".split()
LEFT_OUT = {"view": "serves until it is ended; its requests have a fuzz target", "help": "clap's own"}


def corpus(name):
    return [path.read_bytes() for path in sorted((ROOT / "fuzz/corpus" / name).iterdir())]


def spoilt(dice, seed, others):
    """A copy with one to four mutations."""
    data = bytearray(seed)
    for _ in range(dice.randint(1, 4)):
        at = dice.randint(0, len(data))
        end = min(at + dice.randint(0, 60), len(data))
        kind = dice.randint(0, 9)
        if kind == 0 and data:
            data[min(at, len(data) - 1)] ^= 1 << dice.randint(0, 7)
        elif kind == 1 and data:
            data[min(at, len(data) - 1)] = dice.randint(0, 255)
        elif kind == 2:
            del data[at:end]
        elif kind == 3:
            data[at:at] = data[at:end]
        elif kind == 4:
            data[at:at] = dice.choice(PIECES)
        elif kind == 5:
            other = dice.choice(others)
            start = dice.randint(0, len(other))
            data[at:end] = other[start : start + dice.randint(0, 60)]
        elif kind == 6:
            del data[at:]
        else:
            found = list(re.finditer(rb"-?[0-9]+(\.[0-9]+)?([eE][-+]?[0-9]+)?", bytes(data)))
            if found:
                number = dice.choice(found)
                data[number.start() : number.end()] = dice.choice(NUMBERS).encode()
    return bytes(data[: 1 << 20])


class Dice(random.Random):
    """Calm dice make input that the program can compute, so that some runs pass the input checks."""

    calm = False


def number(dice):
    if dice.calm:
        return f"{dice.uniform(0.05, 0.3):.3g}"
    return dice.choice(NUMBERS) if dice.random() < 0.15 else f"{dice.uniform(-0.2, 1):.3g}"


def length(dice):
    if dice.calm:
        return number(dice)
    return number(dice) + dice.choice(["", "", "", "", " D", " deg", " mm", " parsec"])


def resolution(dice):
    kind = dice.random()
    if kind < 0.7 or dice.calm:
        return str(dice.randint(3, 6) if dice.calm else dice.randint(1, 6))
    if kind < 0.85:
        return f"{dice.randint(1, 6)},{dice.choice(AXES)}={dice.randint(1, 9)}"
    return dice.choice([f"{dice.choice(AXES)}={number(dice)}", number(dice), "", "=", "1e3", "x=,y"])


def pose(dice):
    if dice.calm:
        return f"x={number(dice)}"
    return ",".join(f"{dice.choice(AXES)}={length(dice)}" for _ in range(dice.randint(0, 4)))


def design_options(dice):
    args = []
    if dice.random() < 0.5 and not dice.calm:
        args += ["--free", ",".join(dice.sample(AXES, dice.randint(1, 3)))]
    if dice.random() < 0.2:
        args += ["--cor", length(dice)]
    if dice.random() < 0.2:
        args += [dice.choice(["--rho", "--rotation-length"]), length(dice)]
    if dice.random() < 0.1:
        args += ["--aspect-ratio", number(dice)]
    return args


def drop_options(dice):
    keys = "push gravity mass gyration density damping angular-damping friction restitution drop-height timestep timeout".split()
    args = ["--trials", dice.choice(["1", "1", "3", number(dice)])]
    for key in dice.sample(keys, dice.randint(0, 3)):
        args += [f"--{key}", number(dice)]
    return args


def exec_options(dice):
    args = []
    if dice.calm:
        return args
    if dice.random() < 0.2:
        args += ["--threads", dice.choice(["0", "1", "2", "9", number(dice)])]
    if dice.random() < 0.2:
        args += ["--memory", dice.choice(["1 MiB", "10 MB", "1GiB", "900 GiB", length(dice)])]
    return args + (["-q"] if dice.random() < 0.1 else [])


def run(dice):
    method = dice.choice(METHODS)
    args = ["run", "d.toml", "--resolution", resolution(dice), "--method", method]
    args += design_options(dice) + exec_options(dice)
    if method == "drop":
        args += drop_options(dice)
    if method in ("transport", "descent", "all") and dice.random() < 0.9:
        args += ["--samples", dice.choice(["0", "10", "100", number(dice)])]
    for option, values in {
        "--slices": ["1", "4", number(dice)],
        "--strips": ["1", "3", number(dice)],
        "--depth-tolerance": [number(dice)],
        "--require": ["onaa.edge>=0.1", "sum<=" + number(dice), pose(dice)],
        "--error-sigma": [pose(dice)],
        "--error-uniform": [pose(dice)],
        "--figures": ["pics", "out", "new/pics"],
        "--seed": [number(dice)],
        "--tolerance": ["50%", number(dice)],
        "--budget": ["1s", length(dice)],
        "--time-limit": ["1s", length(dice)],
    }.items():
        if dice.random() < 0.06:
            args += [option, dice.choice(values)]
    if dice.random() < 0.06:
        args += ["--converge", "--tolerance", "50%", "--time-limit", "1s"]
    elif dice.random() < 0.06:
        args += ["--sensitivity", "--samples", "10"]
    return args + dice.choice([[], ["--json"], ["-o", "out"], ["-o", "out.zarr"], ["-o", "s/out"]])


def outcome(dice):
    args = [dice.choice(["trace", "outcome"]), "d.toml", "--poses", "p.csv"] + design_options(dice) + exec_options(dice)
    if dice.random() < 0.1:
        args += ["--method", "drop"] + drop_options(dice)
    if dice.random() < 0.2:
        args += ["--offsets-at", dice.choice(["face", "cor"])]
    return args + dice.choice([[], ["--json"], ["-o", "out.csv"], ["-o", "p.csv", "--force"]])


def slices(dice):
    args = ["slices", "d.toml", "--resolution", resolution(dice)] + design_options(dice) + exec_options(dice)
    if dice.random() < 0.3:
        args += ["--axes", ",".join(dice.choices(AXES, k=2))]
    if dice.random() < 0.1:
        args += ["--method", "drop"] + drop_options(dice)
    return args + dice.choice([[], ["--json"], ["-o", "out"]])


def compare(dice):
    one = dice.choice(["s.zarr", "s", "d.toml"])
    args = ["compare", one] + ([dice.choice(["s.zarr", "s", "d.toml"])] if dice.random() < 0.8 else [])
    if dice.random() < 0.7:
        args += ["--methods", ",".join(dice.choices(METHODS[1:-2], k=dice.randint(1, 2)))]
    if dice.random() < 0.4 or "d.toml" in args:
        args += ["--resolution", resolution(dice)]
    return args + exec_options(dice) + dice.choice([[], ["--json"], ["-o", "out"]])


def value(dice, *usual):
    return number(dice) if dice.random() < 0.1 and not dice.calm else str(dice.choice(usual))


def written(dice, *endings):
    """Prints, or also writes a file, occasionally one whose name has no known extension."""
    return dice.choice([[], [], ["--json"], ["-o", "out." + dice.choice([*endings, "txt"])], ["-o", "d.toml", "--force"]])


def study(dice):
    """Studies by exact motions, with few motions each."""
    command = dice.choice("window success jams friction rests hold".split())
    # `rests --jams` has an old name.
    named = ["rests", "--jams"] if command == "jams" and dice.random() < 0.5 else [command]
    args = named + ["d.toml"] + design_options(dice) + exec_options(dice)
    if command == "hold":
        args += ["--directions", value(dice, 1, 7, 72)]
        args += dice.choice([[], ["--pose", pose(dice)], ["--play", length(dice)], ["--lever", length(dice)], ["--preload", number(dice)]])
    else:
        args += ["--samples", value(dice, 100, 120) if command == "success" else value(dice, 0, 5, 20)]
    if command in ("jams", "rests"):
        args += ["--examine", value(dice, 0, 1)]
        args += dice.choice([[], [], ["--resolution", resolution(dice)], ["--certified"]])
    if command == "window":
        args += dice.choice([[], ["--fix", pose(dice)], ["--proportions", pose(dice)]])
    if command == "success":
        args += ["--resolution", value(dice, 0, 3)]
        args += dice.choice([["--robots", "robots.toml"], ["--error-sigma", pose(dice)], ["--error-uniform", pose(dice)],
                             ["--error-measured", "p.csv"]])
    if command == "friction":
        args += ["--frictions", ",".join(value(dice, 0.1, 0.5) for _ in range(dice.randint(1, 2)))]
    elif command in ("window", "success", "jams", "hold") and dice.random() < 0.2:
        args += ["--friction", value(dice, 0.1, 0.5)]
    if dice.random() < 0.06:
        args += ["--require", "sum<=" + number(dice)]
    return args + written(dice, "svg", "png", "csv", "json")


def chance(dice):
    args = [dice.choice(["dynamics", "chance"]), "d.toml"] + design_options(dice) + exec_options(dice)
    args += ["--trials", value(dice, 1, 2), "--samples", value(dice, 100), "--timeout", value(dice, 0.1, 0.3)]
    args += dice.choice([[], ["--dynamics", "dynamics.toml"], ["--draw", f"friction={number(dice)}..{number(dice)}", "--push", number(dice)],
                         ["--draw", f"speed={length(dice)} ± {number(dice)}"]])
    args += dice.choice([[], ["--pose", pose(dice)], ["--poses", "p.csv"], ["--times", "1," + value(dice, 2, 3)],
                         ["--map", ",".join(dice.choices(AXES, k=2)), "--resolution", value(dice, 1, 2)], ["--error-sigma", pose(dice)]])
    return args + written(dice, "svg", "png", "csv", "json")


def bench(dice):
    """A robot trial, planned or evaluated."""
    if dice.random() < 0.5:
        args = ["validate", "tried.csv", "d.toml", "--repeatability", pose(dice)]
        args += dice.choice([[], [], ["--estimate-friction"], ["--limit", value(dice, 1, 3)]])
    else:
        args = ["plan", "d.toml", "--repeatability", pose(dice)]
        args += dice.choice([["--pattern", "grid", "--steps", f"x={value(dice, 2, 3)},pitch={value(dice, 2)}"],
                             ["--pattern", "lattice", "--step", length(dice), "--max", pose(dice)],
                             ["--pattern", "arc", "--lever", length(dice), "--pitch", "0..10:5 deg"],
                             ["--pattern", "bracket", "--trials", value(dice, 4, 12), "--lines", value(dice, 1, 2)]])
        args += dice.choice([[], ["--repeats", value(dice, 2)], ["--blocks", value(dice, 2)], ["--in-order"], ["--symmetric"]])
    args += dice.choice([[], ["--figure", "pics.svg"], ["--figure", "out.csv"], ["--offsets-at", "cor"]])
    return args + design_options(dice) + written(dice, "csv", "json", "svg", "png")


def place(dice):
    parts = dice.choice([["socket.obj", "plug.ply"], ["socket.obj", "plug.ply"], ["meshes/socket.stl", "meshes/plug.stl"]])
    args = ["place", *parts, "--unit", dice.choice(["mm", "m", "in"])] + exec_options(dice)
    ways = ["+x", "-y", "+z", "z"]
    beside = ["socket.obj", "plug.ply", "none.stl", "{ sphere = { radius = 2 }, at = [1, 0, 8] }", "box = [2, 2, " + length(dice) + "]", "x", "sphere = {"]
    for option in dice.choice([[], [], ["--with-fixed"], ["--with-moving", "--with-moving"], ["--with-fixed", "--with-moving"]]):
        args += [option, dice.choice(beside)]
    args += dice.choice([[], ["--drawn", "assembled"], ["--drawn", "facing"], ["--approach=" + dice.choice(ways)], ["--facing-fixed=" + dice.choice(ways)]])
    return args + dice.choice([[], ["-o", "out.toml"], ["-o", "out.toml", "--figure", "pics.svg"], ["-o", parts[0], "--force"]])


def page(dice):
    args = ["report", dice.choice(["d.toml", "d.toml", "s", "s.zarr"]), "-o", "out.html"] + exec_options(dice)
    return args + ["--resolution", resolution(dice), "--leave-out", "jams", "--leave-out", "window"] + dice.choice([[], [], design_options(dice)])


def systems(dice):
    """Commands on systems above the connector."""
    command = dice.choice("solids classify catalog invert compose latch chain".split())
    of_design = [command, "d.toml"] + design_options(dice)
    if command == "solids":
        return of_design + ["--slices", value(dice, 2, 3), "--strips", value(dice, 1, 2)] + written(dice, "vtp", "obj", "svg", "png")
    if command == "classify":
        return of_design + dice.choice([[], ["--json"]])
    if command == "catalog":
        return dice.choice([["catalog", "--append", "d.toml"], ["catalog", "--where", "gendering=" + dice.choice(["Ungendered", "x"])],
                            ["catalog", "--as-printed", "1.1"], ["catalog", "show", dice.choice(["DRAGON", "x"])], ["catalog", "--csv"],
                            ["catalog", "design", "polybot", "-o", "d.toml", "--force"], ["catalog", "--figure", "4.2", "-o", "out.svg"]])
    if command == "invert":
        args = of_design + dice.choice([[], ["--heights", "heights.csv"], ["--heights", "v.toml"], ["--pitch", "-5..5 deg/3"], ["--yaw", number(dice)]])
        return args + dice.choice([[], ["--backing", number(dice)], ["--min-feature", length(dice)]]) + written(dice, "toml", "svg", "png")
    if command == "compose":
        regions = ["region.csv", "region.svg", "hook.toml", "loop.toml", "v.toml"]
        args = ["compose", dice.choice(regions), dice.choice(regions), "--headings", value(dice, 2, 3)] + exec_options(dice)
        args += dice.choice([[], ["--heading", "-5..5 deg"], ["--heading", length(dice)], ["--frames", "world"],
                             ["--keep-out", f"{dice.choice(regions)},{dice.choice(regions)}"]])
        return args + dice.choice([[], ["--outline"]]) + written(dice, "svg", "png", "csv")
    if command == "latch":
        return dice.choice([["latch", "latch.toml"], ["latch", "latch.toml", "-o", "out"], ["latch", "--table", "-o", "out.csv"]])
    args = ["chain", "chain.toml", "--samples", value(dice, 1, 5)] + exec_options(dice)
    args += dice.choice([[], ["--modules", value(dice, 2, 3)], ["--modules", "2..4"], ["--joint-sigma", "1 deg," + length(dice)]])
    return args + written(dice, "svg", "png", "csv", "json")


def many(dice):
    """Commands on several designs or tables."""
    if dice.random() < 0.2:
        return ["reproduce", dice.choice(["2.1", "2.1", "9.9"])] + dice.choice([[], ["--json"], ["--csv"], ["-o", "out"]]) + exec_options(dice)
    args = ["sweep", "d.toml", "--resolution", resolution(dice), "--samples", value(dice, 0, 10)] + design_options(dice) + exec_options(dice)
    for _ in range(dice.randint(1, 2)):
        key = dice.choice(["cor", "rho", "aspect_ratio", "errors.x", "family", "connector.moving.mesh", "nothing"])
        args += ["--over", key + "=" + dice.choice(["0,1", "0.5", "-1..1/2", "1..2 deg/3", "cone,v-face", length(dice)])]
    return args + dice.choice([[], ["--json"], ["-o", "out"]])


def single(dice):
    command = dice.choice(["trace", "zraa", "export", "check", "check"])
    args = [command, "d.toml"] + design_options(dice)
    if command in ("trace", "export"):
        args += ["--pose", pose(dice)]
    if command == "export":
        return args + ["-o", "out"] + (drop_options(dice) if dice.random() < 0.3 else [])
    if command != "check":
        args += dice.choice([[], [], ["-o", "out." + dice.choice(["svg", "png", "glb", "csv", "json", "xyz", "zarr"])]])
    return args + dice.choice([[], ["--json"]])


def small(dice):
    families = "v-face s-face x-face pyramid cone x-face-3d x-face-3d-locking pin-hole nonsense".split()
    return dice.choice([["new", dice.choice(families)], ["new", dice.choice(families), "-o", "d.toml"] + ["--force"] * dice.randint(0, 1),
                        ["schema"], ["completions", dice.choice(["bash", "zsh", "x"])], ["man", dice.choice(["run", "x"])], ["--help"]])


def words(dice):
    """A mutated command line of the corpus."""
    lines = corpus("arguments")
    data = spoilt(dice, dice.choice(lines), lines)
    return [word for word in data.replace(b"\0", b"").split(b"\n")]


# The generators of command lines, each with its frequency and its subcommands.
KINDS = {
    run: (6, ["run"]),
    outcome: (4, ["trace"]),
    slices: (2, ["slices"]),
    compare: (5, ["compare"]),
    single: (4, ["trace", "zraa", "export", "check"]),
    small: (1, ["new", "schema", "completions", "man", "--help"]),
    words: (3, []),
    study: (5, ["window", "success", "friction", "rests", "hold"]),
    chance: (2, ["dynamics"]),
    bench: (3, ["plan", "validate"]),
    place: (2, ["place"]),
    page: (1, ["report"]),
    systems: (5, ["solids", "classify", "catalog", "invert", "compose", "latch", "chain"]),
    many: (2, ["sweep", "reproduce"]),
}


# Renamed subcommands; the old names still work.
OLD = {"outcome": "trace", "jams": "rests", "chance": "dynamics"}


def subcommands(program):
    """The subcommands that the program's help lists."""
    listed = subprocess.run([program, "--help"], capture_output=True, text=True, check=True).stdout
    return set(re.findall(r"^  ([a-z]+)  ", listed, re.MULTILINE))


class Storm:
    def __init__(self, program, longest, keep):
        self.program, self.most, self.keep = str(Path(program).resolve()), longest, keep
        self.home = Path(tempfile.mkdtemp(prefix="storm-"))
        self.work = self.home / "work"
        covered = {name for _, names in KINDS.values() for name in names if not name.startswith("-")} | set(LEFT_OUT)
        differ = covered ^ subcommands(self.program)
        assert not differ, f"the program and the storm do not have the same subcommands: {sorted(differ)}"
        self.tables, self.meshes = corpus("poses"), corpus("stl")
        self.others, self.beside = self.files_beside()
        self.sound = [path.read_bytes() for path in sorted((ROOT / "designs").glob("*.toml"))]
        self.designs = corpus("design") + self.sound + self.of_files()
        self.codes, self.commands = collections.Counter(), collections.Counter()
        self.largest, self.longest, self.slow, self.faults = (0, ""), (0.0, ""), [], []
        self.results = self.home / "results"
        self.results.mkdir()
        self.design = (ROOT / "designs/v-face.toml").read_bytes()
        (self.results / "d.toml").write_bytes(self.design)
        for place in ("s", "s.zarr"):
            args = ["run", "d.toml", "--method", "flood", "--resolution", "6", "-o", place]
            code, _, _, output = self.start(args, self.results)
            assert code == 0, output
        self.stored = [path.relative_to(self.results) for path in sorted(self.results.rglob("*")) if path.is_file()]

    @staticmethod
    def files_beside():
        """By name: files that other commands read, and files that supply mutations."""
        read = lambda path: (ROOT / "designs" / path).read_bytes()
        files = {
            "robots.toml": read("robots/robots.toml"),
            "arm-d.csv": read("robots/arm-d.csv"),
            "dynamics.toml": read("robots/dynamics.toml"),
            "tried.csv": read("trials/pyramid-arc.csv"),
            "socket.obj": read("meshes/assembled-socket.obj"),
            "plug.ply": read("meshes/assembled-plug.ply"),
            "heights.csv": read("systems/wanted-bowl.csv"),
            "hook.toml": read("systems/hook.toml"),
            "loop.toml": read("systems/loop.toml"),
            "latch.toml": read("systems/latch.toml"),
            "chain.toml": read("systems/chain.toml").replace(b"../x-face.toml", b"x.toml"),
            "region.csv": b"x,y,ring\n0,0,a\n40,0,a\n40,30,a\n0,30,a\n10,10,b\n20,10,b\n15,20,b\n",
            "region.svg": b'<svg xmlns="http://www.w3.org/2000/svg"><g><path d="M0 0L30 0L30 20C20 30 10 30 0 20Z"/></g></svg>',
        }
        beside = {"v.toml": read("v-face.toml"), "x.toml": read("x-face.toml")}
        return files, beside

    @staticmethod
    def of_files():
        """Designs of the files of all readers that are in `drawn`: meshes of every format, and profiles from drawings."""
        mesh = '[connector]\nwidth = 1.0\nfixed = {{ mesh = "part.{0}"{1} }}\nmoving = {{ mesh = "part.{0}"{1} }}\n[errors]\nx = 0.5\n'
        part = '[connector]\nwidth = 10.0\nunit = "mm"\n[[connector.fixed.parts]]\nprofile = "part.{0}"\nunit = "mm"\nheight = 5\n[[connector.moving.parts]]\nbox = [4, 4, 5]\n'
        designs = [mesh.format(ending, "") for ending in ("stl", "obj", "ply")] + [part.format(ending) for ending in ("svg", "dxf")]
        designs += [mesh.format(ending, "").replace("width = 1.0", 'width = 1.0\nunit = "mm"') for ending in ("3mf", "step")]
        return [design.encode() for design in designs]

    def drawn(self, dice):
        """By name: the files of those designs, from the corpora of the fuzzer, some of them mutated."""
        files = {"part.step": b"ISO-10303-21;\n"}
        for name, endings in (("stl", ["stl"]), ("obj", ["obj"]), ("ply", ["ply"]), ("threemf", ["3mf"]), ("drawing", ["svg", "dxf"])):
            seeds = corpus(name)
            for ending in endings:
                data = dice.choice(seeds)
                files["part." + ending] = spoilt(dice, data, seeds) if dice.random() < 0.6 else data
        return files

    def start(self, args, folder):
        """Exit code (minus the signal), kilobytes, CPU seconds and output."""
        with open(self.home / "stdout", "wb") as out, open(self.home / "stderr", "wb") as err, open(os.devnull) as null:
            pid = os.fork()
            if pid == 0:
                try:
                    os.chdir(folder)
                    # A storm started in the background ignores Ctrl-C, and the program would inherit that.
                    for number in (signal.SIGINT, signal.SIGPIPE, signal.SIGXFSZ):
                        signal.signal(number, signal.SIG_DFL)
                    signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGCHLD})
                    for to, stream in enumerate((null, out, err)):
                        os.dup2(stream.fileno(), to)
                    os.execve(self.program, [self.program, *args], {"PATH": "/usr/bin:/bin", "HOME": str(self.home)})
                finally:
                    os._exit(99)
            sent, until = None, 0.0
            while True:
                ended, status, usage = os.wait4(pid, os.WNOHANG)
                if ended:
                    break
                if time.monotonic() > until if sent else self.used(pid) >= self.most:
                    sent, until = (signal.SIGKILL if sent else signal.SIGINT), time.monotonic() + DEAF
                    os.kill(pid, sent)
                signal.sigtimedwait({signal.SIGCHLD}, 1.0)
        code, took = os.waitstatus_to_exitcode(status), usage.ru_utime + usage.ru_stime
        if sent == signal.SIGINT and code == -signal.SIGINT:
            code = 130  # the shells' code: interrupted while reading, before any work
        if sent == signal.SIGINT and code == 130:
            self.slow.append((took, args))
        return code, usage.ru_maxrss, took, (self.home / "stderr").read_bytes()

    @staticmethod
    def used(pid):
        """CPU seconds."""
        fields = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def prepare(self, dice):
        """A folder with a design, a table and stored results, some of them mutated; and the command."""
        shutil.rmtree(self.work, ignore_errors=True)
        self.work.mkdir()
        dice.calm = dice.random() < 0.4
        kind = dice.choices(list(KINDS), weights=[weight for weight, _ in KINDS.values()])[0]
        args = kind(dice)
        assert kind is words or OLD.get(args[0], args[0]) in KINDS[kind][1], args
        design = dice.choice(self.designs)
        if dice.calm:
            design = self.design if kind in (compare, chance, page) else dice.choice(self.sound)
        elif dice.random() < 0.35:
            design = spoilt(dice, design, self.designs)
        if kind in (compare, page):
            shutil.copytree(self.results, self.work, dirs_exist_ok=True)
            if dice.random() < 0.5:
                design = self.design
            for name in dice.sample(self.stored, dice.choice([0, 1, 1, 1, 2])):
                data = (self.work / name).read_bytes()
                (self.work / name).write_bytes(spoilt(dice, data, [data, self.design]))
        elif dice.random() < 0.2:
            shutil.copytree(self.results / "s", self.work / "out")
        (self.work / "d.toml").write_bytes(design)
        table = dice.choice(self.tables)
        table = b"x\n0.1\n-0.2\n" if dice.calm else spoilt(dice, table, self.tables) if dice.random() < 0.5 else table
        (self.work / "p.csv").write_bytes(table)
        (self.work / "s").mkdir(exist_ok=True)
        for name, data in self.beside.items():
            (self.work / name).write_bytes(data)
        if b'"part.' in design:
            for name, data in self.drawn(dice).items():
                (self.work / name).write_bytes(data)
        seeds = list(self.others.values())
        for name, data in self.others.items():
            (self.work / name).write_bytes(spoilt(dice, data, seeds) if dice.random() < 0.25 and not dice.calm else data)
        (self.work / "meshes").mkdir()
        for name in ("plug.stl", "socket.stl"):
            mesh = (ROOT / "designs/meshes" / name).read_bytes()
            mesh = spoilt(dice, dice.choice([mesh, *self.meshes]), self.meshes) if dice.random() < 0.3 and not dice.calm else mesh
            (self.work / "meshes" / name).write_bytes(mesh)
        return kind, args

    def one(self, seed, count):
        dice = Dice(f"{seed}/{count}")
        kind, args = self.prepare(dice)
        if dice.random() < 0.05 and kind is not words and not dice.calm:
            args[dice.randrange(len(args))] = dice.choice(["", "-", "--", "\x1b[2J", "x" * 300, "é\u202e", number(dice)])
        if self.keep:
            shutil.rmtree(self.keep / "last", ignore_errors=True)
            shutil.copytree(self.work, self.keep / "last", symlinks=True)
        code, kilobytes, took, output = self.start(args, self.work)
        shown = " ".join(map(repr, args))
        text = output.decode("utf-8", "replace")
        left = [str(path.relative_to(self.work)) for path in self.work.rglob(".*") if path.name.endswith((".tmp", ".old"))]
        steers = [c for c in text if (ord(c) < 32 and c != "\n") or 127 <= ord(c) < 160 or c in "\u202e\u2066"]
        for wrong, what in (
            (code not in ALLOWED, f"it ended with {code}"),
            (code in (130, 143) and args not in [args for _, args in self.slow], "it was not interrupted"),
            (code in range(2, 6) and not text.strip() and (self.home / "stdout").stat().st_size == 0, "it printed nothing"),
            ("panicked" in text or "a bug of" in text, "it called something a bug"),
            (steers, f"control characters came through: {steers}"),
            (left, f"it left {left}"),
        ):
            if wrong:
                self.faults.append((count, what, shown))
                print(f"FAULT: seed {seed}, number {count}: {what}: {shown}\n{text}", file=sys.stderr, flush=True)
                if self.keep:
                    shutil.copytree(self.keep / "last", self.keep / f"{seed}-{count}", dirs_exist_ok=True)
                    (self.keep / f"{seed}-{count}" / "ARGS").write_text(shown + "\n" + text)
        self.codes[code] += 1
        self.commands["words" if kind is words else args[0] if args else ""] += 1
        self.largest = max(self.largest, (kilobytes, f"{count}: {shown}"))
        self.longest = max(self.longest, (took, f"{count}: {shown}"))

    def tell(self, runs, began):
        print(f"{runs} runs in {time.monotonic() - began:.0f} s: exit codes {dict(sorted(self.codes.items()))}, {dict(self.commands)}")
        print(f"largest memory {self.largest[0] / 1024:.0f} MiB (run {self.largest[1]})")
        print(f"longest time {self.longest[0]:.1f} s of the processor (run {self.longest[1]})")
        print(f"{len(self.slow)} interrupted after {self.most:.0f} s of the processor, {len(self.faults)} faults", flush=True)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("count", type=int, nargs="?", default=300)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--from", type=int, default=0, dest="first")
    parser.add_argument("--mib", type=int, default=1024)
    parser.add_argument("--longest", type=float, default=20.0)
    parser.add_argument("--keep", type=Path)
    options = parser.parse_args()
    resource.setrlimit(resource.RLIMIT_AS, (options.mib << 20, options.mib << 20))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    # Collected by sigtimedwait, without a handler.
    signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGCHLD})
    storm, began = Storm(options.program, options.longest, options.keep), time.monotonic()
    try:
        for count in range(options.first, options.first + options.count):
            storm.one(options.seed, count)
            if (count + 1) % 1000 == 0:
                storm.tell(count + 1 - options.first, began)
    finally:
        storm.tell(sum(storm.codes.values()), began)
        shutil.rmtree(storm.home, ignore_errors=True)
    sys.exit(bool(storm.faults))


if __name__ == "__main__":
    main()
