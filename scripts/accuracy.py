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
                 [(1, "A box slides to a stop (position, m)")], 5),
    "rolling": ("configs/validation/single_contact/slide_to_roll.yaml",
                ["time.step=0.05,0.025,0.0125,0.00625,0.003125,0.0015625", "response.mode=default,accurate"],
                [(3, "A ball set down without spin slides until it rolls (position after 3 s, m)")], 5),
    "racket": ("configs/validation/free_motion/dzhanibekov.yaml",
               ["time.step=0.04,0.02,0.01,0.005,0.0025,0.00125", "response.mode=default,accurate"],
               [(1, "A box that spins about its intermediate axis, after it has turned over five times (spin, rad/s)")], 5),
    "stack": ("configs/validation/resting/stack_20.yaml",
              ["time.step=0.03333333333333333,0.016666666666666667,0.008333333333333333,0.004166666666666667,0.002",
               "response.mode=default,accurate"],
              [(1, "A stack of twenty cubes for 10 s (drift of the top, m)")], 3),
    "mass_ratio": ("configs/validation/resting/light_under_heavy_1000.yaml",
                   ["time.step=0.03333333333333333,0.016666666666666667,0.008333333333333333,0.004166666666666667",
                    "response.mode=default,accurate"],
                   [(1, "A cube carries another cube of a thousand times its mass (worst overlap, m)")], 5),
    "666": ("configs/validation/simbenchmark/666.yaml",
            ["time.step=0.01,0.005,0.002,0.001", "response.mode=default,accurate"],
            [(1, "SimBenchmark's 666 (worst overlap of the run, m)")], 1),
    "pile": ("configs/bench/pile.yaml",
             ["response.iterations=5,10,20,40", "time.step=0.008333333333333333,0.004166666666666667"],
             [(1, "8,000 settled spheres, by the number of sweeps (mean overlap as a share of the radius)")], 1),
    "boxpile": ("configs/bench/boxpile.yaml",
                ["response.iterations=6,12,25,50", "time.step=0.008333333333333333,0.004166666666666667"],
                [(1, "2,000 settled boxes, by the number of sweeps (mean overlap as a share of half the smallest edge)")], 1),
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
    ("tangential impulses, in a heap without friction", "configs/bench/pile.yaml", SMOOTH_PILE, "model.friction", ("off", "on")),
    ("tangential impulses, in a heap of boxes without friction", "configs/bench/boxpile.yaml", ["materials.brick.friction=0", "time.end=0.5"], "model.friction", ("off", "on")),
    ("tangential impulses, in a gas", "configs/validation/accurate/elastic_gas.yaml", ["response.mode=default"], "model.friction", ("off", "on")),
    ("rotation, in a gas", "configs/validation/accurate/elastic_gas.yaml", ["response.mode=default"], "model.rotation", ("off", "on")),
    ("rotation, in a heap without friction", "configs/bench/pile.yaml", SMOOTH_PILE, "model.rotation", ("off", "on")),
    ("restitution, in a heap with e = 0", "configs/bench/pile.yaml", ["materials.gravel.restitution=0", "time.end=0.5"], "model.restitution", ("off", "on")),
    ("continuous collision detection, in a stack at rest", "configs/validation/resting/stack_20.yaml", [], "model.continuous", ("off", "on")),
    ("one grid level instead of the number that is chosen, for two decades of sizes", "configs/09_rockslide.yaml", ["time.end=0.04", "checks=[{measure: energy.unexplained, below: 1.0e-9}]"], "broadphase.levels", ("auto", "1")),
    ("two grid levels instead of the one that is chosen, for sizes of +-20 %", "configs/bench/pile.yaml", ["time.end=0.5"], "broadphase.levels", ("auto", "2")),
    ("a box instead of a plane as the floor", "configs/bench/pile.yaml", ["time.end=0.5"], "bodies[0]",
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
             "| settings | passed | failed | sum of wall times (s) |", "|---|---|---|---|"]
    verdicts = lambda scene: [check["verdict"] == "passed" for check in scene["checks"]]
    for setting in settings:
        scenes = [scene for scene in data["scenes"] if scene["settings"] == setting]
        passed = sum(sum(verdicts(scene)) for scene in scenes)
        total = sum(len(scene["checks"]) for scene in scenes)
        lines.append(f'| {setting} | {passed} | {total - passed} | {sum(scene["wall_s"] for scene in scenes):.3g} |')
    lines += ["", "The comment at the start of a scene says what the scene tests, by which formula, and from which source. A check uses a share of "
              "its tolerance, and it fails if the share is over 1. The table gives the largest share of the scene's checks in each mode, with "
              "separating axes for pairs of boxes, and the wall time of the run. In the default mode a check may have a tolerance of its own "
              "(`in_default_mode`).", "",
              "| scene | checks | default mode: share | s | accurate mode: share | s |", "|---|---|---|---|---|---|"]
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
             f"SimBenchmark has four cases. They were run at its step of 1 ms, and the errors are those of its own metrics over all steps. One program "
             f"measures all engines in the same way (bench/peers; {label(data)}, one thread). Times are the CPU times of all steps. Rows that say "
             "\"published\" have the best result of five engines (RaiSim, Bullet, ODE, MuJoCo, DART) on an i7-7700HQ. Their errors can be compared with "
             "the others. Their times can be compared only roughly, because they are from another processor.", "",
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
             "Random quantities are checked by their mean over several seeds. The whole confidence interval of the mean (at the level that the check asks for, "
             "95 % here; Student's t) must lie within the tolerance. Heaps of thousands of bodies "
             f"(configs/granular; {label(kept('granular'))}) are not run in the accurate mode, because two seeds of the packing had not finished after 17 minutes.", "",
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
             "The table shows what a feature costs in a scene in which it cannot matter. scree saves this time, because it leaves such features out. `scree plan SCENE` "
             "says which features are on, and why. tests/sim/model/model_test.cpp checks that leaving one out changes no bit. Times are wall times for a simulated second, "
             f"the median of five runs ({label(data)}). In the last three rows, \"off\" and \"on\" stand for the first and the second value in the command.", "",
             "| what | `scree study` of | off (s) | on (s) | on / off |", "|---|---|---|---|---|"]
    for row in data["rows"]:
        off, on = row["seconds"]
        sets = "".join(f" --set {setting}" for setting in row["settings"])
        lines.append(f'| {row["words"]} | `{row["scene"]}{sets} --vary {row["key"]}={",".join(row["values"])}` | {off:.3g} | {on:.3g} | {on / off:.2f} |')
    return lines


