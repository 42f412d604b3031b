"""Halves from meshes in memory."""

import numpy as np
import pytest
import trimesh
from conftest import DESIGNS

import catchment


def halves() -> tuple[trimesh.Trimesh, trimesh.Trimesh]:
    socket, plug = (trimesh.load_mesh(DESIGNS / "meshes" / name) for name in ("socket.stl", "plug.stl"))
    return socket, plug


BOX = {"x": 1.0, "y": 1.0, "roll": "90 deg", "pitch": "90 deg", "yaw": "90 deg"}


def problem(fixed: object, moving: object) -> catchment.Problem:
    return catchment.Problem(
        fixed=fixed,
        moving=moving,
        width=50.0,
        unit="mm",
        face_height=12.5,
        cor=0.5,
        rotation_length=0.5,
        error_box=BOX,
        name="pyramid",
    )


def test_meshes_in_memory_are_the_problem_of_their_files() -> None:
    socket, plug = halves()
    in_memory, from_files = problem(socket, plug), catchment.load("designs/pyramid-stl.toml")
    random = np.random.default_rng(5)
    poses = random.uniform(-1, 1, (400, 5)) * np.array([1, 1, 1.5, 1.5, 1.5])
    ours, theirs = in_memory.follow_many(poses), from_files.follow_many(poses)
    # The same corners in another order: where a motion is a close call it may fall either way.
    assert (ours.outcomes == theirs.outcomes).mean() > 0.99
    assert in_memory.name == "pyramid" and in_memory.error_box == from_files.error_box
    run = {"resolution": 4, "samples": 0}
    assert in_memory.run(**run).sum == pytest.approx(from_files.run(**run).sum, rel=0.02)  # type: ignore[arg-type]


def test_arrays_and_trimeshes_are_alike() -> None:
    socket, plug = halves()
    arrays = problem((socket.vertices, socket.faces), (np.array(plug.vertices), np.array(plug.faces, dtype=np.uint16)))
    assert arrays == problem(socket, plug)


def test_a_missing_placement_is_proposed() -> None:
    socket, plug = halves()
    found = catchment.Problem(fixed=socket, moving=plug, error_box={"x": "10 mm"})
    assert found.design["width"] == 50.0 and found.design["unit"] == "mm"
    assert found.follow({"x": "5 mm"}).docks


@pytest.mark.parametrize(
    ("mesh", "message"),
    [
        (3, "trimesh or"),
        ((np.zeros((4, 2)), np.zeros((1, 3), int)), r"\(n, 3\)"),
        ((np.zeros((4, 3)), np.zeros((1, 4), int)), r"\(m, 3\)"),
        ((np.zeros((4, 3)), np.zeros((1, 3))), "whole numbers"),
        ((np.zeros((4, 3)), np.full((1, 3), 9)), "from 0 to 3"),
    ],
)
def test_an_invalid_mesh_is_reported(mesh: object, message: str) -> None:
    with pytest.raises(catchment.ArgumentError, match=f"fixed: .*{message}"):
        catchment.Problem(fixed=mesh, moving=mesh, width=1.0)


def test_a_mesh_with_a_hole_is_refused() -> None:
    socket, plug = halves()
    with pytest.raises(catchment.GeometryError, match="moving half"):
        problem(socket, (plug.vertices, plug.faces[:-1]))
