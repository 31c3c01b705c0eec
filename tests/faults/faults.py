#!/usr/bin/env python3
"""Makes a small run fail in every way that can be caused, and resumes it once the fault is gone.

    faults.py SCREE --libraries DIR [--table] [NAME...]

DIR contains fault_shim.so, which makes single calls fail, and old_driver.so; small disks are mounted if the system allows it. Each fault must have happened, the
run must end as promised and say why, no file with its final name may be incomplete, and the resumed run must be the same to the byte as an undisturbed one.
Faults that cannot be caused on this machine are reported as skipped. Prints a line for each fault (--table: as Markdown); the exit status is 1 if a case is not
as it should be. With NAME, only the cases whose name contains it are tried.
"""
import argparse
import errno
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from judged_run import Case, Finished, Harness, Skipped, Wrong, expect
from runs import SCENE, contents

cases = []


def case(*arguments):
    """Makes a function one case or several; the arguments are tuples of the name of a case and of its own arguments."""

    def add(function):
        for name, *more in arguments:
            cases.append((name, lambda case, function=function, more=more: function(case, *more)))
        return function

    return add


# Faults of the disk.


def no_room(path, after, number=errno.ENOSPC, call="write", times=0):
    return {"FAULT": call, "FAULT_PATH": path, "FAULT_AFTER": after, "FAULT_ERRNO": number, "FAULT_TIMES": times}


FULL, BROKEN, FORBIDDEN = "No space left on device", "Input/output error", "Permission denied"


@case(
    ("disk full for metrics.csv, in the middle of a row", no_room("/metrics.csv", 10000), FULL),
    ("disk full for one row alone", no_room("/metrics.csv", 10000, times=1), FULL),
    ("disk full for timing.csv", no_room("/timing.csv", 4000), FULL),
    ("disk full for checkpoints", no_room("/checkpoint/", 150000), FULL),
    ("disk full for one checkpoint alone", no_room("/checkpoint/", 150000, times=1), FULL),
    ("checkpoints cannot be brought to the disk", no_room("/checkpoint/", 3, errno.EIO, "fsync"), BROKEN),
    ("metrics.csv cannot be brought to the disk", no_room("/metrics.csv", 3, errno.EIO, "fsync"), BROKEN),
    ("disk full for a frame", no_room("/frames/", 12, call="flush"), FULL),
    ("a frame cannot be brought to the disk", no_room("/frames/", 12, errno.EIO, "fsync"), BROKEN),
    ("a frame cannot be renamed", no_room("/frames/", 12, errno.ENOSPC, "rename"), FULL),
    ("checkpoints cannot be renamed", no_room("/checkpoint/", 3, errno.EACCES, "rename"), FORBIDDEN),
    ("metrics.csv cannot get its name", no_room("/metrics.csv", 0, errno.EACCES, "rename"), FORBIDDEN),
    ("disk full for the trajectory's journal", no_room("/trajectory.journal", 30000), FULL),
    ("the journal cannot be brought to the disk", no_room("/trajectory.journal", 3, errno.EIO, "fsync"), BROKEN),
    ("disk full for the trajectory", no_room("/trajectory.vtkhdf", 30000), FULL),
    ("the trajectory cannot be renamed", no_room("/trajectory.vtkhdf", 0, errno.EACCES, "rename"), FORBIDDEN),
    ("disk full for final.csv", no_room("/final.csv", 1000), FULL),
    ("disk full for the manifest", no_room("/manifest.json", 1000), FULL),
)
def cannot_write(case, fault, words):
    case.ends(case.run(fault=fault), 3, fault["FAULT_PATH"], words)
    expect(case.caused() > 0, "the fault did not happen")
    if fault["FAULT_PATH"] != "/manifest.json":
        case.failed()
    if "alone" in case.name and fault["FAULT_PATH"] == "/checkpoint/":
        expect(f"checkpoint of step {case.manifest()['steps']}," in case.left, f"the last step is not saved: {case.left}")
    case.resume()