def study_section():
    lines = ["## 3. Speed against error", "",
             "Each plot is made by one `scree study`. It shows the error of a check over the wall time per simulated second, with a curve for each setting. "
             "Points on the left have long steps or few sweeps, and points on the right have short steps or many. The grey line is the Pareto front: no other "
             "setting is both faster and as exact. The table below each plot lists the settings on the front. There \"rounding\" means an error under 1e-12. A heap is chaotic: its overlap at "
             "one instant differs by a factor of several from run to run, and it falls with the number of sweeps only roughly. The plots of settled spheres and boxes also show other engines (bench/peers)."]
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
            lines += ["| error | s per simulated s | settings |", "|---|---|---|"]
            for k in found["front"]:
                point = study["points"][k]
                settings = " ".join(f"{key}={value}" for key, value in point["settings"].items())
                error = point["checks"][check - 1]["error"]
                lines.append(f'| {"rounding" if error < 1e-12 else f"{error:.1e}"} | {point["wall_s_per_simulated_s"]:.2g} | {settings} |')
    return lines


TAIL = """## 6. Beside other engines
[The table of bench/peers](../bench/results/epyc-2-cores/peers.md) has nine cases in scree, Bullet and ODE. They were run on one thread, and one program
measured all of them. The four cases of SimBenchmark (section 2) are in the table too. It also has earlier measurements of PhysX, Jolt and Box3D, which
are marked.

## 7. Solvers alone
[The table of bench/solvers](../bench/results/epyc-2-cores/solvers.md) takes contact problems (W, q, mu) from eleven scenes. It gives each to scree's
solvers and to three textbook solvers: nonsmooth Gauss-Seidel (NSGS), accelerated projected gradient descent (APGD) and Jacobi. All of them start from
zero impulses. The table has the times to a natural residual of 1e-4 and of 1e-8, with performance profiles (Dolan and More 2002). To 1e-8, the modes of
scree and APGD solve 8 of 11 problems, and NSGS and Jacobi solve 6. Where both scree and NSGS do, scree takes a tenth to a thousandth of the time of NSGS.
From zero impulses no solver solves the settled piles to 1e-8. Runs get there through warm starts.

## 8. What each mode conserves
The table says how exactly each mode conserves a quantity. *Rounding* means that nothing but rounding errors is left.

| | default | accurate |
|---|---|---|
| momentum | rounding | rounding |
| angular momentum | rounding, except for what position correction adds | the same |
| energy in flight | rounding. For boxes other than cubes, the rotation has an error of second order in the step | rounding. That error is of fourth order |
| energy of impacts with e = 1 | rounding, for every size of the step | the same |
| dissipation | Energy is lost only through restitution, friction and position correction, and each loss is computed from its own definition. There is never a gain: islands that would gain are scaled down and counted | the same |
| resting contacts | Contacts are swept until a sweep changes the impulses by less than a share of 1e-10, and islands that creep are solved directly. Heaps of over 2,500 points are swept to 3e-3, and those that flow to 3e-3 to 2e-2, by their overlaps | The natural residual is 1e-10, as far as the direct solver can afford it. Heaps of thousands of bodies keep a larger one |
| overlaps of a heap that flows | The mean is under 5e-4 of the size and the worst under 2e-2 (tested by `WhatFlowsOverlapsLittle`), as far as four substeps are enough. The number of substeps follows the second deepest overlap of four measurements, so a single state may overlap more. A small bed was stirred hard in one substep for 480 steps, and sixteen of them left more than 5e-2 ([0062](decisions/0062-momentum-in-the-correction.md)). `response.quality` divides both limits, and a single measurement may be up to twice as deep (`QualityDividesWhatFlowsOverlaps`) | the same |
| bounces where both bodies bear load | They follow the law of each contact, but may come up to a substep too soon | They come at their own times |
| sliding to a stop | The stopping distance is exact to mu g h^2 / 8, where h is the length of a substep | rounding, because the substep is cut at the instant of the stop |

## 9. Where scree is not good, and why
- **Heavy on light bodies beyond 1e6:1**, in the default mode. Impulses are solved to 1e-10 of their size, and this share of a heavy body's impulse is
  large for a light body. A ratio of 1e9:1 needs `response: {mode: accurate, tolerance: 1e-15}`
  ([scene](../configs/validation/accurate/thousand_to_one.yaml)).
- **A heavy ball on a bed of small balls that touch** ([scene](../configs/bench/ball_on_bed.yaml), 1e6:1). The heavy ball sinks in by a fifth of a small
  radius within half a second. The direct solver gives up on most steps: friction couples so strongly with the normal impulses there that the fixed-point
  iteration for the slips does not converge. A hundred small balls that do not touch one another
  [hold it](../configs/validation/scales/ball_on_100_grains.yaml).
- **Boxes without rebound** (e = 0). Their contacts are found at the midpoint of the substep in which they land. So the lever arms are off by half a
  substep's travel, which is an error of first order.
- **Boxes that bounce among bodies under load**. About once in 1e5 bounces, a corner that closes just after another impact is held without rebound
  ([scene](../configs/validation/statistics/gas_of_boxes.yaml)). This costs up to 0.4 % of the energy in 20 s.
- **Rolling**, by SimBenchmark's metric. The error comes from the correction of overlaps that the scene has at the start. Without these overlaps it is
  4e-24.
- **Falling heaps**. They are solved to 3e-3 (up to 2e-2 where they flow) in each substep, not to convergence. The heap comes to rest within 0.3 % of the
  converged height.
- **Single bodies**. A step costs 2 to 7 microseconds. In Bullet it costs 1 to 6, and in ODE 1 to 9, at larger errors.
- **Position correction** of boxes that rock. It adds up to 1e-4 of the energy at 1/240 s.
- **Chaotic scenes**. There is no exact trajectory to compare with. Balances and ensembles can be compared instead.
"""


def write_page():
    head = ["# Accuracy", "", "<!-- Written by scripts/accuracy.py; run it again rather than edit this page. -->", "",
            "This page shows how exact scree's results are, and what they cost. Each figure comes with the command that gave it, its commit and its machine."]
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
