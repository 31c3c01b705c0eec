// The reference page of the scene language, written from the table of keys and the table of measures.
#include "sim/scene/keys.hpp"
#include "sim/scene/measure.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace scree {
namespace {

constexpr const char* introduction = R"(# Scene reference

<!-- Generated from the table of keys in sim/scene/keys.cpp; test_scene compares, and writes with SCREE_WRITE=1. -->

A scene is one file of YAML 1.2, or of JSON, which is YAML too. Words may be in quotes. Numbers, true and false may not. Units
are SI, and angles are in radians unless a key says degrees. Gravity alone says which direction is up. Unknown keys, wrong types
and impossible values are errors. Their messages give the file, the line, the column, and what is allowed or the nearest key.
Every random choice follows from `seed` and the number of the body.

```yaml
format: 1
gravity: [0, 0, -9.81]
time: {end: 3, step: 0.002}
materials:
  ground: {friction: 0.5, restitution: 0.2}
  glass: {density: 2500, friction: 0.3, restitution: 0.6}
bodies:
  - {plane: {normal: [0, 0, 1]}, material: ground}
  - {sphere: {radius: 0.1}, name: puck, at: [0, 0, 1], velocity: [1, 0, 0], material: glass}
  - box: {size: {uniform: [[0.05, 0.05, 0.05], [0.1, 0.1, 0.1]]}}
    scatter: {count: 50, from: [-1, -1, 2], to: [1, 1, 3]}
    material: glass
checks:
  - {measure: puck.position.z, above: 0.09}
  - {measure: energy.unexplained, over: [0, 3], reduce: max, below: 1e-9}
```

Any key can be changed on the command line: `--set time.step=0.001 --set "bodies[1].velocity[0]=3"`. If the
file lacks a part of the path, this part is created with its defaults. List items and names of your own must be in the file.
)";

constexpr const char* body_files = R"(
## Body files

`file:` takes bodies from a file that has a row for each body. It is a table, an XYZ file or a dump of LAMMPS, which is seen
from its first lines. Its path is relative to the scene file. A finished run leaves its free bodies in the table `final.csv`,
with every number to the bit. It leaves the hulls of polyhedra in `hulls` beside it, and they come back to rounding.
`file: output/NAME` takes both. Bodies that are not free, such as meshes, must be given again in the next scene. `name` gives
the names `name[0]`, `name[1]`, ..., and `fixed: true` makes all the bodies fixed.

```yaml
bodies:
  - {file: bed.csv, material: glass}                                          # with the columns below
  - {file: places.xyz, sphere: {radius: {uniform: [0.04, 0.06]}}, material: glass}   # places alone: the scene says what is there
  - {file: rods.csv, shape: capsule, material: glass}                         # sizes without a word for the shape
  - {file: output/04_pile-lammps/trajectory.lammpstrj, frame: 10, material: gravel}
```

A table begins with a line that names its columns, in any order, in upper or lower case. Then comes one line per body.

| column | meaning |
|---|---|
| `shape` | `sphere`, `box`, `capsule`, `cylinder` or `polyhedron` |
| `radius` | of a sphere, capsule or cylinder (m); empty for a box |
| `size_x`, `size_y`, `size_z` | full edge lengths of a box (m); of a capsule or cylinder `size_z` alone, its length from end to end; else empty |
| `x`, `y`, `z` | the centre (m); of a polyhedron the origin of its points; required |
| `qw`, `qx`, `qy`, `qz` | orientation, a quaternion of any length but 0; all empty: not turned |
| `vx`, `vy`, `vz` | velocity (m/s); empty: 0 |
| `wx`, `wy`, `wz` | spin, world frame (rad/s); empty: 0 |
| `mass` | kg; empty: from the material's density |
| `material` | one of `materials`, or its place among them, from 0; `material` in the scene takes precedence |
| `hull` | of a polyhedron: an OBJ, STL or PLY file, relative to this one; the body is the hull of its vertices; else empty |
| `servo_x`, `servo_y`, `servo_z`, `servo_force` | of a box that is a servo: its axis, and its force (N); else empty |

Cells are separated by commas, semicolons, tabs, bars or blanks, whichever the first line has. A cell may be in quotes (`"`), and
two quotes within quotes stand for one. A line may end with one more separator. Columns that are left out count as empty. Blank
lines, and lines that begin with `#`, are skipped. The text is UTF-8.

