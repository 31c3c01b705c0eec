#include "bench/broadphase/session.hpp"

#include "bench/broadphase/input.hpp"
#include "core/space.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace scree::bench {

namespace {

// The approximate memory in a space that each object takes with its orders, and that each method takes for
// each object (B). Inputs that would need more than the free memory are left out, since the system may end a
// program rather than refuse it memory.
constexpr std::size_t bytes_of_object = 80;
constexpr std::size_t bytes_of_method = 120;

constexpr int profiles = 3;

template <class Space>
bool has_room(const std::string& input, std::int64_t n, std::size_t methods) {
  const std::size_t need = static_cast<std::size_t>(n) * (bytes_of_object + methods * bytes_of_method);
  const std::size_t free = Space::free_memory();
  if (need <= free) return true;
  fmt::print("{} {}: left out in {}: needs about {} bytes, of which {} are free\n", input, n, Space::name,
             need, free);
  return false;
}

/// Returns the objects in a space. `copied` holds them if the space is not Host.
const Objects<Host>& in_space(const Objects<Host>& objects, Objects<Host>&) { return objects; }
template <class Space>
const Objects<Space>& in_space(const Objects<Host>& objects, Objects<Space>& copied) {
  copy(copied.bounds, objects.bounds);
  copy(copied.mobility, objects.mobility);
  return copied;
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

bool Session::wants(const std::string& input, std::int64_t n) const {
  const auto has_methods = [&](const std::string& space) { return !methods_for(input, space).empty(); };
  return std::ranges::any_of(settings_.spaces, has_methods) && has_room<Host>(input, n, 0);
}

std::vector<Session::Method> Session::methods_for(const std::string& input, const std::string& space) const {
  std::vector<Method> methods;
  for (const auto& [name, method] : settings_.methods) {
    if (!slow_.contains({input, space, name, method.levels})) methods.push_back({name, method});
  }
  return methods;
}

void Session::measure_all(const std::string& input, const Objects<Host>& objects) {
  for (const std::string& space : settings_.spaces) {
#define SCREE_TRY(Space) \
  if (space == Space::name) measure_in<Space>(input, objects);
    SCREE_FOR_EACH_SPACE(SCREE_TRY)
#undef SCREE_TRY
  }
}

template <class Space>
void Session::measure_in(const std::string& input, const Objects<Host>& given) {
  const std::vector<Method> methods = methods_for(input, Space::name);
  if (methods.empty() || !has_room<Space>(input, given.bounds.size(), methods.size())) return;
  const double bandwidth = bandwidth_in<Space>();
  Objects<Space> copied;
  const Objects<Space>& objects = in_space(given, copied);
  std::vector<BroadPhaseSettings> settings;
  for (const Method& method : methods) settings.push_back(method.second);
  const bool profiled = settings_.stages || csv_;
  const std::vector<Measurement> results = measure<Space>(
      objects, settings,
      {.order = settings_.order.second, .repeats = settings_.repeats, .profiles = profiled ? profiles : 0});
  for (std::size_t k = 0; k < methods.size(); ++k) {
    const auto& [name, method] = methods[k];
    report({.set = input,
            .n = objects.bounds.size(),
            .order = settings_.order.first,
            .method = name,
            .space = Space::name,
            .levels = method.levels,
            .bandwidth = bandwidth},
           results[k]);
    if (settings_.check && results[k].problem.empty()) {
      const auto& [other_name, other] = *settings_.check;
      const bool agrees = agree<Space>(objects, method, other);
      fmt::print("       {} {}\n", agrees ? "agrees with" : "DIFFERS from", other_name);
      good_ = good_ && agrees;
    }
  }
  std::fflush(stdout);
}

void Session::report(const Subject& subject, const Measurement& result) {
  if (!result.problem.empty()) {
    good_ = false;
    fmt::print("{} {} {} {}: {}\n", subject.set, subject.n, subject.space, subject.method, result.problem);
    return;
  }
  print_row(subject, result);
  if (settings_.stages) print_calls(result);
  if (csv_) csv_->write(subject, result);
  if (settings_.limit > 0 && result.median() > settings_.limit)
    slow_.insert({subject.set, subject.space, subject.method, subject.levels});
}

template <class Space>
double Session::bandwidth_in() {
  double& known = bandwidth_[Space::name];
  if (known == 0) known = copy_bandwidth<Space>(settings_.copy_bytes);
  return known;
}

}  // namespace scree::bench
