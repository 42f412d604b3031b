"""Computation on a Dask cluster: each design of a sweep, and each part of a grid, is a task.

    client ──problem, pickled once──▶ workers ──(key, results)──▶ client stores each on arrival ──▶ report

Dask repeats a task that was lost with its worker. The report does not depend on the assignment of tasks to workers, nor on
their order: a key is a digest of everything that the results of a design depend on.
"""

from __future__ import annotations

import json
import pickle
from functools import lru_cache
from importlib import import_module
from typing import TYPE_CHECKING, Any, TypeAlias

from . import _catchment
from ._arguments import Requested, Expected, How, how

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ._problem import Problem

#: A `distributed.Client`, which is not typed.
Client: TypeAlias = Any

#: Parts per worker thread: small parts keep the wait for the last part short.
PARTS_PER_THREAD = 4
#: Retries of a task whose worker died: if a part ends every worker, the part is at fault.
RETRIES = 5

Plan = tuple[list[str], Requested, Expected, "str | None"]


@lru_cache(maxsize=4)
def _sweep(problem: Problem, plan: str) -> _catchment.Sweep:
    """The sweep on this worker, parsed once. The plan includes the text of the design, because equal problems may differ in text."""
    axes, requested, expected = json.loads(plan)[:3]
    return _catchment.Sweep(problem._native, axes, requested, expected, None)


def _design(problem: Problem, plan: str, number: int) -> tuple[str, str] | None:
    """Computes a design of a sweep, on a worker."""
    return _sweep(problem, plan).design(number, how(threads=1))


def _part(problem: Problem, plan: str, number: int, of: int) -> str:
    """Computes a part of a run, on a worker."""
    return problem._native.part(plan, number, of, how(threads=1))


def _there(client: Client, problem: Problem) -> Any:
    """The problem on the workers: a separate task builds it, so that Dask can rebuild it after the loss of a worker."""
    return client.submit(pickle.loads, pickle.dumps(problem), pure=False, retries=RETRIES)


def _tell(run_how: How, done: int, count: int, stage: str) -> None:
    if run_how["progress"] is not None and count:
        run_how["progress"](done / count, stage)


def _gather(client: Client, futures: dict[Any, Any], run_how: How, stage: str, keep: Any) -> None:
    """Passes every result to `keep` on arrival; cancels the remaining tasks if this ends early."""
    as_completed: Any = import_module("distributed").as_completed
    try:
        for done, future in enumerate(as_completed(futures), 1):
            keep(futures[future], future.result())
            _tell(run_how, done, len(futures), stage)
    finally:
        client.cancel(list(futures))


def designs(
    client: Client,
    problem: Problem,
    plans: Sequence[Plan],
    sweeps: Sequence[_catchment.Sweep],
    run_how: How,
) -> list[list[tuple[str, str]]]:
    """Computes the missing designs of all sweeps at once; returns their keys and results."""
    there = _there(client, problem)
    found: list[list[tuple[str, str]]] = [[] for _ in sweeps]
    futures: dict[Any, Any] = {}
    for which, ((axes, requested, expected, _), sweep) in enumerate(zip(plans, sweeps)):
        plan = json.dumps([axes, requested, expected, problem._path, problem._text, problem._changes])
        for number in sweep.missing():
            future = client.submit(_design, there, plan, number, pure=False, retries=RETRIES)
            futures[future] = which

    def keep(which: int, result: tuple[str, str] | None) -> None:
        if result is not None:
            sweeps[which].keep(*result)
            found[which].append(result)

    _gather(client, futures, run_how, "designs", keep)
    return found


def parts(client: Client, problem: Problem, plan: str, count: int | None, run_how: How) -> list[str]:
    """Computes the parts of a run."""
    threads = sum(client.nthreads().values())
    of = count or max(1, PARTS_PER_THREAD * threads)
    there = _there(client, problem)
    futures = {
        client.submit(_part, there, plan, number, of, pure=False, retries=RETRIES): number for number in range(of)
    }
    found: dict[int, str] = {}
    _gather(client, futures, run_how, "parts", found.__setitem__)
    return [found[number] for number in range(of)]
