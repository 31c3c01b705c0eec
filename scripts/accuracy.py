#!/usr/bin/env python3
"""Writes docs/accuracy.md and its plots: the errors of scree in scenes with known results, and their cost.

    accuracy.py PROGRAM [--only verify,simbenchmark,STUDY,...]

PROGRAM is the built scree. Measurements are kept in output/accuracy, so that parts can be measured again with --only.
Measuring everything takes about 40 minutes on 2 cores, on which nothing else should run.
"""
import argparse
import json
import math
import re
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
OUTPUT = ROOT / "output/accuracy"
PICTURES = ROOT / "docs/pictures/accuracy"

MATRIX = ["response.mode=default,accurate", "narrowphase.box_box=sat,ccd_gjk"]

# By the name of a study: its scene, the settings that vary, check and words of each plot, and the number of runs for each time measured.
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

# The studies whose plots also show points of other engines, and the table that has these points.
PEERS_BESIDE = ["pile", "boxpile"]
PEERS_TABLE = "bench/results/epyc-2-cores/peers.md"

# Published results at a step of 1 ms: the engine and setting with the least error, that error, and their CPU time (s) on an i7-7700HQ
# (SimBenchmark, commit 3fd1764, data/*/sample.csv, ERP off).
PUBLISHED = {
    "rolling": ("Bullet, iterated to the end", 3.9e-27, 1.8),
    "bouncing": ("RaiSim", 0.0186, 0.235),
    "666": ("RaiSim", 1.35e-4, 1.51),
    "elastic_666": ("RaiSim", 8.4, 0.66),
}


# By the name of a case: its metric, and the engines that run it, with their settings.
SIMBENCHMARK = {
    "rolling": ("mean of squared velocity errors, (m/s)^2",
                [("scree", "default"), ("bullet", "default"), ("bullet", "no-erp-wide-200"), ("ode", "quick-10"), ("ode", "direct-slip")]),
    "bouncing": ("mean (E - E0)^2, J^2", [("scree", "default"), ("bullet", "default"), ("bullet", "no-erp"), ("ode", "quick-10"), ("ode", "direct")]),
    "666": ("mean sum of squared overlaps, m^2", [("scree", "default"), ("bullet", "default"), ("ode", "quick-10"), ("ode", "direct")]),
    "elastic_666": ("mean (E - E0)^2, J^2", [("scree", "default"), ("bullet", "default"), ("bullet", "tuned-50"), ("ode", "quick-10"), ("ode", "direct")]),
}
NAMES = {"scree": "scree", "bullet": "Bullet", "ode": "ODE"}

# Scenes in which a feature cannot matter, which show its cost; for the grid levels, also what they save: words, scene, settings, key, (off, on).
SMOOTH_PILE = ["materials.gravel.friction=0", "time.end=0.5"]
SWITCHES = [
    ("tangents, in a heap without friction", "configs/bench/pile.yaml", SMOOTH_PILE, "model.friction", ("off", "on")),
    ("tangents, in a heap of boxes without friction", "configs/bench/boxpile.yaml", ["materials.brick.friction=0", "time.end=0.5"], "model.friction", ("off", "on")),
    ("tangents, in a gas", "configs/validation/accurate/elastic_gas.yaml", ["response.mode=default"], "model.friction", ("off", "on")),
    ("rotation, in a gas", "configs/validation/accurate/elastic_gas.yaml", ["response.mode=default"], "model.rotation", ("off", "on")),
    ("rotation, in a heap without friction", "configs/bench/pile.yaml", SMOOTH_PILE, "model.rotation", ("off", "on")),
    ("restitution, in a heap without", "configs/bench/pile.yaml", ["materials.gravel.restitution=0", "time.end=0.5"], "model.restitution", ("off", "on")),
    ("continuous detection, in a stack at rest", "configs/validation/resting/stack_20.yaml", [], "model.continuous", ("off", "on")),
    ("one grid instead of the levels that are chosen, for two decades of sizes", "configs/09_rockslide.yaml", ["time.end=0.04", "checks=[{measure: energy.unexplained, below: 1.0e-9}]"], "broadphase.levels", ("auto", "1")),
    ("several grid levels instead of the one that is chosen, for sizes of +-20 %", "configs/bench/pile.yaml", ["time.end=0.5"], "broadphase.levels", ("auto", "2")),
    ("a box for a floor instead of a plane", "configs/bench/pile.yaml", ["time.end=0.5"], "bodies[0]",
     ("{plane: {normal: [0, 0, 1], offset: 0}, material: gravel}", "{box: {size: [4, 4, 1]}, at: [0, 0, -0.5], fixed: true, material: gravel}")),
]


