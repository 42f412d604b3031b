"""A design of STEP files, where OpenCASCADE is there: from Python the numbers of the program."""

import shutil
import sys
from pathlib import Path

import pytest
from conftest import ROOT, bytes_of, program

import catchment

pytest.importorskip("OCP")

DESIGN = """[connector]
unit = "mm"
fixed = { mesh = "socket.step", deflection = "0.05 mm" }
moving = { mesh = "peg.step", deflection = "0.05 mm" }
[alignment]
free = ["x", "y"]
"""


def test_step_files_are_the_same_from_both_sides(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for part in ("socket.step", "peg.step"):
        shutil.copy(ROOT / "tests/step" / part, tmp_path)
    (tmp_path / "design.toml").write_text(DESIGN)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("CATCHMENT_PYTHON", sys.executable)
    problem = catchment.load("design.toml")
    # Its flat end, radius 3, slides off the mouth, radius 9.2, up to an offset of 6.2 (tests/step_meshes.py).
    assert problem.follow("x=5 mm").docks and not problem.follow("x=7.5 mm").docks
    result = problem.run(resolution=8, samples=50)
    printed = program("run", "design.toml", "--resolution", 8, "--samples", 50, "--json", cwd=tmp_path)
    assert bytes_of(result.json) == bytes_of(printed)
