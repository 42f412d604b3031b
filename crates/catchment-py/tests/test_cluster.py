"""Sweeps and parts on two workers, one of which is killed on the way, to the bytes of one machine."""

import json
import os
import signal
from collections.abc import Iterator
from pathlib import Path

import pytest
from conftest import bytes_of, program
from distributed import Client, LocalCluster

import catchment

pytestmark = pytest.mark.filterwarnings("default")

OVER = {"aspect_ratio": [0.25, 0.5, 1, 2], "cor": [-0.5, 0, 0.5]}


@pytest.fixture
def client() -> Iterator[Client]:
    options = {"host": "127.0.0.1", "dashboard_address": None, "silence_logs": 50}
    with LocalCluster(n_workers=2, threads_per_worker=1, processes=True, **options) as cluster:
        with Client(cluster) as client:
            yield client


def kill_one(client: Client) -> None:
    """As a machine that goes down does."""
    pids = client.run(os.getpid)
    os.kill(next(iter(pids.values())), signal.SIGKILL)


def test_a_sweep_survives_a_worker(client: Client, tmp_path: Path) -> None:
    problem = catchment.load("designs/v-face.toml")
    shares: list[float] = []

    def on_progress(share: float, stage: str) -> None:
        if not shares:
            kill_one(client)
        shares.append(share)

    report = catchment.sweep(
        problem, OVER, resolution=15, samples=100, client=client, output=tmp_path / "out", progress=on_progress
    )
    alone = catchment.sweep(problem, OVER, resolution=15, samples=100)
    assert bytes_of(report.json) == bytes_of(alone.json)
    over = ["--over", "aspect_ratio=0.25,0.5,1,2", "--over", "cor=-0.5,0.0,0.5"]
    by_program = program("sweep", "designs/v-face.toml", *over, "--resolution", 15, "--samples", 100, "--json")
    ours, theirs = json.loads(report.json), json.loads(by_program)
    assert [trial["figures"] for trial in ours["designs"]] == [trial["figures"] for trial in theirs["designs"]]
    assert bytes_of((tmp_path / "out" / "report.json").read_text()) == bytes_of(alone.json)
    # The cluster reports progress once per design; the report of the whole sweep may add calls.
    assert len(shares) >= 12


def test_a_sweep_that_was_stopped_goes_on(client: Client, tmp_path: Path) -> None:
    problem = catchment.load("designs/v-face.toml")
    out = tmp_path / "out"
    calls: list[float] = []

    def stop(share: float, stage: str) -> None:
        calls.append(share)
        if len(calls) == 5:
            raise KeyboardInterrupt

    settings = {"resolution": 21, "samples": 100, "client": client, "output": out}
    with pytest.raises(KeyboardInterrupt):
        catchment.sweep(problem, OVER, progress=stop, **settings)  # type: ignore[call-overload]
    kept = len(list((tmp_path / "out.parts").iterdir()))
    assert kept >= 5 and not out.exists()
    stages: list[str] = []
    report = catchment.sweep(problem, OVER, progress=lambda _, stage: stages.append(stage), **settings)  # type: ignore[call-overload]
    alone = catchment.sweep(problem, OVER, resolution=21, samples=100)
    assert bytes_of(report.json) == bytes_of(alone.json)
    assert out.exists() and not (tmp_path / "out.parts").exists()


def test_seeds_go_to_the_cluster_too(client: Client, tmp_path: Path) -> None:
    problem = catchment.load("designs/v-face.toml")
    there = catchment.sweep(problem, {"cor": [0, 0.5]}, seed=[1, 2, 3], resolution=15, samples=100, client=client)
    here = catchment.sweep(problem, {"cor": [0, 0.5]}, seed=[1, 2, 3], resolution=15, samples=100)
    assert [bytes_of(report.json) for report in there] == [bytes_of(report.json) for report in here]


@pytest.mark.parametrize("what", [{"resolution": 6}, {"poses": 3000}])
def test_parts_of_one_run_survive_a_worker(client: Client, what: dict[str, int]) -> None:
    problem = catchment.load("designs/pyramid-stl.toml")
    killed: list[bool] = []

    def on_progress(share: float, stage: str) -> None:
        if stage == "parts" and not killed:
            killed.append(True)
            kill_one(client)

    there = problem.run(method="descent", samples=None, client=client, parts=9, progress=on_progress, **what)  # type: ignore[arg-type]
    here = problem.run(method="descent", **what)  # type: ignore[arg-type]
    assert killed and bytes_of(there.json) == bytes_of(here.json)
    assert (there.outcomes == here.outcomes).all()


def test_results_travel_to_a_worker_and_back(client: Client) -> None:
    problem = catchment.load("designs/pyramid-stl.toml")

    def there(sent: catchment.Problem) -> catchment.Result:
        return sent.run(resolution=4, samples=50, threads=1)

    back = client.submit(there, problem).result()
    assert bytes_of(back.json) == bytes_of(problem.run(resolution=4, samples=50).json)
    assert back.problem == problem


def test_indivisible_work_is_refused(client: Client) -> None:
    with pytest.raises(catchment.Error, match="cannot be divided"):
        catchment.load("designs/v-face.toml").run(client=client)