def run(*command):
    """Runs a command. Exit status 1 means that a check failed, which belongs to the report and is no error here."""
    print("+", *command, file=sys.stderr)
    done = subprocess.run([str(part) for part in command], cwd=ROOT, stdout=subprocess.PIPE, text=True)
    if done.returncode > 1:
        sys.exit(f"status {done.returncode}")
    return done


def origin(program):
    """Returns machine and commit. Each part has its own, because parts may be measured separately."""
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


def measure_granular(program):
    table = OUTPUT / "granular-table.json"
    run(program, "verify", "configs/granular", "--all", "--json", table)
    keep("granular", json.loads(table.read_text()), program)


def measure_simbenchmark(program):
    """Measures scree, Bullet and ODE by SimBenchmark's own metrics, each with its default and with settings that suit the case (bench/peers)."""
    peers = ROOT / "build/peers/bench/peers/scree_bench_peers"
    if not peers.exists():
        sys.exit(f"{peers} is not built: cmake --preset peers && cmake --build --preset peers --target scree_bench_peers")
    rows = []
    for case, (_, settings) in SIMBENCHMARK.items():
        for engine, setting in settings:
            line = json.loads(run(peers, "--case", case, "--engine", engine, "--setting", setting, "--step", "0.001").stdout)
            rows.append({"case": case, "engine": engine, "setting": setting, "error": next(iter(line["errors"].values())),
                         "seconds": line["cpu_s"]})
    keep("simbenchmark", {"rows": rows}, program)


def study(program, name, scene, vary, repeats, settings=()):
    """Runs a study. Returns its folder and the contents of study.json."""
    folder = OUTPUT / f"study-{name}"
    words = [word for option, keys in (("--set", settings), ("--vary", vary)) for key in keys for word in (option, key)]
    run(program, "study", ROOT / scene, *words, "--repeats", repeats, "-o", folder, "--overwrite")
    return folder, json.loads((folder / "study.json").read_text())


def measure_study(program, name):
    scene, vary, plots, repeats = STUDIES[name]
    folder, data = study(program, name, scene, vary, repeats)
    PICTURES.mkdir(parents=True, exist_ok=True)
    for check, _ in plots:
        if name in PEERS_BESIDE:
            draw_beside(folder, f"error_{check}", name)
        shutil.copy(folder / f"error_{check}.svg", PICTURES / f"{name}_{check}.svg")
    keep(f"study-{name}", {"study": data}, program)


def draw_beside(folder, plot, case):
    """Adds other engines' points to a study's plot. They are from the table of bench/peers, whose first error is that of the study."""
    script = (folder / f"{plot}.gp").read_text()
    points, here = [], set()
    for line in open(ROOT / PEERS_TABLE):
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        if line.startswith("## "):
            inside = line.split()[1] == case
        elif line.startswith("| ") and inside and cells[0] not in ("engine", "scree") and cells[-2]:
            engine = cells[0].split()[0]
            if not cells[0].endswith("*"):
                here.add(engine)  # an engine that was also measured earlier (rows with *) is not drawn twice
            elif engine in here:
                continue
            points.append((float(cells[-2]) / 1e3, float(cells[3]), f"{cells[0]}, {cells[1]}, {cells[2]} s"))
    block = "$others << END\n" + "".join(f'{cost} {error} "{words}"\n' for cost, error, words in points) + "END\n"
    script = block + script.replace("set yrange [", f"set yrange [:{10 ** math.ceil(math.log10(max(p[1] for p in points)))}]\n#", 1)
    script = re.sub(r"^plot (.*)$", r"plot $others using 1:2 with points pt 2 ps 1 lw 3 lc rgb '#444444' title 'others', "
                    r"$others using 1:2:3 with labels offset 0,0.8 font ',9' notitle, \1", script, flags=re.M)
    (folder / f"{plot}.gp").write_text(script)
    subprocess.run(["gnuplot", "-e", f"cd '{folder}'", f"{plot}.gp"], check=True)


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
    """Returns the share of the tolerance that the error uses up: error over error + margin."""
    if check["margin"] is None:
        return math.inf
    if check["error"] is None:  # a check with `above` and no expected value
        return 0.0 if check["margin"] >= 0 else math.inf
    room = check["error"] + check["margin"]
    return check["error"] / room if room > 0 else (0.0 if check["margin"] >= 0 else math.inf)


