"""Opens the files that `export`, `run` and `trace` write for other tools, in those tools, and compares them with
the report.

    python tests/other_tools.py target/debug/catchment

The versions of vtk, trimesh, pandas and xarray (with netCDF4) are those of tests/requirements.txt. The glTF file is also checked against the
rules of its specification: chunks, alignment, bounds, increasing times, unit quaternions.
"""

import json
import struct
import subprocess
import sys
import tempfile
from math import isclose
from pathlib import Path

import numpy
import pandas
import trimesh
import xarray
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkFiltersCore import vtkMassProperties, vtkTriangleFilter
from vtkmodules.vtkIOXML import vtkXMLImageDataReader, vtkXMLPolyDataReader

ROOT = Path(__file__).resolve().parent.parent


def call(program: Path, home: Path, *args: str) -> str:
    done = subprocess.run([program, *args], cwd=home, capture_output=True, text=True)
    assert done.returncode == 0, f"{args}: {done.stderr}"
    return done.stdout


def opened(reader, path: Path):
    assert reader.CanReadFile(str(path)), path
    reader.SetFileName(str(path))
    reader.Update()
    assert reader.GetErrorCode() == 0, path
    return reader.GetOutput()


def arrays(data) -> dict:
    return {data.GetArrayName(k): vtk_to_numpy(data.GetArray(k)) for k in range(data.GetNumberOfArrays())}


def volume(surface) -> float:
    triangles = vtkTriangleFilter()
    triangles.SetInputData(surface)
    measured = vtkMassProperties()
    measured.SetInputConnection(triangles.GetOutputPort())
    measured.Update()
    return measured.GetVolume()


def check_set(program: Path, home: Path) -> None:
    """Image, border and table of a result with four errors are what its report counts."""
    design = str(ROOT / "designs/pyramid.toml")
    call(program, home, "run", design, "--free", "x,y,roll,yaw", "--resolution", "9", "--samples", "0", "-o", "out")
    report = json.loads((home / "out/report.json").read_text(encoding="utf-8"))
    box = numpy.prod([axis["hi"] - axis["lo"] for axis in report["axes"]])
    whole = xarray.open_zarr(home / "out/result.zarr", consolidated=True).load()
    call(program, home, "export", "out", "-o", "set.vti", "--axes", "x,y,yaw", "--at", "roll=20 deg")
    image = opened(vtkXMLImageDataReader(), home / "set.vti")
    cells = arrays(image.GetCellData())
    assert image.GetNumberOfCells() == 9**3 and image.GetDimensions() == (10, 10, 10)
    section = whole.sel(roll=numpy.radians(20), method="nearest").transpose("yaw", "y", "x")
    assert (cells["outcome"] == section.outcome.values.ravel()).all()
    assert numpy.array_equal(cells["height"], section.height.values.ravel(), equal_nan=True)
    assert (cells["accepted"] == (cells["outcome"] == 1)).all()
    # The mean of all shares is the accepted share of the whole grid.
    assert isclose(cells["share"].mean() * box, report["acceptance"]["sum_grid"], rel_tol=1e-6)
    bounds = [axis[name] for axis in report["axes"] if axis["axis"] != "roll" for name in ("lo", "hi")]
    assert numpy.allclose(image.GetBounds(), bounds, atol=1e-12)

    call(program, home, "export", "out", "-o", "set.vtp", "--axes", "x,y,yaw", "--at", "roll=20 deg")
    border = opened(vtkXMLPolyDataReader(), home / "set.vtp")
    accepted = int(cells["accepted"].sum())
    assert accepted > 20
    assert isclose(volume(border), accepted * numpy.prod(image.GetSpacing()), rel_tol=1e-5)
    assert set(arrays(border.GetCellData())["beyond"]) <= {0, 2, 3, 4}

    call(program, home, "export", "out", "-o", "set.csv")
    table = pandas.read_csv(home / "set.csv")
    counted = table.outcome.value_counts()
    outcomes = report["acceptance"]["outcomes"]
    assert all(counted.get(name, 0) == count for name, count in outcomes.items()), counted
    assert len(table) == report["acceptance"]["cells"] and list(table.columns) == ["x", "y", "roll", "yaw", "outcome", "height"]
    assert isclose((table.outcome == "aligned").mean() * box, report["acceptance"]["sum_grid"], rel_tol=1e-12)

    # The lines from docs/other-tools.md.
    lines = (ROOT / "docs/other-tools.md").read_text(encoding="utf-8").split("import json, xarray\n", 1)[1].split("```", 1)[0]
    lines = lines.replace('"out/', f'"{home}/out/').replace('"set.nc"', f'"{home}/set.nc"')
    exec(lines, {"json": json, "xarray": xarray})
    with xarray.open_dataset(home / "set.nc") as back:
        assert (back.outcome == whole.outcome).all() and back.outcome.attrs["flag_meanings"] == whole.outcome.attrs["flag_meanings"]
        assert json.loads(back.attrs["report"])["acceptance"] == report["acceptance"]


def check_planar(program: Path, home: Path) -> None:
    """Of two errors the run itself writes the files, and the squares have the area of the grid."""
    design = str(ROOT / "designs/v-face.toml")
    options = ["--resolution", "40", "--samples", "0", "--method", "flood"]
    report = json.loads(call(program, home, "run", design, *options, "-o", "v.vtp", "--json"))
    squares = opened(vtkXMLPolyDataReader(), home / "v.vtp")
    assert squares.GetNumberOfCells() == report["acceptance"]["outcomes"]["aligned"]
    places = vtk_to_numpy(squares.GetPoints().GetData())
    corners = vtk_to_numpy(squares.GetPolys().GetConnectivityArray()).reshape(-1, 4)
    sides = places[corners[:, [1, 3]]] - places[corners[:, [0]]]
    area = numpy.cross(sides[:, 0], sides[:, 1])[:, 2].sum()
    assert isclose(area, report["acceptance"]["sum_grid"], rel_tol=1e-9)
    call(program, home, "run", design, *options, "-o", "v.vti")
    image = opened(vtkXMLImageDataReader(), home / "v.vti")
    assert arrays(image.GetCellData())["accepted"].sum() == squares.GetNumberOfCells()