Without the column `shape`, all bodies have the shape that the scene gives beside `file`. If the file has their sizes, this is a
word, as in `shape: cylinder`. If the file has no sizes, it is a shape with sizes, as in `sphere: {radius: 0.1}`. Without either, a
file with `radius` alone has spheres, one with `size_x` to `size_z` has boxes, and one with `hull` has polyhedra. Columns that say
nothing of a body, such as `id`, are ignored. `run`, `plan` and `verify` report once which shape was assumed and which columns were
ignored. A column that says something in other words (`diameter`, `density`) is an error, and its message names the right column.

| format | what is read |
|---|---|
| XYZ | element, x, y, z. Extended: the columns that the comment names: `pos`, `velo` or `velocity`, `angular_velocity`, `orientation` (x, y, z, w), `radius`, `diameter`, `mass` |
| LAMMPS | `x y z`, `xu yu zu`, or shares of the cell `xs ys zs`; `vx vy vz`, `omegax omegay omegaz`, `quatw quati quatj quatk`, `radius`, `diameter`, `mass` |

Numbers are read as SI units. Of several frames the last one is read, or that of `frame`. Files of `scree export --to xyz` and
`--to lammps` come back with their shapes, except for polyhedra, whose vertices they do not have. Bodies that are not free are left
out, and a message says so.
)";

/// Returns the text of a table cell. Each | in it is escaped, because it would end the cell.
std::string cell(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '|') out += '\\';
    out += c;
  }
  return out;
}

std::string kind_of(const Type& type) {
  if (type.kind == Type::Kind::section) return "map, see below";
  if (type.kind == Type::Kind::named) return "map of maps, see below";
  if (type.kind == Type::Kind::list && type.parts[0].kind == Type::Kind::section)
    return "list of maps, see below";
  if (type.kind == Type::Kind::any_of) {
    std::vector<std::string> parts;
    for (const Type& part : type.parts) parts.push_back(kind_of(part));
    return fmt::format("{}", fmt::join(parts, ", or "));
  }
  return words_of(type);
}

void append_section(std::string& page, const SectionType& section);

void append_sections_in(std::string& page, const Type& type) {
  if (type.section) append_section(page, *type.section);
  for (const Type& part : type.parts) append_sections_in(page, part);
}

void append_section(std::string& page, const SectionType& section) {
  page += fmt::format("\n## {}\n\n{}\n\n| key | value | meaning | default |\n|---|---|---|---|\n",
                      section.name, section.help);
  std::vector<std::string> later;
  for (const KeyType& key : section.keys) {
    if (key.presence == Presence::future) {
      later.push_back(fmt::format("`{}` ({})", key.name, key.help));
      continue;
    }
    const std::string fallback = key.presence == Presence::required ? "**required**"
                                 : key.fallback.empty()             ? ""
                                                                    : fmt::format("`{}`", key.fallback);
    page +=
        fmt::format("| `{}` | {} | {} | {} |\n", key.name, cell(kind_of(key.type)), cell(key.help), fallback);
  }
  if (!later.empty())
    page += fmt::format("\nPart of the language, but not in this version: {}.\n", fmt::join(later, ", "));
  for (const KeyType& key : section.keys) append_sections_in(page, key.type);
}

void append_measures(std::string& page, MeasureSubject of) {
  const char* prefix = of == MeasureSubject::body     ? "<body>."
                       : of == MeasureSubject::mesh   ? "<mesh>."
                       : of == MeasureSubject::region ? "region.<name>."
                                                      : "";
  page += "\n| measure | unit | meaning |\n|---|---|---|\n";
  for (const MeasureInfo& info : measure_table())
    if (info.of == of)
      page += fmt::format("| `{}{}{}` | {} | {} |\n", prefix, info.name,
                          info.is_vector() ? ".{x,y,z,norm}" : "", info.unit, cell(info.help));
}

}  // namespace

std::string scene_reference() {
  std::string page = introduction;
  append_section(page, *scene_codec().type.section);
  page += body_files;
  page +=
      "\n## Measures\n\nOf one body, by its name; `bed[3]` is a body of a repeat or scatter. World frame.\n";
  append_measures(page, MeasureSubject::body);
  page += "\nOf a mesh as a whole, by its name; of its triangles as of any body, by `floor[3]`.\n";
  append_measures(page, MeasureSubject::mesh);
  page += "\nOf the whole run.\n";
  append_measures(page, MeasureSubject::run);
  page += "\nOf one of the `regions`, at the end of a step.\n";
  append_measures(page, MeasureSubject::region);
  return page;
}

}  // namespace scree
