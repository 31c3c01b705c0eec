#!/usr/bin/env python3
"""Kills a run again and again at random times, resumes it after each kill, and compares what it leaves with an undisturbed run.

    kill_resume.py SCREE [--kills N] [--signal KILL|TERM] [--seed S] [--longest T] [MORE...]

All other arguments are passed to `scree run` (--device cuda, --set time.end=4...). The run must be the same to the byte: the hash of the state, metrics.csv,
final.csv, the frames and the checks. Prints what happened; the exit status is 1 if anything differs, or if the run ended before it had been killed N times.
"""
import argparse
import random
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from runs import command, contents, differing


def run_whole(arguments, folder):
    start = time.monotonic()
    done = subprocess.run(command(arguments.scree, folder, *arguments.more), capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"the undisturbed run ended with {done.returncode}:\n{done.stdout}{done.stderr}")
    return time.monotonic() - start


def run_killed(arguments, folder):
    """Kills and resumes the run until it ends. Returns the number of kills."""
    times = random.Random(arguments.seed)
    kills = 0
    while True:
        process = subprocess.Popen(command(arguments.scree, folder, "--resume", *arguments.more), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        try:
            process.wait(times.uniform(0, arguments.longest) if kills < arguments.kills else None)
        except subprocess.TimeoutExpired:
            process.send_signal(arguments.signal)
            kills += 1
        said = process.communicate()[0]
        if process.returncode == 0:
            return kills
        expected = {-arguments.signal, 130} if arguments.signal == signal.SIGTERM else {-arguments.signal}
        if process.returncode not in expected:
            sys.exit(f"kill {kills}: the run ended with {process.returncode}:\n{said}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scree")
    parser.add_argument("--kills", type=int, default=200)
    parser.add_argument("--signal", type=lambda name: signal.Signals["SIG" + name], default=signal.SIGKILL)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--longest", type=float, default=0.8, help="until a kill (s)")
    arguments, arguments.more = parser.parse_known_args()
    with tempfile.TemporaryDirectory() as scratch:
        whole, killed = Path(scratch) / "whole", Path(scratch) / "killed"
        wall = run_whole(arguments, whole)
        start = time.monotonic()
        kills = run_killed(arguments, killed)
        expected, manifest = contents(whole)
        found, resumed = contents(killed)
        different = differing(expected, found)
        print(f"{kills} x {arguments.signal.name} in {time.monotonic() - start:.0f} s (undisturbed: {wall:.0f} s, {manifest['steps']} steps, "
              f"{manifest['frames']} frames, state {manifest['state_hash']}); resumed {len(resumed.get('resumed_at', []))} times")
        print(f"compared: {len(expected)} contents, {sum(len(bytes) for name, bytes in expected.items() if name != 'files')} bytes; "
              + (f"DIFFERENT: {', '.join(different)}" if different else "all the same"))
        if kills < arguments.kills:
            print(f"only {kills} kills of {arguments.kills}: the run was too short")
        sys.exit(bool(different) or kills < arguments.kills)


if __name__ == "__main__":
    main()