def glb(path: Path) -> tuple[dict, bytes]:
    """The JSON and the numbers of a file, by the rules of the binary container."""
    data = path.read_bytes()
    magic, version, length = struct.unpack_from("<4sII", data)
    assert (magic, version, length) == (b"glTF", 2, len(data)) and length % 4 == 0
    size, kind = struct.unpack_from("<I4s", data, 12)
    assert kind == b"JSON" and size % 4 == 0
    head = json.loads(data[20 : 20 + size])
    assert data[20 : 20 + size].rstrip(b" ").endswith(b"}")
    rest, kind = struct.unpack_from("<I4s", data, 20 + size)
    assert kind == b"BIN\0" and 28 + size + rest == len(data)
    return head, data[28 + size :]


def values(head: dict, numbers: bytes, accessor: int) -> numpy.ndarray:
    entry = head["accessors"][accessor]
    view = head["bufferViews"][entry["bufferView"]]
    width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[entry["type"]]
    assert entry["componentType"] == 5126 and view["byteOffset"] % 4 == 0
    assert view["byteLength"] == 4 * width * entry["count"] and view["byteOffset"] + view["byteLength"] <= len(numbers)
    found = numpy.frombuffer(numbers, "<f4", width * entry["count"], view["byteOffset"]).reshape(-1, width)
    for name, bound in (("min", found.min(axis=0)), ("max", found.max(axis=0))):
        assert name not in entry or (numpy.float32(entry[name]) == bound).all()
    assert numpy.isfinite(found).all()
    return found


def check_motion(program: Path, home: Path) -> None:
    """A motion ends at the mated pose, in glTF and in VTK, and is that of the trace."""
    design = str(ROOT / "designs/gallery/peg-in-hole.toml")
    free = ["--pose", "x=1.2 mm,y=0.5 mm"]
    trace = json.loads(call(program, home, "trace", design, *free, "--json", "-o", "dock.glb"))
    call(program, home, "trace", design, *free, "-o", "dock.vtp")
    assert trace["outcome"] == "aligned"
    head, numbers = glb(home / "dock.glb")
    for mesh in head["meshes"]:
        for attributes in (primitive["attributes"] for primitive in mesh["primitives"]):
            assert "min" in head["accessors"][attributes["POSITION"]]
            if "NORMAL" in attributes:
                lengths = numpy.linalg.norm(values(head, numbers, attributes["NORMAL"]), axis=1)
                assert numpy.allclose(lengths, 1, atol=1e-5)
    move, turn = head["animations"][0]["samplers"]
    times = values(head, numbers, move["input"])[:, 0]
    assert (numpy.diff(times) > 0).all() and times[0] == 0
    places, turns = (values(head, numbers, sampler["output"]) for sampler in (move, turn))
    assert len(places) == len(turns) == len(times)
    assert numpy.allclose(numpy.linalg.norm(turns, axis=1), 1, atol=1e-5)
    metres = 0.012
    end = trace["waypoints"][-1]["error"]
    assert numpy.allclose(places[-1], numpy.array([end["x"], end["y"], places[-1][2] / metres]) * metres, atol=1e-8)
    # A peg with play docks anywhere in it, 0.55 mm; it stands on the floor, upright.
    assert numpy.abs(places[-1][:2]).max() < 0.55e-3 and abs(places[-1][2]) < 0.002 * metres
    assert numpy.allclose(numpy.abs(turns[-1]), [0, 0, 0, 1], atol=1e-6)

    scene = trimesh.load(home / "dock.glb")
    shown = {name: scene.geometry[name] for name in scene.geometry}
    halves = [mesh for mesh in shown.values() if isinstance(mesh, trimesh.Trimesh)]
    assert len(halves) == 2, list(shown)
    # In metres, y up: the peg is 25 mm long with its tip, and as thick as its diameter.
    peg = min(halves, key=lambda mesh: mesh.extents.min())
    assert isclose(peg.extents.max(), 0.025, rel_tol=1e-3) and isclose(peg.extents.min(), 2 * 0.00599, rel_tol=0.02)

    motion = opened(vtkXMLPolyDataReader(), home / "dock.vtp")
    part = arrays(motion.GetCellData())["part"]
    points = arrays(motion.GetPointData())
    touches = sum(len(waypoint["touches"]) for waypoint in trace["waypoints"])
    assert (part == 0).sum() == touches == motion.GetNumberOfVerts() and (part == 1).sum() == 1
    assert motion.GetLines().GetNumberOfConnectivityIds() == len(trace["waypoints"])
    way = slice(touches, touches + len(trace["waypoints"]))
    assert numpy.array_equal(points["x"][way], [waypoint["error"]["x"] for waypoint in trace["waypoints"]])
    assert numpy.allclose(numpy.linalg.norm(points["normal"][:touches], axis=1), 1)
    assert set(part) == {0, 1, 2, 3, 4} and set(arrays(motion.GetCellData())["outcome"]) == {1}


def main() -> None:
    program = Path(sys.argv[1]).resolve()
    for check in (check_set, check_planar, check_motion):
        with tempfile.TemporaryDirectory() as home:
            check(program, Path(home))
        print(f"{check.__name__}: {check.__doc__.strip()}")


main()
