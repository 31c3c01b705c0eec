// The test of every pair function over families of random and degenerate pairs (families.hpp). Each answer is
// compared with long double (judge.hpp). It uses one thread.
//
//   scree_bench_narrowphase [--pairs 10000000] [--family NAME,...]
//
// It prints a row for each family and method. The exit status is 1 if a bound is broken: then the row says
// so, and the numbers of the first such pairs follow, from which they can be made again. Half of the pairs
// have a margin of a twentieth of the smaller size, the others none.
//   touch        pairs with a contact within the margin
//   miss, false  contacts not found, or found where there are none; a contact is not counted if rounding
//                (1e-12 of the length) decides it, or with a margin if the preference for faces may do so
//   NaN          answers with a number that is not finite
//   error        relative to the length: for sat the largest error of the depth by the 15 axes, for closed
//                forms that of the gap, for ccd the largest excess of the overlap along libccd's own
//                direction over the least, before the certificate refuses it
//   given away   largest difference of the deepest point's gap from the truth, relative to the difference
//                that decision 0007 allows
//   refused      share of libccd's answers that the certificate refused
//   stopped      share of libccd's searches that used up their budget of support points; hang: number of
//                searches that continued after it
//   ns           processor time per pair, median over batches
#include "bench/clock.hpp"
#include "bench/narrowphase/families.hpp"
#include "bench/narrowphase/judge.hpp"
#include "bench/options.hpp"
#include "narrowphase/box_box_libccd.hpp"
#include "narrowphase/box_plane.hpp"
#include "narrowphase/box_tube.hpp"
#include "narrowphase/sphere_box.hpp"
#include "narrowphase/sphere_plane.hpp"
#include "narrowphase/sphere_sphere.hpp"
#include "narrowphase/sphere_tube.hpp"

#include <algorithm>
#include <cstdio>
#include <functional>
#include <optional>
#include <type_traits>
#include <vector>

