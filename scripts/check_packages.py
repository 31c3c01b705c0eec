#!/usr/bin/env python3
"""Checks cmake/packages.txt, because on a machine that has every package no build shows that the list lacks one.

    check_packages.py           checks that docs/dependencies.md explains each package of the list, and no other
    check_packages.py BUILD     checks also that every header that the build read, and every library that its programs
                                load, comes from a package of the list or from one that such a package depends on

Prints one line per fault; the exit status is 1 if there is any.
"""
import os
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def output_of(*command, **options):
    return subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, **options).stdout


def listed_packages():
    lines = (ROOT / "cmake/packages.txt").read_text().splitlines()
    return {name for line in lines if (name := line.split("#")[0].strip())}


def documented_packages():
    return set(re.findall(r"^\| `([a-z0-9.+-]+)` \|", (ROOT / "docs/dependencies.md").read_text(), re.M))


def closure_of(packages):
    """Returns the packages and all installed ones that they depend on."""
    depends, providers = {}, {}
    fields = output_of("dpkg-query", "-W", "-f", "${Package}\t${Depends}, ${Pre-Depends}\t${Provides}\n")
    names = lambda text: re.findall(r"(?:^|[,|])\s*([a-z0-9.+-]+)", text)
    for package, needs, provides in (line.split("\t") for line in fields.splitlines()):
        depends.setdefault(package, set()).update(names(needs))
        for name in names(provides):
            providers.setdefault(name, set()).add(package)
    reached, pending = set(), set(packages)
    while pending:
        name = pending.pop()
        reached.add(name)
        pending |= (depends.get(name, set()) | providers.get(name, set())) - reached
    return reached


def owners_of(paths):
    """Returns {path: package} for the files that come from a package. A file has two names because of Debian's merged /usr."""
    real = {path: os.path.realpath(path) for path in paths}
    asked = sorted({name for path in real.values() for name in (path, path.removeprefix("/usr"))})
    owner = {}
    for line in output_of("xargs", "-d", "\n", "dpkg", "-S", input="\n".join(asked)).splitlines():
        package, _, path = line.partition(": ")
        owner[path] = package.split(":")[0].split(",")[0]
    found = {path: owner.get(name) or owner.get(name.removeprefix("/usr")) for path, name in real.items()}
    return {path: package for path, package in found.items() if package}


def headers_read(build):
    return set(re.findall(r"^\s+(/usr/(?!local/)\S+)$", output_of("ninja", "-C", build, "-t", "deps"), re.M))


def libraries_loaded(build):
    programs = [str(file) for file in build.rglob("*") if file.is_file() and os.access(file, os.X_OK)
                and "CMakeFiles" not in file.parts and file.open("rb").read(4) == b"\x7fELF"]
    return set(re.findall(r"=> (/\S+)", output_of("ldd", *programs))) if programs else set()


def faults(build):
    listed, documented = listed_packages(), documented_packages()
    for name in sorted(listed ^ documented):
        where, other = ("cmake/packages.txt", "docs/dependencies.md")[:: 1 if name in listed else -1]
        yield f"{name} is in {where} but not in {other}"
    if not build:
        return
    owners = owners_of(headers_read(build) | libraries_loaded(build))
    if not owners:
        yield f"{build}: no header or library of a package found there; is it built?"
    covered = closure_of(listed)
    for package in sorted(set(owners.values()) - covered):
        path = min(path for path, owner in owners.items() if owner == package)
        yield f"{path} comes from {package}, which nothing in cmake/packages.txt brings"


if __name__ == "__main__":
    found = list(faults(Path(sys.argv[1]).resolve() if len(sys.argv) > 1 else None))
    print("\n".join(found), end="\n" if found else "")
    sys.exit(bool(found))
