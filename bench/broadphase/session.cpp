#include "bench/broadphase/session.hpp"

#include "bench/broadphase/input.hpp"
#include "core/error.hpp"
#include "core/space.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <new>

namespace scree::bench {

namespace {

// What objects, their orders and a broad phase take of the memory of a space, or about (B). What would need
// more than is free is left out, since the system may end a program rather than refuse it memory.
constexpr std::size_t bytes_per_object = 200;

constexpr int profiles = 3;

template <class Space>
bool has_room(const std::string& input, std::int64_t n) {
  const std::size_t need = static_cast<std::size_t>(n) * bytes_per_object;
  const std::size_t free = Space::free_memory();
  if (need <= free) return true;
  fmt::print("{} {}: left out in {}: needs about {} bytes, of which {} are free\n", input, n, Space::name,
             need, free);
  return false;
}

/// The objects in a space; `copied` holds them if it is not Host.
const Objects<Host>& in_space(const Objects<Host>& objects, Objects<Host>&) { return objects; }
template <class Space>
const Objects<Space>& in_space(const Objects<Host>& objects, Objects<Space>& copied) {
  copy(copied.bounds, objects.bounds);
  copy(copied.mobility, objects.mobility);
  return copied;
}

std::string name_of(const std::string& input, const std::string& space, const std::string& method,
                    int levels) {
  return fmt::format("{} {} {} {}", input, space, method, levels);
}
std::string name_of(const Subject& subject) {
  return name_of(subject.set, subject.space, subject.method, subject.levels);
}

}  // namespace

Session::Session(const SessionSettings& settings) : settings_(settings) {
  if (!settings.csv.empty()) csv_.emplace(settings.csv);
}

bool Session::run() {
  print_table_head();
  for (const std::string& input : settings_.inputs) {
    if (names_scene(input)) {
      measure_all(input, objects_of_scene(input));
      continue;
    }
    for (const std::int64_t n : settings_.counts) {
      if (wants(input, n)) measure_all(input, objects_of_data_set(input, n));
    }
  }
  return good_;
}

/// Whether there is anybody left to be measured with so many objects, and room for them.
bool Session::wants(const std::string& input, std::int64_t n) const {
  for (const std::string& space : settings_.spaces) {
    for (const auto& [name, method] : settings_.methods) {
      if (!slow_.contains(name_of(input, space, name, method.levels))) return has_room<Host>(input, n);
    }
  }
  return false;
}

void Session::measure_all(const std::string& input, const Objects<Host>& objects) {
  for (const std::string& space : settings_.spaces) {
#define SCREE_TRY(Space)                                                     \
  if (space == Space::name && has_room<Space>(input, objects.bounds.size())) \
    measure_in<Space>(input, objects);
    SCREE_FOR_EACH_SPACE(SCREE_TRY)
#undef SCREE_TRY
  }
}

template <class Space>
void Session::measure_in(const std::string& input, const Objects<Host>& given) {
  Objects<Space> copied;
  const Objects<Space>& objects = in_space(given, copied);
  for (const auto& [name, method] : settings_.methods) {
    Subject subject{.set = input,
                    .n = objects.bounds.size(),
                    .order = settings_.order.first,
                    .method = name,
                    .space = Space::name,
                    .levels = method.levels,
                    .bandwidth = bandwidth<Space>()};
    if (slow_.contains(name_of(subject))) continue;
    try {
      measure_one(subject, objects, method);
    } catch (const RunError& error) {
      good_ = false;
      fmt::print("{} {}: {}\n", name_of(subject), subject.n, error.what());
    } catch (const std::bad_alloc&) {
      good_ = false;
      fmt::print("{} {}: out of memory\n", name_of(subject), subject.n);
    }
    std::fflush(stdout);
  }
}

template <class Space>
void Session::measure_one(Subject& subject, const Objects<Space>& objects, const BroadPhaseSettings& method) {
  const bool profiled = settings_.stages || csv_;
  const Measurement result = measure<Space>(
      objects, method,
      {.order = settings_.order.second, .repeats = settings_.repeats, .profiles = profiled ? profiles : 0});
  print_row(subject, result);
  if (settings_.check) {
    const auto& [name, other] = *settings_.check;
    const bool agrees = agree<Space>(objects, method, other);
    fmt::print("  {} {}", agrees ? "agrees with" : "DIFFERS from", name);
    good_ = good_ && agrees;
  }
  fmt::print("\n");
  if (settings_.stages) print_calls(result);
  if (csv_) csv_->write(subject, result);
  if (settings_.limit > 0 && result.median() > settings_.limit) slow_.insert(name_of(subject));
}

template <class Space>
double Session::bandwidth() {
  double& known = bandwidth_[Space::name];
  if (known == 0) known = copy_bandwidth<Space>(settings_.copy_bytes);
  return known;
}

}  // namespace scree::bench
