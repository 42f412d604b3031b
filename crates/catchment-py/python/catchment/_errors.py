"""Why something is refused: one tree of exceptions, with places and advice."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple


class Finding(NamedTuple):
    """One thing that is wrong, where it stands, and what to do about it."""

    #: What is wrong.
    message: str
    #: What to do about it; None where there is nothing to say.
    advice: str | None
    #: Line in the design's text, from 1; None where it has no place.
    line: int | None
    #: Column in that line, in characters from 1.
    column: int | None


class Error(Exception):
    """Whatever this package refuses. `except catchment.Error` catches all of it, and nothing else."""

    #: Everything that is wrong, each with its place and advice; empty where there is only a message.
    findings: tuple[Finding, ...]
    #: The file or name that the places are in.
    path: str | None

    def __init__(
        self,
        message: str,
        findings: Sequence[tuple[str, str | None, tuple[int, int] | None]] = (),
        omitted: int = 0,
        path: str | None = None,
    ) -> None:
        super().__init__(message, findings, omitted, path)
        self.findings = tuple(
            Finding(said, advice, *(place or (None, None))) for said, advice, place in findings
        )
        #: How many more things are wrong that are not in `findings`.
        self.omitted = omitted
        self.path = path

    def __str__(self) -> str:
        return str(self.args[0])


class DesignError(Error):
    """The design says something that cannot be, or cannot be read: `line`, `column`, `advice` of the first thing."""

    @property
    def line(self) -> int | None:
        """Line of the first finding, from 1."""
        return self.findings[0].line if self.findings else None

    @property
    def column(self) -> int | None:
        """Column of the first finding, from 1."""
        return self.findings[0].column if self.findings else None

    @property
    def advice(self) -> str | None:
        """What to do about the first finding."""
        return self.findings[0].advice if self.findings else None


class GeometryError(DesignError):
    """The design reads well, but its halves bound no solids, or do not meet."""


class ArgumentError(Error, ValueError):
    """An argument of a call is wrong: a pose, a method, a resolution."""


class MemoryLimitError(Error, MemoryError):
    """It would not fit into memory; nothing was computed. The message says what would fit."""


class ComputeError(Error):
    """There is no answer: the method gave up, or what was asked for does not exist."""
