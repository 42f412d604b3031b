"""What the tests share: designs, and the program, which must say the same."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[3]
DESIGNS = ROOT / "designs"
#: The program that the wheel put beside this Python, or another one to compare with: that of cargo.
PROGRAM = os.environ.get("CATCHMENT_PROGRAM") or str(Path(sys.executable).with_name("catchment"))


@pytest.fixture(autouse=True)
def in_the_repository(monkeypatch: pytest.MonkeyPatch) -> None:
    """Paths in reports are as they were given: the program and Python are given the same."""
    monkeypatch.chdir(ROOT)


def program(*words: object, cwd: Path = ROOT) -> str:
    """What the program prints."""
    done = subprocess.run([PROGRAM, *map(str, words)], capture_output=True, text=True, check=True, cwd=cwd)
    return done.stdout


def bytes_of(report: str) -> str:
    """A report up to `timing`, its last field and the only one that differs between equal runs."""
    before, found, _ = report.partition('\n  "timing"')
    assert found
    return before
