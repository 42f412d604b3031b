"""How fast Python is beside the program: prints figures, and asserts that both say the same.

    python crates/catchment-py/tests/measure.py [POSES] [--ratchet]

With --ratchet it fails if a figure is far from its target (an answer in 1 s, 0.95 of the program's rate): in seconds of the processor, which a busy
machine stretches little, and with so much room that a slow one passes.

Seconds are of the processor (of all threads), so that a busy machine counts as an idle one; in brackets those of the clock.
"""

import csv
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

import catchment

#: Seconds of the processor from import to answer; share of the program's rate.
ANSWERS_WITHIN, LEAST_RATE = 3.0, 0.8
DESIGNS = Path(__file__).resolve().parents[3] / "designs"
PROGRAM = str(Path(sys.executable).with_name("catchment"))

ANSWER = f"""
import catchment
catchment.load({str(DESIGNS / "v-face.toml")!r}).run()
"""


def of_child(*words: str) -> tuple[float, float]:
    """Seconds of the processor and of the clock that a command takes."""
    before, started = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    subprocess.run(words, check=True, capture_output=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, time.perf_counter() - started


def main() -> None:
    took, clock = of_child(sys.executable, "-c", ANSWER)
    print(f"import to answer on the V-Face  {took:6.2f} s  ({clock:.2f})")
    ratchet = "--ratchet" in sys.argv
    numbers = [word for word in sys.argv[1:] if word != "--ratchet"]
    count = int(numbers[0]) if numbers else 100_000
    if ratchet and took > ANSWERS_WITHIN:
        raise SystemExit(f"from import to answer took {took:.2f} s of the processor, more than {ANSWERS_WITHIN}")
    for name in ("v-face", "x-face-3d"):
        problem = catchment.load(DESIGNS / f"{name}.toml")
        half = np.array([problem.error_box.get(axis, 0.0) for axis in ("x", "y", "roll", "pitch", "yaw")])
        poses = np.random.default_rng(1).uniform(-half, half, (count, 5))
        with tempfile.TemporaryDirectory() as folder:
            table, out = Path(folder, "poses.csv"), Path(folder, "out.csv")
            with open(table, "w", newline="") as file:
                rows = csv.writer(file)
                rows.writerow(["x", "y", "roll", "pitch", "yaw"])
                rows.writerows([[repr(float(value)) for value in pose] for pose in poses])
            command = [PROGRAM, "outcome", str(DESIGNS / f"{name}.toml"), "--poses", str(table), "-o", str(out)]
            program, program_clock = of_child(*command, "--threads", "2")
            before, started = time.process_time(), time.perf_counter()
            ends = problem.follow_many(poses, threads=2)
            own, own_clock = time.process_time() - before, time.perf_counter() - started
            with open(out, newline="") as file:
                outcomes = [row["outcome"] for row in csv.DictReader(file)]
        assert outcomes == [catchment.OUTCOMES[int(code)] for code in ends.outcomes]
        print(
            f"{name:10} {count} poses: program {program:6.2f} s ({program_clock:.2f}), "
            f"follow_many {own:6.2f} s ({own_clock:.2f}): {program / own:.2f} of its rate"
        )
        if ratchet and program / own < LEAST_RATE:
            raise SystemExit(f"{name}: follow_many has {program / own:.2f} of the program's rate, less than {LEAST_RATE}")


if __name__ == "__main__":
    main()