namespace scree::bench {

namespace {

using oracle::ClosedForm;
using oracle::SolidPair;

constexpr std::int64_t batch = 1000;

struct Method {
  const char* name;
  int (*test)(const SolidPair& pair, double margin, Manifold* out);
  std::optional<libccd::Method> ccd;
};

struct Family {
  const char* name;
  std::function<SolidPair(std::uint64_t n)> make;
  std::function<void(Item& item)> find_truth;
  bool of_boxes;
  std::vector<Method> methods;
};

template <auto test>
int by(const SolidPair& pair, double margin, Manifold* out) {
  if constexpr (std::is_invocable_v<decltype(test), const Solid&, const Solid&, double, Manifold*>) {
    return test(pair.a, pair.b, margin, out);
  } else {
    return test(pair.a, pair.b, margin, *out);
  }
}

template <libccd::Method method>
int by_libccd(const SolidPair& pair, double margin, Manifold* out) {
  NarrowPhaseStats stats;
  return box_box_libccd(pair.a, pair.b, margin, method, *out, stats);
}

std::vector<Family> all_families() {
  const std::vector<Method> box_methods = {{"sat", by<box_box>, {}},
                                           {"ccd_gjk", by_libccd<libccd::Method::gjk>, libccd::Method::gjk},
                                           {"ccd_mpr", by_libccd<libccd::Method::mpr>, libccd::Method::mpr}};
  const Method closed_forms[] = {{"closed", by<sphere_sphere>, {}}, {"closed", by<sphere_box>, {}},
                                 {"closed", by<sphere_plane>, {}},  {"closed", by<box_plane>, {}},
                                 {"closed", by<sphere_tube>, {}},   {"closed", by<box_tube>, {}}};
  std::vector<Family> families;
  const auto add = [&families](auto family, bool of_boxes, const std::vector<Method>& methods) {
    families.push_back({oracle::name_of(family), [family](std::uint64_t n) { return make_pair(family, n); },
                        [family](Item& item) { find_truth(family, item); }, of_boxes, methods});
  };
  for (int f = 0; f < static_cast<int>(oracle::Family::count); ++f)
    add(static_cast<oracle::Family>(f), true, box_methods);
  for (int f = 0; f < static_cast<int>(ClosedForm::count); ++f)
    add(static_cast<ClosedForm>(f), false, {closed_forms[f]});
  return families;
}

std::vector<Item> make_items(const Family& family, std::uint64_t first, std::int64_t count) {
  std::vector<Item> items(static_cast<std::size_t>(count));
  for (std::size_t k = 0; k < items.size(); ++k) {
    items[k].pair = family.make(first + k);
    items[k].margin = k % 2 ? 0.05 * items[k].pair.smallest : 0.0;
    family.find_truth(items[k]);
  }
  return items;
}

void run_batch(const Family& family, const Method& method, const std::vector<Item>& items,
               std::uint64_t first, std::vector<Answer>& answers, Row& row) {
  const double start = now(CLOCK_PROCESS_CPUTIME_ID);
  for (std::size_t k = 0; k < items.size(); ++k) {
    answers[k].count = method.test(items[k].pair, items[k].margin, answers[k].manifolds.data());
  }
  const double elapsed = now(CLOCK_PROCESS_CPUTIME_ID) - start;
  row.nanoseconds.push_back(1e9 * elapsed / static_cast<double>(items.size()));
  for (std::size_t k = 0; k < items.size(); ++k)
    judge(items[k], answers[k], first + k, family.of_boxes, method.ccd, row);
}

void print_share(std::int64_t part, std::int64_t whole) {
  std::printf(" %7.3f %%", whole > 0 ? 100.0 * static_cast<double>(part) / static_cast<double>(whole) : 0.0);
}

void print(const Family& family, const Method& method, Row& row) {
  std::printf("%-14s %-7s %8lld %8lld %5lld %5lld %4lld %8.1e", family.name, method.name,
              static_cast<long long>(row.pairs), static_cast<long long>(row.touching),
              static_cast<long long>(row.missed), static_cast<long long>(row.made_up),
              static_cast<long long>(row.not_finite), row.error);
  if (family.of_boxes) {
    std::printf(" %10.4f", row.given_away);
  } else {
    std::printf(" %10s", "-");
  }
  if (method.ccd) {
    print_share(row.ccd_refused, row.ccd_calls);
    print_share(row.ccd_stopped, row.ccd_calls);
    std::printf(" %4lld", static_cast<long long>(row.ccd_hung));
  } else {
    std::printf(" %9s %9s %4s", "-", "-", "-");
  }
  const auto middle = row.nanoseconds.begin() + std::ssize(row.nanoseconds) / 2;
  std::nth_element(row.nanoseconds.begin(), middle, row.nanoseconds.end());
  std::printf(" %6.0f", *middle);
  if (row.broken > 0) std::printf("  BROKEN by %lld:", static_cast<long long>(row.broken));
  for (const std::uint64_t n : row.which) std::printf(" %llu", static_cast<unsigned long long>(n));
  std::printf("\n");
  std::fflush(stdout);
}

/// Tests a family. Returns false if a bound was broken.
bool run(const Family& family, std::int64_t pairs) {
  std::vector<Row> rows(family.methods.size());
  std::vector<Answer> answers(batch);
  for (std::int64_t first = 0; first < pairs; first += batch) {
    const auto start = static_cast<std::uint64_t>(first);
    const std::vector<Item> items = make_items(family, start, std::min(batch, pairs - first));
    for (std::size_t m = 0; m < rows.size(); ++m) {
      run_batch(family, family.methods[m], items, start, answers, rows[m]);
    }
  }
  for (std::size_t m = 0; m < rows.size(); ++m) print(family, family.methods[m], rows[m]);
  return std::all_of(rows.begin(), rows.end(), [](const Row& row) { return row.broken == 0; });
}

int run_all(int argc, char** argv) {
  std::vector<Family> families = all_families();
  const Options options = parse(argc, argv, {{"--pairs", "10000000"}, {"--family", ""}});
  const std::vector<std::string> wanted = split(options.at("--family"));
  for (const std::string& name : wanted) {
    const auto has_name = [&](const Family& family) { return name == family.name; };
    if (std::none_of(families.begin(), families.end(), has_name))
      throw InputError("family " + name + ": unknown");
  }
  std::erase_if(families, [&](const Family& family) {
    return !wanted.empty() && std::find(wanted.begin(), wanted.end(), family.name) == wanted.end();
  });
  const std::int64_t each =
      std::max<std::int64_t>(1, std::stoll(options.at("--pairs")) / std::ssize(families));
  std::printf("%-14s %-7s %8s %8s %5s %5s %4s %8s %10s %9s %9s %4s %6s\n", "family", "method", "pairs",
              "touch", "miss", "false", "NaN", "error", "given away", "refused", "stopped", "hang", "ns");
  bool good = true;
  for (const Family& family : families) good = run(family, each) && good;
  return good ? 0 : 1;
}

}  // namespace

}  // namespace scree::bench

int main(int argc, char** argv) {
  return scree::bench::status_of("scree_bench_narrowphase",
                                 [&] { return scree::bench::run_all(argc, argv); });
}
