"""The command of the wheel, Ctrl-C, types, and the lines of the README."""

import contextlib
import importlib.metadata
import os
import pickle
import re
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from conftest import PROGRAM, ROOT, bytes_of, program

import catchment

PACKAGE = Path(catchment.__file__).parent


def test_the_wheel_puts_the_command_on_the_path() -> None:
    own = str(Path(sys.executable).with_name("catchment"))
    done = subprocess.run([own, "--version"], capture_output=True, text=True, check=True)
    assert done.stdout == f"catchment {catchment.__version__}\n"
    module = subprocess.run([sys.executable, "-m", "catchment", "--version"], capture_output=True, text=True, check=True)
    assert module.stdout == done.stdout
    for words, code in ((["run", "no-such.toml"], 3), (["no-such-command"], 2)):
        done = subprocess.run([own, *words], capture_output=True, text=True, check=False)
        assert (done.returncode, done.stdout) == (code, "") and done.stderr
    unmet = ["run", "designs/v-face.toml", "--resolution", "9", "--require", "onaa.edge>=1"]
    assert subprocess.run([own, *unmet], capture_output=True, check=False).returncode == 1


#: More work than a test has time for; prints a line when it has begun.
LONG = """
import catchment
problem = catchment.load("designs/x-face-3d.toml")
try:
    problem.run(resolution=40, samples=0, progress=lambda share, stage: print("begun", flush=True))
except KeyboardInterrupt:
    print("stopped", flush=True)
"""


@pytest.mark.skipif(os.name == "nt", reason="Windows has no SIGINT for one process")
@pytest.mark.parametrize("what", ["python", "program"])
def test_ctrl_c_ends_a_computation(what: str) -> None:
    own = str(Path(sys.executable).with_name("catchment"))
    words = {
        "python": [sys.executable, "-c", LONG],
        "program": [own, "run", "designs/x-face-3d.toml", "--resolution", "40", "--samples", "0"],
    }[what]
    # What is begun in the background of a script ignores SIGINT, and so do its children: not here.
    process = subprocess.Popen(
        words,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        cwd=ROOT,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )
    assert process.stdout is not None
    if what == "python":
        assert process.stdout.readline() == "begun\n"
    else:
        # It has begun when it listens to the signal by itself.
        listens(process.pid)
    process.send_signal(signal.SIGINT)
    output, complaint = process.communicate(timeout=120)
    if what == "python":
        assert output.endswith("stopped\n") and process.returncode == 0, complaint
    else:
        assert process.returncode == 130 and "interrupted" in complaint, complaint


#: Two processes that are forked from one that has computed, and one that is not.
FORKED = """
import multiprocessing
import catchment

def main():
    problem = catchment.load("designs/v-face.toml")
    with multiprocessing.get_context("fork").Pool(2) as pool:
        for refused in (pool.apply_async(problem.follow, ("x=0.1",)), pool.apply_async(catchment.load, ("designs/v-face.toml",))):
            try:
                refused.get(100)
            except catchment.ComputeError as error:
                print(error)
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        print(pool.apply_async(problem.follow, ("x=0.1",)).get(100).outcome)

if __name__ == "__main__":
    main()
"""


@pytest.mark.skipif(os.name == "nt", reason="Windows has no fork")
def test_a_fork_is_refused_and_does_not_wait_for_ever(tmp_path: Path) -> None:
    script = tmp_path / "forked.py"
    script.write_text(FORKED)
    words = [sys.executable, "-W", "ignore::DeprecationWarning", str(script)]
    lines = subprocess.run(words, capture_output=True, text=True, check=True, cwd=ROOT, timeout=300).stdout.splitlines()
    assert len(lines) == 3 and lines[2] == "aligned", lines
    assert all("was forked" in line and 'multiprocessing.get_context("spawn")' in line for line in lines[:2]), lines


def test_a_problem_out_of_a_pickle_is_built_when_it_is_needed() -> None:
    problem = catchment.load("designs/pyramid-stl.toml")
    again = pickle.loads(pickle.dumps(pickle.loads(pickle.dumps(problem))))
    assert again == problem and hash(again) == hash(problem)
    assert again.follow("x=1 mm").outcome == problem.follow("x=1 mm").outcome


def test_the_wheel_has_the_licences_of_compiled_packages() -> None:
    files = {Path(str(file)).name: file for file in importlib.metadata.files("catchment") or []}
    assert {"LICENSE-MIT", "LICENSE-APACHE", "LICENSE-THIRD-PARTY.txt"} <= set(files)
    text = files["LICENSE-THIRD-PARTY.txt"].read_text()
    assert all(f"\n{name} " in text for name in ("rayon", "pyo3", "numpy", "dejavu", "three"))


def listens(process: int) -> None:
    """Waits until a process has a thread that waits for signals."""
    while "signals" not in thread_names(process):
        time.sleep(0.001)


def thread_names(process: int) -> Iterator[str]:
    """The names of a process's threads, without threads that end before their name is read."""
    for task in Path(f"/proc/{process}/task").iterdir():
        with contextlib.suppress(FileNotFoundError, ProcessLookupError):
            yield task.joinpath("comm").read_text().strip()


@pytest.mark.parametrize("page", ["docs/python.md", "crates/catchment-py/README.md"])
def test_the_lines_of_the_pages_run(page: str) -> None:
    assert isinstance(run_blocks(page)["result"], catchment.Result)


def test_the_lines_of_the_readme_run() -> None:
    result = run_blocks("README.md")["result"]
    assert isinstance(result, catchment.Result)
    assert bytes_of(result.json) == bytes_of(program("run", "designs/v-face.toml", "--json"))


def run_blocks(page: str) -> dict[str, object]:
    """The names that the lines of Python of a page leave, all in a row."""
    blocks = re.findall(r"```python\n(.*?)```", (ROOT / page).read_text(), re.DOTALL)
    assert blocks
    names: dict[str, object] = {}
    for block in blocks:
        exec(compile(block, page, "exec"), names)
    return names


def test_types_are_whole() -> None:
    pytest.importorskip("mypy")
    # From its source: what is beside an installed package is not judged.
    source = str(ROOT / "crates" / "catchment-py" / "python" / "catchment")
    words = [sys.executable, "-m", "mypy", "--strict", "--no-incremental", "--cache-dir", os.devnull, source]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert (PACKAGE / "py.typed").exists()


#: Without the end of the process, in which Python gives back millions of types, one by one: half of its time.
STUBTEST = """
import os
from mypy import stubtest
code = stubtest.test_stubs(stubtest.parse_options(["catchment._catchment", "--ignore-disjoint-bases", "--concise"]))
os._exit(code)
"""


def test_stubs_agree_with_the_compiled_module() -> None:
    pytest.importorskip("mypy")
    done = subprocess.run([sys.executable, "-uc", STUBTEST], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_every_public_name_is_documented() -> None:
    for name in catchment.__all__:
        if name not in ("OUTCOMES", "__version__"):
            assert getattr(catchment, name).__doc__, name
    for kind in (catchment.Problem, catchment.Result, catchment.Report):
        for name, member in vars(kind).items():
            if not name.startswith("_"):
                assert member.__doc__, f"{kind.__name__}.{name}"


def test_the_program_is_the_one_beside_this_python() -> None:
    assert Path(PROGRAM).exists()
