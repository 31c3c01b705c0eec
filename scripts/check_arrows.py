#!/usr/bin/env python3
"""Checks that every include of scree follows an arrow of its structure. There is no list of exceptions.

    check_arrows.py                     checks the tree; prints one line per breach; exit status 1 if there is any
    check_arrows.py --self-test         the same, after a test that each rule refuses a breach of it
    check_arrows.py --headers           prints the headers that no source includes first, each with a word: `parallel` if
                                        it reaches Thrust, else `plain`
"""
import re
import sys
import tempfile
from pathlib import Path

# The paths that files of a folder may include; the row with the longest matching prefix applies. Files under tests/ may include anything.
ARROWS = {
    "scree/": ["scree/"],
    "core/": ["core/", "scree/"],
    "broadphase/": ["core/", "broadphase/"],
    "narrowphase/": ["core/", "broadphase/", "narrowphase/"],
    "render/": ["core/", "render/"],
    "sim/observe/": ["core/", "broadphase/", "narrowphase/", "sim/observe/"],
    "sim/laws/": ["core/", "narrowphase/", "sim/observe/", "sim/laws/"],
    "sim/scene/": ["core/", "broadphase/settings.hpp", "narrowphase/settings.hpp", "sim/observe/observation.hpp", "sim/scene/", "scree/"],
    "sim/bodies/": ["core/", "sim/observe/", "sim/laws/", "sim/scene/", "sim/bodies/"],
    "sim/pairs/": ["core/", "broadphase/", "narrowphase/", "sim/observe/", "sim/laws/", "sim/pairs/"],
    "sim/impacts/": ["core/", "narrowphase/", "sim/observe/", "sim/laws/", "sim/impacts/"],
    "sim/contacts/": ["core/", "broadphase/", "narrowphase/", "sim/observe/", "sim/laws/", "sim/impacts/", "sim/contacts/"],
    "sim/response/": ["core/", "narrowphase/", "sim/observe/", "sim/laws/", "sim/impacts/", "sim/contacts/", "sim/response/"],
    "sim/model/": ["core/", "broadphase/", "sim/laws/", "sim/scene/", "sim/bodies/", "sim/model/"],
    "sim/step/": ["core/", "broadphase/", "narrowphase/", "scree/", "sim/observe/", "sim/laws/", "sim/scene/", "sim/bodies/", "sim/pairs/", "sim/impacts/",
                  "sim/contacts/", "sim/response/", "sim/model/", "sim/step/"],
    "sim/record/": ["core/", "sim/observe/", "sim/model/model.hpp", "sim/scene/", "sim/record/"],
    "sim/library/": ["core/", "scree/", "sim/record/", "sim/scene/", "sim/step/simulation.hpp", "sim/library/"],
    "sim/cli/": ["core/", "broadphase/", "narrowphase/", "render/", "sim/observe/", "sim/laws/", "sim/model/", "sim/scene/", "sim/step/simulation.hpp",
                 "sim/step/step_failure.hpp", "sim/record/", "sim/cli/"],
    "bench/": ["core/", "broadphase/", "narrowphase/", "sim/", "render/", "bench/"],
    "tests/": [""],
}
FOLDERS = ["scree", "core", "broadphase", "narrowphase", "sim", "render", "bench", "tests"]

# At most two files include each of these libraries, so that it can be replaced.
LIBRARIES = {
    "yaml-cpp": r"yaml-cpp/", "libccd": r"ccd/", "Qhull": r"libqhull", "OpenGL and OSMesa": r"GL/", "EGL": r"EGL/", "libpng": r"png\.h",
    "FreeType": r"ft2build\.h", "HDF5": r"hdf5\.h",
    "CLI11": r"CLI/", "Boost": r"boost/", "nlohmann-json": r"nlohmann/", "xxHash": r"xxhash\.h", "zlib": r"zlib\.h",
}
THRUST_HEADERS = ["core/parallel.hpp", "core/space_matches.hpp", "core/space_matches_device.hpp", "core/space_matches_host.hpp",
                  "core/space_policy.hpp", "core/space_warp.hpp", "core/space_phases.hpp", "core/space_tiles.hpp"]
