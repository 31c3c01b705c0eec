// The engine ODE, in double precision, behind the interface of the benchmark.
#include "bench/peers/engine.hpp"
#include "core/error.hpp"

#include <map>
#include <ode/ode.h>

namespace scree::bench {

namespace {

static_assert(sizeof(dReal) == sizeof(double));

/// The settings of ODE. ODE has no friction cone but a pyramid. The pyramid has the orientation that ODE
/// chooses, or an axis along the slip: then its friction has the size and the direction of the cone's.
struct OdeSetting {
  int iterations;           // iterations of the quick step; 0: the direct step, a pivoting solver
  double erp = 0.2;         // share of an overlap that is to vanish in a step, by velocity
  bool along_slip = false;  // whether the pyramids have an axis along the slip
};

const std::map<std::string, OdeSetting> settings = {
    {"quick-10", {10}},
    {"quick-50", {50}},
    {"direct", {0}},
    {"direct-no-erp", {.iterations = 0, .erp = 0}},
    {"quick-10-slip", {.iterations = 10, .erp = 0, .along_slip = true}},
    {"direct-slip", {.iterations = 0, .erp = 0, .along_slip = true}},
};

struct Destroy {
  void operator()(dWorldID world) const { dWorldDestroy(world); }
  void operator()(dSpaceID space) const { dSpaceDestroy(space); }
  void operator()(dJointGroupID group) const { dJointGroupDestroy(group); }
};
template <class Handle>
using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Destroy>;

/// Creates a world. The library's own state lives as long as the program.
dWorldID create_world() {
  static const struct Library {
    Library() { dInitODE2(0); }
    ~Library() { dCloseODE(); }
  } library;
  return dWorldCreate();
}

Vec3 from_ode(const dReal* v) { return {v[0], v[1], v[2]}; }

class OdeEngine : public Engine {
 public:
  OdeEngine(const OdeSetting& setting, const Scene& scene, double step)
      : scene_(scene), setting_(setting), step_(step), forces_(constant_forces(scene, "ODE")) {
    dWorldSetGravity(world_.get(), scene.gravity.x(), scene.gravity.y(), scene.gravity.z());
    dWorldSetERP(world_.get(), setting.erp);
    if (setting.iterations > 0) dWorldSetQuickStepNumIterations(world_.get(), setting.iterations);
    for (std::size_t k = 0; k < scene.bodies.position.size(); ++k) add_body(k);
  }

  void step() override {
    for (const AppliedForce& load : forces_)
      for (std::int32_t k = load.on.first; k < load.on.first + load.on.count; ++k) {
        dBodyAddForce(bodies_[k], load.force.x(), load.force.y(), load.force.z());
        dBodyAddTorque(bodies_[k], load.torque.x(), load.torque.y(), load.torque.z());
      }
    dSpaceCollide(space_.get(), this, [](void* engine, dGeomID a, dGeomID b) {
      static_cast<OdeEngine*>(engine)->add_contacts(a, b);
    });
    const bool done =
        setting_.iterations > 0 ? dWorldQuickStep(world_.get(), step_) : dWorldStep(world_.get(), step_);
    if (!done) throw RunError("ODE has no memory for the step");
    dJointGroupEmpty(contacts_.get());
  }

  void read(BodyTable& bodies) const override {
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
      const dBodyID body = bodies_[k];
      if (!body) continue;
      const dReal* q = dBodyGetQuaternion(body);
      bodies.position[k] = from_ode(dBodyGetPosition(body));
      bodies.orientation[k] = Quat(q[0], q[1], q[2], q[3]);
      bodies.velocity[k] = from_ode(dBodyGetLinearVel(body));
      bodies.spin[k] = from_ode(dBodyGetAngularVel(body));
    }
  }

 private:
  dGeomID make_geometry(std::size_t k) {
    const Vec3& size = scene_.bodies.size[k];
    switch (scene_.bodies.shape[k]) {
      case Shape::sphere:
        return dCreateSphere(space_.get(), size.x());
      case Shape::box:
        return dCreateBox(space_.get(), 2 * size.x(), 2 * size.y(), 2 * size.z());
      case Shape::plane: {
        const Vec3 up = scene_.bodies.orientation[k] * Vec3::UnitZ();
        return dCreatePlane(space_.get(), up.x(), up.y(), up.z(), up.dot(scene_.bodies.position[k]));
      }
      default:
        throw refused_by("ODE");
    }
  }

