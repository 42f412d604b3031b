"""Results as notebooks, arrays, pickles and files have them."""

import json
import pickle
from pathlib import Path

import numpy as np
import pytest
import xarray
from conftest import bytes_of

import catchment


@pytest.fixture(scope="module")
def result() -> catchment.Result:
    from conftest import DESIGNS

    return catchment.load(DESIGNS / "v-face.toml").run(resolution={"x": 12, "pitch": 9}, heights=True)


def test_numbers_have_names(result: catchment.Result) -> None:
    report = json.loads(result.json)
    assert result.to_dict() == report
    assert result.sum == report["acceptance"]["sum"] and result.unit == "D·rad"
    low, high = result.sum_ci95 or (0.0, 0.0)
    assert low < result.sum < high
    assert result.fraction == pytest.approx(result.sum / (2.0 * np.pi), rel=1e-12)
    assert sum(result.counts.values()) == 12 * 9
    assert result.onaa_edge == report["onaa"]["edge"]
    assert set(result.tolerances) == {"x", "pitch"} and all(min(pair) >= 0 for pair in result.tolerances.values())
    assert result.success is None and result.unmet == [] and result.seconds > 0
    assert result.method == "confluence" and result.problem.name == report["design"]["name"]


def test_cells_are_where_the_coordinates_say(result: catchment.Result) -> None:
    assert result.dims == ("pitch", "x") and result.outcomes.shape == (9, 12)
    x, pitch = result.coords["x"], result.coords["pitch"]
    poses = np.zeros((9, 12, 5))
    poses[..., 0], poses[..., 3] = x[None, :], pitch[:, None]
    ends = result.problem.follow_many(poses.reshape(-1, 5))
    # Confluence decides every cell by the motion of its centre.
    assert np.array_equal(ends.outcomes.reshape(9, 12), result.outcomes)
    with pytest.raises(ValueError, match="read-only"):
        result.outcomes[0, 0] = 1


def test_xarray_equals_the_file(result: catchment.Result, tmp_path: Path) -> None:
    dataset = result.to_xarray()
    result.save(tmp_path / "out.zarr")
    stored = xarray.open_zarr(tmp_path / "out.zarr", mask_and_scale=False)
    assert stored.attrs.pop("report") == {**dataset.attrs.pop("report"), "timing": stored_timing(tmp_path)}
    xarray.testing.assert_identical(dataset, stored.load())
    assert float(dataset["height"].min()) < 1.0
    docked = dataset["outcome"] == 1
    assert int(docked.sum()) == result.counts["aligned"]


def stored_timing(folder: Path) -> object:
    return json.loads((folder / "out.zarr" / "zarr.json").read_text())["attributes"]["report"]["timing"]


def test_random_poses_are_no_grid() -> None:
    stream = catchment.load("designs/v-face.toml").run(method="descent", poses=500)
    assert stream.outcomes.shape == (500,) and stream.dims == ()
    with pytest.raises(ValueError, match="no grid"):
        stream.to_xarray()


def test_a_folder_is_written_whole(result: catchment.Result, tmp_path: Path) -> None:
    out = tmp_path / "out"
    result.save(out)
    assert bytes_of((out / "report.json").read_text()) == bytes_of(result.json)
    assert {"overview.png", "overview.svg", "result.zarr"} <= {path.name for path in out.iterdir()}
    result.save(out)
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "notes.txt").write_text("mine")
    with pytest.raises(catchment.Error):
        result.save(tmp_path / "mine")
    assert [path.name for path in (tmp_path / "mine").iterdir()] == ["notes.txt"]


