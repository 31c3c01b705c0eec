"""The plots and tables of docs/broadphase.md, from the tables that `figures measure` has written."""
import csv
import os
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
from plotting import COLORS, count, line_of, plot, table, three

PAGE = ROOT / "docs/broadphase.md"

STAGES = ["initialize", "sort", "construct", "traverse"]
SPACE_WORDS = {"host": "Host", "cuda": "Device"}


def rows_of(table):
    with open(table, newline="") as lines:
        return list(csv.DictReader(lines))


class Row(dict):
    """Of a table; numbers as numbers."""

    def __getattr__(self, name):
        try:
            return float(self[name])
        except ValueError:
            return self[name]

    @property
    def ns(self):
        return 1e6 * self.median_ms / self.n

    @property
    def times_floor(self):
        return self.median_ms / self.floor_ms

    @property
    def stages(self):
        """Their times (ns per object), and what is in none of them."""
        known = [1e6 * float(self[f"{stage}_ms"]) / self.n for stage in STAGES]
        return known + [max(0.0, self.ns - sum(known))]


class Results:
    def __init__(self, folder):
        self.folder = folder / "broadphase"
        self.tables = {table.stem: [Row(row) for row in rows_of(table)] for table in self.folder.glob("*.csv")}
        if not self.tables:
            sys.exit(f"{self.folder}: no tables; `figures measure` makes them")

    def spaces(self, table):
        return list(dict.fromkeys(row["space"] for row in self.tables.get(table, [])))

    def of(self, table, **fields):
        return [row for row in self.tables.get(table, []) if all(row[key] == str(value) for key, value in fields.items())]

    def values(self, table, field, **fields):
        return list(dict.fromkeys(row[field] for row in self.of(table, **fields)))

    def chosen(self, table, **fields):
        """The row of the number of levels that the grid chooses, and those of the numbers asked for, each once: there are no more levels than octaves."""
        rows = self.of(table, **fields)
        forced = {row.levels: row for row in reversed(rows) if row["levels_asked"] != "0"}
        return next(row for row in rows if row["levels_asked"] == "0"), [forced[k] for k in sorted(forced)]


# Plots

def plot_over_counts(results, name, table, value, label, settings=""):
    """A curve for each set and space."""
    curves = []
    for dash, space in enumerate(results.spaces(table), 1):
        for k, name_of_set in enumerate(results.values(table, "set", space=space)):
            rows = results.of(table, space=space, set=name_of_set)
            curves.append(([(row.n, value(row)) for row in rows], line_of(k, f"{name_of_set}, {SPACE_WORDS[space]}", dash)))
    return plot(results.folder, name, f"set logscale xy\nset format x '10^{{%T}}'\nset xlabel 'objects'\nset ylabel '{label}'\n{settings}", curves)


def plot_stages(results, name, rows, labels, xlabel):
    """Stacked bars: of each stage one with all stages up to it, the longest first."""
    curves = []
    for k in reversed(range(len(STAGES) + 1)):
        points = [(x, sum(row.stages[: k + 1]), label) for x, (row, label) in enumerate(zip(rows, labels))]
        title = [*STAGES, "between calls"][k]
        curves.append((points, f"using 1:2:xtic(3) with boxes lc rgb '{COLORS[1:][k]}' title '{title}'"))
    return plot(results.folder, name, f"set xtics noenhanced rotate by -30\nset xlabel '{xlabel}'\nset ylabel 'ns per object'\nset yrange [0:]\n", curves)


def plot_levels(results, name, table, space, key, title):
    """Time over levels, a curve for each value of the field, and a ring where the grid chooses."""
    curves = []
    for k, value in enumerate(results.values(table, key, space=space)):
        chosen, forced = results.chosen(table, space=space, **{key: value})
        curves.append(([(row.levels, row.ns) for row in forced], line_of(k, title(value))))
        curves.append(([(chosen.levels, chosen.ns)], f"with points pt 6 ps 2 lw 2 lc rgb '{COLORS[k % len(COLORS)]}' notitle"))
    return plot(results.folder, name, "set logscale y\nset xrange [0.7:8.3]\nset xtics 1\nset xlabel 'levels'\nset ylabel 'ns per object'\n", curves)


# The page

def by_space(results, name_of_table, section):
    """A section for each space, under its name and that of its machine."""
    lines = []
    for space in results.spaces(name_of_table):
        row = results.of(name_of_table, space=space)[0]
        commits = {row["commit"][:10] + ("+" if row["commit"].endswith("+") else "") for row in results.of(name_of_table, space=space)}
        lines += [f'**{SPACE_WORDS[space]}**: {row["machine"]}, commit {", ".join(sorted(commits))}, a copy runs at {row.copy_GB_per_s:.0f} GB/s.', "", *section(space)]
    return lines


def stages_block(results, picture):
    def section(space):
        rows = [row for row in results.of("sets", space=space, order="random") if row["set"] != "point"]
        drawn = plot_stages(results, f"stages_{space}", rows, [row["set"] for row in rows], f"data set, {count(rows[0].n)} objects")
        return [picture(drawn), "", *table(["set", *(f"{stage} (ns/object)" for stage in STAGES), "between calls", "sum"],
                                           [[row["set"], *(three(x) for x in row.stages), three(sum(row.stages))] for row in rows])]
    return by_space(results, "sets", section)


