#!/usr/bin/env python3
"""Measures whole steps, and writes docs/performance.md and its plots from the measurements.

    performance.py measure BUILD OUT --space host|cuda --part NAME [--most N] [--seconds S]
    performance.py page

BUILD contains scree_bench_step (build/cuda-release, or the folder that scripts/bundle.sh made); OUT is the folder of a machine,
bench/results/MACHINE/step. A part is a list of runs of `scree bench step`. The result of each run is added at once to
OUT/NAME.jsonl, so that nothing is lost if a part is cut short; the page takes the last result of each run. --most is the largest
number of bodies of a run, for trials. --seconds is the time for the whole part (default 570); runs that do not fit into the rest
of it settle for a shorter time, or are reported as not done. The page needs gnuplot, measuring does not. The folders may come from
different machines.
"""
import argparse
import json
import shlex
import subprocess
import sys
import time
from dataclasses import dataclass, field
from pathlib import Path

import performance_page

SCENES = Path("configs/bench")


@dataclass
class Run:
    """A run of `scree bench step`. `settle` is the simulated time to settle (s); `within` is the wall time that settling, and then the timed steps, may take
    (s); `space` is host or cuda, or empty for the space that is asked for."""
    scene: str
    settings: dict
    settle: float
    within: float
    precision: str = "mixed"
    space: str = ""
    varied: dict = field(default_factory=dict)

    @property
    def name(self):
        return " ".join([self.scene, *(f"{key}={value}" for key, value in (self.varied | {"precision": self.precision}).items())])

    def words(self, within):
        settings = ";".join(f"{key}={value}" for key, value in (self.settings | {"precision": self.precision}).items())
        return [str(SCENES / f"{self.scene}.yaml"), "--space", self.space, "--settle", f"{self.settle:g}", "--within", f"{within:.3g}",
                "--calls", "yes", "--set", settings]


def lattice(n, most_layers, height, wall):
    """Returns the settings of a scene of about n bodies in a lattice of two interleaved sets of layers. `height` is the ratio of its layers to the bodies
    along a side, and `most_layers` is the number of layers that the scene has. `wall` gives the offset of the walls from the bodies along a side."""
    side = round(max((n / (2 * height)) ** (1 / 3), (n / (2 * most_layers)) ** 0.5))
    count = f"[{side},{side},{min(most_layers, max(1, round(n / (2 * side * side))))}]"
    return {f"bodies[{k}].repeat.count": count for k in (5, 6)} | {f"bodies[{k}].plane.offset": f"{-wall(side):.6g}" for k in (2, 4)}


def spheres(n, precision="mixed", **rest):
    settings = lattice(n, 71, 71 / 84, lambda side: 0.1206 * side + 0.052)
    return Run(**({"scene": "settled_spheres", "settings": settings, "settle": 2 if n < 10**6 else 5,
                   "within": 15 if n < 10**6 else 110, "precision": precision, "varied": {"n": n}} | rest))


def wide(n, precision="mixed"):
    """Returns a run of spheres in 20 layers, whatever their number."""
    settings = lattice(n, 10, 10, lambda side: 0.1206 * side + 0.052)
    return spheres(n, precision, settings=settings, settle=3, varied={"n": n, "layers": 20})


def boxes(n, precision="mixed"):
    """Returns a run of boxes in 20 layers, because more layers come to rest slowly."""
    settings = lattice(n, 10, 10, lambda side: 0.1206 * side + 0.061)
    return Run("settled_boxes", settings, 3, 30 if n < 10**6 else 150, precision, varied={"n": n, "layers": 20})


def decades(n, precision="mixed"):
    scale = (n / 10**6) ** (1 / 3)
    settings = {"bodies[5].scatter.count": n, "bodies[5].scatter.to": f"[{40 * scale:.6g},{40 * scale:.6g},{22 * scale:.6g}]",
                "bodies[5].sphere.radius.powerlaw": f"[0.05,{5 * min(1, (n / (2 * 10**5)) ** (1 / 3)):.6g},3.5]",
                **{f"bodies[{k}].plane.offset": f"{-40 * scale:.6g}" for k in (2, 4)}}
    return Run("two_decades", settings, 6, 15 if n < 10**6 else 300, precision, varied={"n": n})


def drum(n, precision="mixed"):
    radius = 0.003 * (10**6 / n) ** 0.5
    tube = ((4.189 + 26.9 * n * radius**3) / 4.686) ** (1 / 3)
    settings = {"bodies[4].scatter.count": n, "bodies[4].sphere.radius": f"{radius:.6g}",
                "bodies[4].scatter.from": f"[-{tube:.6g},-{tube:.6g},-{tube:.6g}]", "bodies[4].scatter.to": f"[{tube:.6g},{tube:.6g},{tube:.6g}]",
                **{f"bodies[{k}].tube.radius": f"{tube:.6g}" for k in (0, 1, 2)}}
    return Run("drum_hub", settings, 1.5, 15 if n < 10**6 else 100, precision, varied={"n": n})


