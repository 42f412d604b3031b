"""Every refusal states its place, its reason and advice."""

import json
import pickle

import numpy as np
import pytest

import catchment

V_FACE = '[connector]\nfamily = "v-face"\naspect_ratio = 1.0\n[alignment]\nrotation_length = 1.0\n'


def test_everything_wrong_with_a_design_has_its_place() -> None:
    text = '[connector]\nfamily = "v-fac"\n[alignment]\nfree = ["x", "z"]\n'
    with pytest.raises(catchment.DesignError) as caught:
        catchment.Problem.from_text(text, "mine.toml")
    error = caught.value
    assert (error.line, error.column, error.path) == (2, 10, "mine.toml")
    assert error.advice is not None and "v-face" in str(error)
    assert [(found.line, found.column) for found in error.diagnostics] == [(2, 10), (4, 14)]
    assert str(error).startswith("mine.toml:2:10: ")
    again = pickle.loads(pickle.dumps(error))
    assert type(again) is catchment.DesignError and again.diagnostics == error.diagnostics and str(again) == str(error)


def test_geometry_that_is_none_is_a_refusal_of_its_own() -> None:
    text = V_FACE.replace("v-face", "pyramid").replace("rotation_length", 'free = ["x", "z"]\nrotation_length')
    with pytest.raises(catchment.DesignError):
        catchment.Problem.from_text(text)
    cube = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
    with pytest.raises(catchment.GeometryError) as caught:
        catchment.Problem(fixed=(cube, np.array([[0, 1, 2]])), moving=(cube, np.array([[0, 1, 2]])), width=1.0)
    assert isinstance(caught.value, catchment.DesignError) and "fixed half" in str(caught.value)


def test_a_missing_file_is_reported() -> None:
    with pytest.raises(catchment.DesignError, match="no-such.toml"):
        catchment.load("no-such.toml")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"method": "flod"}, "flood"),
        ({"settings": {"frition": 1}}, "frition"),
        ({"settings": {"a": object()}}, "settings"),
        ({"resolution": 1}, "resolution: 1 cells"),
        ({"resolution": {"yaw": 3}}, "yaw is not free"),
        ({"samples": 10, "tolerance": 0.1}, "one of them"),
        ({"tolerance": 2.0}, "share of the Sum"),
        ({"budget": -1.0}, "seconds"),
        ({"error_sigma": {"x": "1 furlong"}}, "error_sigma"),
        ({"error_sigma": {"x": 1}, "error_uniform": {"x": 1}}, "leave out one"),
        ({"settings": {"friction": "much"}}, "invalid type"),
        ({"require": "onaa.edge"}, "require"),
        ({"samples": -1}, "^samples: -1 is out of range: a whole number from 0"),
        ({"samples": 1e6}, "^samples: a whole number is expected, not 1000000.0"),
        ({"samples": True}, "^samples: a whole number is expected, not True"),
        ({"samples": 2**64}, "^samples: 18446744073709551616 is out of range"),
        ({"poses": -5}, "^poses: -5 is out of range"),
        ({"seed": -1}, "^seed: -1 is out of range"),
        ({"seed": "one"}, "^seed: a whole number is expected, not 'one'"),
        ({"threads": -1}, "^threads: -1 is out of range: a whole number from 0 to 1024"),
        ({"threads": 70_000}, "^threads: 70000 is out of range"),
        ({"memory": -1}, "^memory: -1 is out of range"),
        ({"budget": "soon"}, "^budget: a number is expected, not 'soon'"),
        ({"tolerance": None, "budget": float("nan")}, "budget: a time is a positive number"),
        ({"resolution": {"x": 2.5}}, "^resolution: x: a whole number is expected, not 2.5"),
        ({"settings": {"friction": float("nan")}}, "^settings: .*finite numbers"),
        ({"error_sigma": {"x": object()}}, "^error_sigma: x: a number is expected"),
        ({"error_sigma": {"x": "100%"}}, "error_sigma: x: `100%` is not a number with a unit"),
    ],
)
def test_arguments_are_refused_before_anything_is_computed(arguments: dict[str, object], message: str) -> None:
    with pytest.raises(catchment.ArgumentError, match=message) as caught:
        catchment.load("designs/v-face.toml").run(**arguments)  # type: ignore[arg-type]
    assert isinstance(caught.value, (catchment.Error, ValueError))


