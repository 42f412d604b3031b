"""Opens results of `catchment run -o out.zarr` in xarray and compares them with the report inside.

    python tests/xarray_opens.py out.zarr [more.zarr ...]

Needs xarray and zarr 3. Exits with a message at the first difference.
"""

import sys
import warnings

import numpy as np
import xarray as xr

CODES = {"aligned": 1, "jammed": 2, "missed": 3, "undecided": 4}


def check(path: str) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # a group without consolidated metadata would warn
        run = xr.open_zarr(path)
    report = run.attrs["report"]
    axes = {axis["axis"]: axis for axis in report["axes"]}

    outcome = run["outcome"]
    assert outcome.dtype == np.uint8, outcome.dtype
    assert outcome.dims == tuple(reversed(axes)), f"{outcome.dims}: the first axis must run fastest"
    for name, axis in axes.items():
        step = (axis["hi"] - axis["lo"]) / axis["cells"]
        centers = axis["lo"] + (np.arange(axis["cells"]) + 0.5) * step
        np.testing.assert_allclose(run[name].values, centers, rtol=0, atol=1e-12 * (axis["hi"] - axis["lo"]))
        assert run[name].attrs["units"] == axis["unit"]
        assert run[name].attrs["long_name"]

    codes = dict(zip(outcome.attrs["flag_meanings"].split(), outcome.attrs["flag_values"], strict=True))
    assert codes == CODES, codes
    for name, code in CODES.items():
        found, stated = int((outcome == code).sum()), report["acceptance"]["outcomes"][name]
        assert found == stated, f"{name}: {found} cells, but {stated} in the report"

    # Selecting by coordinate equals selecting by position: the axes are in the right order.
    middle = {name: axis["cells"] // 3 for name, axis in axes.items()}
    at = {name: float(run[name][k]) for name, k in middle.items()}
    assert int(outcome.sel(at, method="nearest")) == int(outcome.isel(middle))

    # Every cell with its centre in the ONAA cube is accepted.
    box = {
        bound["axis"]: slice(bound["lo"], bound["hi"])
        for bound in (report["onaa"] or {"bounds": []})["bounds"]
    }
    if box:
        assert bool((outcome.sel(box) == CODES["aligned"]).all()), "the ONAA cube holds cells that are not accepted"

    if "height" in run:
        assert run["height"].dims == outcome.dims and run["height"].dtype == np.float32
        assert run["height"].attrs["units"] == "D"
    print(f"{path}: {dict(outcome.sizes)}, {len(run.data_vars)} variables")


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    for argument in sys.argv[1:]:
        check(argument)
