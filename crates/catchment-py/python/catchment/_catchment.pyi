"""The compiled part: the library's `Problem` and `Run`. Use the package `catchment`, which gives it names, units and defaults."""

from typing import final

import numpy as np
from numpy.typing import NDArray

from ._arguments import Asked, Changes, Expected, How

__all__ = ["Answer", "Problem", "Rendered", "Sweep", "__version__", "compare", "methods", "program", "read_text"]

__version__: str

def read_text(path: str) -> str:
    """The text of a design file."""

def methods() -> list[tuple[str, str]]:
    """Every method: its name, and what it does in a line."""

def program(words: list[str]) -> int:
    """Does what a command line says, the name of the program first; returns the exit code."""

def compare(
    sides: tuple[str | tuple[str, Problem, str, str], str | tuple[str, Problem, str, str]],
    cells: str | None,
    how: How,
) -> Rendered:
    """Two acceptances: each where a result is stored, or (name, problem, method, settings as JSON)."""

@final
class Problem:
    """An alignment problem: geometry built, mated pose checked."""

    def __new__(
        cls, path: str, text: str, files: list[tuple[str, bytes]], changes: Changes, how: How
    ) -> Problem: ...
    def name(self) -> str:
        """What the design is called."""

    def digest(self) -> str:
        """SHA-256 of all that may change an answer."""

    def design(self) -> str:
        """The resolved design as JSON: lengths in D, angles in radians."""

    def doubts(self) -> list[str]:
        """What speaks against the mated pose, as sentences."""

    def error_box(self) -> list[tuple[str, float]]:
        """Names of the free errors, and the half-widths of the error box, in D and radians."""

    def files(self) -> list[tuple[str, bytes]]:
        """Every file that the halves come from, with what is in it, by its path."""

    def picture(self) -> tuple[str, bytes]:
        """Both halves as SVG and PNG."""

    def plan(self, asked: Asked, expected: Expected) -> str:
        """What was asked for as a run: JSON, refused now if it cannot be made."""

    def run(self, run: str, how: How) -> Answer:
        """Computes a run of `plan`."""

    def part(self, run: str, number: int, of: int, how: How) -> str:
        """Decides one part of a run: JSON for `merge`."""

    def merge(self, run: str, parts: list[str], how: How) -> Answer:
        """Puts the parts of a run together, and goes on as `run` does."""

    def pose(self, text: str) -> list[float]:
        """A pose error as a person writes it: x, y, roll, pitch, yaw in D and radians."""

    def follow(
        self, pose: list[float], name: str, settings: str, how: How
    ) -> tuple[str, list[float], float | None, list[tuple[str, str, list[float]]]]:
        """Where one pose ends: its outcome, the last pose error, z of the centre of rotation there, and what touches; in D and radians."""

    def follow_many(
        self, poses: NDArray[np.float64], name: str, settings: str, how: How
    ) -> tuple[NDArray[np.uint8], NDArray[np.float64], NDArray[np.float64]]:
        """Where every row ends: (n, 5) in D and radians → codes (n,), last errors (n, 5) and heights (n,)."""

    def trace(self, pose: list[float], friction: float, how: How) -> Rendered:
        """The way of one pose, from first contact to where it rests."""

    def window(
        self,
        fix: str | None,
        proportions: str | None,
        motions: int | None,
        seed: int,
        friction: float,
        how: How,
    ) -> Rendered:
        """The largest box of errors that all dock."""

    def jams(
        self,
        motions: int | None,
        seed: int,
        examine: int,
        cells: str | None,
        friction: float,
        certified: bool,
        expected: Expected,
        how: How,
    ) -> Rendered:
        """Where it jams instead of docking, and on which features."""

    def zraa(self, how: How) -> Rendered:
        """Offsets that are corrected by sliding alone, exactly."""

@final
class Answer:
    """The answer of a run."""

    def json(self) -> str:
        """The report, as the command line prints it."""

    def table(self) -> str:
        """The report for eyes."""

    def outcomes(self) -> NDArray[np.uint8]:
        """The code of every outcome, the first axis fastest: 1 aligned, 2 jammed, 3 missed, 4 undecided."""

    def heights(self) -> NDArray[np.float32] | None:
        """Heights of first contact over the grid, in D, where they were kept."""

    def unmet(self) -> list[str]:
        """The requirements that are not met, as sentences."""

    def draw(self, how: How) -> list[tuple[str, str, bytes]]:
        """Every picture: its name, SVG and PNG."""

    def save(self, path: str, how: How) -> None:
        """Writes everything into a folder, or the Zarr group alone where the path ends with `.zarr`."""

@final
class Rendered:
    """A report as JSON, text, CSV and picture."""

    @property
    def json(self) -> str:
        """The report, as the command line prints it."""

    @property
    def table(self) -> str:
        """For eyes."""

    @property
    def csv(self) -> str:
        """For programs."""

    def svg(self) -> str | None:
        """The picture as SVG."""

    def png(self) -> bytes | None:
        """The picture as PNG."""

@final
class Sweep:
    """The designs of a sweep, read and not yet computed."""

    def __new__(
        cls, problem: Problem, over: list[str], asked: Asked, expected: Expected, output: str | None
    ) -> Sweep: ...
    def __len__(self) -> int: ...
    def missing(self) -> list[int]:
        """The numbers of the designs that are not kept yet."""

    def design(self, number: int, how: How) -> tuple[str, str] | None:
        """Computes one design: its key and its figures as JSON; None where its halves do not build."""

    def keep(self, key: str, found: str) -> None:
        """Keeps what was found elsewhere, where results are kept."""

    def run(self, found: list[tuple[str, str]], how: How) -> Rendered:
        """Computes what neither `found` nor the folder has, and tells the whole."""
