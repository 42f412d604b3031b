"""Conversion of arguments to the text that the library parses: `5`, `"5 mm"`, `{"x": "1 mm", "yaw": 0.1}`."""

from __future__ import annotations

import json
import operator
from collections.abc import Callable, Iterable, Mapping
from importlib import import_module
from typing import TYPE_CHECKING, Any, TypeAlias, TypedDict, Union

import numpy as np

from ._errors import ArgumentError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

#: A length in D or with a unit ("5 mm"); an angle in radians or with a unit ("10 deg").
Quantity: TypeAlias = Union[float, str]
#: Pose errors by name, or in the notation of the command line: "x=1 mm,yaw=2 deg".
Errors: TypeAlias = Union[str, Mapping[str, Quantity]]
#: A pose error: as `Errors`, or five numbers x, y, roll, pitch, yaw in D and radians.
Pose: TypeAlias = Union[str, Mapping[str, Quantity], "NDArray[np.float64]", Iterable[float]]
#: Cells per axis: 30, "x=40,yaw=24", {"x": 40, "yaw": 24}.
Cells: TypeAlias = Union[int, str, Mapping[str, int]]
#: Shows progress: True for a bar of tqdm, or a callback that takes the completed share and the name of the stage.
Progress: TypeAlias = Union[bool, Callable[[float, str], object]]

#: The five pose errors, in the order of all arrays.
AXES = ("x", "y", "roll", "pitch", "yaw")


class How(TypedDict):
    """Execution settings: they change no bit of a result."""

    threads: int
    memory: int | None
    progress: Callable[[float, str], object] | None


class Changes(TypedDict):
    """Values that override those of a design."""

    free: str | None
    cor: str | None
    aspect_ratio: float | None
    rotation_length: str | None


class Expected(TypedDict):
    """Expected pose errors of a robot."""

    error_sigma: str | None
    error_uniform: str | None


class Requested(TypedDict):
    """Arguments of a run."""

    method: str
    settings: str
    resolution: str | None
    poses: int | None
    samples: int | None
    budget_s: float | None
    tolerance: float | None
    seed: int
    require: list[str]
    heights: bool
    jams: bool
    window: bool


#: The largest value of seeds and counts.
MOST = 2**64 - 1
#: The largest number of threads, as on the command line.
MOST_THREADS = 1024


def whole(value: Any, name: str, *, least: int = 0, most: int = MOST) -> int:
    """The argument as a whole number in [least, most]. Raises ArgumentError with the name of the argument."""
    try:
        number = None if isinstance(value, (bool, np.bool_)) else operator.index(value)
    except TypeError:
        number = None
    if number is None:
        raise ArgumentError(f"{name}: a whole number is expected, not {value!r}")
    if not least <= number <= most:
        raise ArgumentError(f"{name}: {number} is out of range: a whole number from {least} to {most} is expected")
    return number


def count(value: Any, name: str, *, least: int = 0) -> int | None:
    """As `whole`, for an optional argument."""
    return None if value is None else whole(value, name, least=least)


def real(value: Any, name: str) -> float:
    """The argument as a number. Raises ArgumentError with the name of the argument."""
    try:
        return float(unmasked(value, name))
    except (TypeError, ValueError) as error:
        if isinstance(error, ArgumentError):
            raise
        raise ArgumentError(f"{name}: a number is expected, not {value!r}") from None


def unmasked(value: Any, name: str) -> Any:
    """The value. Raises ArgumentError if it has masked parts: a masked entry has no number to compute with."""
    parts = value if isinstance(value, (list, tuple)) else [value]
    masks = [np.ma.getmaskarray(part) for part in parts if isinstance(part, np.ma.MaskedArray)]
    hidden = sum(int(np.count_nonzero(mask)) for mask in masks)
    if hidden:
        raise ArgumentError(
            f"{name}: {hidden} of its values are masked; leave their rows out (numpy.ma.compress_rows) or fill them in (.filled(0.0))"
        )
    return value


def array(value: ArrayLike, name: str) -> NDArray[np.float64]:
    """Numbers as a contiguous array of float64; an array that is already contiguous float64 is not copied."""
    try:
        return np.ascontiguousarray(unmasked(value, name), dtype=np.float64)
    except (TypeError, ValueError) as error:
        if isinstance(error, ArgumentError):
            raise
        raise ArgumentError(f"{name}: an array of numbers is expected: {error}") from None


def unicode(text: str, name: str) -> str:
    """The text. Raises ArgumentError if UTF-8 cannot encode it: it must contain no unpaired surrogates."""
    try:
        text.encode()
    except UnicodeEncodeError as error:
        raise ArgumentError(f"{name}: character {error.start} is half of a surrogate pair, which is no text") from None
    return text


def quantity(value: Quantity, name: str) -> str:
    """A number with all its digits; text is unchanged."""
    return unicode(value, name) if isinstance(value, str) else repr(real(value, name))


def errors(value: Errors | None, argument: str) -> str | None:
    """Pose errors by name, in the notation of the library."""
    if value is None or isinstance(value, str):
        return value
    return ",".join(f"{name}={quantity(size, f'{argument}: {name}')}" for name, size in value.items())


def cells(value: Cells | None) -> str | None:
    """A resolution, in the notation of the library."""
    if isinstance(value, Mapping):
        return ",".join(f"{name}={whole(number, f'resolution: {name}')}" for name, number in value.items())
    return None if value is None else str(value)


def free(value: str | Iterable[str] | None) -> str | None:
    """Names of pose errors, in the notation of the library."""
    return value if value is None or isinstance(value, str) else ",".join(value)


def settings(value: Mapping[str, object] | None) -> str:
    """Settings of a method as JSON."""
    try:
        return json.dumps(dict(value or {}), allow_nan=False)
    except (TypeError, ValueError) as error:
        raise ArgumentError(f"settings: {error}; give finite numbers, texts and lists") from None


def changes(
    free_: str | Iterable[str] | None,
    cor: Quantity | None,
    aspect_ratio: float | None,
    rotation_length: Quantity | None,
) -> Changes:
    """Values that override those of a design."""
    return Changes(
        free=free(free_),
        cor=None if cor is None else quantity(cor, "cor"),
        aspect_ratio=None if aspect_ratio is None else real(aspect_ratio, "aspect_ratio"),
        rotation_length=None if rotation_length is None else quantity(rotation_length, "rotation_length"),
    )


def require(value: str | Iterable[str]) -> list[str]:
    """Requirements as a list."""
    return [value] if isinstance(value, str) else list(value)


def how(threads: int = 0, memory: int | None = None, progress: Progress = False) -> How:
    """Execution settings from the arguments of a call."""
    shown: Callable[[float, str], object] | None
    if progress is True:
        shown = bar()
    else:
        shown = progress or None
    number = whole(threads, "threads", most=MOST_THREADS)
    return How(threads=number, memory=count(memory, "memory", least=1), progress=shown)


def bar() -> Callable[[float, str], object]:
    """A progress bar of tqdm; in a notebook, its notebook variant."""
    try:
        tqdm: Any = import_module("tqdm.auto").tqdm
    except ImportError:
        raise ArgumentError("progress: a bar needs tqdm: pip install 'catchment[progress]'") from None
    shown = tqdm(total=100.0, bar_format="{desc:16} {bar} {percentage:3.0f} %", leave=False)

    def show(fraction: float, stage: str) -> None:
        shown.set_description_str(stage, refresh=False)
        shown.n = 100.0 * fraction
        shown.refresh()

    return show
