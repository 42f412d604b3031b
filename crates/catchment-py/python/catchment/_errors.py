"""Why something is refused: one tree of exceptions, with places and advice."""

from __future__ import annotations

import unicodedata
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


#: Marks that turn the direction of writing, and breaks of lines that no line shows.
_MARKS = frozenset("\u200e\u200f\u2028\u2029\u202a\u202b\u202c\u202d\u202e\u2066\u2067\u2068\u2069")


def _escaped(text: str) -> str:
    """The text with control characters as Python writes them, but for breaks of lines: files and names must not steer a terminal."""
    steers = (c != "\n" and (unicodedata.category(c) == "Cc" or c in _MARKS) for c in text)
    return "".join(c.encode("unicode_escape").decode() if bad else c for c, bad in zip(text, steers))


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
        message = _escaped(message)
        findings = [(_escaped(said), advice and _escaped(advice), place) for said, advice, place in findings]
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
