#!/usr/bin/env python3
"""Writes docs/accuracy.md and its plots: what scree gets right, by how much, and at what price.

    accuracy.py PROGRAM [--only verify,simbenchmark,STUDY,...]

PROGRAM is the built scree. What was measured is kept in output/accuracy, so that parts can be run again by --only; all
of it takes about 15 minutes on 2 cores, on which nothing else should run.
"""
import argparse
import csv
import json
import math
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
OUTPUT = ROOT / "output/accuracy"
PICTURES = ROOT / "docs/pictures/accuracy"

MATRIX = ["response.mode=default,accurate", "narrowphase.box_box=sat,ccd_gjk"]

# Name: scene, what varies, (check, words) of each plot, runs for each time.
STUDIES = {
    "stopping": ("configs/validation/single_contact/box_stopping.yaml",
                 ["time.step=0.05,0.025,0.0125,0.00625,0.003125,0.0015625", "response.mode=default,accurate"],
                 [(1, "A box slides to a stop (position, m).")], 5),
    "rolling": ("configs/validation/single_contact/slide_to_roll.yaml",
                ["time.step=0.05,0.025,0.0125,0.00625,0.003125,0.0015625", "response.mode=default,accurate"],
                [(3, "A ball set down without spin slides until it rolls (position after 3 s, m).")], 5),
    "racket": ("configs/validation/free_motion/dzhanibekov.yaml",
               ["time.step=0.04,0.02,0.01,0.005,0.0025,0.00125", "response.mode=default,accurate"],
               [(1, "A box thrown about its middle axis, after five turns-over (spin, rad/s).")], 5),
    "stack": ("configs/validation/resting/stack_20.yaml",
              ["time.step=0.03333333333333333,0.016666666666666667,0.008333333333333333,0.004166666666666667,0.002",
               "response.mode=default,accurate"],
              [(1, "Twenty cubes on one another for 10 s (drift of the top, m).")], 3),
    "mass_ratio": ("configs/validation/resting/light_under_heavy_1000.yaml",
                   ["time.step=0.03333333333333333,0.016666666666666667,0.008333333333333333,0.004166666666666667",
                    "response.mode=default,accurate"],
                   [(1, "A cube carries one of a thousand times its mass (worst overlap, m).")], 5),
    "666": ("configs/validation/simbenchmark/666.yaml",
            ["time.step=0.01,0.005,0.002,0.001", "response.mode=default,accurate"],
            [(1, "SimBenchmark's 666 (worst overlap of the run, m).")], 1),
    "pile": ("configs/bench/pile.yaml",
             ["response.iterations=5,10,20,40", "time.step=0.008333333333333333,0.004166666666666667"],
             [(1, "8,000 settled spheres (mean overlap, of the radius), by the number of sweeps.")], 1),
    "boxpile": ("configs/bench/boxpile.yaml",
                ["response.iterations=6,12,25,50", "time.step=0.008333333333333333,0.004166666666666667"],
                [(1, "2,000 settled boxes (mean overlap, of half the smallest edge), by the number of sweeps.")], 1),
}

# Published at a step of 1 ms: the engine and setting that err least and their CPU time, on an i7-7700HQ (SimBenchmark, commit 3fd1764,
# data/*/sample.csv, ERP off).
PUBLISHED = {
    "rolling": ("Bullet, iterated to the end", 3.9e-27, 1.8),
    "bouncing": ("RaiSim", 0.0186, 0.235),
    "666": ("RaiSim", 1.35e-4, 1.51),
    "elastic_666": ("RaiSim", 8.4, 0.66),
}


def run(*command):
    print("+", *command, file=sys.stderr)
    return subprocess.run([str(part) for part in command], cwd=ROOT, stdout=subprocess.PIPE, text=True)


def origin(program):
    """Machine and commit, once for each part: they may be measured apart."""
    git = subprocess.run(["git", "-C", ROOT, "describe", "--always", "--dirty"], capture_output=True, text=True)
    info = run(program, "info").stdout
    cpu = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")), "?")
    return {"commit": git.stdout.strip(), "machine": cpu, "info": info}


def keep(part, data, program):
    OUTPUT.mkdir(parents=True, exist_ok=True)
    (OUTPUT / f"{part}.json").write_text(json.dumps({"origin": origin(program), **data}, indent=1))


def kept(part):
    return json.loads((OUTPUT / f"{part}.json").read_text())


def measure_verify(program):
    table = OUTPUT / "matrix.json"
    vary = [word for key in MATRIX for word in ("--vary", key)]
    run(program, "verify", "configs/validation", "--all", *vary, "--json", table)
    keep("verify", json.loads(table.read_text()), program)


def mean_error(rows, of):
    return sum(of(row) for row in rows) / len(rows)


