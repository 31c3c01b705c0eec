// The benchmark of the renderer: the time from snapshot to pixels, for pictures of a mound of bodies with a
// splash above it.
//
//   scree_bench_render [--context auto,osmesa,egl] [--shape sphere,box,mixed] [--n 10000,100000,1000000]
//                      [--size 1280x720] [--png FOLDER]
//
// One picture warms up, then the median of five is taken, in wall time and in processor time of all threads.
// Three parts are also timed alone. Before OpenGL, the data are set: `found` is for finding and packing the
// visible bodies, as is done if the processor draws; `packed` is for packing all bodies, as is done if a GPU
// draws. `png` is for compressing and writing the picture. --png keeps the last picture of each row.
#include "bench/clock.hpp"
#include "bench/options.hpp"
#include "core/rng.hpp"
#include "core/snapshot.hpp"
#include "render/camera.hpp"
#include "render/gl/frame_data.hpp"
#include "render/png.hpp"
#include "render/renderer.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace scree::bench {

namespace {

namespace fs = std::filesystem;

constexpr int repeats = 5;
const Vec3 gravity(0, 0, -9.81);

void append(BodyTable& bodies, Shape shape, const Vec3& position, const Quat& orientation, const Vec3& size) {
  const bool free = shape != Shape::plane;
  bodies.id.push_back(BodyNumber{static_cast<std::int32_t>(bodies.id.size())});
  bodies.position.push_back(position);
  bodies.orientation.push_back(orientation);
  bodies.velocity.push_back(Vec3(0, 0, -position.z()));
  bodies.spin.push_back(Vec3::Zero());
  bodies.size.push_back(size);
  bodies.inverse_mass.push_back(free ? 1 : 0);
  bodies.inverse_inertia.push_back(Vec3::Constant(free ? 1 : 0));
  bodies.shape.push_back(shape);
  bodies.mobility.push_back(free ? Mobility::free : Mobility::fixed);
  bodies.material.push_back(static_cast<std::int32_t>(bodies.id.size() % 3));
}

/// Returns a cone of bodies over the ground, placed with jitter on a lattice. Its radius is 1 m, its height
/// half of that. One body in a thousand flies above the cone.
Snapshot mound(const std::string& shape, std::int64_t n) {
  const double pitch = std::cbrt(pi / 6 / static_cast<double>(n));
  Snapshot snapshot;
  append(snapshot.bodies, Shape::plane, Vec3::Zero(), Quat::Identity(), Vec3::Zero());
  const auto steps = static_cast<std::int64_t>(1 / pitch) + 1;
  std::int64_t item = 0;
  for (std::int64_t z = 0; z < steps; ++z) {
    for (std::int64_t y = -steps; y <= steps; ++y) {
      for (std::int64_t x = -steps; x <= steps; ++x) {
        const Vec3 place =
            pitch *
            (Vec3(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)) + Vec3(0, 0, 0.5));
        if (std::hypot(place.x(), place.y()) > 1 - 2 * place.z()) continue;
        Random random(1, static_cast<std::uint64_t>(item++));
        Vec3 jitter, axis;
        for (double& c : jitter) c = random.uniform(-0.15, 0.15);
        for (double& c : axis) c = random.uniform(-1, 1);
        const double rise = random.uniform() < 1e-3 ? random.uniform(0, 0.5) : 0;
        const double radius = pitch * random.uniform(0.4, 0.55);
        const bool sphere = shape == "sphere" || (shape == "mixed" && item % 2 == 0);
        append(snapshot.bodies, sphere ? Shape::sphere : Shape::box,
               place + pitch * jitter + Vec3(0, 0, rise), rotation_of(2 * axis),
               Vec3::Constant(sphere ? radius : 0.8 * radius));
      }
    }
  }
  return snapshot;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

struct Times {
  double wall, processor;  // medians (s)
};

template <class Work>
Times times_of(Work work) {
  std::vector<double> wall, processor;
  for (int k = 0; k < repeats; ++k) {
    const double wall_start = now(CLOCK_MONOTONIC), processor_start = now(CLOCK_PROCESS_CPUTIME_ID);
    work();
    wall.push_back(now(CLOCK_MONOTONIC) - wall_start);
    processor.push_back(now(CLOCK_PROCESS_CPUTIME_ID) - processor_start);
  }
  return {median(wall), median(processor)};
}

struct Case {
  std::string context, shape;
  std::int64_t n;
};

void run(const Case& c, render::Renderer& renderer, int width, int height, const std::string& folder) {
  const render::Frame frame{.snapshot = mound(c.shape, c.n)};
  const render::Camera camera =
      render::frame_all(frame.snapshot, gravity, static_cast<double>(width) / height);
  render::Image image = renderer.draw(frame, camera, {});
  const Times drawing = times_of([&] { image = renderer.draw(frame, camera, {}); });
  const int shadow_size = render::gl::shadow_size_for(width, height);
  render::gl::FrameData data;
  const auto data_with = [&](render::gl::Hidden hidden) {
    return times_of(
        [&] { render::gl::set_frame_data(frame, camera, {}, width, height, shadow_size, hidden, data); });
  };
  const Times leaving_out = data_with(render::gl::Hidden::left_out);
  const Times all = data_with(render::gl::Hidden::drawn);
  const std::string name = c.context + "_" + c.shape + "_" + std::to_string(c.n) + ".png";
  const fs::path file = (folder.empty() ? fs::temp_directory_path() : fs::path(folder)) / name;
  const Times writing = times_of([&] { render::write_png(file, image); });
  if (folder.empty()) fs::remove(file);
  std::printf("%-7s %-7s %9lld %8.3f %8.3f %8.3f %8.3f %8.3f\n", c.context.c_str(), c.shape.c_str(),
              static_cast<long long>(frame.snapshot.bodies.count()), drawing.wall, drawing.processor,
              leaving_out.wall, all.wall, writing.wall);
  std::fflush(stdout);
}

render::ContextChoice context_of(const std::string& name) {
  static const std::map<std::string, render::ContextChoice> contexts = {
      {"auto", render::ContextChoice::automatic},
      {"osmesa", render::ContextChoice::osmesa},
      {"egl", render::ContextChoice::egl}};
  const auto found = contexts.find(name);
  if (found == contexts.end()) throw InputError("--context " + name + ": must be auto, osmesa or egl");
  return found->second;
}

void run_all(int argc, char** argv) {
  const Options options = parse(argc, argv,
                                {{"--context", "auto"},
                                 {"--shape", "sphere,box,mixed"},
                                 {"--n", "10000,100000,1000000"},
                                 {"--size", "1280x720"},
                                 {"--png", ""}});
  int width = 0, height = 0;
  if (std::sscanf(options.at("--size").c_str(), "%dx%d", &width, &height) != 2) {
    throw InputError("--size " + options.at("--size") + ": must be WIDTHxHEIGHT");
  }
  for (const std::string& context : split(options.at("--context"))) {
    const auto renderer = render::make_renderer(context_of(context), width, height);
    std::printf("%s: %s\ncontext shape      bodies   wall s    cpu s  found s packed s    png s\n",
                context.c_str(), renderer->name().c_str());
    for (const std::string& shape : split(options.at("--shape"))) {
      for (const std::string& n : split(options.at("--n"))) {
        run({context, shape, std::stoll(n)}, *renderer, width, height, options.at("--png"));
      }
    }
  }
}

}  // namespace

}  // namespace scree::bench

int main(int argc, char** argv) {
  return scree::bench::status_of("scree_bench_render", [&] {
    scree::bench::run_all(argc, argv);
    return 0;
  });
}
