"""Drops random poses of a design in MuJoCo and compares their outcomes with `catchment outcome`.

    python tests/mujoco_agrees.py target/debug/catchment designs/pyramid.toml
    python tests/mujoco_agrees.py target/debug/catchment designs/pyramid.toml --friction 0.2 --poses 200 --aspect-ratio 1
    python tests/mujoco_agrees.py target/debug/catchment designs/chamfered-peg.toml --friction 0.1 --poses 200 --half 0.2,0.2,0.2,0.2,0.05

MuJoCo runs the world that `catchment export` wrote; catchment computes exact quasi-static motion. Both describe the same
heavily damped drop, so they must agree on at least 95 of 100 poses, 97 with friction. Exits with a message if they do not.
"""

import argparse
import csv
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import mujoco
import numpy as np

AGREE = 0.95
AGREE_WITH_FRICTION = 0.97
# MuJoCo's contacts are springs of two time steps: they yield under force · (2 · timestep)² / mass = 2e-4 D. Damping makes the
# half stop within 0.02 D.
SETTINGS = ["--push", "50", "--damping", "50", "--mass", "1", "--timestep", "0.001"]
# Its friction is a damper: a sticking contact creeps, a thousandth as fast as with its default of 1
# ("impratio").
FRICTION_AS_STIFF = 1000.0
TIMEOUT_S = 60.0
# Seconds between two samples of a trial, and the largest displacement between them that counts as rest (a
# slope of 3e-4).
LOOK_S = 0.1
REST = 3e-5
ALIGNED = 0.02
LOST = 1.0


def rotation(roll: float, pitch: float, yaw: float) -> np.ndarray:
    """Rz(yaw) · Ry(pitch) · Rx(roll)."""
    (cr, sr), (cp, sp), (cy, sy) = ((np.cos(a), np.sin(a)) for a in (roll, pitch, yaw))
    x = np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]])
    y = np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
    z = np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]])
    return z @ y @ x


def drop(model: mujoco.MjModel, data: mujoco.MjData, pose: list[float], cor: float, above: float, symmetry: int, play: list[float]) -> bool:
    """Whether a pose error ends aligned."""
    turned = rotation(*pose[2:])
    quaternion = np.zeros(4)
    mujoco.mju_mat2Quat(quaternion, turned.flatten())
    mujoco.mj_resetData(model, data)
    face = cor * turned[:, 2]
    # Starts above everything, as there is no height of first contact here.
    data.qpos[:] = [pose[0] - face[0], pose[1] - face[1], above, *quaternion]
    site = model.site("moving_face").id
    last = None
    steps = round(LOOK_S / model.opt.timestep)
    touched = None
    for _ in range(round(TIMEOUT_S / LOOK_S)):
        mujoco.mj_step(model, data, steps)
        mujoco.mj_kinematics(model, data)
        apart = np.linalg.norm(data.site_xpos[site])
        now = np.concatenate([data.site_xpos[site], data.site_xmat[site]])
        angles = [
            np.arccos(np.clip((np.trace(data.site_xmat[site].reshape(3, 3) @ rotation(0, 0, -2 * np.pi * k / symmetry)) - 1) / 2, -1, 1))
            for k in range(symmetry)
        ]
        if apart <= ALIGNED + play[0] and min(angles) <= ALIGNED + play[1]:
            return True
        if data.ncon and touched is None:
            touched = apart
        if data.site_xpos[site][2] < -LOST - 1 or (touched is not None and apart > touched + LOST):
            return False
        if data.ncon and last is not None and np.abs(now - last).max() < REST:
            return False
        last = now
    return False


def half_widths(text: str) -> list[float]:
    """Half ranges of the error box: D, D, rad, rad, rad."""
    half = [float(part) for part in text.split(",")]
    if len(half) != 5:
        raise argparse.ArgumentTypeError("five numbers: x, y, roll, pitch, yaw")
    return half


def main() -> None:
    say = argparse.ArgumentParser()
    say.add_argument("program")
    say.add_argument("design")
    say.add_argument("--friction", type=float, default=0.0)
    say.add_argument("--poses", type=int, default=100)
    say.add_argument("--aspect-ratio")
    say.add_argument("--half", type=half_widths, default=[0.5, 0.5, np.pi / 4, np.pi / 4, np.pi / 4])
    args = say.parse_args()
    friction = ["--friction", str(args.friction)]
    # A body in MuJoCo is free in all of them.
    drawn = ["--free", "x,y,roll,pitch,yaw", *(["--aspect-ratio", args.aspect_ratio] if args.aspect_ratio else [])]
    with tempfile.TemporaryDirectory() as folder:
        trial, poses = Path(folder) / "trial", Path(folder) / "poses.csv"
        done = subprocess.run(
            [args.program, "export", args.design, *drawn, "--pose", "x=0", "-o", trial, "--json", *SETTINGS, *friction],
            check=True, capture_output=True, text=True,
        )
        alignment = json.loads(done.stdout)["design"]["alignment"]
        errors = (np.random.default_rng(1).uniform(-1, 1, (args.poses, 5)) * args.half).tolist()
        with poses.open("w", newline="") as file:
            csv.writer(file).writerows([["x", "y", "roll", "pitch", "yaw"], *errors])
        done = subprocess.run(
            [args.program, "outcome", args.design, *drawn, "--poses", poses, "--method", "descent", "--json", *friction],
            check=True, capture_output=True, text=True,
        )
        expected = [row["outcome"] == "aligned" for row in json.loads(done.stdout)["poses"]]
        model = mujoco.MjModel.from_xml_path(str(trial / "trial.xml"))
    model.opt.impratio = FRICTION_AS_STIFF
    data = mujoco.MjData(model)
    cor, symmetry = alignment["center_of_rotation"], alignment["symmetry"]
    limits = [limit or 0.0 for limit in alignment["docked"]["limits"]]
    play = [float(np.hypot(*limits[:2])), float(np.linalg.norm(limits[2:]))]
    found = [drop(model, data, pose, cor, 1.5, symmetry, play) for pose in errors]
    same = sum(a == b for a, b in zip(found, expected, strict=True))
    at = f" at a friction of {args.friction}" if args.friction else ""
    print(f"{same} of {args.poses} poses end alike{at}, {sum(found)} of them aligned in MuJoCo, {sum(expected)} by descent")
    if same < (AGREE_WITH_FRICTION if args.friction else AGREE) * args.poses:
        sys.exit(f"MuJoCo and catchment agree on {same} of {args.poses} poses only")


if __name__ == "__main__":
    main()
