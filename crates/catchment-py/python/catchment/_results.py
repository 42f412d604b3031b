"""What was found: the reports of the command line, with arrays and pictures."""

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

if TYPE_CHECKING:
    import xarray

    from . import reports

    from ._problem import Problem

#: The codes of outcomes in arrays; 0 stands for none.
OUTCOMES: Mapping[int, str] = {1: "aligned", 2: "jammed", 3: "missed", 4: "undecided"}


class Picture(NamedTuple):
    """A picture in two forms."""

    #: For pages and papers: text stays text.
    svg: str
    #: For everything else, two pixels per unit of the drawing.
    png: bytes

    def _repr_png_(self) -> bytes:
        return self.png

    def _repr_svg_(self) -> str:
        return self.svg

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes it to a file that ends with .svg or .png."""
        with open(path, "wb") as file:
            file.write(self.svg.encode() if os.fspath(path).endswith(".svg") else self.png)


#: The fields of a report: one of the types in `catchment.reports`.
Fields = TypeVar("Fields", bound=Mapping[str, Any])


class Report(Generic[Fields]):
    """A report: the same JSON, table and picture as the command line's.

    Fields of the JSON are read by `report["sum"]` or `report.to_dict()`; lengths in it are in D, angles in radians.
    It can be pickled; read no pickle of a stranger: it can run any program.
    """

    def __init__(self, json_text: str, table: str, csv: str | None, picture: Picture | None) -> None:
        #: The report as JSON text, byte for byte what `--json` prints but for `timing`.
        self.json = json_text
        #: The report for eyes, as the command line prints it.
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
        """The report as a dictionary of its own; `catchment.reports` has the types of its fields."""
        return cast("Fields", json.loads(self.json))

    def __getitem__(self, key: str) -> Any:
        if self._read is None:
            self._read = json.loads(self.json)
        return self._read[key]

    @property
    def warnings(self) -> list[str]:
        """What speaks against the numbers, as sentences."""
        return [warning["message"] for warning in self["warnings"]]

    @property
    def csv(self) -> str:
        """The table for programs; `pandas.read_csv(io.StringIO(report.csv))` reads it."""
        if self._csv is None:
            raise AttributeError("a run has no table of its own; to_xarray() has its cells")
        return self._csv

    @property
    def picture(self) -> Picture | None:
        """The picture; None where there is nothing to draw."""
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
    """The answer of a run: outcomes over the grid, the Sum with its interval, figures of merit.

    It can be pickled. Pictures that were not drawn before are computed again where they are asked for after that, and so is
    what `save` writes: equal runs have equal answers.
    """

    def __init__(self, problem: Problem, run: str, answer: _catchment.Answer) -> None:
        super().__init__(answer.json(), answer.table(), None, None)
        #: The problem that was decided.
        self.problem = problem
        #: Requirements that are not met, as sentences.
        self.unmet = answer.unmet()
        self._run = run
        self._answer: _catchment.Answer | None = answer
        self._pictures: dict[str, Picture] | None = None
        # The first axis runs fastest.
        shape = tuple(axis["cells"] for axis in reversed(self["axes"])) or (-1,)
        outcomes, heights = answer.outcomes(), answer.heights()
        #: Codes of `OUTCOMES`: of shape `[sizes of dims]`, as in the Zarr group; (n,) for random poses. uint8.
        self.outcomes: NDArray[np.uint8] = outcomes.reshape(shape)
        #: z of the centre of rotation at first contact, in D, of the shape of `outcomes`; None unless `heights=True`
        #: was asked for, or the method needs them. float32; not finite without contact.
        self.heights: NDArray[np.float32] | None = None if heights is None else heights.reshape(shape)
        for array in (self.outcomes, self.heights):
            if array is not None:
                array.flags.writeable = False

    def __getstate__(self) -> dict[str, Any]:
        return {**super().__getstate__(), "_answer": None}

    def _again(self) -> _catchment.Answer:
        """The answer, computed again where it came out of a pickle."""
        if self._answer is None:
            self._answer = self.problem._native.run(self._run, how())
        return self._answer

    @property
    def method(self) -> str:
        """Name of the method that decided."""
        return str(self["method"])

    @property
    def sum(self) -> float:
        """The measure of the accepted set, in `unit`: unbiased where random poses were followed."""
        return float(self["acceptance"]["sum"])

    @property
    def sum_ci95(self) -> tuple[float, float] | None:
        """Its 95 % interval, in `unit`; None where no random poses were followed."""
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
        """How many cells or poses met each outcome."""
        return dict(self["acceptance"]["outcomes"])

    @property
    def onaa_edge(self) -> float | None:
        """Edge of the largest axis-oriented cube in the accepted set, in [0, 1] of the error box; None for random poses."""
        return None if self["onaa"] is None else float(self["onaa"]["edge"])

    @property
    def tolerances(self) -> dict[str, tuple[float, float]]:
        """How far each error may go alone, below and above zero (both not negative), in D and radians."""
        return {found["axis"]: (found["minus"], found["plus"]) for found in self["tolerances"]}

    @property
    def success(self) -> float | None:
        """Probability of success for the errors asked about; None if none were."""
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
        """Every picture by its name: overview, slices, heights, section, solids … Drawn when first asked for."""
        if self._pictures is None:
            drawn = self._again().draw(how())
            self._pictures = {name: Picture(svg, png) for name, svg, png in drawn}
        return self._pictures

    @property
    def picture(self) -> Picture | None:
        """The picture that says most: the overview, where two errors or more are free."""
        return next(iter(self.pictures.values()), None)

    def to_xarray(self) -> xarray.Dataset:
        """The cells with named dimensions and coordinates: what `xarray.open_zarr` makes of the Zarr group of `save`."""
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
        """Writes report.json, result.zarr and all pictures into a folder, or the Zarr group alone to NAME.zarr.

        All or nothing; a folder is replaced where an older result is in it, and refused where anything else is.
        """
        self._again().save(os.fspath(path), how(threads, memory, progress))

    def __repr__(self) -> str:
        interval = self.sum_ci95
        sure = "" if interval is None else f" ± {(interval[1] - interval[0]) / 2:.2g}"
        return f"<Result of {self['design']['name']!r} by {self.method}: Sum {self.sum:.6g}{sure} {self.unit}>"


def _centers(axis: dict[str, Any]) -> NDArray[np.float64]:
    """Centres of the cells of an axis, to the bit those of the library."""
    step = (axis["hi"] - axis["lo"]) / axis["cells"]
    centers: NDArray[np.float64] = axis["lo"] + (np.arange(axis["cells"], dtype=np.float64) + 0.5) * step
    return centers


def _about(axis: dict[str, Any]) -> dict[str, Any]:
    """What a coordinate says of itself, as in the Zarr group."""
    name = axis["axis"]
    long_name = f"lateral offset of the face centre along {name}" if axis["unit"] == "D" else f"{name} error"
    return {"long_name": long_name, "units": axis["unit"], "lower_border": axis["lo"], "upper_border": axis["hi"]}


class Touching(NamedTuple):
    """Two features in contact."""

    #: The feature of the fixed half, in words.
    fixed: str
    #: The feature of the moving half, in words.
    moving: str
    #: Where they touch, in the world frame, in D; (3,).
    point: NDArray[np.float64]


class End(NamedTuple):
    """The state that a motion ends in."""

    #: "aligned", "jammed", "missed" or "undecided".
    outcome: str
    #: The last pose error: x, y in D, roll, pitch, yaw in radians; (5,).
    error: NDArray[np.float64]
    #: z of the centre of rotation in that state, in D; None where the moving half missed.
    height: float | None
    #: What touches there.
    contacts: tuple[Touching, ...]

    @property
    def docks(self) -> bool:
        """Whether contact brings the halves together."""
        return self.outcome == "aligned"


class Ends(NamedTuple):
    """Where many pose errors end, row by row."""

    #: Codes of `OUTCOMES`; (n,), uint8.
    outcomes: NDArray[np.uint8]
    #: The last pose errors, x, y in D, roll, pitch, yaw in radians; (n, 5), float64.
    errors: NDArray[np.float64]
    #: z of the centre of rotation in those states, in D, NaN where the moving half missed; (n,), float64.
    heights: NDArray[np.float64]

    @property
    def docks(self) -> NDArray[np.bool_]:
        """Whether contact brings the halves together; (n,)."""
        docked: NDArray[np.bool_] = self.outcomes == 1
        return docked