def measure_simbenchmark(program):
    """The metrics as SimBenchmark defines them, from a row for each step; times from runs without."""
    found = {}
    for name in PUBLISHED:
        scene = ROOT / f"configs/validation/simbenchmark/{name}.yaml"
        folder = OUTPUT / name
        study = OUTPUT / f"{name}-time"
        run(program, "study", scene, "--vary", "time.substeps=auto", "-o", study, "--overwrite")
        point = json.loads((study / "study.json").read_text())["points"][0]
        end = {"rolling": 4, "bouncing": 20}.get(name, 10)
        if name == "rolling":
            errors = [check["error"] for check in point["checks"]]
            error = sum(sorted(e * e for e in errors)[-4:])  # both bodies, both directions, at the worst second
        else:
            run(program, "run", scene, "--no-render", "--set", "record.metrics_every=0.001", "-o", folder, "--overwrite")
            rows = [{k: float(v) for k, v in row.items()} for row in csv.DictReader(open(folder / "metrics.csv"))]
            if name == "666":  # all contacts as deep as the deepest: at least the sum
                error = mean_error(rows, lambda r: r["contacts_count"] * r["penetration_max"] ** 2)
            else:
                error = mean_error(rows, lambda r: (r["energy_total"] - rows[0]["energy_total"]) ** 2)
        found[name] = {"error": error, "seconds": point["wall_s_per_simulated_s"] * end}
    keep("simbenchmark", {"found": found}, program)


def measure_study(program, name):
    scene, vary, plots, repeats = STUDIES[name]
    folder = OUTPUT / f"study-{name}"
    words = [word for key in vary for word in ("--vary", key)]
    run(program, "study", ROOT / scene, *words, "--repeats", repeats, "-o", folder, "--overwrite")
    PICTURES.mkdir(parents=True, exist_ok=True)
    for check, _ in plots:
        shutil.copy(folder / f"error_{check}.svg", PICTURES / f"{name}_{check}.svg")
    keep(f"study-{name}", {"study": json.loads((folder / "study.json").read_text())}, program)


def label(data):
    return f'{data["origin"]["machine"]}, 2 cores, commit {data["origin"]["commit"]}'


def verify_section():
    data = kept("verify")
    settings = list(dict.fromkeys(scene["settings"] for scene in data["scenes"] if not scene.get("left_out")))
    lines = ["## 1. Closed forms and hard cases", "",
             f'`scree verify configs/validation --all {" ".join("--vary " + key for key in MATRIX)}`: '
             f'{data["passed"]} checks passed, {data["failed"]} failed ({label(data)}).', "",
             "| settings | passed | failed | CPU seconds |", "|---|---|---|---|"]
    verdicts = lambda scene: [check["verdict"] == "passed" for check in scene["checks"]]
    for setting in settings:
        scenes = [scene for scene in data["scenes"] if scene["settings"] == setting]
        passed = sum(sum(verdicts(scene)) for scene in scenes)
        total = sum(len(scene["checks"]) for scene in scenes)
        lines.append(f'| {setting} | {passed} | {total - passed} | {sum(scene["wall_s"] for scene in scenes):.3g} |')
    lines += ["", "Each scene says what it tests, by which formula, from which source. The share of its tolerance that the worst of its "
              "checks uses up, with the separating axes; over 1 it would fail. In the default mode a check may have a tolerance of "
              "its own (`in_default_mode`).", "",
              "| scene | checks | default | s | accurate | s |", "|---|---|---|---|---|---|"]
    by_scene = {}
    for scene in data["scenes"]:
        if "box_box=sat" in scene["settings"]:
            by_scene.setdefault(scene["scene"], {})["default" if "mode=default" in scene["settings"] else "accurate"] = scene
    for path, modes in by_scene.items():
        cells = []
        for mode in ("default", "accurate"):
            cells += [f'{max(share_of(check) for check in modes[mode]["checks"]):.1g}', f'{modes[mode]["wall_s"]:.2g}']
        short = path.removeprefix("configs/validation/").removesuffix(".yaml")
        lines.append(f'| [{short}](../{path}) | {len(modes["default"]["checks"])} | {" | ".join(cells)} |')
    return lines


def share_of(check):
    """Of the room to the limit, what is used: error over error + margin."""
    if check["margin"] is None or check["error"] is None:
        return math.inf
    room = check["error"] + check["margin"]
    return check["error"] / room if room > 0 else (0.0 if check["margin"] >= 0 else math.inf)


def simbenchmark_section():
    data = kept("simbenchmark")
    lines = ["## 2. SimBenchmark", "",
             f"Its four cases at its step of 1 ms, default mode, by its own metrics ({label(data)}, one thread). Beside them the best of five "
             "engines as published (an i7-7700HQ; RaiSim, Bullet, ODE, MuJoCo, DART): errors compare, times do not quite.", "",
             "| case | metric | scree | CPU s | best published | CPU s |", "|---|---|---|---|---|---|"]
    metrics = {"rolling": "mean square of velocity errors, (m/s)^2 (here: of the worst second)", "bouncing": "mean (E - E0)^2, J^2",
               "666": "mean sum of squared overlaps, m^2 (here: a bound)", "elastic_666": "mean (E - E0)^2, J^2"}
    for name, (engine, error, seconds) in PUBLISHED.items():
        here = data["found"][name]
        lines.append(f'| [{name}](../configs/validation/simbenchmark/{name}.yaml) | {metrics[name]} | {here["error"]:.1e} | '
                     f'{here["seconds"]:.2g} | {engine}, {error:g} | {seconds:g} |')
    return lines


