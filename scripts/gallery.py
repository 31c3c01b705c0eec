#!/usr/bin/env python3
"""Writes docs/gallery.md and its pictures from the demos, configs/NN_*.yaml, and the folders of their runs.

    gallery.py [OUTPUT]   OUTPUT (default: output) contains the run folders, made by ./run of each scene; the exit
                          status is 1 if a scene has not been run to its end with pictures, which its entry then says
"""
import json
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PICTURES = ROOT / "docs/pictures"
WIDTH = 960  # largest width of a picture (pixels)

# The times at which scenes show best what they are about (s); all others are shown at their end.
MOMENTS = {
    "01_bouncing_ball": 0.8,
    "02_incline": 1.2,
    "06_hopper": 2.6,
    "08_wall": 0.35,
    "10_billiard": 0.4,
    "11_dominoes": 4.0,
    "14_shaker": 5.5,
    "15_terrain": 3.0,
    "17_shapes": 2.0,
}

HEAD = f"""# Gallery

<!-- Written by scripts/gallery.py; run it again rather than edit this page. -->

Each picture is one frame of what `./run configs/NAME.yaml` makes, scaled to {WIDTH} pixels at most. The figures below it are those
of the whole run. Its time includes the pictures that were drawn (`--set render.fps=2` makes fewer), and "simulation" is the time
of the stages without them. The machine may have had other work.
"""


def seconds_words(seconds):
    if seconds < 60:
        return f"{seconds:.2g} s" if seconds < 10 else f"{seconds:.0f} s"
    return f"{seconds / 60:.1f} min" if seconds < 600 else f"{seconds / 60:.0f} min"


def opening_comment(text):
    """Returns the comment at the start of a scene as Markdown. "Look for" and "Expected" begin new paragraphs."""
    lines = re.match(r"(?:#.*\n)*", text)[0].splitlines()
    words = "\n".join(line.removeprefix("#").strip() for line in lines)
    words = re.sub(r"([\\*_<])", r"\\\1", words)
    return re.sub(r"\n(Look for|Expected):", r"\n\n**\1:**", re.sub(r"\n(?!Look for|Expected)", " ", words))


def run_of(folder):
    """Returns the manifest of a run that reached the scene's end and has pictures, or None if there is no such run."""
    try:
        manifest = json.loads((folder / "manifest.json").read_text())
    except FileNotFoundError:
        return None
    whole = manifest["status"] == "done" and manifest["steps"] == manifest["steps_total"]
    return manifest if whole and manifest["frames"] > 0 else None


def draw(name, folder, manifest):
    """Scales the scene's chosen frame into docs/pictures."""
    moment = MOMENTS.get(name, manifest["time"])
    number = round(moment / manifest["time"] * (manifest["frames"] - 1))
    subprocess.run(["ffmpeg", "-v", "error", "-y", "-i", folder / "frames" / f"{number:05}.png", "-vf",
                    f"scale='min({WIDTH},iw)':-2:flags=lanczos", "-pred", "mixed", PICTURES / f"{name}.png"], check=True)


def figures(manifest):
    bodies = manifest["observation"]["bodies"]
    simulation = sum(stage["seconds"] for name, stage in manifest["stages"].items() if not name.startswith("render."))
    passed = sum(check["verdict"] == "passed" for check in manifest["checks"])
    machine, commit = manifest["machine"], manifest["program"]["commit"]
    yield f"{bodies:,} bodies, {manifest['steps']:,} steps for {manifest['time']:g} s"
    yield f"{seconds_words(manifest['wall_s'])} with {manifest['frames']:,} pictures (simulation {seconds_words(simulation)})"
    yield f"{passed} of {len(manifest['checks'])} checks passed"
    yield f"{machine['cpu']}, {machine['cores']} cores, {manifest['space']}"
    yield f"commit {commit[:10]}{'+' * commit.endswith('+')}"


def entry(scene, manifest):
    text = scene.read_text()
    yield f"## {scene.stem.replace('_', ' ')}"
    if manifest:
        yield f"![{scene.stem}](pictures/{scene.stem}.png)"
    yield opening_comment(text)
    yield "; ".join(figures(manifest)) + "." if manifest else f"*Not run yet: `./run configs/{scene.name}`.*"
    yield f"<details><summary>configs/{scene.name}</summary>"
    yield f"```yaml\n{text.rstrip()}\n```"
    yield "</details>"


def main():
    if len(sys.argv) > 2:
        sys.exit(__doc__)
    output = Path(sys.argv[1]) if len(sys.argv) == 2 else ROOT / "output"
    parts, missing = [HEAD], []
    for scene in sorted((ROOT / "configs").glob("[0-9][0-9]_*.yaml")):
        manifest = run_of(output / scene.stem)
        if manifest:
            draw(scene.stem, output / scene.stem, manifest)
        else:
            missing.append(scene.stem)
        parts += entry(scene, manifest)
    (ROOT / "docs/gallery.md").write_text("\n\n".join(part.strip() for part in parts) + "\n")
    for name in missing:
        print(f"{output / name}: no finished run with pictures", file=sys.stderr)
    sys.exit(bool(missing))


main()