  dBodyID make_body(std::size_t k) {
    const BodyTable& all = scene_.bodies;
    const Vec3 inertia = all.inverse_inertia[k].cwiseInverse();
    dMass mass;
    dMassSetParameters(&mass, 1 / all.inverse_mass[k], 0, 0, 0, inertia.x(), inertia.y(), inertia.z(), 0, 0,
                       0);
    const dBodyID body = dBodyCreate(world_.get());
    dBodySetMass(body, &mass);
    dBodySetLinearVel(body, all.velocity[k].x(), all.velocity[k].y(), all.velocity[k].z());
    dBodySetAngularVel(body, all.spin[k].x(), all.spin[k].y(), all.spin[k].z());
    return body;
  }

  void add_body(std::size_t k) {
    const BodyTable& all = scene_.bodies;
    if (all.mobility[k] == Mobility::prescribed) throw refused_by("ODE");
    const dGeomID geometry = make_geometry(k);
    dGeomSetData(geometry, const_cast<std::int32_t*>(&all.material[k]));
    bodies_.push_back(all.mobility[k] == Mobility::free ? make_body(k) : nullptr);
    if (bodies_.back()) dGeomSetBody(geometry, bodies_.back());
    if (all.shape[k] == Shape::plane) return;  // a plane has its place already
    const Quat& q = all.orientation[k];
    const dQuaternion turn = {q.w(), q.x(), q.y(), q.z()};
    dGeomSetPosition(geometry, all.position[k].x(), all.position[k].y(), all.position[k].z());
    dGeomSetQuaternion(geometry, turn);
  }

  /// Returns the velocity that a point of a body would have after the step without contacts (m/s).
  Vec3 velocity_to_come(dBodyID body, const dReal* point) const {
    if (!body) return Vec3::Zero();
    dVector3 now;
    dBodyGetPointVel(body, point[0], point[1], point[2], now);
    dMass mass;
    dBodyGetMass(body, &mass);
    return from_ode(now) + step_ * (from_ode(dBodyGetForce(body)) / mass.mass + scene_.gravity);
  }

  void align_friction(dContact& contact, dBodyID first, dBodyID second) const {
    const Vec3 normal = from_ode(contact.geom.normal);
    const Vec3 velocity =
        velocity_to_come(first, contact.geom.pos) - velocity_to_come(second, contact.geom.pos);
    const Vec3 slip = velocity - velocity.dot(normal) * normal;
    if (slip.norm() < 1e-9) return;  // m/s; the contact sticks, and any direction will do
    contact.surface.mode |= dContactFDir1;
    Eigen::Map<Vec3>(contact.fdir1) = slip.normalized();
  }

  void add_contacts(dGeomID a, dGeomID b) {
    const dBodyID first = dGeomGetBody(a), second = dGeomGetBody(b);
    if (!first && !second) return;
    constexpr int most = 8;  // two boxes give no more
    dContactGeom found[most];
    const int count = dCollide(a, b, most, found, sizeof(dContactGeom));
    const auto material = [](dGeomID g) { return *static_cast<const std::int32_t*>(dGeomGetData(g)); };
    const ContactLaw& law = scene_.law(material(a), material(b));
    dContact contact{};
    contact.surface.mode = dContactApprox1 | (law.restitution > 0 ? dContactBounce : 0);
    contact.surface.mu = law.friction;
    contact.surface.bounce = law.restitution;
    for (int k = 0; k < count; ++k) {
      contact.geom = found[k];
      if (setting_.along_slip) align_friction(contact, first, second);
      dJointAttach(dJointCreateContact(world_.get(), contacts_.get(), &contact), first, second);
    }
  }

  const Scene& scene_;
  OdeSetting setting_;
  double step_;
  const std::vector<AppliedForce>& forces_;
  Owned<dWorldID> world_{create_world()};                // the world owns the bodies
  Owned<dSpaceID> space_{dHashSpaceCreate(nullptr)};     // the space owns the geometries
  Owned<dJointGroupID> contacts_{dJointGroupCreate(0)};  // contacts of one step
  std::vector<dBodyID> bodies_;                          // in the order of the scene; null for fixed bodies
};

}  // namespace

std::unique_ptr<Engine> make_ode(const std::string& setting, const Scene& scene, double step) {
  return std::make_unique<OdeEngine>(find_setting(settings, setting, "ODE"), scene, step);
}

}  // namespace scree::bench
