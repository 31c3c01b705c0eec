"""A run with one fault: how it is started, what must hold for the files that it leaves, and how it is resumed."""
import csv
import json
import os
import subprocess
import sys

from runs import SCENE, command, contents, differing

SMALL = {"time.end": 0.6, "checks": "[]", "render.size": "[64, 36]", "render.fps": 50, "record.checkpoint_every": 0.003, "bodies[1].until": 0.2,
         "bodies[2].from": 0.1, "forces[0].from": 0.2, "forces[0].until": 0.4, "bodies[3].repeat.count": "[3, 3, 2]", "bodies[4].repeat.count": "[3, 3, 1]"}


class Wrong(Exception):
    """Something is not as it should be."""


class Skipped(Exception):
    """The fault cannot be caused here."""


def expect(condition, words):
    if not condition:
        raise Wrong(words)


class Finished:
    def __init__(self, status, out, error):
        self.status, self.out, self.error = status, out, error


class Case:
    """One fault, with its runs in a folder of their own and the results that are reported."""

    def __init__(self, harness, name, scratch):
        self.harness, self.scratch, self.folder = harness, scratch, scratch / "RUN"
        self.scene, self.expected = None, harness.whole
        self.name, self.happened, self.status, self.left, self.resumed = name, "", "", "", ""

    def start(self, *more, fault={}, environment={}, settings={}, **options):
        variables = {**os.environ, **environment}
        if fault:
            # Every path in the run's folder contains the name of that folder, but not always its full path.
            variables.update({"LD_PRELOAD": str(self.harness.libraries / "fault_shim.so"), "FAULT_NOTE": str(self.note), "FAULT_PATH": "RUN/"})
            variables.update({key: str(value) for key, value in fault.items()})
        sets = [word for key, value in {**SMALL, **settings}.items() for word in ("--set", f"{key}={value}")]
        options = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, **options}
        words = command(self.harness.scree, self.folder, *more, scene=self.scene) if self.scene else command(self.harness.scree, self.folder, *sets, *more)
        return subprocess.Popen(words, env=variables, **options)

    def run(self, *more, **options):
        self.note.unlink(missing_ok=True)
        process = self.start(*more, **options)
        try:
            out, error = (text.decode() if text else "" for text in process.communicate(timeout=60))
        except subprocess.TimeoutExpired:
            process.kill()
            raise Wrong("the run hangs") from None
        return Finished(process.returncode, out, error)

    @property
    def note(self):
        return self.scratch / "note"

    def caused(self):
        return len(self.note.read_bytes()) if self.note.exists() else 0

    def manifest(self):
        return json.loads((self.folder / "manifest.json").read_text())

    def ends(self, finished, status, *words):
        """Checks the exit status of a run, and the words of its messages."""
        said = finished.error.replace(str(self.folder), "RUN").replace(str(SCENE), SCENE.name)
        said = "; ".join(line.removeprefix("scree: ") for line in said.splitlines() if line)
        self.happened, self.status = self.happened or said, self.status or str(finished.status)
        expect(finished.status == status, f"exit status {finished.status}, not {status}: {finished.out}{finished.error}")
        for word in words:
            expect(word in said, f"not said: {word}; but: {said}")
        self.left = self.left or self.found()

    def failed(self):
        manifest = self.manifest()
        expect(manifest["status"] == "failed" and manifest["error"], "the manifest does not say that the run failed")

    def found(self):
        """Describes in words what is on the disk. Every file with its final name must be complete."""
        if not self.folder.exists():
            return "nothing"
        words = []
        steps = [read_checkpoint(file) for file in sorted(self.folder.glob("checkpoint/*.h5"))]
        for name in ("metrics.csv", "metrics.csv.part"):
            if (self.folder / name).exists():
                text = (self.folder / name).read_text()
                expect(text.endswith("\n"), f"{name} ends with half a row")
                rows = list(csv.reader(text.splitlines()))
                expect(len({len(row) for row in rows}) == 1, f"{name} has rows of different lengths")
                words.append(f"{len(rows) - 1} rows")
        frames = list(self.folder.glob("frames/*.png"))
        for frame in frames:
            expect(frame.read_bytes().endswith(b"IEND\xaeB`\x82"), f"{frame.name} is half")
        words += [f"{len(frames)} frames"] if frames else []
        words += [f"checkpoint of step {steps[-1]}"] if steps else []
        if (self.folder / "trajectory.vtkhdf").exists():
            expect((self.folder / "trajectory.vtkhdf").read_bytes().splitlines()[-1].startswith(b"scree trajectory 1,"), "the trajectory is half")
            words.append("trajectory")
        if (self.folder / "movie.mp4").exists():
            expect(b"moov" in (self.folder / "movie.mp4").read_bytes(), "the movie is half")
            words.append("movie")
        if (self.folder / "manifest.json").exists():
            words.append(f"manifest ({self.manifest()['status']})")
        return ", ".join(words) or "nothing but " + " ".join(sorted(path.name for path in self.folder.iterdir()))

    def resume(self, *more, from_checkpoint=True, **options):
        """Resumes the run without the fault. It must reach its end, and leave what a run without a fault leaves."""
        finished = self.run("--resume", *more, **options)
        expect(finished.status == 0, f"resumed, it ended with {finished.status}: {finished.out}{finished.error}")
        self.resumed = "from the beginning"
        if "resumed at" in finished.out:
            self.resumed = f"went on from step {self.manifest()['resumed_at'][-1]}"
        expect(not from_checkpoint or "went on" in self.resumed, "resumed from the beginning")
        self.is_undisturbed()
        self.resumed += ", same bytes"

    def nothing_to_resume(self, **options):
        before = self.bytes()
        finished = self.run("--resume", **options)
        expect(finished.status == 0 and "nothing to resume" in finished.out, f"resumed: {finished.status} {finished.out}{finished.error}")
        expect(self.bytes() == before, "--resume of a finished run has written something")
        self.resumed = "said that it is done"

    def bytes(self):
        return {str(path): path.read_bytes() for path in self.folder.rglob("*") if path.is_file()}

    def is_undisturbed(self, but=()):
        """Checks that the contents are those of a run without a fault, except for those named in `but`."""
        different = [name for name in differing(self.expected, contents(self.folder)[0]) if name not in but and not name.startswith(tuple(but))]
        expect(not different, f"DIFFERENT: {', '.join(different)}")

    def warned(self, words):
        expect(any(words in warning for warning in self.manifest()["warnings"]), f"no warning of the manifest says {words}: {self.manifest()['warnings']}")


def read_checkpoint(file):
    expect(file.read_bytes().startswith(b"scree checkpoint") and file.stat().st_size > 2048, f"{file.name} is half")
    return int(file.stem)


class Harness:
    def __init__(self, arguments, scratch):
        self.scree, self.libraries = arguments.scree.resolve(), arguments.libraries.resolve()
        info = subprocess.run([self.scree, "info"], capture_output=True, text=True, check=True).stdout
        self.gpu = next(line.removeprefix("cuda").strip() for line in info.splitlines() if line.startswith("cuda"))
        self.whole = {}
        self.whole = self.undisturbed(scratch / "whole")
        self.without_pictures = self.undisturbed(scratch / "without_pictures", "--no-render")

    def undisturbed(self, scratch, *more):
        scratch.mkdir()
        case = Case(self, "undisturbed", scratch)
        finished = case.run(*more)
        if finished.status != 0 or finished.error:
            sys.exit(f"the undisturbed run ended with {finished.status}: {finished.out}{finished.error}")
        return contents(case.folder)[0]