def simbenchmark_section():
    data = kept("simbenchmark")
    lines = ["## 2. SimBenchmark", "",
             f"Its four cases at its step of 1 ms, by its own metrics over every step, judged by one program for all engines (bench/peers; "
             f"{label(data)}, one thread, CPU time of all steps). Published: the best of five engines (RaiSim, Bullet, ODE, MuJoCo, DART) "
             "on an i7-7700HQ: its errors compare, its times do not quite.", "",
             "| case | metric | engine | setting | error | CPU s |", "|---|---|---|---|---|---|"]
    for case, (metric, _) in SIMBENCHMARK.items():
        for row in data["rows"]:
            if row["case"] == case:
                lines.append(f'| [{case}](../configs/validation/simbenchmark/{case}.yaml) | {metric} | {NAMES[row["engine"]]} | {row["setting"]} | '
                             f'{"none" if row["error"] is None else format(row["error"], ".1e")} | {row["seconds"]:.2g} |')
        engine, error, seconds = PUBLISHED[case]
        lines.append(f"| | | published: {engine} | | {error:g} | {seconds:g} |")
    return lines


def ensemble_section():
    """Lists the checks that are judged by a mean over seeds: in both modes, and heaps of thousands of bodies in the default mode only."""
    lines = ["## 4. Ensembles", "",
             "What is random is judged by its mean over several seeds: the whole interval that holds it with the confidence asked for (95 %, Student's t) "
             f"must lie within the tolerance. Heaps of thousands (configs/granular; {label(kept('granular'))}) are not run in the accurate mode: two seeds of the packing were not done after 17 minutes.", "",
             "| scene | check | expected | default | accurate |", "|---|---|---|---|---|"]
    rows = {}
    for scene in kept("verify")["scenes"] + kept("granular")["scenes"]:
        settings = scene.get("settings", "")
        if "box_box=ccd_gjk" in settings:
            continue
        mode = "accurate" if "mode=accurate" in settings else "default"
        for check in scene["checks"]:
            if "half_width" in check:
                rows.setdefault((scene["scene"], check["check"], check["expected"]), {})[mode] = check
    for (scene, check, expected), modes in rows.items():
        cells = [f'{modes[m]["measured"]:.5g} +- {modes[m]["half_width"]:.1g}' if m in modes else "" for m in ("default", "accurate")]
        tolerance = modes["default"].get("tolerance")
        limits = expected if tolerance is None else f"{float(expected):.5g} +- {tolerance:.2g}"
        name = scene.removeprefix("configs/").removeprefix("validation/").removesuffix(".yaml")
        lines.append(f'| [{name}](../{scene}) | {check} | {limits} | {" | ".join(cells)} |')
    return lines


def measure_model(program):
    rows = []
    for words, scene, settings, key, (off, on) in SWITCHES:
        points = study(program, "model", scene, [f"{key}=[{off}, {on}]"], 5, settings)[1]["points"]
        rows.append({"words": words, "scene": scene, "settings": settings, "key": key, "values": [off, on],
                     "seconds": [point["wall_s_per_simulated_s"] for point in points]})
    keep("model", {"rows": rows}, program)


def model_section():
    data = kept("model")
    lines = ["## 5. Only what a scene needs", "",
             "What each feature costs where it cannot matter, and so what leaving it out saves (`scree plan SCENE` says which are on and why; tests/sim/model/model_test.cpp "
             "holds that no bit changes). Wall time for a simulated second, median of five runs "
             f"({label(data)}).", "",
             "| what | `scree study` of | off (s) | on (s) | on / off |", "|---|---|---|---|---|"]
    for row in data["rows"]:
        off, on = row["seconds"]
        sets = "".join(f" --set {setting}" for setting in row["settings"])
        lines.append(f'| {row["words"]} | `{row["scene"]}{sets} --vary {row["key"]}={",".join(row["values"])}` | {off:.3g} | {on:.3g} | {on / off:.2f} |')
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


