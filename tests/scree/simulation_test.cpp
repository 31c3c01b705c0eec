// Tests of the library through its interface: against closed forms, against the state of the program's own
// parts, and against the program's files.
#include "scree/simulation.hpp"

#include "sim/record/checkpoint.hpp"
#include "sim/step/simulation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace scree {
namespace {

namespace fs = std::filesystem;

/// A scene with a ball and two crates above a floor, and a ball that appears later.
const std::string scene_text =
    "format: 1\n"
    "name: heap\n"
    "gravity: [0, 0, -9.81]\n"
    "time: {end: 0.5, step: 0.005}\n"
    "materials: {stone: {density: 1000, restitution: 0.3, friction: 0.4}}\n"
    "bodies:\n"
    "  - {plane: {normal: [0, 0, 1]}, material: stone}\n"
    "  - {sphere: {radius: 0.1}, name: ball, at: [0.05, 0.02, 0.9], velocity: [0.1, 0, 0], material: stone}\n"
    "  - {box: {size: [0.2, 0.3, 0.4]}, name: crate, at: [0, 0, 0.25], repeat: {count: [1, 1, 2], spacing: "
    "[0, 0, "
    "0.42]}, material: stone}\n"
    "  - {sphere: {radius: 0.1}, name: late, at: [2, 0, 1], from: 0.3, material: stone}\n";

Simulation heap(const std::vector<Override>& overrides = {}) {
  return Simulation::from_text(scene_text, "heap.yaml", overrides, {SpaceChoice::host, 1});
}

void run_to_end(Simulation& simulation) {
  while (!simulation.finished()) simulation.step();
}

template <class Error, class Call>
std::string refusal(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  ADD_FAILURE() << "nothing was thrown";
  return {};
}

class LibraryTest : public testing::Test {
 protected:
  LibraryTest() {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~LibraryTest() override { fs::remove_all(folder_); }
  fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }

