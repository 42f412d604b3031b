"""The numbers are those of the program, to the bit."""

import csv
import io
import json

import numpy as np
import pytest
from conftest import bytes_of, program

import catchment


@pytest.mark.parametrize(
    ("design", "options", "arguments"),
    [
        ("v-face", [], {}),
        ("v-face", ["--resolution", "31", "--seed", "7"], {"resolution": 31, "seed": 7}),
        ("x-face", ["--samples", "500"], {"samples": 500}),
        ("s-face", ["--method", "flood"], {"method": "flood"}),
        (
            "pyramid",
            ["--free", "x", "--resolution", "21", "--samples", "200", "--window", "--jams"],
            {"resolution": 21, "samples": 200, "window": True, "jams": True},
        ),
        ("pyramid-stl", ["--resolution", "5", "--samples", "200"], {"resolution": 5, "samples": 200}),
        (
            "x-face-3d",
            ["--resolution", "x=6,yaw=4,4", "--method", "descent", "--error-sigma", "x=1 mm,yaw=2 deg"],
            {
                "resolution": {"x": 6, "yaw": 4} | {axis: 4 for axis in ("y", "roll", "pitch")},
                "method": "descent",
                "error_sigma": {"x": "1 mm", "yaw": "2 deg"},
            },
        ),
        (
            "v-face",
            ["--method", "drop", "--resolution", "4", "--samples", "0", "--friction", "0.2"],
            {"method": "drop", "resolution": 4, "samples": 0, "settings": {"friction": 0.2}},
        ),
    ],
)
def test_a_run_is_that_of_the_program(design: str, options: list[str], arguments: dict[str, object]) -> None:
    path = f"designs/{design}.toml"
    if "--error-sigma" in options and catchment.load(path).design["unit"] is None:
        options = [word.replace(" mm", " D").replace("x=1", "x=0.02") for word in options]
        arguments = arguments | {"error_sigma": {"x": "0.02 D", "yaw": "2 deg"}}
    free = options[options.index("--free") + 1] if "--free" in options else None
    result = catchment.load(path, free=free).run(**arguments)  # type: ignore[arg-type]
    assert bytes_of(result.json) == bytes_of(program("run", path, "--json", *options))


def test_changed_designs_agree_with_the_program() -> None:
    path = "designs/v-face.toml"
    options = ["--cor", "0.3", "--aspect-ratio", "0.7", "--rotation-length", "0.4", "--resolution", "21"]
    printed = bytes_of(program("run", path, "--json", *options))
    problem = catchment.load(path, cor=0.3, aspect_ratio=0.7, rotation_length=0.4)
    assert bytes_of(problem.run(resolution=21).json) == printed
    step_by_step = catchment.load(path).replace(cor=0.3).replace(aspect_ratio=0.7, rotation_length=0.4)
    assert bytes_of(step_by_step.run(resolution=21).json) == printed
    assert step_by_step == problem != catchment.load(path)


def test_threads_change_no_bit() -> None:
    problem = catchment.load("designs/x-face.toml")
    one, *others = (problem.run(resolution=24, threads=threads) for threads in (1, 2, 3))
    for many in others:
        assert bytes_of(one.json) == bytes_of(many.json)
        assert np.array_equal(one.outcomes, many.outcomes)


@pytest.mark.parametrize(("method", "count"), [("descent", 2000), ("drop", 60)])
def test_final_poses_agree_with_the_program(method: str, count: int, tmp_path: object) -> None:
    problem = catchment.load("designs/x-face-3d.toml")
    random = np.random.default_rng(3)
    half = np.array([problem.error_box[axis] for axis in ("x", "y", "roll", "pitch", "yaw")])
    poses = random.uniform(-half, half, (count, 5))
    table = tmp_path / "poses.csv"  # type: ignore[operator]
    with open(table, "w", newline="") as file:
        rows = csv.writer(file)
        rows.writerow(["x", "y", "roll", "pitch", "yaw"])
        rows.writerows([[repr(float(value)) for value in pose] for pose in poses])
    report = json.loads(program("outcome", "designs/x-face-3d.toml", "--poses", table, "--method", method, "--json"))
    ends = problem.follow_many(poses, method=method)
    assert [catchment.OUTCOMES[code] for code in ends.outcomes] == [pose["outcome"] for pose in report["poses"]]
    finals = [[pose["final"][axis] for axis in ("x", "y", "roll", "pitch", "yaw")] for pose in report["poses"]]
    assert np.array_equal(ends.errors, np.array(finals))
    assert len(set(ends.outcomes)) > 1
    heights = [np.nan if pose["final_height_d"] is None else pose["final_height_d"] for pose in report["poses"]]
    assert np.array_equal(ends.heights, np.array(heights), equal_nan=True)
    one = problem.follow(poses[7], method=method)
    assert one.outcome == catchment.OUTCOMES[ends.outcomes[7]] and np.array_equal(one.error, ends.errors[7])
    assert one.docks == ends.docks[7] and one.height == report["poses"][7]["final_height_d"]
    touching = [{"fixed": c.fixed, "moving": c.moving, "point_d": list(c.point)} for c in one.contacts]
    assert touching == report["poses"][7]["contacts"]