@case(("disk full for log.txt", no_room("/log.txt", 0, errno.ENOSPC, "write"), FULL))
def cannot_log(case, fault, words):
    case.ends(case.run(fault=fault), 0, "the log is not complete", words)
    case.warned("the log is not complete")
    case.is_undisturbed(but=("files",))
    case.nothing_to_resume()


@case(("disk full for the report", no_room("/report.html", 1000), FULL))
def cannot_report(case, fault, words):
    case.ends(case.run(fault=fault), 0, "no report", words)
    case.is_undisturbed(but=("files",))
    case.nothing_to_resume()
    again = subprocess.run([case.harness.scree, "report", str(case.folder)], capture_output=True, text=True)
    expect(again.returncode == 0 and (case.folder / "report.html").exists(), f"scree report: {again.returncode} {again.stderr}")


def mount(case, *arguments):
    place = case.scratch / "disk"
    place.mkdir(exist_ok=True)
    done = subprocess.run(["mount", *arguments, str(place)], capture_output=True, text=True)
    if done.returncode != 0:
        raise Skipped(f"no mount here: {done.stderr.strip()}")
    case.folder = place / "RUN"
    return place


def ext4(case):
    image = case.scratch / "image"
    image.write_bytes(bytes(4 << 20))
    made = subprocess.run(["mkfs.ext4", "-q", "-m", "0", str(image)], capture_output=True, text=True)
    if made.returncode != 0:
        raise Skipped(f"no mkfs.ext4 here: {made.stderr.strip()}")
    return mount(case, "-o", "loop", str(image))


def tmpfs(case):
    return mount(case, "-t", "tmpfs", "-o", "size=4m", "none")


def fill(place, free):
    """Fills the disk until only `free` bytes are left."""
    disk = os.statvfs(place)
    (place / "other").write_bytes(bytes(disk.f_bavail * disk.f_frsize - free))


@case(("a full disk (tmpfs)", tmpfs), ("a full disk (ext4 on a loop device)", ext4))
def full_disk(case, make):
    place = make(case)
    # There is room for three checkpoints of 64 kB, the number that exists while one is written, and for less than half of the rows and frames.
    fill(place, 260000)
    case.ends(case.run(), 3, "cannot", FULL)
    (place / "other").unlink()
    case.resume()


@case(("a disk that is full from the start (tmpfs)",))
def disk_without_room(case):
    place = tmpfs(case)
    fill(place, 0)
    case.ends(case.run(), 3, "cannot write", FULL)
    (place / "other").unlink()
    case.resume(from_checkpoint=False)


@case(("a read-only folder",))
def read_only(case):
    place = tmpfs(case)
    case.run("--until", "0.3")
    before = case.bytes()
    mount(case, "-o", "remount,ro")
    for more in ("--overwrite", "--resume"):
        case.ends(case.run(more), 2, "cannot create RUN/.lock: Read-only file system; give another folder with -o")
    case.folder = place / "new" / "RUN"
    case.ends(case.run(), 2, "cannot make the run folder RUN: Read-only file system; give another one with -o")
    expect(not (place / "new").exists(), "something was written")
    mount(case, "-o", "remount,rw")
    expect(case.bytes() == before, "something was written")
    case.resume()


