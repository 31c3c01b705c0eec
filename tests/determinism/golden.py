#!/usr/bin/env python3
"""Runs the golden scene again, and compares the hashes of its states with those kept in tests/determinism/SPACE.

    golden.py SCREE host|cuda [--write]

The exit status is 1 if a state differs, and 77 if the machine has no such space. --write instead replaces the kept states by those of this build. That is to be
done, and mentioned in the commit, if a change is meant to change bits.
"""
import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
SCENE = HERE.parent / "faults/everything.yaml"
SETTINGS = ["time.end=2.4", "checks=[]", "render=false"]
SKIPPED = 77
KEPT = ["machine", "space", "precision", "program", "scene", "states", "steps", "state_hash"]


def write(scree, space):
    kept = HERE / space
    kept.mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        command = [scree, "run", str(SCENE.relative_to(Path.cwd())), "--device", space, "-o", folder, "--overwrite"]
        subprocess.run(command + [word for setting in SETTINGS for word in ("--set", setting)], check=True)
        manifest = json.loads((Path(folder) / "manifest.json").read_text())
        (kept / "manifest.json").write_text(json.dumps({key: manifest[key] for key in KEPT}, indent=2) + "\n")
        (kept / "scene.yaml").write_text((Path(folder) / "scene.yaml").read_text())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scree")
    parser.add_argument("space", choices=["host", "cuda"])
    parser.add_argument("--write", action="store_true")
    arguments = parser.parse_args()
    if arguments.write:
        write(arguments.scree, arguments.space)
        return 0
    run = subprocess.run([arguments.scree, "run", "--reproduce", str(HERE / arguments.space / "manifest.json")], stderr=subprocess.PIPE, text=True)
    print(run.stderr, file=sys.stderr)
    return SKIPPED if run.returncode == 2 and "there is no GPU to run on" in run.stderr else run.returncode


if __name__ == "__main__":
    sys.exit(main())