def test_poses_are_read_where_they_lie() -> None:
    problem = catchment.load("designs/v-face.toml")
    poses = np.zeros((300, 5))
    poses[:, 0] = np.linspace(-0.9, 0.9, 300)
    before = poses.copy()
    ends = problem.follow_many(poses)
    assert np.array_equal(poses, before)
    assert ends.outcomes.dtype == np.uint8 and ends.errors.flags.c_contiguous
    # Any layout that NumPy has.
    assert np.array_equal(problem.follow_many(np.asfortranarray(poses)).errors, ends.errors)
    assert np.array_equal(problem.follow_many(poses[::3]).errors, ends.errors[::3])
    assert problem.follow_many(np.zeros((0, 5))).outcomes.shape == (0,)
    poses.flags.writeable = False
    assert np.array_equal(problem.follow_many(poses).outcomes, ends.outcomes)


def test_a_pose_may_be_written_in_any_way() -> None:
    problem = catchment.load("designs/pyramid-stl.toml")
    ends = [
        problem.follow(pose)
        for pose in (
            "x=5 mm,pitch=10 deg",
            {"x": "5 mm", "pitch": "10 deg"},
            {"x": 0.1, "pitch": float(np.radians(10.0))},
            [0.1, 0.0, 0.0, np.radians(10.0), 0.0],
            np.array([0.1, 0.0, 0.0, np.radians(10.0), 0.0]),
        )
    ]
    assert len({end.outcome for end in ends}) == 1
    for end in ends:
        np.testing.assert_allclose(end.error, ends[0].error, rtol=0, atol=1e-12)


def test_studies_are_those_of_the_program() -> None:
    path = "designs/v-face.toml"
    problem = catchment.load(path)
    window = problem.window(fix={"x": 0.2}, motions=3000, seed=3)
    options = ["--fix", "x=0.2", "--motions", "3000", "--seed", "3"]
    assert bytes_of(window.json) == bytes_of(program("window", path, "--json", *options))
    jams = problem.jams(motions=400, examine=2, error_uniform={"x": 0.5, "pitch": "20 deg"})
    options = ["--motions", "400", "--examine", "2", "--error-uniform", "x=0.5,pitch=20 deg"]
    assert bytes_of(jams.json) == bytes_of(program("jams", path, "--json", *options))
    assert jams.picture is not None
    assert problem.zraa().json == program("zraa", path, "--json")
    trace = problem.trace("x=0.2,pitch=10 deg")
    assert trace.json == program("trace", path, "--pose", "x=0.2,pitch=10 deg", "--json")


def test_two_acceptances_beside_each_other(tmp_path: object) -> None:
    path, other = "designs/v-face.toml", "designs/x-face.toml"
    found = catchment.compare(catchment.load(path), methods="descent,flood", resolution=21)
    printed = program("compare", path, "--methods", "descent,flood", "--resolution", 21, "--json")
    assert bytes_of(found.json) == bytes_of(printed)
    two = catchment.compare(catchment.load(path), catchment.load(other), resolution=21)
    assert bytes_of(two.json) == bytes_of(program("compare", path, other, "--resolution", 21, "--json"))
    stored = str(tmp_path / "out.zarr")  # type: ignore[operator]
    catchment.load(path).run(resolution=21).save(stored)
    beside = catchment.compare(stored, catchment.load(other))
    assert bytes_of(beside.json) == bytes_of(program("compare", stored, other, "--json"))
    with pytest.raises(catchment.ArgumentError, match="by two methods"):
        catchment.compare(catchment.load(path))
    with pytest.raises(catchment.ArgumentError, match="stored results have theirs"):
        catchment.compare(stored, stored, methods="flood")


def test_a_sweep_is_that_of_the_program(tmp_path: object) -> None:
    path = "designs/v-face.toml"
    out = tmp_path / "sweep"  # type: ignore[operator]
    report = catchment.sweep(
        catchment.load(path), {"aspect_ratio": [0.5, 1, 2], "cor": "0..1/2"}, resolution=15, samples=200, output=out
    )
    over = ["--over", "aspect_ratio=0.5,1,2", "--over", "cor=0..1/2", "--resolution", 15, "--samples", 200]
    printed = bytes_of(program("sweep", path, *over, "--json"))
    assert bytes_of(report.json) == printed == bytes_of((out / "report.json").read_text())
    assert report.csv == (out / "sweep.csv").read_text()
    assert len(list(csv.reader(io.StringIO(report.csv)))) == 7
    assert not (tmp_path / "sweep.parts").exists()  # type: ignore[operator]
    seeds = catchment.sweep(catchment.load(path), {"cor": [0, 1]}, resolution=9, samples=100, seed=[1, 2])
    assert [seeds[k]["settings"]["run"]["seed"] for k in (0, 1)] == [1, 2]
    assert seeds[0]["designs"][0]["figures"]["sum"] != seeds[1]["designs"][0]["figures"]["sum"]


def test_parts_make_the_whole() -> None:
    problem = catchment.load("designs/v-face.toml")
    whole = problem.run(method="descent", resolution=19, samples=50)
    native, plan = problem._native, whole._run
    how = {"threads": 1, "memory": None, "progress": None}
    parts = [native.part(plan, number, 3, how) for number in (2, 0, 1)]  # type: ignore[arg-type]
    assert bytes_of(native.merge(plan, parts, how).json()) == bytes_of(whole.json)  # type: ignore[arg-type]
