"""Results: the reports of the command line, with arrays and pictures."""

from __future__ import annotations

import base64
import html
import json
import os
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Generic, NamedTuple, TypeVar, cast

import numpy as np
from numpy.typing import NDArray

from . import _catchment
from ._arguments import Progress, how
from ._errors import Diagnostic

if TYPE_CHECKING:
    import xarray

    from . import reports

    from ._problem import Problem

#: The codes of outcomes in arrays; 0 means that there is no outcome.
OUTCOMES: Mapping[int, str] = {1: "aligned", 2: "jammed", 3: "missed", 4: "undecided"}


class Picture(NamedTuple):
    """A picture in two formats."""

    #: SVG, for web pages and papers; text remains text.
    svg: str
    #: PNG, with two pixels per unit of the drawing.
    png: bytes

    def _repr_png_(self) -> bytes:
        return self.png

    def _repr_svg_(self) -> str:
        return self.svg

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the picture to a file whose name ends with .svg or .png."""
        with open(path, "wb") as file:
            file.write(self.svg.encode() if os.fspath(path).endswith(".svg") else self.png)


#: The fields of a report: one of the types in `catchment.reports`.
Fields = TypeVar("Fields", bound=Mapping[str, Any])


class Report(Generic[Fields]):
    """A report: the JSON, table and picture of the command line.

    Read fields of the JSON by `report["sum"]` or `report.to_dict()`; lengths are in D, angles in radians.
    You can pickle a report. Never read a pickle from a stranger: it can run any program.
    """

    def __init__(self, json_text: str, table: str, csv: str | None, picture: Picture | None) -> None:
        #: The report as JSON text, equal to the output of `--json` byte for byte, except for `timing`.
        self.json = json_text
        #: The report as a table to read, as the command line prints it.
        self.table = table
        self._csv = csv
        self._picture = picture
        self._read: dict[str, Any] | None = None

    @classmethod
    def _of(cls, rendered: _catchment.Rendered) -> Report[Fields]:
        svg, png = rendered.svg(), rendered.png()
        picture = None if svg is None or png is None else Picture(svg, png)
        return cls(rendered.json, rendered.table, rendered.csv, picture)

    def to_dict(self) -> Fields:
        """The report as a new dictionary; `catchment.reports` defines the types of its fields."""
        return cast("Fields", json.loads(self.json))

    def __getitem__(self, key: str) -> Any:
        if self._read is None:
            self._read = json.loads(self.json)
        return self._read[key]

    @property
    def warnings(self) -> list[str]:
        """Warnings about the results, as sentences."""
        return [warning["message"] for warning in self["warnings"]]

    @property
    def diagnostics(self) -> list[Diagnostic]:
        """Warnings about the results, with severity, code and advice; `self["warnings"]` has their numbers."""
        return [
            Diagnostic(one["message"], one["help"], severity=one["severity"], code=one["code"])
            for one in self["warnings"]
        ]

    @property
    def csv(self) -> str:
        """The table as CSV, for programs; `pandas.read_csv(io.StringIO(report.csv))` reads it."""
        if self._csv is None:
            raise AttributeError("a run has no table of its own; to_xarray() has its cells")
        return self._csv

    @property
    def picture(self) -> Picture | None:
        """The picture, or `None` if there is nothing to draw."""
        return self._picture

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_read": None}

    def __str__(self) -> str:
        return self.table

    def __repr__(self) -> str:
        return f"<{type(self).__name__} of {self['design']['name']!r}>"

    def _repr_png_(self) -> bytes | None:
        return None if self.picture is None else self.picture.png

    def _repr_html_(self) -> str:
        table = f'<pre style="line-height: 1.25">{html.escape(self.table)}</pre>'
        if self.picture is None:
            return table
        image = base64.b64encode(self.picture.png).decode()
        name = html.escape(self["design"]["name"], quote=True)
        return f'<img alt="{name}" style="max-width: 100%" src="data:image/png;base64,{image}">{table}'


class Result(Report["reports.RunReport"]):
    """The result of a run: outcomes over the grid, the Sum with its confidence interval, figures of merit.

    You can pickle a result. An unpickled result recomputes the output of `save`, and the pictures if they were not drawn before,
    when you use them: equal runs have equal results.
    """

    def __init__(self, problem: Problem, run: str, answer: _catchment.Answer) -> None:
        super().__init__(answer.json(), answer.table(), None, None)
        #: The problem of the run.
        self.problem = problem
        #: Unmet requirements, as sentences.
        self.unmet = answer.unmet()
        self._run = run
        self._answer: _catchment.Answer | None = answer
        self._pictures: dict[str, Picture] | None = None
        # The first axis varies fastest.
        shape = tuple(axis["cells"] for axis in reversed(self["axes"])) or (-1,)
        outcomes, heights = answer.outcomes(), answer.heights()
        #: Codes of `OUTCOMES`, uint8; the shape is `[sizes of dims]`, as in the Zarr group, or (n,) for random poses.
        self.outcomes: NDArray[np.uint8] = outcomes.reshape(shape)
        #: z of the centre of rotation at first contact, in D, float32, with the shape of `outcomes`; `None` unless you set
        #: `heights=True`, or the method needs them. Not finite without contact.
        self.heights: NDArray[np.float32] | None = None if heights is None else heights.reshape(shape)
        for array in (self.outcomes, self.heights):
            if array is not None:
                array.flags.writeable = False

    def __getstate__(self) -> dict[str, Any]:
        return {**super().__getstate__(), "_answer": None}

    def _again(self) -> _catchment.Answer:
        """The native result; computed again after unpickling."""
        if self._answer is None:
            self._answer = self.problem._native.run(self._run, how())
        return self._answer

    @property
    def method(self) -> str:
        """Name of the method of the run."""
        return str(self["method"])

    @property
    def sum(self) -> float:
        """The Sum: measure of the area of acceptance, in `unit`; unbiased if poses were sampled."""
        return float(self["acceptance"]["sum"])

    @property
    def sum_ci95(self) -> tuple[float, float] | None:
        """95 % confidence interval of the Sum, in `unit`; `None` without sampled poses."""
        interval = self["acceptance"]["sum_ci95"]
        return None if interval is None else (interval[0], interval[1])

    @property
    def unit(self) -> str:
        """Unit of the Sum, such as `D²·rad³`."""
        return str(self["acceptance"]["unit"])

    @property
    def fraction(self) -> float:
        """The Sum as a share of the error box, in [0, 1]."""
        return float(self["acceptance"]["fraction"])

    @property
    def counts(self) -> dict[str, int]:
        """Number of cells or poses per outcome."""
        return dict(self["acceptance"]["outcomes"])

    @property
    def onaa_edge(self) -> float | None:
        """ONAA: edge of the largest axis-parallel cube in the accepted set, in [0, 1] of the error box; `None` for random poses."""
        return None if self["onaa"] is None else float(self["onaa"]["edge"])

    @property
    def tolerances(self) -> dict[str, tuple[float, float]]:
        """Single-axis limits: tolerance of each error below and above zero (both not negative), all others zero, in D and radians."""
        return {found["axis"]: (found["minus"], found["plus"]) for found in self["tolerances"]}

    @property
    def success(self) -> float | None:
        """Success probability for `error_sigma` or `error_uniform`; `None` without them."""
        return None if self["success"] is None else float(self["success"]["probability"])

    @property
    def seconds(self) -> float:
        """Wall-clock time of the computation, in seconds."""
        return float(self["timing"]["total_s"])

    @property
    def dims(self) -> tuple[str, ...]:
        """Names of the dimensions of `outcomes`, such as `("pitch", "x")`; empty for random poses."""
        return tuple(axis["axis"] for axis in reversed(self["axes"]))

    @property
    def coords(self) -> dict[str, NDArray[np.float64]]:
        """Centres of the cells along every dimension, in D and radians; each of shape (cells,)."""
        return {axis["axis"]: _centers(axis) for axis in reversed(self["axes"])}

    @property
    def pictures(self) -> dict[str, Picture]:
        """Every picture by its name: overview, slices, heights, section, solids … Drawn at first use."""
        if self._pictures is None:
            drawn = self._again().draw(how())
            self._pictures = {name: Picture(svg, png) for name, svg, png in drawn}
        return self._pictures

    @property
    def picture(self) -> Picture | None:
        """The main picture: the overview if two or more errors are free."""
        return next(iter(self.pictures.values()), None)

    def to_xarray(self) -> xarray.Dataset:
        """The cells with named dimensions and coordinates, as `xarray.open_zarr` reads them from the Zarr group of `save`."""
        import xarray

        if not self.dims:
            raise ValueError("random poses are no grid; outcomes has their codes")
        codes = {
            "long_name": f"outcome by {self.method}",
            "flag_values": list(OUTCOMES),
            "flag_meanings": " ".join(OUTCOMES.values()),
        }
        arrays = {"outcome": xarray.Variable(self.dims, self.outcomes, codes)}
        if self.heights is not None:
            finite = np.where(np.isfinite(self.heights), self.heights, np.float32(np.nan))
            about = {"long_name": "z of the centre of rotation at first contact", "units": "D"}
            arrays["height"] = xarray.Variable(self.dims, finite, about)
        coords = {axis["axis"]: xarray.Variable(axis["axis"], _centers(axis), _about(axis)) for axis in self["axes"]}
        attributes = {"catchment": 1, "title": self["design"]["name"], "report": self.to_dict()}
        return xarray.Dataset(arrays, coords, attributes)

    def save(
        self, path: str | os.PathLike[str], *, threads: int = 0, memory: int | None = None, progress: Progress = False
    ) -> None:
        """Writes report.json, result.zarr and all pictures into a folder, or only the Zarr group to NAME.zarr.

        It writes everything or nothing. It replaces a folder that holds an older result, and refuses a folder with other content.
        """
        self._again().save(os.fspath(path), how(threads, memory, progress))

    def __repr__(self) -> str:
        interval = self.sum_ci95
        sure = "" if interval is None else f" ± {(interval[1] - interval[0]) / 2:.2g}"
        return f"<Result of {self['design']['name']!r} by {self.method}: Sum {self.sum:.6g}{sure} {self.unit}>"


def _centers(axis: dict[str, Any]) -> NDArray[np.float64]:
    """Centres of the cells of an axis, equal to those of the library to the bit."""
    step = (axis["hi"] - axis["lo"]) / axis["cells"]
    centers: NDArray[np.float64] = axis["lo"] + (np.arange(axis["cells"], dtype=np.float64) + 0.5) * step
    return centers


def _about(axis: dict[str, Any]) -> dict[str, Any]:
    """Attributes of a coordinate, as in the Zarr group."""
    name = axis["axis"]
    long_name = f"lateral offset of the face centre along {name}" if axis["unit"] == "D" else f"{name} error"
    return {"long_name": long_name, "units": axis["unit"], "lower_border": axis["lo"], "upper_border": axis["hi"]}


class Touching(NamedTuple):
    """Two features in contact."""

    #: Name of the feature of the fixed half.
    fixed: str
    #: Name of the feature of the moving half.
    moving: str
    #: The contact point, in the world frame, in D; (3,).
    point: NDArray[np.float64]


class End(NamedTuple):
    """The final state of a motion."""

    #: "aligned", "jammed", "missed" or "undecided".
    outcome: str
    #: The final pose error: x, y in D, roll, pitch, yaw in radians; (5,).
    error: NDArray[np.float64]
    #: z of the centre of rotation in the final state, in D; `None` if the moving half missed.
    height: float | None
    #: The contacts in the final state.
    contacts: tuple[Touching, ...]

    @property
    def docks(self) -> bool:
        """Whether the pose error docks."""
        return self.outcome == "aligned"


class Ends(NamedTuple):
    """The final states of many motions, row by row."""

    #: Codes of `OUTCOMES`; (n,), uint8.
    outcomes: NDArray[np.uint8]
    #: The final pose errors: x, y in D, roll, pitch, yaw in radians; (n, 5), float64.
    errors: NDArray[np.float64]
    #: z of the centre of rotation in the final states, in D, NaN if the moving half missed; (n,), float64.
    heights: NDArray[np.float64]

    @property
    def docks(self) -> NDArray[np.bool_]:
        """Whether each pose error docks; (n,)."""
        docked: NDArray[np.bool_] = self.outcomes == 1
        return docked
