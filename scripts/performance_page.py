"""Writes docs/performance.md and its plots from the results of `performance.py measure` (bench/results/MACHINE/step/PART.jsonl)."""
import json
import math
import os
from pathlib import Path

from plotting import COLORS, count, line_of, plot, table, three

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs/performance.md"
PICTURES = ROOT / "docs/pictures/performance"
PEERS = ROOT / "bench/results/epyc-2-cores/peers.md"
HEAP_BODIES = {"pile": 8000, "boxpile": 2000}
STAGES = ["integration", "broadphase", "slots", "narrowphase", "impacts", "response", "correction"]

HEAD = """# Performance

<!-- Written by scripts/performance.py; run it again rather than edit this page. -->

This page says how fast whole steps are, and how large their errors are, since a speed counts only beside its error. A step is all of motion,
candidate pairs, contacts, impacts, impulses, position correction and energy ledger. All bodies are awake, and nothing is damped, put to sleep
or cut off. Times are medians of 100 steps, or of fewer where a run had no time for them, after the scene has settled for as long as its table
says. Overlaps are of the true shapes at the end of a step, relative to the size of the smaller body. The mean is over all pairs that overlap.
Each table names the program that measured it (`scripts/performance.py`), the commit and the hardware. The files that it links to have each run
with its own command line.
"""


class Row(dict):
    """The settings of a run and its results, which replace settings of the same name. Its keys are attributes."""

    __getattr__ = dict.__getitem__

    @property
    def machine(self):
        return self.hardware.split(" beside ")[0] if self.space == "cuda" else self.hardware

    @property
    def curve(self):
        return f"{self.machine}, {self.precision}"


def rows_of(*parts):
    """Returns (runs, [failed runs and why]) of all machines. If a run was repeated, the last one that succeeded counts."""
    done, failed = {}, {}
    for part in parts:
        for file in sorted((ROOT / "bench/results").glob(f"*/step/{part}.jsonl")):
            for line in map(json.loads, file.read_text().splitlines()):
                key = (file.parent.parent.name, line["space"], line["name"])
                if "result" in line:
                    line |= line.pop("result")
                    done[key] = Row(line | line["varied"], file=file)
                else:
                    failed[key] = f'{key[0]}, {key[2]}, {key[1]}: {line["failed"]}'
    rows = sorted(done.values(), key=lambda row: (row.space != "cuda", row.machine, row.precision != "mixed"))
    return rows, [words for key, words in failed.items() if key not in done]


def caption(rows):
    """Returns the lines that name machine, commit and commands of the measurements."""
    lines = {}
    for row in rows:
        folder = row.file.parent.relative_to(ROOT)
        command = f"scripts/performance.py measure BUILD {folder} {row.asked}"
        link = os.path.relpath(row.file, PAGE.parent)
        lines.setdefault((row.hardware, f"[`{command}`]({link})"), set()).add(row.commit[:10] + ("+" if row.commit.endswith("+") else ""))
    by_origin = {}
    for (hardware, command), commits in lines.items():
        by_origin.setdefault((hardware, ", ".join(sorted(commits))), []).append(command)
    words = [f'{hardware}, commit {commits}: {"; ".join(commands)}' for (hardware, commits), commands in by_origin.items()]
    return ["Measured on " + ".\n\nMeasured on ".join(words) + ".", ""]


def left_out(failed):
    return [f"Did not run: {'; '.join(failed)}.", ""] if failed else []


def curves_of(rows, x, y, key=lambda row: row.curve):
    """Returns a line of the plot for each value of `key`, through the rows in their order."""
    names = list(dict.fromkeys(map(key, rows)))
    return [([(x(row), y(row)) for row in rows if key(row) == name], line_of(k, name)) for k, name in enumerate(names)]


def picture(name, settings, curves):
    PICTURES.mkdir(parents=True, exist_ok=True)
    return [f"![{name}]({os.path.relpath(plot(PICTURES, name, settings, curves), PAGE.parent)})", ""]


