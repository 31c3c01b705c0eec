#!/usr/bin/env python3
"""Checks that CMakeLists.txt, CITATION.cff and the newest numbered section of CHANGELOG.md have the same version.

    check_version.py [ROOT]     prints one line per fault; the exit status is 1 if there is any
"""
import re
import sys
from pathlib import Path


def first(root, file, pattern):
    found = re.search(pattern, (root / file).read_text(), re.M)
    return found[1] if found else None


def faults(root):
    versions = {
        "CMakeLists.txt": first(root, "CMakeLists.txt", r"^project\(scree VERSION (\S+)"),
        "CITATION.cff": first(root, "CITATION.cff", r"^version: (\S+)$"),
        "CHANGELOG.md": first(root, "CHANGELOG.md", r"^## (\d\S*) - \d{4}-\d\d-\d\d$"),
    }
    for file, version in versions.items():
        if version is None:
            yield f"{file}: tells no version"
        elif version != versions["CMakeLists.txt"]:
            yield f"{file}: version {version}, and CMakeLists.txt has {versions['CMakeLists.txt']}"
    sections = re.findall(r"^## (.*)$", (root / "CHANGELOG.md").read_text(), re.M)
    if sections[:1] != ["Unreleased"]:
        yield "CHANGELOG.md: the first section is Unreleased"


if __name__ == "__main__":
    found = list(faults(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parent.parent))
    print("\n".join(found), end="\n" if found else "")
    sys.exit(bool(found))
