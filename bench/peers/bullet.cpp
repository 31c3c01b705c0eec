// The engine Bullet, in double precision, behind the interface of the benchmark.
#include "bench/peers/engine.hpp"

#include <btBulletDynamicsCommon.h>
#include <map>

namespace scree::bench {

namespace {

static_assert(sizeof(btScalar) == sizeof(double));

/// The settings of Bullet. The initial values are Bullet's own defaults. In "tuned", overlaps of any depth
/// are corrected without velocity, every approach bounces, and contacts do not act at a distance, so that a
/// ball keeps its energy. Without erp, overlaps are not corrected. In "wide", contacts are found all at once
/// and kept however far a body slides; otherwise a sliding body loses them now and then and falls for a step.
struct BulletSetting {
  int iterations = 10;
  bool continuous = false;                 // whether small fast bodies have continuous detection
  double restitution_threshold = 0.2;      // least approach speed that bounces (m/s)
  double split_impulse_threshold = -0.04;  // deeper overlaps (m) are corrected without velocity
  double contact_distance = 0.02;          // contacts are kept up to this share of the smaller radius
  double warm_start = 0.85;                // share of the last impulses with which the solver starts
  double erp = 0.2;                        // share of an overlap that is to vanish in a step
  bool all_plane_contacts = false;         // all contacts with a plane at once, else one more per step
};

const std::map<std::string, BulletSetting> settings = {
    {"default", {}},
    {"continuous", {.continuous = true}},
    {"tuned", {.restitution_threshold = 0, .split_impulse_threshold = 0, .contact_distance = 0.0005}},
    {"tuned-50",
     {.iterations = 50,
      .restitution_threshold = 0,
      .split_impulse_threshold = 0,
      .contact_distance = 0.0005,
      .warm_start = 1}},
    {"no-erp", {.restitution_threshold = 0, .contact_distance = 0.0005, .erp = 0}},
    {"no-erp-wide", {.contact_distance = 0.5, .erp = 0, .all_plane_contacts = true}},
    {"no-erp-wide-200", {.iterations = 200, .contact_distance = 0.5, .erp = 0, .all_plane_contacts = true}},
};

btVector3 to_bullet(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
Vec3 from_bullet(const btVector3& v) { return {v.x(), v.y(), v.z()}; }

/// Returns the contact law of two bodies' materials. A body's user pointer is the scene, its user index the
/// material.
const ContactLaw& law_of(const btCollisionObject* a, const btCollisionObject* b) {
  return static_cast<const Scene*>(a->getUserPointer())->law(a->getUserIndex(), b->getUserIndex());
}
btScalar friction_of(const btCollisionObject* a, const btCollisionObject* b) { return law_of(a, b).friction; }
btScalar restitution_of(const btCollisionObject* a, const btCollisionObject* b) {
  return law_of(a, b).restitution;
}

std::unique_ptr<btCollisionShape> shape_of(const BodyTable& bodies, std::size_t k) {
  switch (bodies.shape[k]) {
    case Shape::sphere:
      return std::make_unique<btSphereShape>(bodies.size[k].x());
    case Shape::box:
      return std::make_unique<btBoxShape>(to_bullet(bodies.size[k]));
    case Shape::plane:
      return std::make_unique<btStaticPlaneShape>(btVector3(0, 0, 1), 0);
    default:
      throw refused_by("Bullet");
  }
}

class BulletEngine : public Engine {
 public:
  BulletEngine(const BulletSetting& setting, const Scene& scene, double step)
      : scene_(scene), step_(step), forces_(constant_forces(scene, "Bullet")) {
    gCalculateCombinedFrictionCallback = friction_of;
    gCalculateCombinedRestitutionCallback = restitution_of;
    world_.setGravity(to_bullet(scene.gravity));
    btContactSolverInfo& solver = world_.getSolverInfo();
    solver.m_numIterations = setting.iterations;
    solver.m_restitutionVelocityThreshold = setting.restitution_threshold;
    solver.m_splitImpulsePenetrationThreshold = setting.split_impulse_threshold;
    solver.m_warmstartingFactor = setting.warm_start;
    solver.m_erp2 = setting.erp;
    if (setting.all_plane_contacts) configuration_.setPlaneConvexMultipointIterations();
    gContactBreakingThreshold = setting.contact_distance;
    for (std::size_t k = 0; k < scene.bodies.position.size(); ++k) add_body(k, setting.continuous);
  }

  void step() override {
    for (const AppliedForce& load : forces_)
      for (std::int32_t k = load.on.first; k < load.on.first + load.on.count; ++k) {
        bodies_[k]->applyCentralForce(to_bullet(load.force));
        bodies_[k]->applyTorque(to_bullet(load.torque));
      }
    world_.stepSimulation(step_, 0);
  }

  void read(BodyTable& bodies) const override {
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
      const btRigidBody& body = *bodies_[k];
      const btQuaternion q = body.getOrientation();
      bodies.position[k] = from_bullet(body.getCenterOfMassPosition());
      bodies.orientation[k] = Quat(q.w(), q.x(), q.y(), q.z());
      bodies.velocity[k] = from_bullet(body.getLinearVelocity());
      bodies.spin[k] = from_bullet(body.getAngularVelocity());
    }
  }

 private:
  void add_body(std::size_t k, bool continuous) {
    const BodyTable& all = scene_.bodies;
    if (all.mobility[k] == Mobility::prescribed) throw refused_by("Bullet");
    shapes_.push_back(shape_of(all, k));
    const bool free = all.mobility[k] == Mobility::free;
    const double mass = free ? 1 / all.inverse_mass[k] : 0;
    const Vec3 inertia = free ? Vec3(all.inverse_inertia[k].cwiseInverse()) : Vec3::Zero();
    auto body = std::make_unique<btRigidBody>(mass, nullptr, shapes_.back().get(), to_bullet(inertia));
    const Quat& q = all.orientation[k];
    body->setCenterOfMassTransform(
        btTransform(btQuaternion(q.x(), q.y(), q.z(), q.w()), to_bullet(all.position[k])));
    body->setLinearVelocity(to_bullet(all.velocity[k]));
    body->setAngularVelocity(to_bullet(all.spin[k]));
    body->setActivationState(DISABLE_DEACTIVATION);
    body->setUserPointer(const_cast<Scene*>(&scene_));
    body->setUserIndex(all.material[k]);
    if (continuous && free) {
      const double size = smallest_size(all.shape[k], all.size[k]);
      body->setCcdMotionThreshold(size);
      body->setCcdSweptSphereRadius(0.5 * size);
    }
    world_.addRigidBody(body.get());
    bodies_.push_back(std::move(body));
  }

  const Scene& scene_;
  double step_;
  const std::vector<AppliedForce>& forces_;
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;  // in the order of the scene
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
};

}  // namespace

std::unique_ptr<Engine> make_bullet(const std::string& setting, const Scene& scene, double step) {
  return std::make_unique<BulletEngine>(find_setting(settings, setting, "Bullet"), scene, step);
}

}  // namespace scree::bench