def over_bodies(name, rows, y, label, scale="xy"):
    settings = f"set logscale {scale}\nset format x '10^{{%T}}'\nset xlabel 'bodies'\nset ylabel '{label}'\nset yrange [{'*' if 'y' in scale else 0}:]\n"
    return picture(name, settings, curves_of(rows, lambda row: row.bodies, y))


def small(x):
    return f"{x:.1e}"


SPEED = {
    "bodies": lambda row: count(row.bodies),
    "contacts": lambda row: count(row.contacts),
    "ms/step": lambda row: three(row.median_ms),
    "steps/s": lambda row: three(row.steps_per_s),
    "body-steps/s": lambda row: small(row.body_steps_per_s),
    "substeps": lambda row: three(row.substeps),
    "sweeps": lambda row: three(row.sweeps),
}
ERROR = {
    "mean overlap": lambda row: small(row.penetration_relative_mean),
    "worst": lambda row: small(row.penetration_relative_max),
    "median speed (mm/s)": lambda row: three(1e3 * row.speed_median),
    "unexplained energy": lambda row: small(row.unexplained),
}
MEMORY = {"bytes/body at the peak": lambda row: three(row.memory_peak_bytes / row.bodies)}
SCENE = {"scene": lambda row: f"[{row.scene}](../configs/bench/{row.scene}.yaml)"}
WHERE = {"hardware": lambda row: row.machine, "precision": lambda row: row.precision}
SETTLED = {"settled for (s)": lambda row: f"{row.time * row.settling_steps / (row.settling_steps + row.steps):.2g}", "steps": lambda row: f"{row.steps:.0f}"}


def table_of(rows, columns):
    return table(list(columns), [[cell(row) for cell in columns.values()] for row in rows])


def scaling_rows():
    rows, failed = rows_of("spheres", "spheres-double", "spheres-largest")
    return sorted(rows, key=lambda row: (row.space != "cuda", row.machine, row.precision != "mixed", row.bodies)), failed


def scaling(number):
    rows, failed = scaling_rows()
    if not rows:
        return []
    lines = [f"## {number}. Speed against the number of bodies", "",
             "The scene is a heap of spheres in a box, with radii that differ by up to 20 % from their mean, friction 0.5 and steps of 1/240 s "
             "([scene](../configs/bench/settled_spheres.yaml)). Up to a million spheres, the heap is as deep as it is wide; a million are 100 layers. "
             "Larger heaps are as deep, and wider. Some heaps are not quite at rest when they are timed. The column of the median speed shows it.", ""]
    lines += over_bodies("steps", rows, lambda row: row.steps_per_s, "steps/s")
    lines += over_bodies("body_steps", rows, lambda row: row.body_steps_per_s, "body-steps/s")
    lines += table_of(rows, WHERE | SPEED | ERROR | SETTLED) + left_out(failed) + caption(rows)
    wide, failed = rows_of("wide")
    if not wide:
        return lines
    in_order = sorted(wide, key=lambda row: (row.precision != "mixed", row.bodies))
    return lines + ["The next table is of heaps that have 20 layers, whatever the number of spheres.", "", *table_of(in_order, WHERE | SPEED | ERROR | MEMORY | SETTLED)] + left_out(failed) + caption(wide)


def stages_of(row):
    """Returns the shares of the stages in a step, and the share that is in none of them."""
    seen = row.by_calls if row.space == "cuda" else row
    total = row.by_calls["mean_ms"] if row.space == "cuda" else row.mean_ms
    shares = [seen["stages_ms"].get(stage, 0) / total for stage in STAGES]
    return shares + [max(0.0, 1 - sum(shares))]


