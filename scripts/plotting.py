"""Plots, made with gnuplot, and tables for the generated pages."""
import subprocess
import sys

COLORS = ["#000000", "#e69f00", "#56b4e9", "#009e73", "#cc79a7", "#0072b2", "#d55e00", "#888888"]
STYLE = ("set grid lc rgb '#e8e8e8'\nset border lc rgb '#444444'\nset key outside right noenhanced\nset ytics format '%g'\n"
         "set boxwidth 0.7\nset style fill solid\n")


def plot(folder, name, settings, curves, size="900,520"):
    """Draws curves with gnuplot. A curve is (points, gnuplot's words for them); a point is a list of numbers or words."""
    script, words = STYLE + settings, []
    for k, (points, how) in enumerate(curves):
        script += f"$data{k} << END\n" + "".join(" ".join(quoted(x) for x in point) + "\n" for point in points) + "END\n"
        words.append(f"$data{k} {how}")
    picture = folder / f"{name}.svg"
    script += f"set terminal svg size {size} background 'white' font 'DejaVu Sans,13'\nset output '{picture}'\nplot " + ", ".join(words) + "\n"
    try:
        subprocess.run(["gnuplot"], input=script, text=True, check=True)
    except FileNotFoundError:
        sys.exit("gnuplot is not installed")
    return picture


def quoted(x):
    return f'"{x}"' if isinstance(x, str) else f"{x:.6g}"


def line_of(k, title, dash=1, points=True):
    return f"with {'linespoints' if points else 'lines'} lw 2 dt {dash} pt 7 ps 0.5 lc rgb '{COLORS[k % len(COLORS)]}' title '{title}'"


def table(head, rows):
    line = lambda cells: "| " + " | ".join(str(cell) for cell in cells) + " |"
    return [line(head), "|" + "---|" * len(head), *(line(row) for row in rows), ""]


def count(n):
    return f"{int(float(n)):,}"


def three(x):
    return f"{x:.3g}" if x < 1000 else f"{x:,.0f}"


