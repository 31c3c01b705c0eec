// The table of keys. A key of the language is one line here or in a file of its section (key_sections.hpp):
// name, member, type with unit and range, presence, and one line of help. The default is the member's
// initialiser in keys.hpp or scene.hpp.
#include "sim/scene/key_sections.hpp"
#include "sim/scene/rules.hpp"

namespace scree {
namespace {

/// The largest number of materials or of regions: each pair of materials has a contact law, and each region
/// needs a sum over all bodies.
constexpr std::int64_t most_names = 1000;

Codec<TimeSettings> time_section() {
  using T = TimeSettings;
  return section<T>(
      "time", "Length and step of the run.",
      {
          key<T>("end", &T::end, number(above_zero, "s"), required, "when the run ends; it starts at 0"),
          key<T>("step", &T::step, number(above_zero, "s"), required,
                 "length of a step; the last one is shorter if `end` is no multiple"),
          key<T>("substeps", &T::substeps, or_auto(integer(between(1, 1e6))), optionally,
                 "contacts are found and solved this many times per step; auto: as few as keep overlaps to "
                 "what response.quality says, 1 to 4 with quality 1"),
      },
      check_time);
}

Codec<MaterialEntry> material_section() {
  using T = MaterialEntry;
  return section<T>(
      "materials.<name>", "What bodies are made of. The names are yours; bodies and contacts refer to them.",
      {
          key<T>("density", &T::density, number(above_zero, "kg/m^3"), optionally, "mass per volume"),
          key<T>("restitution", &T::restitution, number(between(0, 1)), optionally,
                 "share of the approach speed that an impact gives back"),
          key<T>("friction", &T::friction, number(not_negative), optionally, "Coulomb's coefficient"),
          with_default(
              key<T>("rolling_friction", &T::rolling_friction, optional(number(not_negative)), optionally,
                     "coefficient of rolling friction: the moment against rolling is at most this times the "
                     "normal force times the radius. A ball starts to roll on a slope with this tangent"),
              "0"),
      });
}

Codec<ContactEntry> contact_section() {
  using T = ContactEntry;
  return section<T>(
      "contacts[]",
      "Laws of pairs of materials. For a pair that is not listed, and for a value that is left out, it is "
      "the geometric mean of the two materials' values.",
      {
          key<T>("between", &T::between, array_of<2>(identifier()), required,
                 "the two materials, in any order"),
          key<T>("restitution", &T::restitution, optional(number(between(0, 1))), optionally, "of the pair"),
          key<T>("friction", &T::friction, optional(number(not_negative)), optionally, "of the pair"),
          key<T>("rolling_friction", &T::rolling_friction, optional(number(not_negative)), optionally,
                 "of the pair"),
      });
}

Codec<ForceEntry> force_section() {
  using T = ForceEntry;
  return section<T>(
      "forces[]",
      "A constant force on the centre of a body, a torque, or both, in the world frame. They act for from <= "
      "t < until; for both times the nearest step is taken.",
      {
          key<T>(
              "on", &T::on, text(), required,
              "name of a free body; of a repeat or scatter, `name[3]` is one of its bodies and `name` each"),
          key<T>("force", &T::force, vector("N"), optionally, "on the centre"),
          key<T>("torque", &T::torque, vector("N m"), optionally, "about the centre"),
          key<T>("from", &T::from, number(not_negative, "s"), optionally, "when it starts to act"),
          key<T>("until", &T::until, optional(number(above_zero, "s")), optionally,
                 "when it ends; at the end of the run if not given"),
      },
      check_force);
}

Codec<Region> region_section() {
  using T = Region;
  return section<T>(
      "regions.<name>",
      "A box to measure in, its faces along the world's axes, or one that takes bodies out. The names are "
      "yours; see Measures.",
      {
          key<T>("from", &T::from, vector("m"), required, "lower corner"),
          key<T>("to", &T::to, vector("m"), required, "upper corner"),
          with_default(key<T>("removes", &T::removes, optional(boolean()), optionally,
                              "free bodies whose centre is in the box at the end of a step are taken out, "
                              "and counted as gone"),
                       "false"),
      },
      check_region);
}

Codec<World> world_section() {
  using T = World;
  return section<T>(
      "world", "A box, its faces along the world's axes, in which the bodies are expected to stay.",
      {
          key<T>("from", &T::from, vector("m"), required, "lower corner"),
          key<T>("to", &T::to, vector("m"), required, "upper corner"),
          key<T>("leaving", &T::leaving,
                 word<Leaving>(
                     {{"stop", Leaving::stop}, {"remove", Leaving::remove}, {"ignore", Leaving::ignore}}),
                 optionally,
                 "what happens if the centre of a free body leaves it. stop: the run stops with the state "
                 "before. remove: the body is taken out and counted (guards.left). ignore: nothing"),
      },
      check_world);
}

Codec<PeriodicEntry> periodic_section() {
  using T = PeriodicEntry;
  const auto ends = optional(array_of<2>(number(any_value, "m")));
  return section<T>(
      "periodic",
      "A space that repeats: what leaves the cell at one end comes in at the other, and bodies meet through "
      "its ends. Positions are counted on from period to period: a body that went through twice is two "
      "periods away. So is potential energy along a periodic axis. Regions and pictures use the image in the "
      "cell. Planes must be parallel to periodic axes. Momentum is conserved. Angular momentum about the "
      "origin is not, because such a space is not the same in all directions.",
      {
          key<T>("x", &T::x, ends, optionally, "[low, high]: the cell's ends along x"),
          key<T>("y", &T::y, ends, optionally, "along y"),
          key<T>("z", &T::z, ends, optionally, "along z"),
      },
      check_periodic);
}

Codec<std::optional<TrajectorySettings>> trajectory_section() {
  using T = TrajectorySettings;
  using Maybe = std::optional<T>;
  const Codec<Maybe> whether{word_type({"false", "true"}),
                             [](Maybe& trajectory, const Node& node, Reader&) {
                               trajectory = node.text == "true" ? Maybe(T{}) : std::nullopt;
                             },
                             [](const Maybe& trajectory) {
                               return trajectory ? std::nullopt : std::optional(Node::scalar("false"));
                             }};
  return any_of<Maybe>(
      {whether,
       optional(section<T>(
           "record.trajectory",
           "trajectory.vtkhdf: number, place, size, shape, material and mobility of every body, and what "
           "else "
           "is asked for; `true` stands for the defaults.",
           {
               with_default(key<T>("every", &T::every, optional(number(above_zero, "s")), optionally,
                                   "simulated time between frames; a frame for each picture if not given"),
                            ""),
               key<T>("orientation", &T::orientation, boolean(), optionally,
                      "with the orientations, as quaternions w, x, y, z"),
               key<T>("velocity", &T::velocity, boolean(), optionally, "with the velocities"),
               key<T>("spin", &T::spin, boolean(), optionally, "with the angular velocities"),
               key<T>("precision", &T::in_double, word<bool>({{"single", false}, {"double", true}}),
                      optionally, "of the real numbers in the file"),
               with_default(key<T>("contacts", &T::contacts, optional(boolean()), optionally,
                                   "contacts.vtkhdf beside it: a line from body to body for each contact "
                                   "that carries a force, with that force"),
                            "false"),
           }))});
}

Codec<RecordSettings> record_section() {
  using T = RecordSettings;
  return section<T>(
      "record", "What a run writes besides pictures.",
      {
          key<T>("metrics_every", &T::metrics_every, number(above_zero, "s"), optionally,
                 "simulated time between rows of metrics.csv"),
          key<T>("trajectory", &T::trajectory, trajectory_section(), optionally, "the motion of every body"),
          key<T>("checkpoint_every", &T::checkpoint_every, number(above_zero, "s"), optionally,
                 "wall time between saved states that `--resume` can go on from"),
      });
}

Codec<GravityKey> gravity_key_section() {
  using T = GravityKey;
  return section<T>(
      "gravity.keyframes[]", "Gravity at one time.",
      {
          key<T>("at", &T::at, number(not_negative, "s"), required, "time"),
          key<T>("vector", &T::vector, vector("m/s^2"), required, "acceleration of free bodies"),
      });
}

/// Makes the codec of gravity: a vector, or a section if gravity changes with time.
Codec<GravityEntry> gravity_value() {
  using T = GravityEntry;
  const Codec<Vec3> constant = vector("m/s^2");
  const Codec<T> plain{constant.type,
                       [constant](T& gravity, const Node& node, Reader& reader) {
                         constant.read(gravity.vector, node, reader);
                       },
                       [constant](const T& gravity) {
                         return gravity.spin || !gravity.keyframes.empty() ? std::nullopt
                                                                           : constant.write(gravity.vector);
                       }};
  Key<T> at_start = key<T>("vector", &T::vector, constant, optionally, "at t = 0");
  at_start.type.fallback.clear();
  at_start.write = [write = at_start.write](const T& gravity) {
    return gravity.spin ? write(gravity) : std::nullopt;
  };
  return any_of<T>(
      {plain, section<T>("gravity",
                         "Gravity that turns or changes with time. Only this force is computed, as in a "
                         "frame that turns slowly. The centrifugal and Coriolis forces of a frame that turns "
                         "fast are left out. The work of the change is part of energy.work.",
                         {
                             std::move(at_start),
                             key<T>("spin", &T::spin, optional(vector("rad/s")), optionally,
                                    "constant angular velocity of the vector, from t = 0 on"),
                             key<T>("keyframes", &T::keyframes, list_of(gravity_key_section(), 1), optionally,
                                    "instead of these: gravity at ascending times, linear between them, "
                                    "constant before the first and after the last"),
                         },
                         check_gravity)});
}

Codec<Reduce> reduce_word() {
  using enum Reduce;
  return word<Reduce>({{"max", max},
                       {"min", min},
                       {"mean", mean},
                       {"drift", drift},
                       {"range", range},
                       {"crossings", crossings}});
}

/// Makes the key `level`. It is left out of the resolved scene unless crossings are counted, because it is
/// refused otherwise.
Key<CheckEntry> crossings_level() {
  using T = CheckEntry;
  Key<T> level = with_default(
      key<T>("level", &T::level, number(), optionally, "of crossings, in the unit of the measure"), "0");
  level.write = [write = level.write](const T& check) {
    return check.reduce == Reduce::crossings ? write(check) : std::nullopt;
  };
  return level;
}

Codec<CheckEntry> check_section() {
  using T = CheckEntry;
  return section<T>(
      "checks[]", "The scene's own acceptance test. Each compares a measure with what is expected.",
      {
          key<T>("measure", &T::measure, text(), required, "what is measured; see Measures"),
          key<T>("at", &T::at, optional(number(not_negative, "s")), optionally,
                 "when: at the step nearest to this time; at the end if neither `at` nor `over` is given"),
          key<T>("over", &T::over, optional(array_of<2>(number(not_negative, "s"))), optionally,
                 "[start, end]: over every step between, ends included; needs `reduce`"),
          key<T>("reduce", &T::reduce, reduce_word(), optionally,
                 "what is made of the values in `over`; drift: the largest change since its start; "
                 "crossings: how often they pass `level`"),
          crossings_level(),
          key<T>("expect", &T::expect, optional(number()), optionally,
                 "the value, within `tolerance` or `relative`"),
          key<T>("tolerance", &T::tolerance, optional(number(not_negative)), optionally,
                 "of `expect`, in the unit of the measure"),
          key<T>("relative", &T::relative, optional(number(not_negative)), optionally,
                 "of `expect`, as a share"),
          key<T>("below", &T::below, optional(number()), optionally, "the measure must be less"),
          key<T>("above", &T::above, optional(number()), optionally, "the measure must be more"),
          key<T>("in_default_mode", &T::in_default_mode, optional(number()), optionally,
                 "takes the place of `tolerance`, `relative`, `below` or `above` where response.mode is "
                 "default"),
          key<T>("confidence", &T::confidence, optional(number(between(0, 1))), optionally,
                 "of the mean over the `seeds`: its whole confidence interval of this level (Student's t) "
                 "must lie within the limits; without it, each seed by itself must"),
      },
      check_check);
}

}  // namespace

const Codec<SceneEntry>& scene_codec() {
  using T = SceneEntry;
  static const Codec<T> codec = section<T>(
      "scene", "The top of a scene file.",
      {
          key<T>("format", &T::format, integer(between(1, 1)), required, "version of the scene language"),
          key<T>("name", &T::name, file_name(), optionally,
                 "names the run folder; the file's stem if not given"),
          key<T>("label", &T::label, identifier(), optionally,
                 "`long` scenes are left out of verify unless asked for"),
          key<T>("seed", &T::seed, seed_integer(), optionally, "every random choice follows from it"),
          key<T>("seeds", &T::seeds, integer(between(1, 1000)), optionally,
                 "number of runs, with seed, seed + 1, ..., that verify and study judge together; run makes "
                 "the first one"),
          key<T>("gravity", &T::gravity, gravity_value(), optionally,
                 "acceleration of free bodies; a map if it changes with time"),
          key<T>("time", &T::time, time_section(), required, "length and step of the run"),
          key<T>("materials", &T::materials, named(material_section(), most_names), required,
                 "a map of names to materials"),
          key<T>("contacts", &T::contacts, list_of(contact_section()), optionally,
                 "laws of pairs of materials"),
          key<T>("bodies", &T::bodies, list_of(body_section(), 1), required, "the bodies"),
          key<T>("forces", &T::forces, list_of(force_section()), optionally, "forces besides gravity"),
          key<T>("periodic", &T::periodic, optional(periodic_section()), optionally,
                 "axes along which the space repeats; none if not given"),
          key<T>("world", &T::world, optional(world_section()), optionally,
                 "where bodies are expected to stay; anywhere if not given"),
          key<T>("regions", &T::regions, named(region_section(), most_names), optionally,
                 "a map of names to boxes to measure in"),
          key<T>("response", &T::response, response_section(), optionally,
                 "how contact impulses are computed"),
          key<T>("broadphase", &T::broadphase, broadphase_section(), optionally, "how pairs are found"),
          key<T>("narrowphase", &T::narrowphase, narrowphase_section(), optionally, "how contacts are found"),
          key<T>("precision", &T::precision,
                 word<Precision>({{"double", Precision::double_precision}, {"mixed", Precision::mixed}}),
                 optionally,
                 "precision of the response. mixed: impulses and their velocities are in float, which is "
                 "faster and exact to 1e-7; the state stays in double. The accurate mode has double only"),
          key<T>("model", &T::model, model_section(), optionally, "features to compute"),
          key<T>("render", &T::render, render_section(), optionally, "the pictures"),
          key<T>("record", &T::record, record_section(), optionally, "what is written besides"),
          key<T>("checks", &T::checks, list_of(check_section()), optionally, "the scene's own test"),
          future<T>("crosscheck", "the run again by other means, compared"),
      },
      [](const T& scene, const Node& node, Reader& reader) {
        check_precision(scene, node, reader);
        check_in_period(scene, node, reader);
      });
  return codec;
}

}  // namespace scree