def scaled(n, of, **lengths):
    """Returns settings of lengths, or of lists of lengths, scaled from the `of` bodies that the scene has to n bodies."""
    scale = (n / of) ** (1 / 3)
    text = lambda value: f"[{','.join(map(text, value))}]" if isinstance(value, (list, tuple)) else f"{scale * value:.6g}"
    return {key: text(value) for key, value in lengths.items()}


def collapse(n, **rest):
    side = round((n / 5.7) ** (1 / 3))
    settings = {"bodies[5].repeat.count": f"[{side},{side},{round(5.7 * side)}]", **{f"bodies[{k}].plane.offset": f"{-0.0225 * side:.6g}" for k in (2, 4)}}
    return Run(**({"scene": "collapse", "settings": settings, "settle": 0.75, "within": 60, "varied": {"n": n}} | rest))


def beads(n, **rest):
    settings = {"bodies[1].scatter.count": n, "bodies[1].sphere.radius": f"{0.0037 * (10**5 / n) ** (1 / 3):.6g}"}
    return Run(**({"scene": "drum", "settings": settings, "settle": 0.8, "within": 60, "varied": {"n": n}} | rest))


def rubble(n, **rest):
    x, y, z = (round(count * (n / 10**5) ** (1 / 3)) for count in (40, 88, 14))
    settings = {**{f"bodies[{k}].repeat.count": f"[{x},{y},{z}]" for k in (4, 5)}, **{f"bodies[{k}].plane.offset": f"{-0.013 * y - 0.002:.6g}" for k in (2, 3)},
                **{f"bodies[{k}].at[1]": f"{-0.013 * (y - 1):.6g}" for k in (4, 5)}}
    return Run(**({"scene": "rubble", "settings": settings, "settle": 0.6, "within": 100, "varied": {"n": n}} | rest))


def stirrer(n):
    lengths = {"bodies[0].tube.radius": 0.3, "bodies[0].tube.length": 1.6, "bodies[0].at": (0, 0, 0.8), "bodies[1].box.size": (0.54, 0.02, 0.16),
               "bodies[1].at": (0, 0, 0.2), "bodies[2].scatter.from": (-0.3, -0.3, 0), "bodies[2].scatter.to": (0.3, 0.3, 1.2)}
    return Run("stirrer", {"bodies[2].scatter.count": n, **scaled(n, 3 * 10**5, **lengths)}, 1.5, 60, varied={"n": n})


def hopper(n):
    scale = (10**5 / n) ** (1 / 3)
    settings = {"bodies[4].scatter.count": n, "bodies[4].sphere.radius.uniform": f"[{0.0037 * scale:.6g},{0.0045 * scale:.6g}]"}
    return Run("hopper", settings, 1.2, 60, varied={"n": n})


def mixed_drum(n):
    scale = (10**5 / n) ** (1 / 3)
    settings = {"bodies[1].scatter.count": n, "bodies[1].sphere.radius.powerlaw": f"[{0.0018 * scale:.6g},{0.018 * scale:.6g},3.5]"}
    return Run("mixed_drum", settings, 0.8, 60, varied={"n": n})


def motion(n):
    return [collapse(n), beads(n), stirrer(3 * n if n == 10**5 else n), hopper(n), mixed_drum(n), rubble(n)]


def motion_and_error(n):
    for scene in (collapse, beads, rubble):
        for quality in (0.0625, 0.25, 1, 4):
            run = scene(n, within=12, varied={"n": n, "quality": quality})
            run.settings |= {"response.quality": quality}
            yield run


def speed_and_error(n):
    """Yields runs whose sweeps go on to their largest number, because the tolerance is out of reach."""
    for precision in ("mixed", "double"):
        for substeps in (1, 2, 4):
            for iterations in (3, 6, 12, 24):
                run = spheres(n, precision, within=12, varied={"substeps": substeps, "iterations": iterations})
                run.settings |= {"time.substeps": substeps, "response.iterations": iterations, "response.tolerance": "1e-12"}
                yield run


def crossover(counts, space):
    """Yields runs on Host and, if the space is cuda, also on Device, so that both are measured on the same machine."""
    for n in counts:
        for here in ("host", "cuda") if space == "cuda" else ("host",):
            for precision in ("double", "mixed"):
                yield spheres(n, precision, settle=1.5, within=10, space=here)