def study_section():
    lines = ["## 3. Speed against error", "",
             "Each plot is one `scree study`: the error of a check over the wall time per simulated second, a curve for each setting, "
             "points from long steps or few sweeps (left) to short or many. The grey stairs are the front, which nothing beats. A heap is chaotic: "
             "its overlap at one instant differs by a factor of several from run to run, and the number of sweeps orders it only roughly."]
    for name, (scene, vary, plots, _) in STUDIES.items():
        data = kept(f"study-{name}")
        study = data["study"]
        for check, words in plots:
            found = study["checks"][check - 1]
            orders = [f'{o["order"]:.1f} ({o["settings"]})' for o in found["orders"] if o["order"] is not None]
            lines += ["", f"### {words}", "",
                      f'`scree study {scene} {" ".join("--vary " + key for key in vary)}` ({label(data)})', "",
                      f"![error over cost](pictures/accuracy/{name}_{check}.svg)", ""]
            if vary[0].startswith("time.step") and orders:
                lines += [f'Fitted order in the step: {", ".join(orders)}.', ""]
            lines += ["| cheapest to | s per simulated s | settings |", "|---|---|---|"]
            for k in found["front"]:
                point = study["points"][k]
                settings = " ".join(f"{key}={value}" for key, value in point["settings"].items())
                error = point["checks"][check - 1]["error"]
                lines.append(f'| {"rounding" if error < 1e-12 else f"{error:.1e}"} | {point["wall_s_per_simulated_s"]:.2g} | {settings} |')
    return lines


TAIL = """## 4. Beside other engines
[The table of bench/peers](../bench/results/epyc-2-cores/peers.md) has nine cases in scree, Bullet and ODE, run here by one judge on one
thread, and rows measured earlier of PhysX, Jolt and Box3D, marked so.

## 5. What each mode conserves
| | default | accurate |
|---|---|---|
| momentum | rounding | rounding |
| angular momentum | rounding, but for what position correction books | the same |
| energy in flight | rounding for spheres and cubes; for other boxes rounding, the path of second order in the step | the same, of fourth order |
| energy of impacts with e = 1 | rounding, every step size | the same |
| dissipation | only through restitution, friction and correction, each booked from its own definition; never a gain (islands that would gain are scaled down and counted) | the same |
| resting contacts | swept to 1e-10 of the impulses, islands that creep solved directly; heaps of over 2,500 points to 3e-3 | natural residual 1e-10, heaps included |
| sliding to a stop | to mu g h^2 / 8 | rounding: the step is cut there |

## 6. Where scree is not good, and why
- **Heavy on light beyond 1e6:1** in the default mode: impulses are solved to 1e-10 of their size, and that much of a heavy body's is a lot
  to a light one. 1e9:1 needs `response: {mode: accurate, tolerance: 1e-15}` ([scene](../configs/validation/accurate/thousand_to_one.yaml)).
- **A heavy ball on a bed of touching small ones** ([scene](../configs/bench/ball_on_bed.yaml), 1e6:1): it sinks in by a fifth of a small
  radius within half a second, and the direct solver gives up on most steps: friction couples so strongly with the normals there that the slips' fixed point does not converge.
- **Falling heaps** are solved to 3e-3 in each substep, not to the end: the heap comes to rest within 0.3 % of the converged height.
- **One body**: a step costs 2 to 7 microseconds, in Bullet 1 to 6 and in ODE 1 to 9, at larger errors.
- **Position correction** of boxes that rock books up to 1e-4 of the energy at 1/240 s.
- **Chaotic scenes** have no error of a trajectory; what can be compared are balances and ensembles, and the latter are not here yet.
"""


def write_page():
    head = ["# Accuracy", "", "<!-- Written by scripts/accuracy.py; run it again rather than edit this page. -->", "",
            "What scree gets right, by how much, and what it costs. Every figure is of the commands named, with commit and machine beside it."]
    sections = [head, verify_section(), simbenchmark_section(), study_section(), TAIL.splitlines()]
    (ROOT / "docs/accuracy.md").write_text("\n\n".join("\n".join(section) for section in sections) + "\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=lambda text: Path(text).resolve())
    parser.add_argument("--only", type=lambda text: text.split(","), help="parts to measure again; `page`: none")
    arguments = parser.parse_args()
    parts = arguments.only or ["verify", "simbenchmark", *STUDIES]
    OUTPUT.mkdir(parents=True, exist_ok=True)
    for part in parts:
        if part == "verify":
            measure_verify(arguments.program)
        elif part == "simbenchmark":
            measure_simbenchmark(arguments.program)
        elif part in STUDIES:
            measure_study(arguments.program, part)
        elif part != "page":
            parser.error(f"--only: no part {part}; parts are verify, simbenchmark, {', '.join(STUDIES)}, page")
    write_page()


if __name__ == "__main__":
    main()
