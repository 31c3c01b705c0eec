#!/usr/bin/env python3
"""Gives every broken scene to scree run, and checks the limits for bad input: exit status 2, a message that names a
place, no file written, less than a second (of processor time, so that a busy machine has no influence), and less than
50 MB more than the program takes for a file that does not exist (those are its libraries, as far as the system has
them in memory: between 83 MB and 105 MB were measured for one program on one machine).

    broken_scenes.py PROGRAM [FOLDER]   prints a markdown table; exit status 1 if any scene breaks a limit

FOLDER (default: tests/data/bad) contains scenes that begin with a comment on what is wrong; scenes that are too large
or too odd to keep there are made here.
"""
import os
import random
import subprocess
import sys
import tempfile
import time
from pathlib import Path

MOST_SECONDS = 1.0
MOST_MEGABYTES = 50.0
HEAD = "format: 1\ntime: {end: 1, step: 0.01}\nmaterials: {glass: {density: 2500}}\n"


def generated(folder):
    """Writes scenes that are broken on a large scale. Yields (file, what is wrong)."""
    def scene(name, text):
        file = folder / f"{name}.yaml"
        file.write_bytes(text if isinstance(text, bytes) else text.encode())
        return file

    ball = "{sphere: {radius: 0.1}, material: glass, "
    yield scene("repeat_1e9", HEAD + f"bodies: [{ball}repeat: {{count: [1000, 1000, 1000], spacing: [1, 1, 1]}}}}]\n"), \
        "1e9 repeated bodies"
    yield scene("scatter_1e9", HEAD + f"bodies: [{ball}scatter: {{count: 1000000000, from: [0, 0, 0], to: [1, 1, 1]}}}}]\n"), \
        "1e9 scattered bodies"
    names = "".join(f"  m{i}: {{}}\n" for i in range(20000))
    yield scene("materials_20000", HEAD.splitlines()[0] + "\ntime: {end: 1, step: 0.01}\nmaterials:\n" + names +
                f"bodies: [{ball}}}]\n"), "20,000 materials, so 4e8 pairs of them"
    yield scene("regions_20000", HEAD + "regions:\n" + names + f"bodies: [{ball}}}]\n"), "20,000 regions"
    yield scene("deep_100000", "a: " + "[" * 100000), "100,000 levels deep"
    yield scene("keys_deep", "".join(" " * i + "a:\n" for i in range(500))), "500 maps within each other"
    bomb = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n" + "".join(
        f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 10)}]\n" for i in range(1, 12))
    yield scene("alias_bomb_1e12", bomb), "1e12 nodes of aliases"
    yield scene("wrong_20000", HEAD + "bodies:\n" + f"  - {ball.replace('0.1', '-1')}at: [0, 0, 0]}}\n" * 20000), \
        "20,000 bodies, each wrong"
    yield scene("long_word", HEAD + "bodies: [{" + "x" * 1000000 + ": 1}]\n"), "a key of 1e6 letters"
    yield scene("noise", random.Random(1).randbytes(1000000)), "1 MB of noise"
    yield scene("blank", " " * 1000000), "1 MB of blanks"
    for name, content, wrong in [
            ("csv_noise", random.Random(2).randbytes(1000000), "a body file of noise"),
            ("csv_long_line", b"shape,x,y,z\n" + b"1" * 10000000, "a body file of one long line"),
            ("csv_bad_last_row", b"shape,radius,x,y,z\n" + b"sphere,1,0,0,0\n" * 100000 + b"sphere,1,0,0\n",
             "a body file whose row 100,001 is short")]:
        (folder / f"{name}.csv").write_bytes(content)
        yield scene(name, HEAD + f"bodies: [{{file: {name}.csv, material: glass}}]\n"), wrong
    yield scene("csv_endless", HEAD + "bodies: [{file: /dev/zero, material: glass}]\n"), "a body file without end"
    yield scene("mesh_endless", HEAD + "bodies: [{mesh: {file: /dev/zero}, fixed: true, material: glass}]\n"), "a mesh without end"
    (folder / "csv_hull_endless.csv").write_text("shape,x,y,z,hull\npolyhedron,0,0,0,/dev/zero\n")
    yield scene("csv_hull_endless", HEAD + "bodies: [{file: csv_hull_endless.csv, material: glass}]\n"), "a hull without end in a body file"
    yield folder, "a folder instead of a scene"
    yield folder / "absent.yaml", "no such file"


def kept(folder):
    for file in sorted(folder.glob("*.yaml")):
        wrong = file.read_bytes().splitlines()[0].decode(errors="replace")
        yield file, wrong.removeprefix("# Wrong: ").rstrip(".")


def measure(program, file):
    """Runs the scene in an empty folder. Returns exit status, message, wall time and processor time (s), memory at its
    peak (MB) and the names of the files written."""
    with tempfile.TemporaryDirectory() as folder, tempfile.TemporaryFile() as errors:
        start = time.monotonic()
        process = subprocess.Popen([program, "run", file], cwd=folder, stdout=subprocess.DEVNULL, stderr=errors)
        _, status, usage = os.wait4(process.pid, 0)
        wall = time.monotonic() - start
        process.returncode = os.waitstatus_to_exitcode(status)
        errors.seek(0)
        message = errors.read().decode(errors="replace")
        return process.returncode, message, wall, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024, \
            os.listdir(folder)


def faults_of(status, message, seconds, more_megabytes, written):
    if status != 2:
        yield f"exit status {status}"
    if not message.strip():
        yield "no message"
    if written:
        yield f"wrote {', '.join(written)}"
    if seconds > MOST_SECONDS:
        yield f"over {MOST_SECONDS:g} s"
    if more_megabytes > MOST_MEGABYTES:
        yield f"over {MOST_MEGABYTES:g} MB more than for an absent file"


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    program = Path(sys.argv[1]).resolve()
    folder = Path(sys.argv[2]) if len(sys.argv) == 3 else Path(__file__).resolve().parents[1] / "tests/data/bad"
    broken = 0
    print("| scene | what is wrong | wall s | CPU s | MB | message |\n|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as made:
        usual = max(measure(program, Path(made) / "absent.yaml")[4] for _ in range(3))
        for file, wrong in [*kept(folder.resolve()), *generated(Path(made))]:
            status, message, wall, seconds, megabytes, written = measure(program, file)
            faults = list(faults_of(status, message, seconds, megabytes - usual, written))
            broken += bool(faults)
            words = (message.strip().splitlines() or [""])[0]
            for place in (file.parent, file.parent.parent):
                words = words.replace(f"{place}/", "")
            words = words[:160].replace("|", "\\|")
            words += "".join(f" **{fault}**" for fault in faults)
            print(f"| {file.stem} | {wrong} | {wall:.2f} | {seconds:.2f} | {megabytes:.0f} | {words} |")
    print(f"\n{broken} broke a limit")
    sys.exit(broken > 0)


main()