def stages(number):
    rows, _ = scaling_rows()
    if not rows:
        return []
    lines = [f"## {number}. Where the time goes", "",
             "The pictures show the shares of the stages ([method](method.md)) in the runs of section 1, which has their commands and commits. On Device the shares are of ten further "
             "steps, in which the program waits for each parallel call. Otherwise a call may overlap with the next ones.", ""]
    for k, name in enumerate(dict.fromkeys(row.curve for row in rows)):
        of_curve = [row for row in rows if row.curve == name]
        bars = []
        for s in reversed(range(len(STAGES) + 1)):
            points = [(x, 100 * sum(stages_of(row)[: s + 1]), count(row.bodies)) for x, row in enumerate(of_curve)]
            bars.append((points, f"using 1:2:xtic(3) with boxes lc rgb '{COLORS[s]}' title '{[*STAGES, 'the rest'][s]}'"))
        lines += picture(f"stages_{k}", f"set title '{name}'\nset xlabel 'bodies'\nset ylabel '% of a step'\nset yrange [0:100]\n", bars)
        row = min(of_curve, key=lambda row: abs(math.log(row.bodies / 1e6)))
        calls = sorted(row.by_calls["calls_ms"].items(), key=lambda call: -call[1])[:8]
        lines += [f"These are the longest calls in a step of {count(row.bodies)} bodies ({name}), measured with a wait after each call.", "",
                  *table(["call", "ms/step", "%"], [[f"`{call}`", three(ms), f"{100 * ms / row.by_calls['mean_ms']:.0f}"] for call, ms in calls])]
    return lines


def memory(number):
    rows = [row for row in scaling_rows()[0] if row.bodies >= 5000]  # with fewer bodies the program itself takes most of the memory
    if not rows:
        return []
    lines = [f"## {number}. Memory", "",
             "On Device, the memory is what the bodies, their contacts and all buffers have in use. On Host, it is the resident memory of the process, "
             "with the program (30 MB) and the scene. The runs, with their commands and commits, are those of section 1. The peak is that of a whole run "
             "up to the end of the steps that are timed.", ""]
    lines += over_bodies("memory", rows, lambda row: row.memory_peak_bytes / row.bodies, "bytes per body at the peak", "x")
    columns = WHERE | {"bodies": SPEED["bodies"], "bytes/body": lambda row: three(row.memory_bytes / row.bodies),
                       "at the peak": lambda row: three(row.memory_peak_bytes / row.bodies), "peak (GB)": lambda row: three(row.memory_peak_bytes / 1e9)}
    return lines + table_of(rows, columns)


def other_scenes(number):
    rows, failed = rows_of("boxes", "decades", "drum")
    if not rows:
        return []
    rows.sort(key=lambda row: (row.scene, row.space != "cuda", row.machine, row.precision != "mixed", row.bodies))
    return [f"## {number}. Other scenes", "",
            "These scenes are boxes at rest, balls whose radii range over two decades, and a drum with a ball that thousands of others touch. The file of each scene "
            "describes it, and says how to change the number of its bodies.", "", *table_of(rows, SCENE | WHERE | SPEED | ERROR | SETTLED), *left_out(failed), *caption(rows)]


MACROSCOPIC = {"centre (m)": lambda row: f"{row.centre_z:.5f}", "rms speed (m/s)": lambda row: three(row.speed_rms)}


def in_motion(number):
    rows, failed = rows_of("motion", "motion-large")
    if not rows:
        return []
    rows.sort(key=lambda row: (row.scene, row.space != "cuda", row.machine, row.bodies))
    return [f"## {number}. In motion", "",
            "In these scenes most bodies move. The height of the centre of mass and the rms speed would change first if steps were too coarse.", "",
            *table_of(rows, SCENE | WHERE | SPEED | {"impacts/step": lambda row: three(row.impacts)} | ERROR | MACROSCOPIC | SETTLED), *left_out(failed), *caption(rows)]


