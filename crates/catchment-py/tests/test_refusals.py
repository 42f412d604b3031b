"""What is refused says where, why, and what helps."""

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
    assert [(found.line, found.column) for found in error.findings] == [(2, 10), (4, 14)]
    assert str(error).startswith("mine.toml:2:10: ")
    again = pickle.loads(pickle.dumps(error))
    assert type(again) is catchment.DesignError and again.findings == error.findings and str(again) == str(error)


def test_geometry_that_is_none_is_a_refusal_of_its_own() -> None:
    text = V_FACE.replace("v-face", "pyramid").replace("rotation_length", 'free = ["x", "z"]\nrotation_length')
    with pytest.raises(catchment.DesignError):
        catchment.Problem.from_text(text)
    cube = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
    with pytest.raises(catchment.GeometryError) as caught:
        catchment.Problem(fixed=(cube, np.array([[0, 1, 2]])), moving=(cube, np.array([[0, 1, 2]])), width=1.0)
    assert isinstance(caught.value, catchment.DesignError) and "fixed half" in str(caught.value)


def test_a_file_that_is_not_there_is_said() -> None:
    with pytest.raises(catchment.DesignError, match="no-such.toml"):
        catchment.load("no-such.toml")


@pytest.mark.parametrize(
    ("arguments", "said"),
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
    ],
)
def test_arguments_are_refused_before_anything_is_computed(arguments: dict[str, object], said: str) -> None:
    with pytest.raises(catchment.ArgumentError, match=said) as caught:
        catchment.load("designs/v-face.toml").run(**arguments)  # type: ignore[arg-type]
    assert isinstance(caught.value, (catchment.Error, ValueError))


def test_poses_that_cannot_be_tried_are_refused_by_their_rows() -> None:
    problem = catchment.load("designs/v-face.toml")
    poses = np.zeros((4, 5))
    poses[1, 4], poses[2, 0], poses[3, 3] = 0.1, 200.0, np.nan
    with pytest.raises(catchment.ArgumentError) as caught:
        problem.follow_many(poses)
    said = [found.message for found in caught.value.findings]
    assert [text.split(":")[0].split(" holds")[0] for text in said] == ["row 1", "row 2", "row 3"]
    for wrong in (np.zeros(5), np.zeros((3, 4))):
        with pytest.raises(catchment.ArgumentError, match="shape"):
            problem.follow_many(wrong)
    with pytest.raises(catchment.ArgumentError, match="pose"):
        problem.follow("x=1 furlong")
    with pytest.raises(catchment.ArgumentError, match="five numbers"):
        problem.follow([0.1, 0.2])
    with pytest.raises(catchment.ComputeError, match="confluence"):
        problem.follow([0.0] * 5, method="confluence")


def test_what_does_not_fit_into_memory_is_not_begun() -> None:
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
