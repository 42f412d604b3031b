"""The exceptions of the package: a single tree, with diagnostics that have a place and advice."""

from __future__ import annotations

import unicodedata
from collections.abc import Sequence
from typing import NamedTuple


class Diagnostic(NamedTuple):
    """An error in the input, or a warning about a result, with its place and advice."""

    #: Description, a sentence or several.
    message: str
    #: What to do, or `None`.
    advice: str | None = None
    #: Line in the text of the design, from 1; `None` without a place.
    line: int | None = None
    #: Column in that line, in characters from 1.
    column: int | None = None
    #: `error`, `warning` or `note`.
    severity: str = "error"
    #: Stable code in kebab case, such as `touches-border`.
    code: str = ""


#: Characters that change the direction of writing, and invisible line breaks.
_MARKS = frozenset("\u200e\u200f\u2028\u2029\u202a\u202b\u202c\u202d\u202e\u2066\u2067\u2068\u2069")


def _escaped(text: str) -> str:
    """The text with control characters escaped as in Python, except line breaks: files and names must not control a terminal."""
    steers = (c != "\n" and (unicodedata.category(c) == "Cc" or c in _MARKS) for c in text)
    return "".join(c.encode("unicode_escape").decode() if bad else c for c, bad in zip(text, steers))


class Error(Exception):
    """Base class of all exceptions of this package. `except catchment.Error` catches these and no others."""

    #: All errors, each with its place and advice; empty if there is only a message.
    diagnostics: tuple[Diagnostic, ...]
    #: The file or name that the places refer to.
    path: str | None

    def __init__(
        self,
        message: str,
        diagnostics: Sequence[tuple[str, str | None, int | None, int | None, str, str]] = (),
        omitted: int = 0,
        path: str | None = None,
    ) -> None:
        message = _escaped(message)
        self.diagnostics = tuple(
            Diagnostic(_escaped(text), advice and _escaped(advice), line, column, severity, code)
            for text, advice, line, column, severity, code in diagnostics
        )
        super().__init__(message, self.diagnostics, omitted, path)
        #: Number of further errors that are not in `diagnostics`.
        self.omitted = omitted
        self.path = path

    def __str__(self) -> str:
        return str(self.args[0])


class DesignError(Error):
    """The design is invalid, or cannot be read; `line`, `column` and `advice` are those of the first error."""

    @property
    def line(self) -> int | None:
        """Line of the first error, from 1."""
        return self.diagnostics[0].line if self.diagnostics else None

    @property
    def column(self) -> int | None:
        """Column of the first error, from 1."""
        return self.diagnostics[0].column if self.diagnostics else None

    @property
    def advice(self) -> str | None:
        """How to correct the first error."""
        return self.diagnostics[0].advice if self.diagnostics else None


class GeometryError(DesignError):
    """The design can be read, but its halves do not bound solids, or do not meet."""


class ArgumentError(Error, ValueError):
    """An argument of a call is invalid: a pose, a method, a resolution."""


class MemoryLimitError(Error, MemoryError):
    """The result would exceed the memory budget; nothing was computed. The message advises how to make it fit."""


class ComputeError(Error):
    """There is no result: the method failed, or the requested result does not exist."""