def test_poses_that_cannot_be_tried_are_refused_by_their_rows() -> None:
    problem = catchment.load("designs/v-face.toml")
    poses = np.zeros((4, 5))
    poses[1, 4], poses[2, 0], poses[3, 3] = 0.1, 200.0, np.nan
    with pytest.raises(catchment.ArgumentError) as caught:
        problem.follow_many(poses)
    messages = [found.message for found in caught.value.diagnostics]
    assert [text.split(":")[0].split(" holds")[0] for text in messages] == ["row 1", "row 2", "row 3"]
    for wrong in (np.zeros(5), np.zeros((3, 4))):
        with pytest.raises(catchment.ArgumentError, match="shape"):
            problem.follow_many(wrong)
    with pytest.raises(catchment.ArgumentError, match="pose"):
        problem.follow("x=1 furlong")
    with pytest.raises(catchment.ArgumentError, match="five numbers"):
        problem.follow([0.1, 0.2])
    with pytest.raises(catchment.ComputeError, match="confluence"):
        problem.follow([0.0] * 5, method="confluence")


@pytest.mark.parametrize("name", ["motions", "seed", "examine"])
def test_counts_of_studies_name_their_argument(name: str) -> None:
    problem = catchment.load("designs/v-face.toml")
    with pytest.raises(catchment.ArgumentError, match=f"^{name}: -1 is out of range"):
        problem.jams(**{name: -1})  # type: ignore[arg-type]
    if name != "examine":
        with pytest.raises(catchment.ArgumentError, match=f"^{name}: -1 is out of range"):
            problem.window(**{name: -1})  # type: ignore[arg-type]
    with pytest.raises(catchment.ArgumentError, match="^friction: a number is expected, not 'ice'"):
        problem.trace("x=0.1", friction="ice")  # type: ignore[arg-type]


def test_masked_values_are_refused() -> None:
    problem = catchment.load("designs/v-face.toml")
    poses = np.zeros((3, 5))
    hidden = np.ma.masked_array(poses, mask=np.zeros((3, 5), dtype=bool))
    assert problem.follow_many(hidden).outcomes.shape == (3,)
    hidden[1, 0] = np.ma.masked
    for masked in (hidden, list(hidden)):
        with pytest.raises(catchment.ArgumentError, match="^poses: 1 of its values are masked; leave their rows out"):
            problem.follow_many(masked)
    with pytest.raises(catchment.ArgumentError, match="^pose: 1 of its values are masked"):
        problem.follow(hidden[1])
    with pytest.raises(catchment.ArgumentError, match="^poses: an array of numbers is expected"):
        problem.follow_many([["a"] * 5])  # type: ignore[list-item]
    with pytest.raises(catchment.ArgumentError, match="^pose: a text, a mapping or five numbers are expected"):
        problem.follow(5.0)  # type: ignore[arg-type]
    cube = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
    half = (np.ma.masked_equal(cube, 1.0), np.array([[0, 1, 2]]))
    with pytest.raises(catchment.ArgumentError, match="^fixed: vertices: 12 of its values are masked"):
        catchment.Problem(fixed=half, moving=half, width=1.0)


@pytest.mark.parametrize("name", ["socket 🔩", "розетка", 'a "quoted" \\ name', "𝔻"])
def test_names_may_hold_any_character(name: str) -> None:
    assert catchment.Problem.from_text(f"name = {toml(name)}\n{V_FACE}").name == name
    assert pyramid(name).name == name


def test_a_wrong_type_names_its_argument() -> None:
    with pytest.raises(catchment.ArgumentError, match="^name: character 1 is half of a surrogate pair"):
        pyramid("a\ud800")
    with pytest.raises(catchment.ArgumentError, match="^text: character 8 is half of a surrogate pair"):
        catchment.Problem.from_text('name = "\ud800"\n')


