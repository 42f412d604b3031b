"""Work on a Dask cluster: designs of a sweep and parts of one grid, a task each.

    client ──problem, pickled once──▶ workers ──(key, figures)──▶ client keeps each as it comes ──▶ report

A task that was lost with its worker is done again by Dask. Nothing depends on who did what, nor on the order: keys are
digests of all that the figures depend on.
"""

from __future__ import annotations

import json
import pickle
from functools import lru_cache
from importlib import import_module
from typing import TYPE_CHECKING, Any, TypeAlias

from . import _catchment
from ._arguments import Asked, Expected, How, how

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ._problem import Problem

#: A `distributed.Client`, which is not typed.
Client: TypeAlias = Any

#: Parts per worker thread: enough that the last of them is not waited for long.
PARTS_PER_THREAD = 4
#: How often a task may die with its worker before it is given up: a part that ends every worker is no worker's fault.
RETRIES = 5

Plan = tuple[list[str], Asked, Expected, "str | None"]


@lru_cache(maxsize=4)
def _sweep(problem: Problem, plan: str) -> _catchment.Sweep:
    """The sweep on this worker, read once. The plan has the design's text, too: equal problems may be written differently."""
    axes, asked, expected = json.loads(plan)[:3]
    return _catchment.Sweep(problem._native, axes, asked, expected, None)


def _design(problem: Problem, plan: str, number: int) -> tuple[str, str] | None:
    """One design of a sweep, on a worker."""
    return _sweep(problem, plan).design(number, how(threads=1))


def _part(problem: Problem, plan: str, number: int, of: int) -> str:
    """One part of a run, on a worker."""
    return problem._native.part(plan, number, of, how(threads=1))


def _there(client: Client, problem: Problem) -> Any:
    """The problem on the workers: made by a task of its own, so that it comes back where it was lost with a worker."""
    return client.submit(pickle.loads, pickle.dumps(problem), pure=False, retries=RETRIES)


def _tell(run_how: How, done: int, count: int, stage: str) -> None:
    if run_how["progress"] is not None and count:
        run_how["progress"](done / count, stage)


def _gather(client: Client, futures: dict[Any, Any], run_how: How, stage: str, keep: Any) -> None:
    """Hands every result to `keep` as it comes; cancels the rest where this ends early."""
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
    """The designs that are not kept yet, of all sweeps at once: their keys and figures."""
    there = _there(client, problem)
    found: list[list[tuple[str, str]]] = [[] for _ in sweeps]
    futures: dict[Any, Any] = {}
    for which, ((axes, asked, expected, _), sweep) in enumerate(zip(plans, sweeps)):
        plan = json.dumps([axes, asked, expected, problem._path, problem._text, problem._changes])
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
    """The parts of a run."""
    threads = sum(client.nthreads().values())
    of = count or max(1, PARTS_PER_THREAD * threads)
    there = _there(client, problem)
    futures = {
        client.submit(_part, there, plan, number, of, pure=False, retries=RETRIES): number for number in range(of)
    }
    found: dict[int, str] = {}
    _gather(client, futures, run_how, "parts", found.__setitem__)
    return [found[number] for number in range(of)]