DRIVERS = ["core/space.cpp"]  # sources that are named parallel because they call the GPU's driver, without Thrust
THRUST = re.compile(r"(thrust|cub|cuda)/|cooperative_groups\.h")

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.M)
CONDITIONAL = re.compile(r"^\s*#\s*(if|ifdef|ifndef|elif)\b", re.M)
PARALLEL = re.compile(r"\bscree_parallel_sources\s*\(([^)]*)\)")


class Tree:
    def __init__(self, root):
        self.root = Path(root)
        files = sorted(f for folder in FOLDERS for f in (self.root / folder).rglob("*.[ch]pp"))
        self.text = {f.relative_to(self.root).as_posix(): f.read_text() for f in files}
        self.includes = {name: INCLUDE.findall(text) for name, text in self.text.items()}
        self.reach = {}

    def reaches_thrust(self, name):
        """Returns whether a file includes one of the Thrust headers, directly or through others."""
        if name not in self.reach:
            self.reach[name] = name in THRUST_HEADERS  # this value also ends a cycle of includes
            self.reach[name] |= any(self.reaches_thrust(to) for _, to in self.includes.get(name, []))
        return self.reach[name]

    def parallel_sources(self):
        """Returns the sources that the CMake files name parallel."""
        return {(lists.parent / source).resolve().relative_to(self.root.resolve()).as_posix()
                for folder in FOLDERS for lists in (self.root / folder).rglob("CMakeLists.txt")
                for arguments in PARALLEL.findall(re.sub(r"#.*", "", lists.read_text()))
                for source in re.findall(r"[\w./-]+\.cpp", arguments)}

    def headers_alone(self):
        """Returns the headers that no source of every build includes first, which would prove that they are self-contained.
        Headers that are parts of one source, which is compiled for several instruction sets, are left out."""
        left_out = ("tests/", "sim/laws/simd/kernels/")
        first = {includes[0][1] for name, includes in self.includes.items()
                 if name.endswith(".cpp") and not name.startswith(("tests/", "bench/peers/")) and includes}
        return [name for name in self.text
                if name.endswith(".hpp") and not name.startswith(left_out) and name not in first]

    def breaches(self):
        yield from self.bad_arrows()
        yield from self.bad_libraries()
        for name, text in self.text.items():
            if not name.startswith("core/space") and (found := CONDITIONAL.search(text)):
                yield f"{name}: #{found[1]}: preprocessor conditionals stand in core/space* alone"
        parallel = self.parallel_sources()
        for name, text in self.text.items():
            if name.endswith(".hpp") and not re.search("^#pragma once$", text, re.M):
                yield f"{name} has no #pragma once"
            if name.endswith(".cpp") and self.reaches_thrust(name) and name not in parallel:
                yield f"{name} reaches core/parallel.hpp: it must be named in scree_parallel_sources"
            if name in parallel and not self.reaches_thrust(name) and name not in DRIVERS:
                yield f"{name} is named in scree_parallel_sources and does not reach core/parallel.hpp: nvcc takes long"

    def bad_arrows(self):
        for name, includes in self.includes.items():
            allowed = ARROWS[row] if (row := max(filter(name.startswith, ARROWS), key=len, default="")) else []
            if not row:
                yield f"{name}: no row of ARROWS says what it may include"
            for mark, to in includes:
                if mark == '"' and "/" in to and not any(map(to.startswith, allowed)):
                    yield f'{name} includes "{to}": not along an arrow'
                if mark == '"' and (Path(name).parent / to).as_posix() in self.text:
                    yield f'{name} includes "{to}": write the path from the root'
                if name.startswith("scree/") and mark == "<" and not re.fullmatch("[a-z_]+", to):
                    yield f"{name} includes <{to}>: the interface has the standard library alone"
                if THRUST.match(to) and name not in THRUST_HEADERS:
                    yield f"{name} includes <{to}>: only {' and '.join(THRUST_HEADERS)} do"

    def bad_libraries(self):
        for library, pattern in LIBRARIES.items():
            users = [name for name, includes in self.includes.items() if not name.startswith(("tests/", "bench/"))
                     and any(re.match(pattern, to) for _, to in includes)]
            if len(users) > 2:
                yield f"{library} is included in {len(users)} files, two at most: {', '.join(users)}"


