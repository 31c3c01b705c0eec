// The keys of bodies: their shapes, their positions and motions, and the number of bodies.
#include "sim/scene/key_sections.hpp"
#include "sim/scene/particle_kinds.hpp"
#include "sim/scene/rules.hpp"

namespace scree {
namespace {

template <class T>
Codec<Distribution<T>> distribution(std::string name, const Codec<T>& value) {
  using D = Distribution<T>;
  const Codec<D> fixed{
      value.type,
      [value](D& sizes, const Node& node, Reader& reader) {
        value.read(sizes.value.emplace(), node, reader);
      },
      [value](const D& sizes) { return sizes.value ? value.write(*sizes.value) : std::nullopt; }};
  return any_of<D>(
      {fixed, section<D>(std::move(name), "A size to be drawn for each body. Exactly one key.",
                         {
                             key<D>("uniform", &D::uniform, optional(array_of<2>(value)), optionally,
                                    "[low, high]: all sizes between the two are equally likely; each edge of "
                                    "a box is drawn by itself"),
                             key<D>("powerlaw", &D::powerlaw, optional(array_of<3>(number())), optionally,
                                    "[min, max, exponent]: sizes x from min to max, whose number falls as "
                                    "x^-exponent; boxes are cubes"),
                             key<D>("choose", &D::choose, list_of(value, 1), optionally,
                                    "[size, ...]: one of these sizes, all equally likely"),
                         },
                         check_distribution<T>)});
}

/// Makes the codec of three numbers, given as one number for all axes or as one for each. `is_short`: three
/// equal numbers are written as one.
Codec<Vec3> one_or_three(const Codec<double>& number, bool is_short) {
  const Codec<Vec3> one{number.type,
                        [number](Vec3& v, const Node& node, Reader& reader) {
                          double value = 0;
                          number.read(value, node, reader);
                          v.setConstant(value);
                        },
                        [number, is_short](const Vec3& v) {
                          return is_short && (v.array() == v.x()).all() ? number.write(v.x()) : std::nullopt;
                        }};
  return any_of<Vec3>({one, fixed_list<Vec3, 3>(number)});
}

/// Makes the codec of the edge lengths of a box, or one number for a cube.
Codec<Vec3> edges() { return one_or_three(number(above_zero, "m"), false); }

Codec<PlaneEntry> plane_section() {
  using T = PlaneEntry;
  return section<T>("bodies[].plane", "A fixed half space; the free side is where normal . x >= offset.",
                    {
                        key<T>("normal", &T::normal, vector(""), required,
                               "points to the free side; of any length but 0, made a unit vector"),
                        key<T>("offset", &T::offset, number(any_value, "m"), optionally,
                               "distance of the plane from the origin, along the unit normal"),
                    },
                    check_plane);
}

Codec<SphereEntry> sphere_section() {
  using T = SphereEntry;
  return section<T>(
      "bodies[].sphere", "A ball.",
      {
          key<T>("radius", &T::radius, distribution("bodies[].sphere.radius", number(above_zero, "m")),
                 required, "one radius, or a distribution"),
      });
}

Codec<BoxEntry> box_section() {
  using T = BoxEntry;
  return section<T>("bodies[].box", "A cuboid, its edges along the axes of the body.",
                    {
                        key<T>("size", &T::size, distribution("bodies[].box.size", edges()), required,
                               "full edge lengths [x, y, z], one number for a cube, or a distribution"),
                    });
}

Codec<TubeEntry> tube_section() {
  using T = TubeEntry;
  return section<T>("bodies[].tube",
                    "The inside of a cylinder along the body's z axis, closed by a cap at each end. It acts "
                    "on one side only: it holds what is in it, and does not touch bodies whose centre is "
                    "outside. It never moves freely.",
                    {
                        key<T>("radius", &T::radius, number(above_zero, "m"), required, "of the inside"),
                        key<T>("length", &T::length, number(above_zero, "m"), required, "from cap to cap"),
                    });
}

Codec<CapsuleEntry> capsule_section() {
  using T = CapsuleEntry;
  return section<T>("bodies[].capsule",
                    "All points within a radius of a segment along the z axis of the body.",
                    {
                        key<T>("radius", &T::radius, number(above_zero, "m"), required, "about the axis"),
                        key<T>("length", &T::length, number(above_zero, "m"), required,
                               "of the segment; from end to end it is two radii more"),
                    });
}

Codec<CylinderEntry> cylinder_section() {
  using T = CylinderEntry;
  return section<T>("bodies[].cylinder", "A solid cylinder along the z axis of the body.",
                    {
                        key<T>("radius", &T::radius, number(above_zero, "m"), required, "about the axis"),
                        key<T>("length", &T::length, number(above_zero, "m"), required, "from end to end"),
                    });
}

Codec<PolyhedronEntry> polyhedron_section() {
  using T = PolyhedronEntry;
  return section<T>(
      "bodies[].polyhedron",
      "The convex hull of points. `at`, `orientation` and `rotate` place the frame in which the points are "
      "given; the body's own place is its centre of mass, and its axes are the principal ones. With "
      "`scatter` and `emit` the centre of mass is at the random place. Faces are flat, and points are one, "
      "to a millionth of the longest extent (at most of five times the thickness). A hull may have 128 "
      "vertices; more points may be given if the others lie within its faces and edges. Points thinner than "
      "2e-7 of their longest extent count as points of a plane.",
      {
          key<T>("points", &T::points, optional(list_of(vector("m"), 4)), optionally,
                 "[[x, y, z], ...], not all in a plane"),
          key<T>("file", &T::file, text(), optionally,
                 "instead: the vertices of an OBJ, STL or PLY file, whether its surface is convex or not"),
          key<T>("scale", &T::scale, number(above_zero), optionally, "the points are multiplied by it"),
      },
      check_polyhedron);
}

Codec<Weld> weld() {
  const auto named = [](const char* name, bool on) {
    return Codec<Weld>{word_type({name}),
                       [on](Weld& weld, const Node&, Reader&) {
                         weld = {on, {}};
                       },
                       [name, on](const Weld& weld) {
                         return weld.on == on && !weld.length ? std::optional(Node::scalar(name))
                                                              : std::nullopt;
                       }};
  };
  const Codec<std::optional<double>> length = optional(number(above_zero, "m"));
  const Codec<Weld> given{length.type,
                          [length](Weld& weld, const Node& node, Reader& reader) {
                            weld.on = true;
                            length.read(weld.length, node, reader);
                          },
                          [length](const Weld& weld) { return length.write(weld.length); }};
  return any_of<Weld>({named("auto", true), named("off", false), given});
}

Codec<MeshEntry> mesh_section() {
  using T = MeshEntry;
  return section<T>(
      "bodies[].mesh",
      "A surface of triangles from a file. Each triangle is a body, called `name[k]`; `name` is all of them. "
      "Bodies may touch both sides: a body is on the side of a triangle on which its centre is. Bodies do "
      "not feel edges between triangles in one plane, concave edges, or cracks that are welded. A mesh never "
      "moves freely. `scree plan` says how many corners were welded, how far they moved, how many triangles "
      "were split, and how many edges are open. A warning says what of the file is not read.",
      {
          key<T>("file", &T::file, text(), required,
                 "Wavefront OBJ, STL (text or binary) or PLY (likewise); polygons are cut into triangles"),
          key<T>(
              "scale", &T::scale, one_or_three(number(), true), optionally,
              "vertices are multiplied by it: a number for all axes, or [x, y, z]; not 0. Where it mirrors, "
              "triangles are turned round"),
          key<T>(
              "weld", &T::weld, weld(), optionally,
              "corners nearer than this count as one, and a corner nearer than this to an edge splits its "
              "triangles. `auto`: the smaller of 4e-5 of the mesh's size (the diagonal of its box) and 0.01 "
              "of the shortest edge at the corners, but at least 1e-9 of the size. `off`: only corners of "
              "equal place are one"),
      },
      check_mesh);
}

Codec<RotationEntry> rotate_section() {
  using T = RotationEntry;
  return section<T>(
      "bodies[].rotate", "Orientation by a turn about an axis through the body's centre.",
      {
          key<T>("axis", &T::axis, vector(""), required, "of any length but 0"),
          key<T>("degrees", &T::degrees, optional(number()), optionally, "angle in degrees; or give radians"),
          key<T>("radians", &T::radians, optional(number()), optionally, "angle in radians; or give degrees"),
      },
      check_rotation);
}

Codec<Oscillation> oscillate_section() {
  using T = Oscillation;
  return section<T>(
      "bodies[].motion.oscillate",
      "An oscillation. At the time t since the body has appeared, it is moved and turned by sin(2 pi "
      "frequency t + phase) - sin(phase) times these amplitudes, on top of `velocity` and `spin`.",
      {
          key<T>("displacement", &T::displacement, vector("m"), optionally, "amplitude"),
          key<T>("angle", &T::angle, vector("rad"), optionally,
                 "amplitude of the turn, as a vector along its axis; parallel to `spin`, if there is one"),
          key<T>("frequency", &T::frequency, number(above_zero, "Hz"), required, "oscillations per second"),
          key<T>("phase", &T::phase, number(any_value, "rad"), optionally, "at the start"),
      },
      check_oscillation);
}

Codec<MotionKeyEntry> motion_key_section() {
  using T = MotionKeyEntry;
  return section<T>(
      "bodies[].motion.keyframes[]", "Where the body is at one time.",
      {
          key<T>("at", &T::at, number(not_negative, "s"), required, "time since the body has appeared"),
          key<T>("position", &T::position, vector("m"), required, "of the centre"),
          key<T>("orientation", &T::orientation, optional(array_of<4>(number())), optionally,
                 "quaternion [w, x, y, z]; every keyframe has one, or none and the body keeps its own"),
          key<T>("rotate", &T::rotate, optional(rotate_section()), optionally, "instead of `orientation`"),
      },
      check_motion_key);
}

/// Makes a key that is left out of the resolved scene if there are keyframes, because it is refused beside
/// them.
Key<MotionEntry> rate(const char* name, Vec3 MotionEntry::*member, const char* unit, const char* help) {
  Key<MotionEntry> rate = key<MotionEntry>(name, member, vector(unit), optionally, help);
  rate.write = [write = rate.write](const MotionEntry& motion) {
    return motion.keyframes.empty() ? write(motion) : std::nullopt;
  };
  return rate;
}

Codec<MotionEntry> motion_section() {
  using T = MotionEntry;
  return section<T>(
      "bodies[].motion", "Prescribed motion: the body moves like this whatever hits it.",
      {
          rate("velocity", &T::velocity, "m/s", "constant velocity"),
          rate("spin", &T::spin, "rad/s", "constant angular velocity"),
          key<T>("about", &T::about, optional(vector("m")), optionally,
                 "the point to turn about, which moves along with `velocity` and `oscillate`; the body's own "
                 "centre if not given"),
          key<T>("oscillate", &T::oscillate, optional(oscillate_section()), optionally,
                 "an oscillation in addition"),
          key<T>("keyframes", &T::keyframes, list_of(motion_key_section(), 1), optionally,
                 "instead of all that, and of `at`: places at ascending times. Between them the body moves "
                 "smoothly, on monotone cubics: along each axis it is never beyond the two keyframes, and it "
                 "is at rest where the direction changes. It turns the short way. Before the first and after "
                 "the last keyframe it rests"),
      },
      check_motion);
}

Codec<ServoEntry> servo_section() {
  using T = ServoEntry;
  return section<T>(
      "bodies[].servo",
      "A wall that holds a force. It is a box that moves along one axis alone, as if in a guide without "
      "friction, and does not turn. At rest, what it presses on feels the force. It starts at rest, and its "
      "drive bears its weight. Steps are taken on Host, as in the accurate mode.",
      {
          key<T>("axis", &T::axis, vector(""), required, "along which it moves; of any length but 0"),
          key<T>("force", &T::force, number(any_value, "N"), required,
                 "along the axis; apart from contacts, nothing else moves the body"),
      },
      check_servo);
}

Codec<RepeatEntry> repeat_section() {
  using T = RepeatEntry;
  return section<T>(
      "bodies[].repeat",
      "Copies of the body on a lattice, the first one at `at`. Bodies are called `name[0]`, `name[1]`, ..., "
      "x fastest.",
      {
          key<T>("count", &T::count, array_of<3>(large_integer(at_least(1))), required,
                 "bodies along x, y and z"),
          key<T>("spacing", &T::spacing, vector("m"), required, "between centres, along x, y and z"),
          key<T>("jitter", &T::jitter, number(not_negative, "m"), optionally,
                 "each centre is moved at random by up to this much along each axis"),
      });
}

Codec<ScatterEntry> scatter_section() {
  using T = ScatterEntry;
  return section<T>("bodies[].scatter",
                    "Copies of the body at random places, in random orientations unless one is given. "
                    "Centres lie between the two corners, and no body overlaps another one that appears at "
                    "the same time, or a fixed one. Bodies are called `name[0]`, `name[1]`, ...",
                    {
                        key<T>("count", &T::count, large_integer(at_least(1)), required, "how many"),
                        key<T>("from", &T::from, vector("m"), required, "lower corner"),
                        key<T>("to", &T::to, vector("m"), required, "upper corner"),
                    },
                    check_scatter);
}

Codec<EmitEntry> emit_section() {
  using T = EmitEntry;
  return section<T>(
      "bodies[].emit",
      "Copies of the body that appear one after another, at random places and in random orientations unless "
      "one is given. The first one is asked for at `from` of the item. Each appears with its centre between "
      "the two corners, where it overlaps nothing. While there is no such place it waits, and none is left "
      "out: see the measures emission.requested and emission.emitted. Bodies are called `name[0]`, "
      "`name[1]`, ... in the order in which they are asked for.",
      {
          key<T>("count", &T::count, large_integer(at_least(1)), required, "how many in all"),
          key<T>("rate", &T::rate, number(above_zero, "1/s"), required, "how many a second are asked for"),
          key<T>("from", &T::from, vector("m"), required, "lower corner"),
          key<T>("to", &T::to, vector("m"), required, "upper corner"),
      },
      check_emit);
}

Codec<Shape> shape_word() {
  std::vector<std::pair<std::string, Shape>> words;
  for (const Shape shape : shapes_of_kinds) words.emplace_back(word_of(shape), shape);
  return word<Shape>(words);
}

}  // namespace

Codec<BodyEntry> body_section() {
  using T = BodyEntry;
  return section<T>(
      "bodies[]",
      "One body, or many alike. Each has exactly one shape: plane, sphere, box, tube, capsule, cylinder, "
      "polyhedron or mesh; beside `file` a shape is that of all the file's bodies.",
      {
          key<T>("plane", &T::plane, optional(plane_section()), optionally, "the shape: a fixed half space"),
          key<T>("sphere", &T::sphere, optional(sphere_section()), optionally, "the shape: a ball"),
          key<T>("box", &T::box, optional(box_section()), optionally, "the shape: a cuboid"),
          key<T>("tube", &T::tube, optional(tube_section()), optionally,
                 "the shape: the inside of a cylinder, with end caps; needs `fixed: true` or `motion`"),
          key<T>("capsule", &T::capsule, optional(capsule_section()), optionally,
                 "the shape: a cylinder with round ends"),
          key<T>("cylinder", &T::cylinder, optional(cylinder_section()), optionally,
                 "the shape: a solid cylinder"),
          key<T>("polyhedron", &T::polyhedron, optional(polyhedron_section()), optionally,
                 "the shape: a convex polyhedron"),
          key<T>("mesh", &T::mesh, optional(mesh_section()), optionally,
                 "the shape: a surface of triangles; needs `fixed: true` or `motion`"),
          key<T>(
              "file", &T::file, text(), optionally,
              "bodies from a table (CSV), an XYZ file or a dump of LAMMPS, or those that another run left, "
              "by its folder; see Body files"),
          key<T>("shape", &T::shape, optional(shape_word()), optionally,
                 "of a file's bodies, where it has their sizes but no column `shape`"),
          key<T>("frame", &T::frame, optional(large_integer(not_negative)), optionally,
                 "of an XYZ file or a dump, from 0 on; the last one if not given"),
          key<T>("name", &T::name, identifier(), optionally, "to refer to it in measures"),
          key<T>("material", &T::material, identifier(), optionally,
                 "one of `materials`; required, except for a file that has a column of them"),
          key<T>("mass", &T::mass, optional(number(above_zero, "kg")), optionally,
                 "instead of the material's density"),
          with_default(key<T>("at", &T::at, optional(vector("m")), optionally,
                              "place of the centre; of the first one if repeated"),
                       "[0, 0, 0]"),
          with_default(key<T>("orientation", &T::orientation, optional(array_of<4>(number())), optionally,
                              "quaternion [w, x, y, z] of any length but 0, made a unit one"),
                       "[1, 0, 0, 0]"),
          key<T>("rotate", &T::rotate, optional(rotate_section()), optionally, "instead of `orientation`"),
          with_default(key<T>("velocity", &T::velocity, optional(vector("m/s")), optionally, "at the start"),
                       "[0, 0, 0]"),
          with_default(key<T>("spin", &T::spin, optional(vector("rad/s")), optionally,
                              "angular velocity at the start"),
                       "[0, 0, 0]"),
          with_default(key<T>("fixed", &T::fixed, optional(boolean()), optionally, "the body never moves"),
                       "false"),
          key<T>("motion", &T::motion, optional(motion_section()), optionally,
                 "the body moves as prescribed"),
          key<T>("servo", &T::servo, optional(servo_section()), optionally,
                 "the body is pushed along a guide by a force; a box"),
          key<T>("repeat", &T::repeat, optional(repeat_section()), optionally, "many on a lattice"),
          key<T>("scatter", &T::scatter, optional(scatter_section()), optionally, "many at random places"),
          key<T>("emit", &T::emit, optional(emit_section()), optionally, "many, one after another"),
          with_default(
              key<T>("from", &T::from, optional(number(not_negative, "s")), optionally,
                     "when the body appears, in the state given here; its motion starts then. The nearest "
                     "step is taken, also for `until`. With `emit`: when the first body is asked for"),
              "0"),
          key<T>("until", &T::until, optional(number(above_zero, "s")), optionally,
                 "when the body is gone; never if not given"),
      },
      check_body);
}

}  // namespace scree