def test_no_exception_steers_a_terminal() -> None:
    steering = "a\x1b[2J\x9b2J\u202eb"
    caught: list[catchment.Error] = []
    for text in (f'[connector]\nfamily = "{steering}"\n', f'{V_FACE}"{steering}" = 1\n'):
        with pytest.raises(catchment.Error) as error:
            catchment.Problem.from_text(text, f"{steering}.toml")
        caught.append(error.value)
    with pytest.raises(catchment.Error) as error:
        catchment.load(f"{steering}.toml")
    caught.append(error.value)
    problem = catchment.load("designs/v-face.toml")
    for arguments in ({"method": steering}, {"require": steering}, {"error_sigma": {steering: 1}}, {"samples": steering}):
        with pytest.raises(catchment.Error) as error:
            problem.run(**arguments)  # type: ignore[arg-type]
        caught.append(error.value)
    for one in caught:
        texts = [str(one), repr(one), *(part or "" for found in one.diagnostics for part in found[:2])]
        assert not any(c in "".join(texts) for c in "\x1b\x9b\u202e"), texts


def toml(text: str) -> str:
    """A string of TOML, every character beyond ASCII as it is."""
    return json.dumps(text, ensure_ascii=False)


def pyramid(name: str) -> catchment.Problem:
    """A pyramid in its pit, from arrays: base 2, height 1."""
    corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]], dtype=float)
    base = np.column_stack([corners, np.full(4, -1.0)])
    rim = np.column_stack([corners, np.zeros(4)])
    sides = [[0, 2, 1], [0, 3, 2]]
    sides += [f for k in range(4) for f in ([k, (k + 1) % 4, (k + 1) % 4 + 4], [k, (k + 1) % 4 + 4, k + 4])]
    roof = [[k + 4, (k + 1) % 4 + 4, 8] for k in range(4)]
    plug = np.vstack([base, rim, [[0, 0, 1.0]]])
    pit = np.vstack([base - [0, 0, 1], rim, [[0, 0, -1.0]]])
    return catchment.Problem(fixed=(pit, np.array(sides + roof)), moving=(plug, np.array(sides + roof)), width=2.0, name=name)


def test_a_run_beyond_the_memory_is_refused() -> None:
    with pytest.raises(catchment.MemoryLimitError, match="more than") as caught:
        catchment.load("designs/pyramid.toml").run(resolution=40, memory=1_000_000)
    assert isinstance(caught.value, MemoryError) and "cells per axis fit" in str(caught.value)


def test_no_answer_is_an_error_with_its_reason() -> None:
    with pytest.raises(catchment.ComputeError):
        catchment.load("designs/v-face.toml").window(fix={"x": 0.99, "pitch": "85 deg"})
    with pytest.raises(catchment.ArgumentError, match="both given"):
        catchment.load("designs/v-face.toml").window(fix={"x": 0.1}, proportions={"x": 1.0})


def test_settings_that_are_out_of_range_are_refused() -> None:
    with pytest.raises(catchment.ComputeError, match="slices must be at least 2"):
        catchment.load("designs/v-face.toml").run(method="partition", settings={"slices": 0})


def test_a_sweep_names_its_key() -> None:
    problem = catchment.load("designs/v-face.toml")
    with pytest.raises(catchment.ArgumentError, match="aspect_ratio"):
        catchment.sweep(problem, {"aspect_rato": [1]})
    with pytest.raises(catchment.ArgumentError, match="no values"):
        catchment.sweep(problem, {"aspect_ratio": []})
    with pytest.raises(catchment.DesignError):
        catchment.sweep(problem, {"aspect_ratio": [-1]})
    with pytest.raises(catchment.ArgumentError, match="cor was replaced"):
        catchment.sweep(problem.replace(cor=0.5), {"cor": [0, 1]})


def test_all_refusals_are_one_kind() -> None:
    for kind in (
        catchment.DesignError,
        catchment.GeometryError,
        catchment.ArgumentError,
        catchment.MemoryLimitError,
        catchment.ComputeError,
    ):
        assert issubclass(kind, catchment.Error)