def motion_against_error(number):
    rows, failed = rows_of("motion-error")
    if not rows:
        return []
    lines = [f"## {number}. In motion: speed against error", "",
             "Here scenes in motion run with different values of `response.quality`, from the start of the scene on. The number of substeps follows this key, and so do the errors at which sweeps and position correction end.", ""]
    for scene in dict.fromkeys(row.scene for row in rows):
        of_scene = sorted((row for row in rows if row.scene == scene), key=lambda row: (row.machine, row.quality))
        lines += picture(f"motion_{scene}", "set logscale xy\nset xlabel 'ms/step'\nset ylabel 'mean overlap (of the size)'\nset format y '10^{%T}'\n",
                         curves_of(of_scene, lambda row: row.median_ms, lambda row: row.penetration_relative_mean, lambda row: row.curve))
        lines += table_of(of_scene, SCENE | WHERE | {"quality": lambda row: f"{row.quality:g}", "substeps": SPEED["substeps"],
                                                     "sweeps": SPEED["sweeps"], "ms/step": SPEED["ms/step"]} | ERROR | MACROSCOPIC | SETTLED)
    return lines + left_out(failed) + caption(rows)


def crossings(rows):
    """Returns lines that say from how many bodies on a GPU is faster than Host on the same machine."""
    lines = []
    for gpu in dict.fromkeys((row.file, row.machine) for row in rows if row.space == "cuda"):
        for precision in ("double", "mixed"):
            ms = {(row.space, row.bodies): row.median_ms for row in rows if row.file == gpu[0] and row.precision == precision}
            both = sorted(n for space, n in ms if space == "host" and ("cuda", n) in ms)
            faster = []
            for n in reversed(both):
                if ms["cuda", n] >= ms["host", n]:
                    break
                faster = [n, *faster]
            if both:
                lines.append(f"- {gpu[1]}, {precision}: " + (f"faster than its host from {count(faster[0])} bodies on, of those measured." if faster else
                                                             f"slower than its host up to {count(both[-1])} bodies, the most that were measured."))
    return lines + [""] if lines else []


def crossover(number):
    rows, failed = rows_of("crossover")
    if not rows:
        return []
    rows.sort(key=lambda row: (row.bodies, row.space, row.precision))
    lines = [f"## {number}. Host against Device", "",
             "The processor and the GPU of one machine simulate spheres at rest, as in section 1. Both take the same step ([decision 0046](decisions/0046-one-step.md)), but the "
             "figures were measured before that decision, when Host in double precision took another one. Scenes with fewer than 2,500 contact points are solved until they converge, which takes more sweeps "
             "([decision 0005](decisions/0005-sweeps-by-contacts.md)).", ""]
    lines += over_bodies("crossover", rows, lambda row: row.median_ms, "ms/step") + crossings(rows)
    return lines + table_of(rows, WHERE | SPEED | ERROR) + left_out(failed) + caption(rows)


def speed_against_error(number):
    rows, failed = rows_of("error")
    if not rows:
        return []
    lines = [f"## {number}. Speed against error", "",
             "Spheres at rest, as in section 1, run in every combination of 1, 2 and 4 substeps (`time.substeps`) with 3, 6, 12 and 24 sweeps "
             "(`response.iterations`), in both precisions. `response.tolerance` is too small to be reached. So sweeps end at their largest number, or in mixed "
             "precision where floats no longer change. Each line in the pictures is of one number of substeps, and the number of sweeps grows along it.", ""]
    rows.sort(key=lambda row: (row.space != "cuda", row.machine, row.precision != "mixed", row.substeps, row.iterations))
    key = lambda row: f"{row.curve}, {row.substeps} to a step"
    words = {"overlap": (lambda row: row.penetration_relative_mean, "mean overlap (of the radius)"),
             "speed": (lambda row: 1e3 * row.speed_median, "median speed (mm/s)")}
    for name, (error, label) in words.items():
        lines += picture(f"error_{name}", f"set logscale xy\nset xlabel 'ms/step'\nset ylabel '{label}'\nset format y '10^{{%T}}'\n",
                         curves_of(rows, lambda row: row.median_ms, error, key))
    best = [row for row in rows if not any(other.median_ms < row.median_ms and other.penetration_relative_mean <= row.penetration_relative_mean and
                                           other.machine == row.machine for other in rows)]
    best.sort(key=lambda row: (row.machine, row.median_ms))
    return [*lines, "The table has the settings that no other one beats in both time and mean overlap.", "",
            *table_of(best, WHERE | {"bodies": SPEED["bodies"], "substeps": SPEED["substeps"], "sweeps asked": lambda row: row.iterations,
                                        "sweeps of a step": SPEED["sweeps"], "ms/step": SPEED["ms/step"]} | ERROR),
            *left_out(failed), *caption(rows)]