def self_test():
    """Checks small trees, of which each but the last breaks one rule. The words of the message show that this rule refuses it."""
    lib = {"core/CMakeLists.txt": "add_library(a core.cpp)"}
    trees = [
        ("not along an arrow", {"core/a.hpp": '#pragma once\n#include "sim/step/simulation.hpp"'}),
        ("not along an arrow", {"scree/a.hpp": '#pragma once\n#include "core/math.hpp"'}),
        ("the standard library alone", {"scree/a.hpp": "#pragma once\n#include <vector>\n#include <Eigen/Core>"}),
        ("not along an arrow", {"broadphase/a.cpp": '#include "narrowphase/contact.hpp"'}),
        ("not along an arrow", {"render/a.cpp": '#include "sim/scene/scene.hpp"'}),
        ("not along an arrow", {"sim/bodies/a.cpp": '  #  include "sim/record/metrics.hpp"'}),
        ("not along an arrow", {"sim/scene/a.hpp": '#pragma once\n#include "narrowphase/contact.hpp"'}),
        ("the path from the root", {"core/a.hpp": '#pragma once\n#include "b.hpp"', "core/b.hpp": "#pragma once"}),
        ("no row of ARROWS", {"sim/other.cpp": ""}),
        ("<thrust/sort.h>", {"broadphase/a.cpp": "#include <thrust/sort.h>"}),
        ("yaml-cpp is included in 3", {f"sim/scene/{n}.cpp": "#include <yaml-cpp/yaml.h>" for n in "abc"}),
        ("#ifdef", {"render/a.cpp": "int x;\n# ifdef NDEBUG\n"}),
        ("must be named in", {"core/core.cpp": '#include "core/a.hpp"', "core/a.hpp": '#pragma once\n#include "core/b.hpp"',
                              "core/b.hpp": '#pragma once\n#include "core/parallel.hpp"', **lib}),
        ("must be named in", {"core/lost.cpp": '#include "core/parallel.hpp"', **lib}),
        ("has no #pragma once", {"core/a.hpp": "#include <vector>"}),
        ("nvcc takes long", {"core/core.cpp": "#include <vector>", "core/CMakeLists.txt": "scree_parallel_sources(core.cpp)"}),
        ("", {"core/core.cpp": '#include "core/parallel.hpp"\n#include <vector>',
              "core/space.cpp": "#if X\n#endif", "tests/a.cpp": '#include "sim/cli/run.hpp"',
              "core/CMakeLists.txt": "add_library(a core.cpp) # b.cpp\nscree_parallel_sources(\n  core.cpp)\nf(a)"}),
    ]
    for expected, files in trees:
        with tempfile.TemporaryDirectory() as root:
            for name, text in files.items():
                (Path(root) / name).parent.mkdir(parents=True, exist_ok=True)
                (Path(root) / name).write_text(text)
            found = "\n".join(Tree(root).breaches())
            if found.count("\n") or (expected not in found if expected else found):
                sys.exit(f"check_arrows.py --self-test: expected {expected!r} and got {found!r}")


if __name__ == "__main__":
    tree = Tree(Path(__file__).resolve().parent.parent)
    if "--headers" in sys.argv:
        for header in tree.headers_alone():
            print(header, "parallel" if tree.reaches_thrust(header) else "plain")
        sys.exit()
    if "--self-test" in sys.argv:
        self_test()
    breaches = list(tree.breaches())
    print("\n".join(breaches), end="\n" if breaches else "")
    sys.exit(bool(breaches))
