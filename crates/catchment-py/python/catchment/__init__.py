"""How much misalignment does a docking connector forgive?

    >>> import catchment
    >>> problem = catchment.load("design.toml")
    >>> result = problem.run()
    >>> result.sum, result.sum_ci95, result.unit
    >>> problem.follow("x=5 mm,pitch=10 deg").outcome
    'aligned'

Lengths are in D, the width of the connector, and angles in radians, unless they have a unit: "5 mm", "10 deg". Arrays of pose
errors have the shape (n, 5): x, y, roll, pitch, yaw. The numbers equal those of the command line, to the bit.
"""

from . import _catchment
from ._catchment import __version__
from ._errors import (
    ArgumentError,
    ComputeError,
    DesignError,
    Diagnostic,
    Error,
    GeometryError,
    MemoryLimitError,
)
from ._problem import Problem, compare, load
from ._results import OUTCOMES, End, Ends, Picture, Report, Result, Touching
from ._sweep import sweep


def methods() -> dict[str, str]:
    """Every method that decides outcomes, with a description in a single line; the default first."""
    return dict(_catchment.methods())


__all__ = [
    "OUTCOMES",
    "ArgumentError",
    "ComputeError",
    "DesignError",
    "Diagnostic",
    "End",
    "Ends",
    "Error",
    "GeometryError",
    "MemoryLimitError",
    "Picture",
    "Problem",
    "Report",
    "Result",
    "Touching",
    "__version__",
    "compare",
    "load",
    "methods",
    "sweep",
]