  const fs::path folder_ =
      fs::temp_directory_path() /
      (std::string("scree-library-") + testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(LibraryTest, LoadsASceneWithOverrides) {
  const Simulation from_file(write("pile.yaml", scene_text), {{"time.step", "0.01"}, {"name", "other"}});
  EXPECT_EQ(from_file.steps_total(), 50);
  EXPECT_EQ(from_file.steps(), 0);
  EXPECT_EQ(from_file.time(), 0);
  EXPECT_EQ(from_file.scene_name(), "other");
  EXPECT_EQ(from_file.space_name(), std::string("host"));
  const std::map<std::string, std::int32_t> names = {
      {"ball", 1}, {"crate[0]", 2}, {"crate[1]", 3}, {"late", 4}};
  EXPECT_EQ(from_file.body_names(), names);

  Simulation here = heap({{"time.step", "0.01"}});
  Simulation again = Simulation::from_text(here.resolved_scene());
  run_to_end(here);
  run_to_end(again);
  EXPECT_EQ(here.time(), 0.5);
  EXPECT_EQ(here.state_hash(), again.state_hash()) << "the resolved scene is the same scene";
  EXPECT_EQ(again.resolved_scene(), here.resolved_scene());
}

TEST_F(LibraryTest, SaysWhatIsWrong) {
  const auto loading = [](const std::vector<Override>& overrides) { return [=] { heap(overrides); }; };
  EXPECT_EQ(
      refusal<InputError>([] { Simulation::from_text("format: 1\nbodys: []\n", "some.yaml"); }).substr(0, 14),
      "some.yaml:2:1:");
  EXPECT_NE(refusal<InputError>(loading({{"time.stop", "1"}})).find("time.stop"), std::string::npos);
  EXPECT_NE(refusal<InputError>([&] { Simulation(folder_ / "none.yaml"); }).find("none.yaml"),
            std::string::npos);

  Simulation simulation = heap();
  EXPECT_EQ(refusal<InputError>([&] { simulation.measure("bal.position.z"); }),
            "bal.position.z is no measure: there is no body called bal (did you mean ball?)");
  EXPECT_EQ(refusal<InputError>([&] { simulation.read_body(5); }), "there is no body 5: they are 0 to 4");
  EXPECT_EQ(refusal<InputError>([&] { simulation.read_body(-1); }), "there is no body -1: they are 0 to 4");
  run_to_end(simulation);
  const std::uint64_t hash = simulation.state_hash();
  refusal<std::logic_error>([&] { simulation.step(); });
  EXPECT_EQ(simulation.state_hash(), hash);
  EXPECT_EQ(simulation.time(), 0.5);
}

TEST_F(LibraryTest, AStepThatFailsNamesTheBodiesAndLeavesTheStateBeforeIt) {
  Simulation simulation =
      Simulation::from_text(scene_text + "world: {from: [-9, -9, 0.85], to: [9, 9, 9]}\n");
  const std::uint64_t hash = simulation.state_hash();
  try {
    for (;;) simulation.step();
  } catch (const StepFailure& failure) {
    EXPECT_EQ(failure.bodies(), (std::vector<std::int32_t>{2, 3})) << failure.what();
    EXPECT_NE(std::string(failure.what()).find("crate[0]"), std::string::npos) << failure.what();
  }
  EXPECT_EQ(simulation.steps(), 0);
  EXPECT_EQ(simulation.state_hash(), hash);
}

TEST_F(LibraryTest, FallsFreelyByTheClosedForm) {
  Simulation simulation = Simulation::from_text(
      "format: 1\ngravity: [0, 0, -10]\ntime: {end: 1, step: 0.01}\n"
      "materials: {m: {density: 1000}}\n"
      "bodies: [{box: {size: [0.2, 0.4, 0.6]}, at: [1, 2, 3], velocity: [1, 0, 0], "
      "orientation: [0.6, 0.8, 0, 0], material: m}]\n");
  run_to_end(simulation);
  const Body body = simulation.bodies().at(0);
  EXPECT_EQ(body.id, 0);
  EXPECT_EQ(body.shape, Shape::box);
  EXPECT_EQ(body.mobility, Mobility::free);
  EXPECT_EQ(body.size, (Vector{0.1, 0.2, 0.3}));
  EXPECT_NEAR(body.mass, 48, 1e-12);
  EXPECT_NEAR(body.position[0], 2, 1e-12);
  EXPECT_NEAR(body.position[2], 3 - 5, 1e-12);
  EXPECT_NEAR(body.velocity[2], -10, 1e-12);
  EXPECT_NEAR(body.orientation[0], 0.6, 1e-12);
  EXPECT_NEAR(body.orientation[1], 0.8, 1e-12);
  EXPECT_NEAR(simulation.measure("energy.kinetic"), 0.5 * 48 * 101, 1e-9);
}

TEST_F(LibraryTest, BodiesAreThoseOfTheSnapshot) {
  Simulation simulation = heap();
  for (const int until : {0, 30, 100}) {
    while (simulation.steps() < until) simulation.step();
    Snapshot snapshot;
    simulation.snapshot(snapshot);
    const BodyTable& table = snapshot.bodies;
    const std::vector<Body> bodies = simulation.bodies();
    ASSERT_EQ(bodies.size(), 5);
    for (std::size_t k = 0; k < bodies.size(); ++k) {
      const Body one = simulation.read_body(static_cast<std::int32_t>(k));
      for (const Body& body : {bodies[k], one}) {
        EXPECT_EQ(body.mass, 1 / table.inverse_mass[k]);
        EXPECT_EQ(body.id, static_cast<std::int32_t>(k));
        EXPECT_EQ(body.shape, table.shape[k]);
        EXPECT_EQ(body.mobility, table.mobility[k]);
        EXPECT_EQ(Vec3(body.size.data()), table.size[k]);
        EXPECT_EQ(Vec3(body.position.data()), table.position[k]);
        EXPECT_EQ(Vec3(body.velocity.data()), table.velocity[k]);
        EXPECT_EQ(Vec3(body.spin.data()), table.spin[k]);
        const auto& [w, x, y, z] = body.orientation;
        EXPECT_EQ(Quat(w, x, y, z).coeffs(), table.orientation[k].coeffs());
      }
    }
    EXPECT_EQ(bodies[0].mass, HUGE_VAL);
    EXPECT_EQ(bodies[4].mobility, until < 60 ? Mobility::absent : Mobility::free);
  }
}

TEST_F(LibraryTest, MeasuresAreThoseOfTheBodies) {
  Simulation simulation = heap();
  EXPECT_TRUE(std::isnan(simulation.measure("late.position.z")));
  while (simulation.steps() < 80) simulation.step();
  double mass = 0, linear = 0, potential = 0, momentum = 0;
  for (const Body& body : simulation.bodies()) {
    if (body.mobility != Mobility::free) continue;
    mass += body.mass;
    potential += 9.81 * body.mass * body.position[2];
    momentum += body.mass * body.velocity[0];
    for (const double v : body.velocity) linear += 0.5 * body.mass * v * v;
  }
  const double pi = std::numbers::pi;
  EXPECT_NEAR(mass, 1000 * (2 * 4 / 3.0 * pi * 0.001 + 2 * 0.2 * 0.3 * 0.4), 1e-9);
  EXPECT_NEAR(simulation.measure("energy.linear"), linear, 1e-12 * linear);
  EXPECT_NEAR(simulation.measure("energy.potential"), potential, 1e-12 * potential);
  EXPECT_NEAR(simulation.measure("momentum.x"), momentum, 1e-12 * mass);
  EXPECT_EQ(simulation.measure("bodies.count"), 5);
  EXPECT_EQ(simulation.measure("crate[1].position.z"), simulation.read_body(3).position[2]);
  EXPECT_LT(simulation.measure("energy.unexplained"), 1e-9);
  EXPECT_EQ(simulation.loaded_contacts().size(), 3) << "ball, crate, crate, floor: one contact for each two";
  EXPECT_EQ(simulation.measure("contacts.count"), 9) << "points: one, and four of each crate";
  // This comes last, because computing the penetration is expensive.
  EXPECT_EQ(simulation.measure("penetration.max"), simulation.observe().penetration.max);
}

TEST_F(LibraryTest, ABallAtRestIsHeldByItsWeight) {
  Simulation simulation = Simulation::from_text(
      "format: 1\ngravity: [0, 0, -9.81]\ntime: {end: 1, step: 0.01}\nmaterials: {m: {density: 1000}}\n"
      "bodies:\n  - {plane: {normal: [0, 0, 1]}, material: m}\n"
      "  - {sphere: {radius: 0.1}, at: [3, 4, 0.1], material: m}\n");
  EXPECT_TRUE(simulation.loaded_contacts().empty());
  run_to_end(simulation);
  const std::vector<LoadedContact> contacts = simulation.loaded_contacts();
  ASSERT_EQ(contacts.size(), 1);
  const double weight = 9.81 * simulation.read_body(1).mass;
  EXPECT_NEAR(contacts[0].j == 1 ? contacts[0].force[2] : -contacts[0].force[2], weight, 1e-9 * weight);
  EXPECT_EQ(contacts[0].i + contacts[0].j, 1);
  EXPECT_NEAR(contacts[0].point[0], 3, 1e-12);
  EXPECT_NEAR(contacts[0].point[1], 4, 1e-12);
  EXPECT_NEAR(contacts[0].point[2], 0, 1e-6);
}

TEST_F(LibraryTest, GoesOnFromACheckpointWithTheSameBits) {
  Simulation whole = heap();
  while (whole.steps() < 40) whole.step();
  whole.save_checkpoint(folder_ / "half.h5");
  run_to_end(whole);

  Simulation rest = heap();
  rest.load_checkpoint(folder_ / "half.h5");
  EXPECT_EQ(rest.steps(), 40);
  EXPECT_EQ(rest.time(), 0.2);
  run_to_end(rest);
  EXPECT_EQ(rest.state_hash(), whole.state_hash());
  EXPECT_EQ(rest.measure("energy.unexplained"), whole.measure("energy.unexplained"));
}

TEST_F(LibraryTest, RefusesTheCheckpointOfAnotherSceneAndOneThatIsDamaged) {
  Simulation other = heap({{"gravity", "[0, 0, -1.62]"}});
  other.save_checkpoint(folder_ / "moon.h5");
  Simulation simulation = heap();
  simulation.step();
  const std::uint64_t hash = simulation.state_hash();
  const std::string why = refusal<InputError>([&] { simulation.load_checkpoint(folder_ / "moon.h5"); });
  EXPECT_NE(why.find("moon.h5: the checkpoint is of another scene: it has `gravity: [0, 0, -1.62]`"),
            std::string::npos)
      << why;
  fs::resize_file(folder_ / "moon.h5", fs::file_size(folder_ / "moon.h5") - 1);
  refusal<RunError>([&] { other.load_checkpoint(folder_ / "moon.h5"); });
  refusal<RunError>([&] { simulation.load_checkpoint(folder_ / "none.h5"); });
  refusal<RunError>([&] { simulation.save_checkpoint(folder_ / "no/folder.h5"); });
  EXPECT_EQ(simulation.steps(), 1);
  EXPECT_EQ(simulation.state_hash(), hash);
}

TEST_F(LibraryTest, AStateStaysAsItWasWhateverFieldACheckpointLacks) {
  const fs::path file = folder_ / "half.h5";
  Simulation saved = heap();
  while (saved.steps() < 40) saved.step();
  saved.save_checkpoint(file);
  SavedState state = read_checkpoint(file);
  Simulation simulation = heap();
  simulation.step();
  const std::uint64_t hash = simulation.state_hash();
  ASSERT_GT(state.fields.size(), 50);
  for (std::size_t tried = 0; tried < state.fields.size(); ++tried) {
    SavedField lacking = std::move(state.fields.front());
    state.fields.erase(state.fields.begin());
    write_checkpoint(file, state);
    refusal<InputError>([&] { simulation.load_checkpoint(file); });
    ASSERT_EQ(simulation.state_hash(), hash) << lacking.name;
    ASSERT_EQ(simulation.steps(), 1) << lacking.name;
    state.fields.push_back(std::move(lacking));
  }
  // The next step is that of a simulation that has tried nothing.
  Simulation alone = heap();
  alone.step();
  alone.step();
  simulation.step();
  EXPECT_EQ(simulation.state_hash(), alone.state_hash());
}

/// The library gives the numbers of a run that the program stopped early, and continues from its checkpoint.
TEST_F(LibraryTest, TakesTheProgramsCheckpointsAndSeesItsNumbers) {
  const fs::path scene = write("heap.yaml", scene_text);
  const std::string command = std::string(SCREE_PROGRAM) + " run " + scene.string() + " -o " +
                              (folder_ / "run").string() + " --no-render --until 0.2 >/dev/null";
  ASSERT_EQ(std::system(command.c_str()), 0);
  std::vector<fs::path> checkpoints(fs::directory_iterator(folder_ / "run/checkpoint"), {});
  ASSERT_EQ(checkpoints.size(), 1);

  Simulation whole(scene);
  std::ifstream rows(folder_ / "run/metrics.csv");
  std::string names, row;
  std::getline(rows, names);
  const auto column = [&](const std::string& line, std::size_t k) {
    std::size_t start = 0;
    while (k-- > 0) start = line.find(',', start) + 1;
    return line.substr(start, line.find(',', start) - start);
  };
  const auto column_named = [&](const std::string& name) {
    std::size_t k = 0;
    while (column(names, k) != name) ++k;
    return k;
  };
  int seen = 0;
  for (; std::getline(rows, row); ++seen) {
    while (whole.steps() < std::stoll(column(row, column_named("step")))) whole.step();
    EXPECT_EQ(std::stod(column(row, column_named("time"))), whole.time());
    for (const char* measure : {"energy.total", "ball.position.z", "penetration.max", "contacts.count"}) {
      std::string name = measure;
      for (char& c : name)
        if (c == '.') c = '_';
      EXPECT_EQ(std::stod(column(row, column_named(name))), whole.measure(measure)) << row;
    }
  }
  EXPECT_GT(seen, 10);
  run_to_end(whole);
  Simulation rest(scene);
  rest.load_checkpoint(checkpoints.front());
  EXPECT_EQ(rest.steps(), 40);
  run_to_end(rest);
  EXPECT_EQ(rest.state_hash(), whole.state_hash());
}

TEST_F(LibraryTest, RunsAreOfTheirOwnOnThreadsOfTheirOwn) {
  Simulation alone = heap();
  run_to_end(alone);
  std::vector<std::uint64_t> hashes(3);
  std::vector<std::thread> threads;
  for (std::uint64_t& hash : hashes)
    threads.emplace_back([&hash] {
      Simulation one = Simulation::from_text(scene_text, "heap.yaml");
      run_to_end(one);
      hash = one.state_hash();
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(hashes, std::vector<std::uint64_t>(3, alone.state_hash()));

  Simulation moved = heap();
  moved.step();
  Simulation to = std::move(moved);
  moved = heap();
  EXPECT_EQ(to.steps(), 1);
  EXPECT_EQ(moved.steps(), 0);
  to = std::move(moved);
  run_to_end(to);
  EXPECT_EQ(to.state_hash(), alone.state_hash());
}

TEST_F(LibraryTest, TellsItsVersion) { EXPECT_EQ(version(), SCREE_VERSION); }

}  // namespace
}  // namespace scree