def spaces_block(results, picture):
    drawn = plot_over_counts(results, "spaces", "scaling", lambda row: row.median_ms, "ms")
    spaces = results.spaces("scaling")
    if len(spaces) < 2:
        return [picture(drawn), ""]
    times = {(row["space"], row["set"], row["n"]): row.median_ms for row in results.tables["scaling"]}
    rows = [[name, count(n), *(three(times[space, name, n]) for space in spaces), three(times["host", name, n] / times["cuda", name, n])]
            for name in results.values("scaling", "set") for n in results.values("scaling", "n") if all((space, name, n) in times for space in spaces)]
    return [picture(drawn), "", *table(["set", "objects", *(f"{SPACE_WORDS[space]} (ms)" for space in spaces), "Host / Device"], rows)]


def scaling_block(results, picture):
    drawn = plot_over_counts(results, "scaling", "scaling", lambda row: row.ns, "ns per object")
    section = lambda space: table(["set", "objects", "levels", "pairs", "ms", "ns/object", "times the floor"],
                                  [[row["set"], count(row.n), row["levels"], count(row.pairs), three(row.median_ms), three(row.ns), three(row.times_floor)]
                                   for row in results.of("scaling", space=space) if row["n"].startswith("1")])
    return [picture(drawn), "", *by_space(results, "scaling", section)]


def floor_block(results, picture):
    return [picture(plot_over_counts(results, "floor", "scaling", lambda row: row.times_floor, "times the floor")), ""]


def levels_table(results, name_of_table, space, key, head, word):
    rows = []
    for value in results.values(name_of_table, key, space=space):
        chosen, forced = results.chosen(name_of_table, space=space, **{key: value})
        best = min(forced, key=lambda row: row.median_ms)
        rows.append([word(value), best["levels"], three(best.ns), chosen["levels"], three(chosen.ns), f"{chosen.median_ms / best.median_ms:.2f}", three(forced[0].ns)])
    return table([head, "best levels", "ns/object", "chosen levels", "ns/object", "chosen / best", "one level (ns/object)"], rows)


def disparity_block(results, picture):
    def section(space):
        drawn = plot_levels(results, f"disparity_{space}", "disparity", space, "set", lambda value: f'1 : {value.split(":")[1]}')
        n = count(results.of("disparity", space=space)[0].n)
        return [f"{n} objects.", "", picture(drawn), "", *levels_table(results, "disparity", space, "set", "sizes", lambda value: f'1 : {value.split(":")[1]}')]
    return by_space(results, "disparity", section)


def levels_block(results, picture):
    def section(space):
        drawn = plot_levels(results, f"levels_{space}", "levels", space, "n", count)
        return [picture(drawn), "", *levels_table(results, "levels", space, "n", "objects", count)]
    return by_space(results, "levels", section)


def level_stages_block(results, picture):
    def section(space):
        most = max(results.values("levels", "n", space=space), key=int)
        chosen, forced = results.chosen("levels", space=space, n=most)
        return [picture(plot_stages(results, f"level_stages_{space}", forced, [row["levels"] for row in forced], f"levels, set B of {count(most)}; {chosen['levels']} are chosen")), ""]
    return by_space(results, "levels", section)


def methods_block(results, picture):
    lines = []
    for name in results.values("methods", "set"):
        curves = []
        for dash, space in enumerate(results.spaces("methods"), 1):
            for k, method in enumerate(results.values("methods", "method")):
                if rows := results.of("methods", space=space, set=name, method=method):
                    curves.append(([(row.n, row.ns) for row in rows], line_of(k, f"{method}, {SPACE_WORDS[space]}", dash)))
        settings = f"set logscale xy\nset format x '10^{{%T}}'\nset xlabel 'objects of set {name}'\nset ylabel 'ns per object'\n"
        lines += [picture(plot(results.folder, f"methods_{name}", settings, curves, size="900,420")), ""]
    return lines


def sets_block(results, picture):
    def section(space):
        rows = results.of("sets", space=space)
        of_a = {row["order"]: row.ns for row in rows if row["set"] == "A"}
        return table(["set", "objects", "order", "levels", "pairs/object", "tests/object", "ms", "ns/object", "of A's", "times the floor", "B/object"],
                     [[row["set"], count(row.n), row["order"], row["levels"], three(row.pairs / row.n), three(row.tests / row.n), three(row.median_ms),
                       three(row.ns), f"{row.ns / of_a['random']:.2f}", three(row.times_floor), f"{row.bytes_per_object:.0f}"] for row in rows])
    return by_space(results, "sets", section)


BLOCKS = {"stages": stages_block, "spaces": spaces_block, "disparity": disparity_block, "levels": levels_block, "level_stages": level_stages_block,
          "scaling": scaling_block, "floor": floor_block, "methods": methods_block, "sets": sets_block}


def draw(folder, page):
    """The plots of a folder of tables, and the page: docs/broadphase.md with its measured parts anew."""
    results = Results(folder)
    picture = lambda file: f"![{file.stem}]({os.path.relpath(file, page.parent)})"
    text = PAGE.read_text()
    for name, block in BLOCKS.items():
        begin, end = f"<!-- measured: {name} -->", "<!-- end -->"
        if text.count(begin) != 1:
            sys.exit(f"{PAGE}: there must be one line {begin}")
        before, after = text.split(begin)
        text = before + begin + "\n" + "\n".join(block(results, picture)).rstrip("\n") + "\n" + end + after.split(end, 1)[1]
    page.write_text(text)
    print(page)