def test_a_notebook_shows_table_and_picture(result: catchment.Result, tmp_path: Path) -> None:
    page = result._repr_html_()
    assert page.startswith("<img") and "data:image/png;base64," in page and "ONAA" in page
    assert (result._repr_png_() or b"").startswith(b"\x89PNG")
    assert repr(result).startswith("<Result of 'V-Face, AR 1, COR 0' by confluence: Sum 2.3")
    assert str(result) == result.table
    picture = result.pictures["overview"]
    picture.save(tmp_path / "a.svg")
    picture.save(tmp_path / "a.png")
    assert (tmp_path / "a.svg").read_text() == picture.svg
    assert (tmp_path / "a.png").read_bytes() == picture.png
    assert result.problem._repr_png_().startswith(b"\x89PNG")
    # What a design is called does not become a part of the page.
    text = Path("designs/v-face.toml").read_text().replace("V-Face, AR", "<script>'\\\"")
    named = catchment.Problem.from_text(text).run(resolution=5, samples=10)
    assert "<script>" not in named._repr_html_() and "&lt;script&gt;" in named._repr_html_()


def test_a_pickle_is_the_result(result: catchment.Result, tmp_path: Path) -> None:
    again = pickle.loads(pickle.dumps(result))
    assert again.json == result.json and again.table == result.table
    assert np.array_equal(again.outcomes, result.outcomes) and np.array_equal(again.heights, result.heights)
    assert again.problem == result.problem
    assert again.pictures["section"] == result.pictures["section"]
    again.save(tmp_path / "again")
    assert bytes_of((tmp_path / "again" / "report.json").read_text()) == bytes_of(result.json)
    window = result.problem.window(motions=500)
    assert pickle.loads(pickle.dumps(window)).to_dict() == window.to_dict()


@pytest.mark.parametrize("design", ["v-face", "pyramid-stl", "pyramid-assembled", "kelvin-balls"])
def test_a_pickled_problem_is_the_same(design: str) -> None:
    problem = catchment.load(f"designs/{design}.toml")
    again = pickle.loads(pickle.dumps(problem))
    assert again.digest == problem.digest and again.design == problem.design and again.text == problem.text


def test_a_pickle_needs_no_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "meshes").mkdir()
    from conftest import DESIGNS

    for name in ("plug.stl", "socket.stl"):
        (tmp_path / "meshes" / name).write_bytes((DESIGNS / "meshes" / name).read_bytes())
    (tmp_path / "d.toml").write_text((DESIGNS / "pyramid-stl.toml").read_text())
    problem = catchment.load("d.toml", cor="10 mm")
    state = pickle.dumps(problem)
    for name in ("plug.stl", "socket.stl"):
        (tmp_path / "meshes" / name).unlink()
    again = pickle.loads(state)
    assert again == problem
    assert bytes_of(again.run(resolution=3, samples=20).json) == bytes_of(problem.run(resolution=3, samples=20).json)
    # And once more, from what is in memory alone; also where something in it is changed.
    assert pickle.loads(pickle.dumps(again)) == problem
    assert again.replace(cor=0.5).digest != problem.digest
    report = catchment.sweep(again, {"rho": [0.4, 0.5]}, resolution=3, samples=10)
    assert len(report["designs"]) == 2 and all("figures" in trial for trial in report["designs"])


def test_progress_is_reported_and_may_be_a_bar(capfd: pytest.CaptureFixture[str]) -> None:
    calls: list[tuple[float, str]] = []
    catchment.load("designs/x-face.toml").run(progress=lambda share, stage: calls.append((share, stage)))
    assert calls and all(0.0 <= share <= 1.0 and stage for share, stage in calls)
    catchment.load("designs/v-face.toml").run(resolution=20, progress=True)
    assert "%" in capfd.readouterr().err

    def broken(share: float, stage: str) -> None:
        raise RuntimeError("no more")

    with pytest.raises(RuntimeError, match="no more"):
        catchment.load("designs/x-face.toml").run(progress=broken)


def test_requirements_are_judged() -> None:
    problem = catchment.load("designs/v-face.toml")
    result = problem.run(resolution=9, require=["onaa.edge>=0.99", "acceptance.sum>=0"])
    assert len(result.unmet) == 1 and "onaa.edge" in result.unmet[0]
    with pytest.raises(catchment.ArgumentError, match="require"):
        problem.run(require="no.such.thing>=1")
