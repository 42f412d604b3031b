"""The compiled module: `Problem` and `Run` of the library. Use the package `catchment`, which adds names, units and defaults."""

from typing import final

import numpy as np
from numpy.typing import NDArray

from ._arguments import Requested, Changes, Expected, How

__all__ = ["Answer", "Problem", "Rendered", "Sweep", "__version__", "compare", "methods", "program", "read_text"]

__version__: str

def read_text(path: str) -> str:
    """The text of a design file."""

def methods() -> list[tuple[str, str]]:
    """Every method: its name, and a description in a single line."""

def program(words: list[str]) -> int:
    """Runs a command line; its first word is the name of the program. Returns the exit code."""

def compare(
    sides: tuple[str | tuple[str, Problem, str, str], str | tuple[str, Problem, str, str]],
    cells: str | None,
    how: How,
) -> Rendered:
    """Compares two areas of acceptance: each the path of a stored result, or (name, problem, method, settings as JSON)."""

@final
class Problem:
    """An alignment problem, with its geometry built and its mated pose checked."""

    def __new__(
        cls, path: str, text: str, files: list[tuple[str, bytes]], changes: Changes, how: How
    ) -> Problem: ...
    def name(self) -> str:
        """Name of the design."""

    def digest(self) -> str:
        """SHA-256 of everything that can change a result."""

    def design(self) -> str:
        """The resolved design as JSON: lengths in D, angles in radians."""

    def diagnostics(self) -> list[tuple[str, str | None, int | None, int | None, str, str]]:
        """Warnings about the mated pose: message, advice, line, column, severity and code."""

    def error_box(self) -> list[tuple[str, float]]:
        """Names of the free errors, with the half-widths of the error box, in D and radians."""

    def files(self) -> list[tuple[str, bytes]]:
        """Every source file of the halves: its path and its content."""

    def picture(self) -> tuple[str, bytes]:
        """Both halves as SVG and PNG."""

    def plan(self, requested: Requested, expected: Expected) -> str:
        """The arguments as a run in JSON. Raises if the run is impossible."""

    def run(self, run: str, how: How) -> Answer:
        """Computes a run of `plan`."""

    def part(self, run: str, number: int, of: int, how: How) -> str:
        """Decides a part of a run; returns JSON for `merge`."""

    def merge(self, run: str, parts: list[str], how: How) -> Answer:
        """Merges the parts of a run, and continues as `run` does."""

    def pose(self, text: str) -> list[float]:
        """Parses a pose error; returns x, y, roll, pitch, yaw in D and radians."""

    def follow(
        self, pose: list[float], name: str, settings: str, how: How
    ) -> tuple[str, list[float], float | None, list[tuple[str, str, list[float]]]]:
        """Follows a pose: its outcome, and the pose error, z of the centre of rotation and contacts of its final state; in D and radians."""

    def follow_many(
        self, poses: NDArray[np.float64], name: str, settings: str, how: How
    ) -> tuple[NDArray[np.uint8], NDArray[np.float64], NDArray[np.float64]]:
        """Follows every row: (n, 5) in D and radians → codes (n,), final errors (n, 5) and heights (n,)."""

    def trace(self, pose: list[float], friction: float, how: How) -> Rendered:
        """The trajectory of a pose, from first contact to rest."""

    def window(
        self,
        fix: str | None,
        proportions: str | None,
        motions: int | None,
        seed: int,
        friction: float,
        how: How,
    ) -> Rendered:
        """Finds the tolerance window: the largest box of errors that all dock."""

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
        """Finds the jams: rests that do not dock, with their features."""

    def zraa(self, how: How) -> Rendered:
        """Computes exactly the offsets corrected with all rotations locked (ZRAA)."""

@final
class Answer:
    """The result of a run."""

    def json(self) -> str:
        """The report, as the command line prints it."""

    def table(self) -> str:
        """The report as a table to read."""

    def outcomes(self) -> NDArray[np.uint8]:
        """The code of every outcome: 1 aligned, 2 jammed, 3 missed, 4 undecided. The first axis varies fastest."""

    def heights(self) -> NDArray[np.float32] | None:
        """Heights of first contact over the grid, in D; None unless they were kept."""

    def unmet(self) -> list[str]:
        """Unmet requirements, as sentences."""

    def draw(self, how: How) -> list[tuple[str, str, bytes]]:
        """Draws every picture: its name, SVG and PNG."""

    def save(self, path: str, how: How) -> None:
        """Writes everything into a folder, or only the Zarr group if the path ends with `.zarr`."""

@final
class Rendered:
    """A report as JSON, text, CSV and picture."""

    @property
    def json(self) -> str:
        """The report, as the command line prints it."""

    @property
    def table(self) -> str:
        """The report as a table to read."""

    @property
    def csv(self) -> str:
        """The report as CSV, for programs."""

    def svg(self) -> str | None:
        """The picture as SVG."""

    def png(self) -> bytes | None:
        """The picture as PNG."""

@final
class Sweep:
    """The designs of a sweep, parsed and not yet computed."""

    def __new__(
        cls, problem: Problem, over: list[str], requested: Requested, expected: Expected, output: str | None
    ) -> Sweep: ...
    def __len__(self) -> int: ...
    def missing(self) -> list[int]:
        """The numbers of the designs without a stored result."""

    def design(self, number: int, how: How) -> tuple[str, str] | None:
        """Computes a design: its key and its results as JSON; None if its halves cannot be built."""

    def keep(self, key: str, found: str) -> None:
        """Stores the result of a design that was computed elsewhere, if results are stored."""

    def run(self, found: list[tuple[str, str]], how: How) -> Rendered:
        """Computes the designs that are neither in `found` nor in the folder; returns the report of all designs."""