@case(("a folder that another run holds",))
def held(case):
    other = case.start(stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    rows = case.folder / "metrics.csv.part"
    while not rows.exists() or rows.read_bytes().count(b"\n") < 2:  # the header and one row
        expect(other.poll() is None, "the other run came to nothing")
        time.sleep(0.001)
    other.send_signal(signal.SIGSTOP)
    for more in ("--overwrite", "--resume"):
        case.ends(case.run(more), 2, "another run is writing here")
    other.send_signal(signal.SIGCONT)
    expect(other.wait(60) == 0, "the other run failed")
    case.is_undisturbed()
    case.left = "the other run came to its end, same bytes"
    case.nothing_to_resume()


# Faults of pictures and movies.


def no_room_for_movie(after):
    """Returns the maker of a script that replaces ffmpeg, which runs ffmpeg itself on a disk that gets full."""

    def script(case):
        variables = {"LD_PRELOAD": case.harness.libraries / "fault_shim.so", **no_room("/movie.mp4", after)}
        return " ".join(f"{name}={value}" for name, value in variables.items()) + f' exec {shutil.which("ffmpeg")} "$@"'

    return script


@case(
    ("ffmpeg is missing", None, "not installed"),
    ("ffmpeg fails half way", lambda case: "echo no codec >&2; exit 1", "ffmpeg failed: no codec"),
    ("ffmpeg is killed half way", lambda case: "kill -KILL $$", "ffmpeg was ended by signal 9"),
    ("ffmpeg is no program", lambda case: "", "ffmpeg does not start"),
    ("disk full for the movie's first bytes", no_room_for_movie(after=0), FULL),
    ("disk full for the movie's index", no_room_for_movie(after=1000), FULL),
)
def no_movie(case, script, words):
    programs = case.scratch / "bin"
    programs.mkdir()
    if script is not None:
        lines = script(case)
        (programs / "ffmpeg").write_text(f'#!/bin/sh\nfor last; do :; done\necho half > "$last"\n{lines}\n' if lines else "")
        (programs / "ffmpeg").chmod(0o755 if lines else 0o644)
    case.ends(case.run(environment={"PATH": str(programs)}), 0, "no movie, but the frames are in", words)
    case.warned(words)
    case.is_undisturbed(but=("files",))
    expect(not list(case.folder.glob("movie*")), "half a movie is left")
    case.nothing_to_resume()


@case(("OSMesa gives no context", "osmesa_create", "OSMesa gives no"), ("OSMesa's context cannot be used", "osmesa_current", "OSMesa cannot make"))
def no_pictures(case, fault, words):
    case.ends(case.run(fault={"FAULT": fault}), 0, "no pictures from t = 0 s on", words)
    expect(case.caused() > 0, "the fault did not happen")
    case.warned(words)
    case.is_undisturbed(but=("files", "frames", "manifest: frames"))
    expect(not list(case.folder.glob("frames/*")) and not list(case.folder.glob("movie*")), "pictures are left")
    case.nothing_to_resume()


# Faults of memory.


@case(("more bodies than memory",))
def too_large(case):
    counts = {"bodies[3].repeat.count": "[1000, 1000, 1000]"}
    case.ends(case.run(settings=counts), 2, "GiB")
    expect(not case.folder.exists(), "something was written")
    planned = subprocess.run([case.harness.scree, "plan", str(SCENE), "--set", "bodies[3].repeat.count=[1000, 1000, 1000]"], capture_output=True, text=True)
    expect(planned.returncode == 2 and "GiB" in planned.stderr, f"plan: {planned.returncode} {planned.stderr}")
    case.resume(from_checkpoint=False)


def shortage(fault, size=0, times=0, after=12000):
    """Returns a shortage of memory that begins after `after` bytes of metrics.csv. A separate thread writes that file, so that on a busy machine most steps have
    been taken by then."""
    return {"FAULT": fault, "FAULT_PATH": "/metrics.csv", "FAULT_AFTER": after, "FAULT_TIMES": times, "FAULT_SIZE": size}


@case(
    ("memory runs out: no more arrays, in the middle of a step", shortage("arrays")),
    ("memory runs out: for one array alone, in the middle of a step", shortage("arrays", 2500, times=1, after=3000)),
    ("memory runs out: nothing of 32 kB and more", shortage("memory", 32768)),
    ("memory runs out: no more address space", shortage("limit")),
)
def out_of_memory(case, fault):
    case.expected = case.harness.without_pictures
    # With this threshold, blocks of 32 kB and more come from the system and go back to it.
    case.ends(case.run("--no-render", fault=fault, environment={"MALLOC_MMAP_THRESHOLD_": "32768"}), 3, "out of memory", "--resume", "scree plan")
    expect(case.caused() > 0, "the fault did not happen")
    if fault["FAULT"] != "arrays":
        # If no array can be allocated at all, the state of the run cannot be written to the manifest either.
        case.failed()
    case.resume("--no-render")


@case(("any allocation of 32 kB fails, and all after it", 32768, 0), ("any allocation of 8 kB fails, alone", 8192, 1))
def out_of_memory_anywhere(case, size, times):
    case.expected = case.harness.without_pictures
    case.folder.mkdir(exist_ok=True)  # so that the run reads what is in the folder, which takes memory, too
    statuses = {}
    # If memory runs out at the start, right after it was seen that there is some, HDF5 crashes; only a test can bring that about.
    first = 8 if times == 0 else 0
    for after in (*range(first, 20), *range(20, 600, 14)):
        fault = {"FAULT": "allocation", "FAULT_SIZE": size, "FAULT_AFTER": after, "FAULT_TIMES": times}
        finished = case.run("--no-render", "--overwrite", fault=fault, environment={"MALLOC_MMAP_THRESHOLD_": "32768"})
        statuses[finished.status] = statuses.get(finished.status, 0) + 1
        expect(finished.status in (0, 3), f"allocation {after}: exit status {finished.status}: {finished.error}")
        says_why = "out of memory" in finished.error or os.strerror(errno.ENOMEM) in finished.error
        expect(says_why == (finished.status == 3), f"allocation {after}: {finished.status} {finished.error}")
    expect(statuses.get(3, 0) > 10, f"few faults happened: {statuses}")
    case.happened = f"{statuses[3]} of {sum(statuses.values())} runs ended with: out of memory"
    case.status, case.left = "3", case.found()
    case.resume("--no-render", from_checkpoint=False)


@case(("memory runs out while pictures are drawn", shortage("memory", 4096)))
def out_of_memory_for_pictures(case, fault):
    finished = case.run(fault=fault)
    # Mesa and libpng react to a lack of memory in their own ways, and some of them end the process.
    expect(finished.status in (3, -signal.SIGABRT, -signal.SIGSEGV), f"exit status {finished.status}")
    expect(case.caused() > 0, "the fault did not happen")
    case.ends(finished, finished.status)
    case.resume()


# Faults of the GPU.


@case(("--device cuda where there is no GPU",))
def no_gpu(case):
    if "GiB" in case.harness.gpu:
        raise Skipped("there is one: " + case.harness.gpu)
    case.ends(case.run("--device", "cuda"), 2, "--device cuda: there is no GPU to run on", case.harness.gpu.removeprefix("none: ").replace("not in this build", "built without CUDA"))
    expect(not case.folder.exists(), "something was written")
    case.resume("--device", "auto", from_checkpoint=False)


@case(("a driver that is too old for the GPU",))
def old_driver(case):
    if "not in this build" in case.harness.gpu:
        raise Skipped("this build has no use for a GPU")
    (case.scratch / "libcuda.so.1").symlink_to(case.harness.libraries / "old_driver.so")
    old = {"LD_LIBRARY_PATH": str(case.scratch)}
    case.ends(case.run("--device", "cuda", environment=old), 2, "--device cuda", "driver", "12.0")
    expect(not case.folder.exists(), "something was written")
    finished = case.run(environment=old)
    expect(finished.status == 0, f"on Host: {finished.status} {finished.error}")
    expect("12.0" in case.manifest()["machine"]["gpu"], "the manifest does not say that there was no GPU")
    case.is_undisturbed()
    case.resumed = "without --device cuda: on Host, same bytes; the manifest says why"


HEAP = """format: 1
name: heap
gravity: [0, 0, -9.81]
time: {end: 1, step: 0.002}
materials: {stone: {density: 1000, friction: 0.5}}
bodies:
  - {plane: {normal: [0, 0, 1]}, material: stone}
  - {sphere: {radius: 0.05}, at: [0, 0, 0.1], repeat: {count: [100, 100, 40], spacing: [0.16, 0.16, 0.16], jitter: 0.02}, material: stone}
render: false
record: {metrics_every: 0.01, checkpoint_every: 0.3}
"""


@case(("device memory runs out, since another program takes it",))
def out_of_device_memory(case):
    if "GiB" not in case.harness.gpu:
        raise Skipped("there is no GPU")
    case.scene = case.scratch / "heap.yaml"
    case.scene.write_text(HEAP)
    folder, case.folder = case.folder, case.scratch / "whole"
    expect(case.run("--device", "cuda").status == 0, "the undisturbed run failed")
    case.expected, case.folder = contents(case.folder)[0], folder
    run = case.start("--device", "cuda")
    # Memory is taken before the balls meet and have contacts, which need memory.
    while not list(case.folder.glob("checkpoint/*.h5")):
        expect(run.poll() is None, "it has come to its end")
        time.sleep(0.001)
    run.send_signal(signal.SIGSTOP)
    other = subprocess.Popen([sys.executable, str(Path(__file__).parent / "take_device_memory.py")], stdout=subprocess.PIPE, text=True)
    case.happened = other.stdout.readline().strip() + "; "
    run.send_signal(signal.SIGCONT)
    out, error = run.communicate(timeout=100)
    other.kill()
    other.wait()
    case.happened += error.decode().strip().removeprefix("scree: ")
    case.ends(Finished(run.returncode, out.decode(), error.decode()), 3, "out of memory", "--resume")
    case.failed()
    case.resume("--device", "cuda")


# Faults of clocks.


@case(("the time of day jumps to and fro by hours", {"FAULT": "realtime", "FAULT_SIZE": 10000}, 0))
@case(("the steady clock jumps ahead by an hour", {"FAULT": "monotonic", "FAULT_SIZE": 3600, "FAULT_AFTER": 2000}, 1))
def jump(case, fault, checkpoints):
    finished = case.run(fault=fault, settings={"record.checkpoint_every": 1000})
    case.ends(finished, 0)
    taken = case.manifest()["stages"].get("checkpoint", {}).get("calls", 0)
    expect(case.caused() > 0 or fault["FAULT"] == "realtime", "the fault did not happen")
    expect(taken == checkpoints, f"{taken} checkpoints, not {checkpoints}")
    case.is_undisturbed(but=("scene.yaml",))
    case.happened = f"read {case.caused()} times since; checkpoints, one in 1000 s: {taken}; same bytes"
    case.nothing_to_resume(settings={"record.checkpoint_every": 1000})


# Faults of the standard streams.


def closed_pipe():
    """Returns the writing end of a pipe whose reading end is closed."""
    reading, writing = os.pipe()
    os.close(reading)
    return writing


@case(
    ("standard output on a full disk", ("stdout",), "/dev/full", "nothing more can be written to standard output"),
    ("standard output is a closed pipe", ("stdout",), "pipe", "nothing more can be written to standard output (Broken pipe)"),
    ("all that is said goes to a closed pipe", ("stdout", "stderr"), "pipe", "nothing more can be written to standard output (Broken pipe)"),
)
def unheard(case, streams, kind, words):
    end = os.open("/dev/full", os.O_WRONLY) if kind == "/dev/full" else closed_pipe()
    case.ends(case.run(**{name: end for name in streams}), 0)
    os.close(end)
    case.is_undisturbed()
    expect(words in (case.folder / "log.txt").read_text(), "log.txt does not say it")
    case.warned(words)
    case.happened = case.happened or f"log.txt: warning: {words}"
    case.nothing_to_resume()


@case(("the three standard streams are closed, and there is a warning",))
def closed_streams(case):
    # With closed streams, files of the run may get the descriptors 0 to 2. Messages must not be written into those files.
    case.ends(case.run(fault={"FAULT": "osmesa_create"}, preexec_fn=lambda: os.closerange(0, 3)), 0)
    expect(case.caused() > 0, "the fault did not happen")
    case.is_undisturbed(but=("files", "frames", "manifest: frames"))
    log = (case.folder / "log.txt").read_text()
    expect(log.count("no pictures") == 1 and "scree: " not in log and (case.folder / ".lock").stat().st_size == 0, f"words went to a file: {log}")
    case.happened = "log.txt: warning: no pictures"
    case.nothing_to_resume()


@case(("`scree plan` onto a full disk",))
def unheard_result(case):
    with open("/dev/full", "w") as full:
        planned = subprocess.run([case.harness.scree, "plan", str(SCENE)], stdout=full, stderr=subprocess.PIPE, text=True)
    case.ends(Finished(planned.returncode, "", planned.stderr), 3, "cannot write to standard output", FULL)
    case.left = case.resumed = "-"


def try_case(harness, name, act):
    """Tries a case. Returns the case, its verdict, and what is wrong or why it was skipped."""
    with tempfile.TemporaryDirectory() as scratch:
        case = Case(harness, name, Path(scratch))
        try:
            act(case)
            return case, "ok", ""
        except (Wrong, OSError, LookupError, ValueError) as wrong:
            return case, "WRONG", f"{'' if isinstance(wrong, Wrong) else type(wrong).__name__ + ': '}{wrong}"
        except Skipped as skipped:
            return case, "skipped", str(skipped)
        finally:
            if (case.scratch / "disk").is_mount():
                subprocess.run(["umount", str(case.scratch / "disk")], check=True)


def alone():
    """Restarts this program in a mount namespace of its own, if the system allows it. Mounts then exist only for this process and end with it, and a user other
    than root may mount a tmpfs."""
    mine = ["unshare", "--mount", *([] if os.geteuid() == 0 else ["--user", "--map-root-user"])]
    if os.environ.get("FAULTS_ALONE") or subprocess.run([*mine, "true"], capture_output=True).returncode != 0:
        return
    os.execvpe(mine[0], [*mine, sys.executable, *sys.argv], {**os.environ, "FAULTS_ALONE": "1"})


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scree", type=Path)
    parser.add_argument("names", nargs="*")
    parser.add_argument("--libraries", type=Path, required=True)
    parser.add_argument("--table", action="store_true")
    arguments = parser.parse_intermixed_args()
    alone()
    start = time.monotonic()
    counts = {"ok": 0, "WRONG": 0, "skipped": 0}
    with tempfile.TemporaryDirectory() as scratch:
        harness = Harness(arguments, Path(scratch))
        if arguments.table:
            print("| fault | what happened | exit status | left on disk | what --resume did |\n|---|---|---|---|---|")
        for name, act in cases:
            if arguments.names and not any(part in name for part in arguments.names):
                continue
            began = time.monotonic()
            case, verdict, why = try_case(harness, name, act)
            counts[verdict] += 1
            if not arguments.table:
                print(f"{verdict:7} {name} ({time.monotonic() - began:.1f} s){': ' if why else ''}{why}", flush=True)
            elif why:
                print(f"| {name} | {verdict}: {why} | | | |")
            else:
                print(f"| {name} | {case.happened} | {case.status} | {case.left} | {case.resumed} |", flush=True)
    print(f"{counts['ok']} faults as they should be, {counts['WRONG']} not, {counts['skipped']} skipped, in {time.monotonic() - start:.0f} s "
          f"(a run: {harness.whole['manifest: steps']} steps, state {harness.whole['manifest: state_hash']})", file=sys.stderr if arguments.table else sys.stdout)
    sys.exit(counts["WRONG"] > 0 or counts["ok"] == 0)


if __name__ == "__main__":
    main()