def peers_of(case):
    """Returns the rows of a case in the table of bench/peers as dictionaries with the column heads as keys."""
    rows, inside, head = [], False, None
    for line in PEERS.read_text().splitlines():
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        if line.startswith("## "):
            inside, head = line == f"## {case}", None
        elif inside and line.startswith("| ") and head is None:
            head = cells
        elif inside and line.startswith("| "):
            rows.append(dict(zip(head, cells)))
    return [row for row in rows if row["engine"] != "scree" and row["us/step"] and row["penetration mean (r)"]]


def peers(number):
    rows, failed = rows_of("heaps")
    if not rows:
        return []
    machine = PEERS.read_text().split(": ")[1].split(",")[0]
    lines = [f"## {number}. Beside other engines", "",
             "The two heaps are those of [the table of bench/peers](../bench/results/epyc-2-cores/peers.md): 8,000 spheres at rest, and 2,000 boxes that still topple. "
             "The other engines run on one thread of the machine of that table. Rows with * were measured earlier, on another machine. scree runs on all cores or on the GPU, "
             "and is timed after 2.5 s. That table has scree on one thread.", ""]
    for case, bodies in HEAP_BODIES.items():
        here = [row for row in rows if row.scene == case]
        others = peers_of(case)
        measured_here = {row["engine"] for row in others if not row["engine"].endswith("*")}
        points = [(float(row["us/step"]) / 1e3, float(row["penetration mean (r)"]), f'{row["engine"]}, {row["setting"]}, {row["step (s)"]}') for row in others
                  if row["engine"] in measured_here or row["engine"].split()[0] not in measured_here]
        labelled = "using 1:2:3 with labels offset 0,0.8 font ',9' notitle"
        lines += picture(f"peers_{case}", "set logscale xy\nset format y '10^{%T}'\nset offsets graph 0.2, graph 0.2, graph 0.1, graph 0.1\n"
                         "set xlabel 'ms/step'\nset ylabel 'mean overlap (of the size)'\n",
                         [(points, "using 1:2 with points pt 2 ps 1 lw 2 lc rgb '#444444' title 'others, one thread'"), (points, labelled),
                          *curves_of(here, lambda row: row.median_ms, lambda row: row.penetration_relative_mean)])
        cells = [[row.machine, f"scree, {row.precision}", "1/240", three(row.median_ms), small(row.body_steps_per_s), small(row.penetration_relative_mean),
                  small(row.penetration_relative_max)] for row in here]
        cells += [["another, one thread" if row["engine"].endswith("*") else f"{machine}, one thread", f'{row["engine"]}, {row["setting"]}', row["step (s)"], three(float(row["us/step"]) / 1e3), small(bodies / float(row["us/step"]) * 1e6),
                   small(float(row["penetration mean (r)"])), small(float(row["penetration max (r)"]))] for row in others]
        lines += table([f"{case}: hardware", "engine, setting", "step (s)", "ms/step", "body-steps/s", "mean overlap", "worst"], cells)
    return lines + left_out(failed) + caption(rows)


def write():
    """Writes the page. Sections without results are left out."""
    text = HEAD
    number = 1
    for section in (scaling, stages, memory, other_scenes, in_motion, motion_against_error, crossover, speed_against_error, peers):
        if lines := section(number):
            text += "\n" + "\n".join(lines).rstrip("\n") + "\n"
            number += 1
    PAGE.write_text(text)
    print(PAGE)
