"""Problems from design files, from the text of a design, and from meshes in memory."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from . import _catchment, _meshes
from ._arguments import (
    AXES,
    Requested,
    Cells,
    Changes,
    Errors,
    Expected,
    Pose,
    Progress,
    Quantity,
    array,
    cells,
    changes,
    count,
    errors,
    free as names,
    how,
    quantity,
    real,
    require as requirements,
    settings as as_json,
    unicode,
    unmasked,
    whole,
)
from ._errors import ArgumentError, Diagnostic
from ._results import End, Ends, Picture, Report, Result, Touching

if TYPE_CHECKING:
    from distributed import Client

    from . import reports

NOTHING = Changes(free=None, cor=None, aspect_ratio=None, rotation_length=None)


def load(
    path: str | os.PathLike[str],
    *,
    free: str | Iterable[str] | None = None,
    cor: Quantity | None = None,
    aspect_ratio: float | None = None,
    rotation_length: Quantity | None = None,
) -> Problem:
    """Loads the problem of a design file.

    free, cor, aspect_ratio, rotation_length: override the values of the file, as in `Problem.replace`.
    Raises DesignError with the line, column and advice of every error, and GeometryError if the halves do not fit.
    """
    place = os.fspath(path)
    given = changes(free, cor, aspect_ratio, rotation_length)
    return Problem._made(place, _catchment.read_text(place), [], given)


class Problem:
    """An alignment problem: two halves, their free errors and the error box. The design is checked once.

    A problem is immutable; `replace` returns a new problem. You can pickle it, with its source meshes. Never read a pickle from a
    stranger: it can run any program. A process that was forked after a computation cannot compute: start processes by "spawn".

    Build a problem from two meshes. Each is a trimesh or (vertices, faces), with vertices (n, 3) in `unit` and faces (m, 3)
    counter-clockwise seen from outside:

    >>> Problem(fixed=socket, moving=plug, width=50.0, unit="mm", cor=0.5)

    width: D, the length unit of all results, in `unit`; without it, D is measured at the mating contact.
    drawn: "facing": each half is drawn in its own frame and faces +z; "assembled": both halves are drawn docked, in a common
    frame, and `approach` is the direction of motion of the moving half ("-z").
    face_height: z of the face centre in the frame of each half, in `unit`; without it, it is computed.
    cor: distance of the centre of rotation in front of the face centre, in D or with a unit.
    rotation_length: characteristic length ρ, which converts radians to length in the damping metric, in D or with a unit.
    error_box: half-widths of the error box, such as {"x": "20 mm", "yaw": "30 deg"}.
    """

    _built: _catchment.Problem | None
    _path: str
    _text: str
    _files: list[tuple[str, bytes]]
    _changes: Changes

    def __init__(
        self,
        *,
        fixed: _meshes.Mesh,
        moving: _meshes.Mesh,
        width: float | None = None,
        unit: str = "mm",
        name: str = "from meshes",
        free: str | Iterable[str] | None = None,
        cor: Quantity | None = None,
        rotation_length: Quantity | None = None,
        error_box: Mapping[str, Quantity] | None = None,
        drawn: str | None = None,
        approach: str | None = None,
        face_height: float | None = None,
        settle: bool | None = None,
    ) -> None:
        files = [("fixed.ply", _meshes.ply(fixed, "fixed")), ("moving.ply", _meshes.ply(moving, "moving"))]
        connector = {
            "width": None if width is None else real(width, "width"),
            "unit": unit,
            "drawn": drawn,
            "approach": approach,
            "face_height": None if face_height is None else real(face_height, "face_height"),
            "settle": settle,
        }
        alignment: dict[str, object] = {"center_of_rotation": cor, "rotation_length": rotation_length}
        if free is not None:
            alignment["free"] = [word.strip() for word in (names(free) or "").split(",")]
        lines = [f"name = {_toml(name, 'name')}", "[connector]", *_keys(connector)]
        lines += [f'{half} = {{ mesh = "{half}.ply", unit = {_toml(unit, "unit")} }}' for half in ("fixed", "moving")]
        lines += ["[alignment]", *_keys(alignment), "[errors]", *_keys(error_box or {})]
        self._make(f"{name}.toml".replace("/", "-"), "\n".join(lines) + "\n", files, NOTHING)

    @classmethod
    def from_text(cls, text: str, name: str = "design.toml") -> Problem:
        """Builds the problem from the text of a design file. Messages call it `name`; mesh paths are relative to its folder."""
        return cls._made(name, text, [], NOTHING)

    @classmethod
    def _made(cls, path: str, text: str, files: list[tuple[str, bytes]], given: Changes) -> Problem:
        problem = cls.__new__(cls)
        problem._make(path, text, files, given)
        return problem

    @classmethod
    def _restored(cls, path: str, text: str, files: list[tuple[str, bytes]], given: Changes) -> Problem:
        """A problem from a pickle, built at its first use. A pool of processes loses a task that cannot be unpickled, and its caller
        waits forever; an exception that a call raises reaches the caller."""
        problem = cls.__new__(cls)
        problem._hold(path, text, files, given)
        return problem

    def _make(self, path: str, text: str, files: list[tuple[str, bytes]], given: Changes) -> None:
        self._hold(path, unicode(text, "text"), files, given)
        self._built = self._build()

    def _hold(self, path: str, text: str, files: list[tuple[str, bytes]], given: Changes) -> None:
        self._path, self._text, self._files, self._changes, self._built = path, text, files, given, None

    def _build(self) -> _catchment.Problem:
        return _catchment.Problem(self._path, self._text, self._files, self._changes, how())

    @property
    def _native(self) -> _catchment.Problem:
        if self._built is None:
            self._built = self._build()
        return self._built

    def __reduce__(self) -> tuple[Any, ...]:
        files = self._files if self._built is None else self._built.files()
        return Problem._restored, (self._path, self._text, files, self._changes)

    def replace(
        self,
        *,
        free: str | Iterable[str] | None = None,
        cor: Quantity | None = None,
        aspect_ratio: float | None = None,
        rotation_length: Quantity | None = None,
    ) -> Problem:
        """Returns a copy of this problem with other values.

        free: the free errors, such as "x,y,yaw"; the others are locked.
        cor: distance of the centre of rotation in front of the face centre, in D or with a unit ("5 mm").
        aspect_ratio: H/D, height of the mating profile divided by the width; only of the built-in families.
        rotation_length: characteristic length ρ, which converts radians to length in the damping metric, in D or with a unit.
        """
        given = changes(free, cor, aspect_ratio, rotation_length)
        both = Changes(
            free=given["free"] or self._changes["free"],
            cor=given["cor"] or self._changes["cor"],
            aspect_ratio=self._changes["aspect_ratio"] if aspect_ratio is None else given["aspect_ratio"],
            rotation_length=given["rotation_length"] or self._changes["rotation_length"],
        )
        return Problem._made(self._path, self._text, self._files, both)

    @property
    def name(self) -> str:
        """Name of the design."""
        return self._native.name()

    @property
    def digest(self) -> str:
        """SHA-256 of everything that can change a result: equal digests give equal results."""
        return self._native.digest()

    @property
    def design(self) -> dict[str, Any]:
        """The resolved design: lengths in D, angles in radians."""
        read: dict[str, Any] = json.loads(self._native.design())
        return read

    @property
    def text(self) -> str:
        """The text of the design file."""
        return self._text

    @property
    def error_box(self) -> dict[str, float]:
        """Half-widths of the error box, for the free errors, in D and radians."""
        return dict(self._native.error_box())

    @property
    def diagnostics(self) -> list[Diagnostic]:
        """Warnings about the mated pose; empty without warnings."""
        return [Diagnostic(*fields) for fields in self._native.diagnostics()]

    @property
    def picture(self) -> Picture:
        """Both halves as the program reads them: separated in space, and mated in section."""
        return Picture(*self._native.picture())

    def __repr__(self) -> str:
        box = ", ".join(f"{name} ±{size:.4g}" for name, size in self.error_box.items())
        return f"<Problem {self.name!r}: {box} [D, rad]>"

    def _repr_png_(self) -> bytes:
        return self.picture.png

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Problem) and self.digest == other.digest

    def __hash__(self) -> int:
        return hash(self.digest)

    def _pose(self, pose: Pose) -> list[float]:
        """The five numbers of a pose error."""
        if isinstance(pose, (str, Mapping)):
            written = errors(pose, "pose") or ""
            return self._native.pose(written) if written else [0.0] * 5
        try:
            row = [real(value, "pose") for value in unmasked(pose, "pose")]
        except TypeError:
            raise ArgumentError(f"pose: a text, a mapping or five numbers are expected, not {pose!r}") from None
        if len(row) != 5:
            raise ArgumentError(f"pose: five numbers x, y, roll, pitch, yaw in D and radians are wanted, not {len(row)}")
        return row

    def run(
        self,
        *,
        method: str = "confluence",
        settings: Mapping[str, object] | None = None,
        resolution: Cells | None = None,
        poses: int | None = None,
        samples: int | None = None,
        budget: float | None = None,
        tolerance: float | None = None,
        seed: int = 1,
        error_sigma: Errors | None = None,
        error_uniform: Errors | None = None,
        require: str | Iterable[str] = (),
        heights: bool = False,
        jams: bool = False,
        window: bool = False,
        client: Client | None = None,
        parts: int | None = None,
        threads: int = 0,
        memory: int | None = None,
        progress: Progress = False,
    ) -> Result:
        """Computes the area of acceptance: the set of pose errors that dock.

        method: the method that decides outcomes; `catchment.methods()` lists them.
        settings: settings of the method, such as {"friction": 0.2}.
        resolution: cells per axis of the error grid: 30, {"x": 40, "yaw": 24}.
        poses: number of random poses to decide instead of a grid.
        samples: number of sampled poses, followed exactly to correct the Sum; 0 leaves the Sum uncorrected.
        budget: instead of samples, the time for grid and samples in seconds; the grid takes at most half of it.
        tolerance: instead of samples, sample until the 95 % interval is ± this share of the Sum.
        seed: seed of the sampled poses.
        error_sigma, error_uniform: expected errors of a robot, normal or uniform, such as {"x": "1 mm", "yaw": "2 deg"}: adds
        `success`.
        require: conditions on the report, such as "onaa.edge>=0.3"; `Result.unmet` lists those that fail.
        heights: keep the heights of first contact.
        jams: add the most frequent jams, with their contacts, to the report.
        window: add the tolerance window to the report.
        client: a dask.distributed.Client: its workers decide parts of the grid (or of the random poses), with methods that
        decide each pose independently (descent, drop).
        parts: number of parts into which the work of a client is divided.
        threads, memory, progress: execution settings; they change no bit of the result. threads=0 uses every core; memory is a
        limit in bytes; progress is True or a callback that takes the completed share and the stage.
        Ctrl-C ends the run with KeyboardInterrupt.
        """
        requested = Requested(
            method=method,
            settings=as_json(settings),
            resolution=cells(resolution),
            poses=count(poses, "poses"),
            samples=count(samples, "samples"),
            budget_s=None if budget is None else real(budget, "budget"),
            tolerance=None if tolerance is None else real(tolerance, "tolerance"),
            seed=whole(seed, "seed"),
            require=requirements(require),
            heights=heights,
            jams=jams,
            window=window,
        )
        plan = self._native.plan(requested, _expected(error_sigma, error_uniform))
        run_how = how(threads, memory, progress)
        if client is not None:
            from . import _cluster

            found = _cluster.parts(client, self, plan, count(parts, "parts", least=1), run_how)
            return Result(self, plan, self._native.merge(plan, found, run_how))
        return Result(self, plan, self._native.run(plan, run_how))

    def follow(
        self,
        pose: Pose,
        *,
        method: str = "descent",
        settings: Mapping[str, object] | None = None,
    ) -> End:
        """Follows a pose error to its final state, by exact quasi-static motion.

        pose: "x=5 mm,pitch=10 deg", {"x": "5 mm", "pitch": 0.2}, or x, y, roll, pitch, yaw in D and radians.
        settings: settings of the method, such as {"friction": 0.2}.
        """
        outcome, end, height, contacts = self._native.follow(self._pose(pose), method, as_json(settings), how())
        touching = tuple(Touching(fixed, moving, np.asarray(point)) for fixed, moving, point in contacts)
        return End(outcome, np.asarray(end), height, touching)

    def follow_many(
        self,
        poses: ArrayLike,
        *,
        method: str = "descent",
        settings: Mapping[str, object] | None = None,
        threads: int = 0,
        memory: int | None = None,
        progress: Progress = False,
    ) -> Ends:
        """Follows every pose error of an array to its final state, on all threads.

        poses: (n, 5): x, y in D, roll, pitch, yaw in radians; 0 for locked errors. A contiguous array of float64 is read in place;
        do not write to it during the call.
        Returns outcomes (n,), errors (n, 5) and heights (n,).
        """
        rows = array(poses, "poses")
        if rows.ndim != 2 or rows.shape[1] != 5:
            raise ArgumentError(
                f"poses: an array of shape (n, 5) is wanted, {', '.join(AXES)} of each pose, not {rows.shape}"
            )
        return Ends(*self._native.follow_many(rows, method, as_json(settings), how(threads, memory, progress)))

    def trace(self, pose: Pose, *, friction: float = 0.0) -> Report[reports.TraceReport]:
        """Follows a pose error and returns its trajectory, from first contact to rest, with a picture."""
        return Report._of(self._native.trace(self._pose(pose), real(friction, "friction"), how()))

    def window(
        self,
        *,
        fix: Errors | None = None,
        proportions: Errors | None = None,
        motions: int | None = None,
        seed: int = 1,
        friction: float = 0.0,
        threads: int = 0,
        memory: int | None = None,
        progress: Progress = False,
    ) -> Report[reports.WindowReport]:
        """Finds the tolerance window: the largest box of errors around zero that all dock, for a datasheet. `report["window"]`.

        fix: given half-widths, such as {"x": "2 mm"}; the others grow.
        proportions: proportions of the other half-widths; errors that are not named are zero. Default: the error box.
        motions: number of sampled poses of the certificate.
        """
        run_how = how(threads, memory, progress)
        sizes = errors(fix, "fix"), errors(proportions, "proportions")
        drawn = count(motions, "motions"), whole(seed, "seed")
        return Report._of(self._native.window(*sizes, *drawn, real(friction, "friction"), run_how))

    def jams(
        self,
        *,
        motions: int | None = None,
        seed: int = 1,
        examine: int = 6,
        resolution: Cells | None = None,
        friction: float = 0.0,
        certified: bool = False,
        error_sigma: Errors | None = None,
        error_uniform: Errors | None = None,
        threads: int = 0,
        memory: int | None = None,
        progress: Progress = False,
    ) -> Report[reports.JamsReport]:
        """Finds the jams: rests that do not dock, with their features and their stability. `report["jams"]`.

        motions: number of sampled poses to follow.
        examine: number of jams whose stability and escape path are computed.
        certified: also compute a guaranteed lower bound on the escape height of each jam.
        """
        expected = _expected(error_sigma, error_uniform)
        run_how = how(threads, memory, progress)
        drawn = count(motions, "motions"), whole(seed, "seed"), whole(examine, "examine")
        mu = real(friction, "friction")
        return Report._of(self._native.jams(*drawn, cells(resolution), mu, certified, expected, run_how))

    def zraa(self, *, threads: int = 0, memory: int | None = None, progress: Progress = False) -> Report[reports.ZraaReport]:
        """Computes exactly the offsets corrected with all rotations locked (ZRAA). `report["area_d2"]` or `report["from_d"]`."""
        return Report._of(self._native.zraa(how(threads, memory, progress)))


def _expected(error_sigma: Errors | None, error_uniform: Errors | None) -> Expected:
    return Expected(
        error_sigma=errors(error_sigma, "error_sigma"), error_uniform=errors(error_uniform, "error_uniform")
    )


#: Keys of TOML that need no quotes.
_BARE = re.compile(r"[A-Za-z0-9_-]+")


def _toml(text: str, name: str) -> str:
    """A TOML string: characters are unchanged, except those that TOML requires to be escaped."""
    return json.dumps(unicode(text, name), ensure_ascii=False).replace("\x7f", "\\u007f")


def _keys(table: Mapping[str, object]) -> list[str]:
    """Lines of a TOML table; keys with the value None are omitted."""
    lines = []
    for key, value in table.items():
        written = key if _BARE.fullmatch(key) else _toml(key, "key")
        if isinstance(value, str):
            lines.append(f"{written} = {_toml(value, key)}")
        elif isinstance(value, bool):
            lines.append(f"{written} = {json.dumps(value)}")
        elif isinstance(value, list):
            lines.append(f"{written} = [{', '.join(_toml(word, key) for word in value)}]")
        elif value is not None:
            lines.append(f"{written} = {quantity(value, key)}")  # type: ignore[arg-type]
    return lines


def compare(
    first: Problem | str | os.PathLike[str],
    second: Problem | str | os.PathLike[str] | None = None,
    *,
    methods: Iterable[str] | str | None = None,
    resolution: Cells | None = None,
    threads: int = 0,
    memory: int | None = None,
    progress: Progress = False,
) -> Report[reports.ComparisonReport]:
    """Compares two areas of acceptance: location and size of their differences. `report["comparison"]`.

    first, second: problems, or folders (or NAME.zarr) of stored results. A problem alone is decided by two methods.
    methods: the method of each problem, in order, such as "descent,flood"; a single method applies to both.
    """
    sides = [first, first if second is None else second]
    chosen = methods.split(",") if isinstance(methods, str) else list(methods or [])
    problems = sum(isinstance(side, Problem) for side in sides)
    if second is None and len(chosen) != 2:
        raise ArgumentError('compare: one problem is compared with itself by two methods, such as methods="descent,flood"')
    if len(chosen) > problems:
        raise ArgumentError(f"compare: {len(chosen)} methods for {problems} problems; stored results have theirs already")
    rest, common = iter(chosen), chosen[0] if chosen else "confluence"
    subjects: list[str | tuple[str, _catchment.Problem, str, str]] = []
    for side in sides:
        if isinstance(side, Problem):
            subjects.append((side._path, side._native, next(rest, common), "{}"))
        else:
            subjects.append(os.fspath(side))
    return Report._of(_catchment.compare((subjects[0], subjects[1]), cells(resolution), how(threads, memory, progress)))
