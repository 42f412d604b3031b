"""Sweeps: every combination of values for keys of a design, computed here or on a cluster."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any, overload

from . import _catchment
from ._arguments import (
    Requested,
    Cells,
    Errors,
    Progress,
    Quantity,
    cells,
    count,
    how,
    quantity,
    real,
    settings as as_json,
    whole,
)
from ._errors import ArgumentError
from ._problem import Problem, _expected
from ._results import Report

if TYPE_CHECKING:
    from distributed import Client


@overload
def sweep(
    problem: Problem,
    over: Mapping[str, str | Iterable[Quantity]],
    *,
    seed: int = 1,
    method: str = ...,
    settings: Mapping[str, object] | None = ...,
    resolution: Cells | None = ...,
    samples: int | None = ...,
    tolerance: float | None = ...,
    error_sigma: Errors | None = ...,
    error_uniform: Errors | None = ...,
    output: str | os.PathLike[str] | None = ...,
    client: Client | None = ...,
    threads: int = ...,
    memory: int | None = ...,
    progress: Progress = ...,
) -> Report[Mapping[str, Any]]: ...
@overload
def sweep(
    problem: Problem,
    over: Mapping[str, str | Iterable[Quantity]],
    *,
    seed: Iterable[int],
    method: str = ...,
    settings: Mapping[str, object] | None = ...,
    resolution: Cells | None = ...,
    samples: int | None = ...,
    tolerance: float | None = ...,
    error_sigma: Errors | None = ...,
    error_uniform: Errors | None = ...,
    output: str | os.PathLike[str] | None = ...,
    client: Client | None = ...,
    threads: int = ...,
    memory: int | None = ...,
    progress: Progress = ...,
) -> list[Report[Mapping[str, Any]]]: ...
def sweep(
    problem: Problem,
    over: Mapping[str, str | Iterable[Quantity]],
    *,
    seed: int | Iterable[int] = 1,
    method: str = "confluence",
    settings: Mapping[str, object] | None = None,
    resolution: Cells | None = None,
    samples: int | None = None,
    tolerance: float | None = None,
    error_sigma: Errors | None = None,
    error_uniform: Errors | None = None,
    output: str | os.PathLike[str] | None = None,
    client: Client | None = None,
    threads: int = 0,
    memory: int | None = None,
    progress: Progress = False,
) -> Report[Mapping[str, Any]] | list[Report[Mapping[str, Any]]]:
    """Varies design parameters: computes and compares every combination of values. `report["designs"]`.

    over: keys of the design file and their values: {"aspect_ratio": [0.5, 1, 2], "cor": "-1..1/5"}; the last key varies
    fastest. A key is its path ("errors.x"), or its last word if no other key has it.
    seed: seed of the sampled poses; several seeds give a report each.
    output: a folder for report, table, pictures and a Zarr group, written when the sweep is complete. Until then, finished designs
    are stored beside it, and the same call resumes from them. Several seeds: each in a subfolder seed-1, seed-2 …
    client: a dask.distributed.Client: its workers compute the designs, a task each; the tasks of a lost worker are computed
    again elsewhere. The report equals that of a single machine byte for byte, except for `timing`. A design is never divided: with
    `confluence`, the default, a grid of any size is a single task; `Problem.run(method="descent", client=client)` divides a grid.
    Everything else is as in `Problem.run`.
    """
    axes = [f"{key}={values if isinstance(values, str) else _values(key, values)}" for key, values in over.items()]
    expected = _expected(error_sigma, error_uniform)
    seeds = [whole(number, "seed") for number in ([seed] if isinstance(seed, int) else seed)]
    place = None if output is None else os.fspath(output)
    if place is not None and not isinstance(seed, int):
        os.makedirs(place, exist_ok=True)
    plans = []
    for number in seeds:
        requested = Requested(
            method=method,
            settings=as_json(settings),
            resolution=cells(resolution),
            poses=None,
            samples=count(samples, "samples"),
            budget_s=None,
            tolerance=None if tolerance is None else real(tolerance, "tolerance"),
            seed=number,
            require=[],
            heights=False,
            jams=False,
            window=False,
        )
        own = place if place is None or isinstance(seed, int) else os.path.join(place, f"seed-{number}")
        plans.append((axes, requested, expected, own))
    sweeps = [_catchment.Sweep(problem._native, *plan) for plan in plans]
    run_how = how(threads, memory, progress)
    found: list[list[tuple[str, str]]] = [[] for _ in sweeps]
    if client is not None:
        from . import _cluster

        found = _cluster.designs(client, problem, plans, sweeps, run_how)
    reports: list[Report[Mapping[str, Any]]] = [Report._of(one.run(elsewhere, run_how)) for one, elsewhere in zip(sweeps, found)]
    return reports[0] if isinstance(seed, int) else reports


def _values(key: str, values: Iterable[Quantity]) -> str:
    """Values in the notation of a design; whole numbers stay whole."""
    written = [str(value) if isinstance(value, (str, int)) else quantity(value, f"over: {key}") for value in values]
    if not written:
        raise ArgumentError(f"over: {key} has no values")
    return ",".join(written)