TAIL = """## 6. Beside other engines
[The table of bench/peers](../bench/results/epyc-2-cores/peers.md) has nine cases in scree, Bullet and ODE, run here by one judge on one
thread (SimBenchmark's four, section 2, are cases of it too), and rows measured earlier of PhysX, Jolt and Box3D, marked so.

## 7. Solvers alone
[The table of bench/solvers](../bench/results/epyc-2-cores/solvers.md) takes the contact problems (W, q, mu) out of eleven scenes and gives each to scree's
solvers and to three of the textbook's, from no impulses at all: time to a natural residual of 1e-4 and 1e-8, with performance profiles (Dolan and More 2002). To
1e-8 the modes of scree and APGD solve 8 of 11, NSGS and Jacobi 6; where both do, scree takes a tenth to a thousandth of the time of NSGS. Nobody solves the
settled piles to 1e-8 from nothing: runs get there by their warm starts.

## 8. What each mode conserves
| | default | accurate |
|---|---|---|
| momentum | rounding | rounding |
| angular momentum | rounding, except for what position correction adds | the same |
| energy in flight | rounding for spheres and cubes; for other boxes rounding, the path of second order in the step | the same, of fourth order |
| energy of impacts with e = 1 | rounding, every step size | the same |
| dissipation | only through restitution, friction and correction, each computed from its own definition; never a gain (islands that would gain are scaled down and counted) | the same |
| resting contacts | swept to 1e-10 of the impulses, islands that creep solved directly; heaps of over 2,500 points to 3e-3, those that flow to 2e-2 | natural residual 1e-10, as far as the direct solver can afford it: heaps of thousands keep more |
| overlaps of a heap that flows | mean under 5e-4 of the size, worst under 2e-2 (tested: `WhatFlowsOverlapsLittle`) | the same |
| bounces where both bodies bear load | the law of each contact, up to a substep too soon | at their times |
| sliding to a stop | to mu g h^2 / 8 | rounding: the step is cut there |

## 9. Where scree is not good, and why
- **Heavy on light beyond 1e6:1** in the default mode: impulses are solved to 1e-10 of their size, and that much of a heavy body's is a lot
  to a light one. 1e9:1 needs `response: {mode: accurate, tolerance: 1e-15}` ([scene](../configs/validation/accurate/thousand_to_one.yaml)).
- **A heavy ball on a bed of touching small ones** ([scene](../configs/bench/ball_on_bed.yaml), 1e6:1): it sinks in by a fifth of a small
  radius within half a second, and the direct solver gives up on most steps: friction couples so strongly with the normals there that the slips' fixed point does not converge.
  (A hundred that do not touch one another [hold it](../configs/validation/scales/ball_on_100_grains.yaml).)
- **Boxes without rebound** (e = 0) are met at the midpoint of the substep in which they land: their arms are off by half a substep's travel, first order.
- **Boxes that bounce among bodies under load**: about once in 1e5 bounces a corner that closes in the wake of another impact is held without rebound
  ([scene](../configs/validation/statistics/gas_of_boxes.yaml)): up to 0.4 % of the energy in 20 s.
- **Rolling** by SimBenchmark's metric is bounded by the correction of the scene's own overlaps at the start: without these it is 4e-24.
- **Falling heaps** are solved to 3e-3 (2e-2 where they flow) in each substep, not to the end: the heap comes to rest within 0.3 % of the converged height.
- **One body**: a step costs 2 to 7 microseconds, in Bullet 1 to 6 and in ODE 1 to 9, at larger errors.
- **Position correction** of boxes that rock adds up to 1e-4 of the energy at 1/240 s.
- **Chaotic scenes** have no error of a trajectory; what can be compared are balances and ensembles.
"""


def write_page():
    head = ["# Accuracy", "", "<!-- Written by scripts/accuracy.py; run it again rather than edit this page. -->", "",
            "What scree gets right, by how much, and what it costs. Every figure is of the commands named, with commit and machine beside it."]
    sections = [head, verify_section(), simbenchmark_section(), study_section(), ensemble_section(), model_section(), TAIL.splitlines()]
    (ROOT / "docs/accuracy.md").write_text("\n\n".join("\n".join(section) for section in sections) + "\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=lambda text: Path(text).resolve())
    parser.add_argument("--only", type=lambda text: text.split(","), help="parts to measure again; `page`: none")
    arguments = parser.parse_args()
    parts = arguments.only or ["verify", "granular", "simbenchmark", "model", *STUDIES]
    OUTPUT.mkdir(parents=True, exist_ok=True)
    for part in parts:
        if part == "verify":
            measure_verify(arguments.program)
        elif part == "granular":
            measure_granular(arguments.program)
        elif part == "simbenchmark":
            measure_simbenchmark(arguments.program)
        elif part == "model":
            measure_model(arguments.program)
        elif part in STUDIES:
            measure_study(arguments.program, part)
        elif part != "page":
            parser.error(f"--only: no part {part}; parts are verify, granular, simbenchmark, model, {', '.join(STUDIES)}, page")
    write_page()


if __name__ == "__main__":
    main()
