// The benchmark of the broad phase over data sets and scenes. `usage` describes its options and its output.
#include "bench/broadphase/data_sets.hpp"
#include "bench/broadphase/input.hpp"
#include "bench/broadphase/session.hpp"
#include "bench/options.hpp"
#include "core/error.hpp"
#include "core/space.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <map>
#include <string>
#include <type_traits>
#include <vector>

namespace scree::bench {

namespace {

const std::map<std::string, BroadPhaseMethod> methods = {
    {"hierarchical_grid", BroadPhaseMethod::hierarchical_grid},
    {"alternative_grid", BroadPhaseMethod::alternative_grid},
    {"uniform_grid", BroadPhaseMethod::uniform_grid},
    {"sweep_and_prune", BroadPhaseMethod::sweep_and_prune},
    {"lbvh", BroadPhaseMethod::lbvh},
    {"brute_force", BroadPhaseMethod::brute_force}};

const std::map<std::string, Order> orders = {
    {"random", Order::random}, {"rows", Order::rows}, {"given", Order::given}};

const std::map<std::string, bool> yes_or_no = {{"yes", true}, {"no", false}};

constexpr const char* usage = R"([SCENE.yaml | DATASET]... [OPTION VALUE]...

Time of the broad phase from bounds in the space to pairs in the space, everything between included: two calls to
warm up, then the median of nine. A scene's boxes are those that the simulation makes in its first step. Values may
be lists with commas, but for those of order and check; all combinations are measured.

  DATASET           one of {}
                    (A,B,C; bench/broadphase/data_sets.hpp says what they are)
  --n N             objects of a data set (1000000)
  --space NAME      host, cuda, or all that are here (host)
  --method NAME     one of {} (hierarchical_grid)
  --levels L        of the hierarchical and the alternative grid; 0: as they choose (0)
  --order NAME      of the objects: random, another one for each call; rows, sorted by rows of cells of the mean
                    size; given (random)
  --check METHOD    compare the pairs with those of this method; exit status 1 if they differ
  --stages yes      print the times of the parallel calls, medians of three calls more
  --csv FILE        write the measurements there too, with the times of the stages
  --repeats K       calls of which each time is the median (9)
  --limit S         leave out larger n where a call took longer (s; 0: none)
  --copy MIB        size of the copy by which the memory's bandwidth is measured (1024)

x floor: the median, over the time in which a copy moves as many bytes as the boxes (24 B each) and the pairs (8 B)
have. B/object: most memory in use at once beyond boxes and pairs. The checksum is of the pairs of the order given, in
whatever order they are found.
)";

template <class Value>
std::vector<std::string> names_of(const std::map<std::string, Value>& table) {
  std::vector<std::string> names;
  for (const auto& [name, value] : table) names.push_back(name);
  return names;
}

template <class Value>
Value value_of(const char* option, const std::string& name, const std::map<std::string, Value>& table) {
  const auto found = table.find(name);
  if (found != table.end()) return found->second;
  throw InputError(fmt::format("{} {}: must be one of {}", option, name, fmt::join(names_of(table), ", ")));
}

template <class Number>
Number number(const char* option, const std::string& text, Number least) {
  Number value{};
  const char* end = text.data() + text.size();
  const auto [rest, problem] = std::from_chars(text.data(), end, value);
  if (problem == std::errc() && rest == end && value >= least) return value;
  throw InputError(fmt::format("{} {}: must be a {}number, {} or more", option, text,
                               std::is_integral_v<Number> ? "whole " : "", least));
}

std::vector<std::string> spaces_of(const std::string& list) {
  std::map<std::string, bool> here = {{Host::name, true}};
  if (device_info().available) here["cuda"] = true;
  if (list == "all") return names_of(here);
  for (const std::string& space : split(list)) value_of("--space", space, here);
  return split(list);
}

std::vector<std::string> inputs_of(const std::vector<std::string>& words) {
  if (words.empty()) return {"A", "B", "C"};
  std::vector<std::string> inputs;
  for (const std::string& word : words) {
    for (const std::string& input : split(word)) {
      if (!names_scene(input)) make_data_set(input, 1);  // refuses unknown names before any measurement
      inputs.push_back(input);
    }
  }
  return inputs;
}

SessionSettings settings_of(const Options& options, const std::vector<std::string>& words) {
  SessionSettings settings;
  settings.inputs = inputs_of(words);
  for (const std::string& n : split(options.at("--n")))
    settings.counts.push_back(number("--n", n, std::int64_t{1}));
  settings.spaces = spaces_of(options.at("--space"));
  for (const std::string& name : split(options.at("--method"))) {
    for (const std::string& levels : split(options.at("--levels")))
      settings.methods.push_back(
          {name, {.method = value_of("--method", name, methods), .levels = number("--levels", levels, 0)}});
  }
  settings.order = {options.at("--order"), value_of("--order", options.at("--order"), orders)};
  const std::string& check = options.at("--check");
  if (!check.empty()) settings.check = {check, {.method = value_of("--check", check, methods)}};
  settings.stages = value_of("--stages", options.at("--stages"), yes_or_no);
  settings.csv = options.at("--csv");
  settings.repeats = number("--repeats", options.at("--repeats"), 1);
  settings.limit = number("--limit", options.at("--limit"), 0.0);
  settings.copy_bytes = number("--copy", options.at("--copy"), std::int64_t{1}) << 20;
  return settings;
}

int run_all(int argc, char** argv) {
  std::vector<std::string> words;
  const Options options = parse(
      argc, argv,
      {{"--n", "1000000"},
       {"--space", Host::name},
       {"--method", "hierarchical_grid"},
       {"--levels", "0"},
       {"--order", "random"},
       {"--check", ""},
       {"--stages", "no"},
       {"--csv", ""},
       {"--repeats", "9"},
       {"--limit", "0"},
       {"--copy", "1024"}},
      &words, fmt::format(usage, fmt::join(data_set_names(), ", "), fmt::join(names_of(methods), ", ")));
  return Session(settings_of(options, words)).run() ? 0 : 1;
}

}  // namespace

}  // namespace scree::bench

int main(int argc, char** argv) {
  return scree::bench::status_of("scree_bench_broadphase", [&] { return scree::bench::run_all(argc, argv); });
}
