"""Commands that run everything.yaml, and the contents that two such runs must have in common."""
import json
from pathlib import Path

SCENE = Path(__file__).resolve().parent / "everything.yaml"


def command(scree, folder, *more, scene=SCENE):
    return [str(scree), "run", str(scene), "-o", str(folder), *more]


def contents(folder):
    """Returns the contents of a run that must be the same to the byte, by name, and its manifest."""
    manifest = json.loads((folder / "manifest.json").read_text())
    found = {f"manifest: {key}": json.dumps(manifest[key]) for key in ("status", "state_hash", "states", "steps", "checks", "observation", "counters", "frames")}
    for file in [folder / "metrics.csv", folder / "final.csv", folder / "scene.yaml", folder / "trajectory.vtkhdf", *sorted(folder.glob("frames/*"))]:
        found[str(file.relative_to(folder))] = file.read_bytes()
    found["files"] = sorted(str(path.relative_to(folder)) for path in folder.rglob("*"))
    return found, manifest


def differing(expected, found):
    """Returns the names of the contents that differ."""
    return sorted(name for name in expected.keys() | found.keys() if expected.get(name) != found.get(name))