def heaps(space):
    for scene in ("pile", "boxpile"):
        for here in ("host", "cuda") if space == "cuda" else ("host",):
            for precision in ("double", "mixed"):
                yield Run(scene, {}, 2.5, 60, precision, here)


PRECISIONS = ("mixed", "double")
PARTS = {
    "spheres": lambda at_most, space: [spheres(n) for n in at_most(10**3, 10**4, 10**5, 10**6, 10**7)],
    "wide": lambda at_most, space: [wide(n, p) for p in PRECISIONS for n in at_most(10**5, 10**6, 4 * 10**6, 10**7, 3 * 10**7)],
    "spheres-double": lambda at_most, space: [spheres(n, "double") for n in at_most(10**3, 10**4, 10**5, 10**6, 10**7)],
    "spheres-largest": lambda at_most, space: [spheres(n, p, within=130) for p in PRECISIONS for n in at_most(3 * 10**7, 10**8)],
    "boxes": lambda at_most, space: [boxes(n, p) for p in PRECISIONS for n in at_most(10**4, 10**5, 10**6)],
    "decades": lambda at_most, space: [decades(n, p) for p in PRECISIONS for n in at_most(10**6)],
    "drum": lambda at_most, space: [drum(n, p) for p in PRECISIONS for n in at_most(10**6)],
    "motion": lambda at_most, space: [run for n in at_most(10**5) for run in motion(n)],
    "motion-large": lambda at_most, space: [run for n in at_most(10**6) for run in motion(n)],
    "motion-error": lambda at_most, space: [run for n in at_most(10**5) for run in motion_and_error(n)],
    "crossover": lambda at_most, space: list(crossover(at_most(100, 300, 1000, 3000, 10**4, 3 * 10**4, 10**5), space)),
    "error": lambda at_most, space: [run for n in at_most(10**5) for run in speed_and_error(n)],
    "heaps": lambda at_most, space: list(heaps(space)),
}


def program_in(build):
    found = sorted(path for path in build.rglob("scree_bench_step") if path.is_file())
    if not found:
        sys.exit(f"{build}: no scree_bench_step; cmake --build --preset cuda-release --target scree_bench_step")
    return found[0]


def result_of(program, words, seconds):
    """Returns the result of a run, or the reason why there is none."""
    try:
        done = subprocess.run([program, *words], cwd=performance_page.ROOT, capture_output=True, text=True, timeout=seconds)
    except subprocess.TimeoutExpired:
        return {"failed": f"not done in the {seconds:.0f} s that were left"}
    if done.returncode == 0:
        return {"result": json.loads(done.stdout)}
    lines = done.stderr.strip().splitlines()
    return {"failed": lines[-1] if lines else f"status {done.returncode}"}


def measure(arguments):
    program = program_in(arguments.build)
    at_most = lambda *counts: list(dict.fromkeys(min(n, arguments.most) for n in counts))
    end = time.monotonic() + arguments.seconds
    asked = f"--space {arguments.space} --part {arguments.part}" + (f" --most {arguments.most}" if arguments.most < 10**9 else "")
    arguments.out.mkdir(parents=True, exist_ok=True)
    for run in PARTS[arguments.part](at_most, arguments.space):
        run.space = run.space or arguments.space
        if (left := end - time.monotonic()) < 10:
            sys.exit("no time is left for: " + run.name)
        words = run.words(max(1, min(run.within, left / 2.2)))
        command = shlex.join(["scree", "bench", "step", *words])
        print(f"+ {command}", file=sys.stderr)
        line = {"part": arguments.part, "asked": asked, "name": run.name, "varied": run.varied, "scene": run.scene, "precision": run.precision,
                "space": run.space, "command": command, **result_of(program, words, left)}
        with open(arguments.out / f"{arguments.part}.jsonl", "a") as lines:
            lines.write(json.dumps(line) + "\n")
        said = line.get("result")
        print(f"  {said['bodies']} bodies, {said['median_ms']:.3g} ms" if said else f"  {line['failed']}", file=sys.stderr)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    steps = parser.add_subparsers(dest="step", required=True)
    step = steps.add_parser("measure")
    step.add_argument("build", type=lambda text: Path(text).resolve(), metavar="BUILD")
    step.add_argument("out", type=Path, metavar="OUT")
    step.add_argument("--space", choices=("host", "cuda"), required=True)
    step.add_argument("--part", choices=PARTS, required=True)
    step.add_argument("--most", type=int, default=10**9)
    step.add_argument("--seconds", type=float, default=570)
    steps.add_parser("page")
    arguments = parser.parse_args()
    measure(arguments) if arguments.step == "measure" else performance_page.write()


if __name__ == "__main__":
    main()
