#include "sim/scene/hints.hpp"

#include <algorithm>
#include <string>

namespace scree {
namespace {

constexpr std::string_view rigid =
    "bodies are rigid: leave it out; `restitution` says how much speed an impact keeps";
constexpr std::string_view not_modelled = "is not modelled: leave it out";
constexpr std::string_view of_material = "belongs to the material: write it in `materials`";
constexpr std::string_view of_time = "write `time: {end: 2, step: 0.001}`, in seconds";
constexpr std::string_view to_spin = "write `spin`, a vector in rad/s";

// clang-format off
constexpr Hint hints[] = {
    {"scene", "dt timestep timesteps deltat step stepsize duration end endtime tend tmax steps nsteps substeps length", of_time},
    {"scene", "g acceleration", "write `gravity: [0, 0, -9.81]`"},
    {"scene", "objects particles rigidbodies shapes geoms entities actors items balls spheres boxes", "write `bodies`, a list of maps"},
    {"scene", "title scene id", "write `name`"},
    {"scene", "version schema", "write `format: 1`"},
    {"scene", "camera fps resolution color colour lights view film video movie pictures", "belongs to the pictures: write it in `render`"},
    {"scene", "output save log metrics trajectory checkpoint outputinterval", "belongs to the output: write it in `record`"},
    {"scene", "solver iterations tolerance mode integrator restitutionthreshold warmstart", "belongs to the contact response: write it in `response`"},
    {"scene", "domain boundary boundaries bounds walls box", "write `world` where bodies must stay, `periodic` for a space that repeats, or bodies that are walls"},
    {"scene", "friction mu restitution cor density rho", of_material},
    {"scene", "threads device gpu cpu cores", "belongs to the command line: --threads, --device"},
    {"scene", "units unit", "units are SI: leave it out"},
    {"scene", "damping drag wind viscosity air airresistance fluid joints constraints springs", not_modelled},

    {"time", "dt timestep deltat h stepsize delta", "write `step`, in seconds"},
    {"time", "duration endtime tend tmax stop total length until final simulationtime", "write `end`, in seconds"},
    {"time", "steps nsteps numsteps numberofsteps iterations", "write `end`: steps times `step`"},
    {"time", "nsubsteps substepping", "write `substeps`"},
    {"time", "start begin tstart", "a run starts at 0: leave it out"},
    {"time", "fps framerate", "belongs to the pictures: write it in `render`"},

    {"materials.<name> contacts[]",
     "mu static staticfriction dynamicfriction kineticfriction slidingfriction frictioncoefficient coefficientoffriction cof mus muk mud staticfrictioncoefficient dynamicfrictioncoefficient",
     "write `friction`: one coefficient, of rest and of sliding"},
    {"materials.<name> contacts[]", "frictionangle", "write `friction`: the tangent of the angle"},
    {"materials.<name> contacts[]",
     "e cor coefficientofrestitution restitutioncoefficient bounciness bounce elasticity coeffrestitution",
     "write `restitution`, from 0 to 1"},
    {"materials.<name> contacts[]",
     "rolling rollingresistance murolling mur crr rollingfrictioncoefficient rollingresistancecoefficient coefficientofrollingfriction",
     "write `rolling_friction`"},
    {"materials.<name> contacts[]", "spinningfriction torsionalfriction twistingfriction drilling cohesion adhesion surfaceenergy surfacetension stickiness", not_modelled},
    {"materials.<name> contacts[]",
     "youngsmodulus youngmodulus young youngs modulus elasticmodulus shearmodulus poisson poissonratio poissonsratio nu stiffness normalstiffness tangentialstiffness kn kt ks spring hardness damping normaldamping contactdamping dampingcoefficient dampingratio gamma gamman gammat viscosity compliance",
     rigid},
    {"materials.<name>", "rho massdensity densitykg densitykgm3 densitykgpm3 specificmass volumetricmass", "write `density`, in kg/m^3"},
    {"materials.<name>", "mass weight", "belongs to a body: write `mass` there, or `density` here"},
    {"materials.<name> bodies[]", "color colour rgb rgba", "what colours show is one for all: write `color` in `render`"},
    {"contacts[]", "pair materials material bodies of a b first", "write `between: [glass, steel]`, two names of `materials`"},

    {"bodies[]", "position pos place location center centre translation origin xyz com x y z r0 initialposition", "write `at: [x, y, z]`, in m"},
    {"bodies[]", "euler eulerangles rpy roll pitch yaw angle angles axisangle rotation heading tilt", "write `rotate: {axis: [0, 0, 1], degrees: 30}`, or `orientation: [w, x, y, z]`"},
    {"bodies[]", "quaternion quat q attitude rot pose", "write `orientation: [w, x, y, z]`, w first"},
    {"bodies[]", "vel linearvelocity linvel initialvelocity speed v v0", "write `velocity`, a vector in m/s"},
    {"bodies[] bodies[].motion", "angularvelocity angvel rotationalvelocity rotationalspeed angularspeed omega w w0", to_spin},
    {"bodies[] bodies[].motion", "rpm revolutionsperminute", "write `spin`, a vector in rad/s: rpm times pi / 30"},
    {"bodies[]", "static isstatic kinematic dynamic isdynamic frozen anchored immovable movable free mobility inmotion", "write `fixed: true` for what never moves, `motion` for what moves as prescribed; else a body is free"},
    {"bodies[]", "ball", "write `sphere: {radius: 0.1}`"},
    {"bodies[]", "cube cuboid brick block rectangle", "write `box: {size: [x, y, z]}`, full edges"},
    {"bodies[]", "pill spherocylinder rod", "write `capsule: {radius: 0.1, length: 1}`"},
    {"bodies[]", "hull convexhull convex polytope convexpolyhedron", "write `polyhedron: {points: [...]}` or `polyhedron: {file: part.stl}`"},
    {"bodies[]", "trimesh trianglemesh triangles stl obj ply", "write `mesh: {file: part.stl}`, which is a boundary, or `polyhedron: {file: part.stl}`, which is its hull"},
    {"bodies[]", "ground floor halfspace wall", "write `plane: {normal: [0, 0, 1], offset: 0}`"},
    {"bodies[]", "pipe drum container", "write `tube: {radius: 1, length: 1}`, the inside of a cylinder"},
    {"bodies[]", "type kind geometry geom collider primitive", "the shape is a key of its own: write `sphere: {radius: 0.1}`"},
    {"bodies[]", "radius diameter r d", "belongs to the shape: write `sphere: {radius: 0.1}`"},
    {"bodies[]", "size halfsize extents halfextents halfextent dimensions dims width height depth", "belongs to the shape: write `box: {size: [x, y, z]}`, full edges"},
    {"bodies[]", "length halflength halfheight", "belongs to the shape: write `cylinder: {radius: 0.1, length: 1}`"},
    {"bodies[]", "points vertices", "belongs to the shape: write `polyhedron: {points: [...]}`"},
    {"bodies[]", "normal offset", "belongs to the shape: write `plane: {normal: [0, 0, 1], offset: 0}`"},
    {"bodies[]", "axis degrees radians", "write `rotate: {axis: [0, 0, 1], degrees: 30}`"},
    {"bodies[]", "csv table path filename data xyzfile lammps dump", "write `file: bed.csv`"},
    {"bodies[]", "density rho friction mu restitution cor rollingfriction staticfriction dynamicfriction bounciness", of_material},
    {"bodies[]", "youngsmodulus youngmodulus young modulus poissonsratio poissonratio stiffness damping lineardamping angulardamping kn kt", rigid},
    {"bodies[]", "drag cohesion charge temperature joint joints constraint spring hinge", not_modelled},
    {"bodies[]", "inertia momentofinertia inertiatensor", "follows from shape and mass: leave it out"},
    {"bodies[]", "weight", "write `mass`, in kg"},
    {"bodies[]", "count number n copies amount", "write `repeat`, `scatter` or `emit`, which have a `count`"},
    {"bodies[]", "force torque", "write it in `forces`, with `on: <name of the body>`"},
    {"bodies[]", "start birth appears begin tstart", "write `from`, in seconds"},
    {"bodies[]", "end death lifetime disappears stop tend", "write `until`, in seconds"},
    {"bodies[]", "id label tag", "write `name`"},
    {"bodies[]", "group layer mask collisiongroup collisionmask collisionfilter category", "any two bodies may touch: leave it out"},

    {"bodies[].sphere bodies[].tube bodies[].capsule bodies[].cylinder", "diameter d dia", "write `radius`, half of it"},
    {"bodies[].sphere bodies[].tube bodies[].capsule bodies[].cylinder", "r rad size", "write `radius`, in m"},
    {"bodies[].sphere.radius", "diameter", "these are radii: write half of it"},
    {"bodies[].capsule", "height h l segment", "write `length`, of the segment: the height less two radii"},
    {"bodies[].cylinder bodies[].tube", "height h l depth thickness", "write `length`, from end to end"},
    {"bodies[].capsule bodies[].cylinder bodies[].tube", "halflength halfheight", "write `length`, twice of it"},
    {"bodies[].box", "halfsize halfextents halfextent halfextend halfsizes halfedges halflengths halfwidth halfdimensions hx hy hz", "write `size: [x, y, z]`, full edges: twice of it"},
    {"bodies[].box", "extents dimensions dims dim lengths edges edge side sides sizes width height depth length lx ly lz x y z", "write `size: [x, y, z]`, full edges"},
    {"bodies[].plane", "point distance dist d height z at position constant", "write `offset`, the plane's distance from the origin along its normal"},
    {"bodies[].plane", "n direction up axis", "write `normal: [0, 0, 1]`"},
    {"bodies[].mesh bodies[].polyhedron", "path filename filepath obj stl ply uri url source mesh", "write `file: part.stl`"},
    {"bodies[].polyhedron", "vertices verts corners", "write `points: [[x, y, z], ...]`"},
    {"bodies[].sphere.radius bodies[].box.size", "min max low high from to range", "write `uniform: [low, high]`"},
    {"bodies[].sphere.radius bodies[].box.size", "normal gaussian mean sd std sigma lognormal", "write `uniform`, `powerlaw` or `choose`: there is no normal distribution"},
    {"bodies[].rotate", "angle deg degree theta", "write `degrees`, or `radians`"},
    {"bodies[].rotate", "rad radian", "write `radians`"},
    {"bodies[].rotate", "vector direction about n", "write `axis: [0, 0, 1]`"},
    {"bodies[].rotate", "euler rpy roll pitch yaw quaternion", "write `axis` and `degrees`; beside `rotate` goes `orientation: [w, x, y, z]`"},
    {"bodies[].motion", "vel linearvelocity v speed", "write `velocity`, a vector in m/s"},
    {"bodies[].motion", "pivot center centre origin point", "write `about: [x, y, z]`, the point to turn about"},
    {"bodies[].motion", "axis", "write `spin`, a vector along the axis"},
    {"bodies[].motion", "amplitude frequency period displacement", "write `oscillate: {displacement: [x, y, z], frequency: 1}`"},
    {"bodies[].motion", "path waypoints trajectory positions", "write `keyframes`, a list of maps {at, position}"},
    {"bodies[].motion.oscillate", "amplitude", "write `displacement` in m, or `angle` in rad, a vector"},
    {"bodies[].motion.oscillate", "omega angularfrequency w", "write `frequency` in Hz: omega / (2 pi)"},
    {"bodies[].motion.oscillate", "period", "write `frequency`: 1 / period"},
    {"bodies[].motion.keyframes[] render.camera.keyframes[] gravity.keyframes[]", "time t when", "write `at`, in seconds"},
    {"bodies[].motion.keyframes[]", "pos place x", "write `position: [x, y, z]`"},
    {"bodies[].motion.keyframes[]", "quaternion quat q", "write `orientation: [w, x, y, z]`, w first"},
    {"bodies[].servo", "direction dir n normal", "write `axis`"},
    {"bodies[].servo", "f load pressure", "write `force`, in N"},
    {"bodies[].repeat", "n number counts copies shape", "write `count: [nx, ny, nz]`"},
    {"bodies[].repeat", "step pitch distance gap delta offset", "write `spacing: [x, y, z]`, between centres"},
    {"bodies[].repeat", "noise random perturbation", "write `jitter`, in m"},
    {"bodies[].scatter bodies[].emit", "n number amount", "write `count`"},
    {"bodies[].scatter bodies[].emit world regions.<name>", "min minimum low lower start lo begin", "write `from: [x, y, z]`, the lower corner"},
    {"bodies[].scatter bodies[].emit world regions.<name>", "max maximum high upper stop hi end", "write `to: [x, y, z]`, the upper corner"},
    {"bodies[].scatter bodies[].emit world regions.<name>", "region box size center centre extents bounds at position", "write `from` and `to`, two corners"},
    {"bodies[].emit", "frequency persecond flow flux", "write `rate`, bodies a second"},
    {"bodies[].emit", "interval period every dt", "write `rate`: 1 / interval"},

    {"forces[]", "body bodies target name object", "write `on: <name of the body>`"},
    {"forces[]", "value vector f magnitude", "write `force: [x, y, z]`, in N"},
    {"forces[]", "moment m", "write `torque: [x, y, z]`, in N m"},
    {"forces[]", "at point position", "a force acts on the centre: write the rest as `torque`"},
    {"forces[]", "start begin tstart", "write `from`, in seconds"},
    {"forces[]", "end stop to duration tend", "write `until`, in seconds"},
    {"forces[] checks[]", "true", "a reader of YAML 1.1 has made this of `on`: write \"on\" in quotes, or use a reader of YAML 1.2"},
    {"periodic", "min max low high from to size box cell lattice axes length", "write `x: [low, high]`, `y` and `z`"},
    {"gravity", "value acceleration g magnitude direction", "write `gravity: [0, 0, -9.81]`; a map has `vector` and `spin`, or `keyframes`"},
    {"gravity", "omega angularvelocity", to_spin},

    {"response", "sweeps maxiterations iteration niterations numiterations solveriterations maxiter positioniterations velocityiterations", "write `iterations`"},
    {"response", "tol epsilon eps residual", "write `tolerance`"},
    {"response", "solver method type", "write `mode: default` or `mode: accurate`"},
    {"response", "baumgarte erp cfm slop margin contactmargin contactoffset stiffness damping penalty regularization relaxation sor", "there is no such parameter: leave it out; overlap is corrected without a spring"},
    {"response", "restitution friction", of_material},
    {"broadphase narrowphase", "type algorithm kind", "write `method` of broadphase, `box_box` and `convex` of narrowphase"},
    {"model", "rolling", "write `rolling_friction`"},
    {"model", "ccd bullet", "write `continuous: on`"},
    {"model", "gravity", "write `gravity` at the top of the scene"},

    {"render", "width height resolution imagesize pixels", "write `size: [1280, 720]`, in pixels"},
    {"render", "framerate framespersecond rate", "write `fps`"},
    {"render", "every interval period", "write `fps`: 1 / interval"},
    {"render", "colorby colourby colormap", "write `color`"},
    {"render", "background lights light sky shadows", "cannot be chosen: leave it out"},
    {"render", "from to fov eye lookat target", "belongs to the camera: write `camera: {from: [x, y, z], to: [x, y, z]}`"},
    {"render.camera render.camera.keyframes[]", "eye position pos location", "write `from: [x, y, z]`"},
    {"render.camera render.camera.keyframes[]", "target lookat focus center centre", "write `to: [x, y, z]`"},
    {"render.camera render.camera.keyframes[]", "fieldofview angle zoom fovy", "write `fov`, in degrees"},
    {"render.camera", "up", "up is against gravity: leave it out"},
    {"render.camera.orbit", "angle rotation", "write `degrees`"},
    {"render.camera.orbit", "speed rate omega rpm", "write `degrees_per_second`"},

    {"record", "every interval dt outputinterval output metrics metricsinterval period", "write `metrics_every`, in seconds"},
    {"record", "fps frames pictures", "belongs to the pictures: write it in `render`"},
    {"record", "checkpoint checkpoints restart", "write `checkpoint_every`, in seconds"},
    {"record", "vtk vtp xyz lammps csv", "write `trajectory: true`; scree export makes it of that"},
    {"record.trajectory", "interval dt period", "write `every`, in seconds"},
    {"record.trajectory", "orientations quaternion", "write `orientation`"},

    {"checks[]", "quantity what name variable", "write `measure`"},
    {"checks[]", "expected equals equal value target is", "write `expect`"},
    {"checks[]", "tol atol abs absolute error", "write `tolerance`"},
    {"checks[]", "rtol rel", "write `relative`, a share"},
    {"checks[]", "max maximum less lessthan lt upper", "write `below`"},
    {"checks[]", "min minimum greater greaterthan gt lower", "write `above`"},
    {"checks[]", "time t when", "write `at`, in seconds"},
    {"checks[]", "interval from between during", "write `over: [start, end]`"},
    {"checks[]", "reduction aggregate op statistic", "write `reduce`"},

    {"column", "diameter d dia", "write a column `radius`, half of it"},
    {"column", "r rad", "write `radius`"},
    {"column", "posx px xpos positionx positionsx centerx centrex xc xcoordinate points0 posy py ypos positiony centery centrey yc ycoordinate points1 posz pz zpos positionz centerz centrez zc zcoordinate points2", "write `x`, `y`, `z`"},
    {"column", "velx velocityx vely velocityy velz velocityz velocity0 velocity1 velocity2 u v", "write `vx`, `vy`, `vz`"},
    {"column", "omegax omegay omegaz angularvelocityx angularvelocityy angularvelocityz spinx spiny spinz", "write `wx`, `wy`, `wz`, in rad/s"},
    {"column", "quatw quatx quaty quatz q0 q1 q2 q3 orientationw orientationx orientationy orientationz", "write `qw`, `qx`, `qy`, `qz`"},
    {"column", "roll pitch yaw euler eulerx eulery eulerz phi theta psi", "write a quaternion: `qw`, `qx`, `qy`, `qz`"},
    {"column", "halfx halfy halfz hx hy hz halfsizex halfsizey halfsizez", "write `size_x`, `size_y`, `size_z`, full edges: twice of it"},
    {"column", "size edge side lx ly lz sx sy sz width depth", "write `size_x`, `size_y`, `size_z`, full edges"},
    {"column", "length height halflength", "write `size_z`, from end to end"},
    {"column", "density rho", "write `mass`, or give the density to a material"},
    {"column", "m weight", "write `mass`, in kg"},
    {"column", "fixed static mobility motion kinematic", "bodies of a file are free: give `fixed: true` beside `file`, and what moves in files of its own"},
    {"column", "friction mu restitution", of_material},
};
// clang-format on

std::string normalised(std::string_view word) {
  std::string text;
  for (const char c : word)
    if (c != '_' && c != '-' && c != ' ' && c != ':')
      text += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return text;
}

bool lists(std::string_view list, std::string_view word) {
  for (std::size_t at = 0; at < list.size();) {
    const std::size_t end = std::min(list.find(' ', at), list.size());
    if (list.substr(at, end - at) == word) return true;
    at = end + 1;
  }
  return false;
}

}  // namespace

std::span<const Hint> hint_table() { return hints; }

std::string_view advice_for(std::string_view section, std::string_view word) {
  const std::string plain = normalised(word);
  const auto found = std::ranges::find_if(
      hints, [&](const Hint& hint) { return lists(hint.sections, section) && lists(hint.words, plain); });
  return found == std::end(hints) ? std::string_view() : found->advice;
}

}  // namespace scree
