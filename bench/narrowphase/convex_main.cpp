// The test of pairs of convex particles, by the search along axes and by libccd, over families of overlapping
// pairs (convex_families.hpp). Each answer is compared with long double (convex_oracle.hpp). It uses one
// thread.
//
//   scree_bench_convex [--pairs 66000] [--by family|kind]
//
// It prints a row for each family (or for each kind of pair, over all families) and method. The exit status
// is 1 if a bound is broken: then the row says so, and the numbers of the first such pairs follow. Half of
// the pairs have a margin of a twentieth of the smaller size, the others none. Lengths are relative to the
// smaller body's smallest size.
//   miss, NaN    overlapping pairs without a contact found; answers with a number that is not finite
//   error        largest excess of an overlap over the least one: for axes along the best axis, for ccd along
//                libccd's own direction before the certificate refuses it; `over`: share of excesses over
//                libccd_excess; `taken`: largest excess along directions that the certificate accepted
//   given away   largest difference of the deepest point's gap from the truth, relative to the difference
//                that decision 0007 allows
//   refused      share of libccd's answers that the certificate refused
//   stopped      share of libccd's searches that used up their budget of support points; hang: number of
//                searches that continued after it
//   ns           processor time per pair, median over batches; for ccd, with the axes that judge it
#include "bench/clock.hpp"
#include "bench/narrowphase/bounds.hpp"
#include "bench/narrowphase/convex_families.hpp"
#include "bench/narrowphase/convex_oracle.hpp"
#include "bench/options.hpp"
#include "narrowphase/box_pair.hpp"
#include "narrowphase/convex_libccd.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <vector>

namespace scree::bench {

namespace {

using oracle::ConvexFamily;
using oracle::ConvexPair;

constexpr std::int64_t batch = 500;

struct Method {
  const char* name;
  std::optional<libccd::Method> ccd;
};
constexpr Method methods[] = {
    {"axes", {}}, {"ccd_gjk", libccd::Method::gjk}, {"ccd_mpr", libccd::Method::mpr}};

struct Item {
  ConvexPair pair;
  double margin, truth;
  std::uint64_t n;
};

struct Answer {
  int count;
  Manifold manifold;
};

struct Row {
  std::int64_t pairs = 0, missed = 0, not_finite = 0, over = 0;
  std::int64_t calls = 0, refused = 0, stopped = 0, hung = 0;
  double error = 0, taken = 0, given_away = 0;
  std::vector<double> nanoseconds;
  std::int64_t broken = 0;
  std::vector<std::uint64_t> which;
};

int find(const Item& item, const Method& method, Manifold& out) {
  const ConvexPair& pair = item.pair;
  if (!method.ccd) return find_general_contacts(pair.a, pair.b, pair.shapes(), {.margin = item.margin}, &out);
  NarrowPhaseStats stats;
  return find_contacts_by_libccd(pair.a, pair.b, pair.shapes(), item.margin, *method.ccd, &out, stats);
}

/// The oracle's bodies relative to the first one's place, which the narrow phase uses as origin too.
struct Exact {
  oracle::Convex a, b;
  explicit Exact(const ConvexPair& pair)
      : a(pair.a, pair.data_a.hull, pair.a.solid.position),
        b(pair.b, pair.data_b.hull, pair.a.solid.position) {}
  double separation_along(const Vec3& n) const {
    return static_cast<double>(oracle::separation_along(a, b, n.cast<oracle::Real>().normalized()));
  }
};

/// Finds the true separation. The oracle's samples may miss the largest separation, and no direction exceeds
/// it; therefore the directions that the methods find are tried too.
void find_truth(Item& item) {
  const Exact exact(item.pair);
  item.truth = static_cast<double>(oracle::separation(exact.a, exact.b));
  for (const Method& method : methods) {
    Manifold m;
    if (find(item, method, m) > 0) item.truth = std::max(item.truth, exact.separation_along(m.normal));
  }
}

void judge_axes(const Item& item, Row& row) {
  const ConvexPair& pair = item.pair;
  const ConvexBody a(pair.a, &pair.data_a, pair.a.solid.position),
      b(pair.b, &pair.data_b, pair.a.solid.position);
  ConvexAxes axes;
  best_axes(a, b, HUGE_VAL, std::min(a.size(), b.size()), axes);
  const double error = (item.truth - axes.best.separation) / pair.smallest;
  row.error = std::max(row.error, error);
  row.over += error > tolerance::libccd_excess + rounding * pair.length / pair.smallest;
}

/// Judges libccd on one pair. Returns false if it continued after its budget.
bool judge_libccd(const Item& item, libccd::Method method, Row& row) {
  const ConvexPair& pair = item.pair;
  const ConvexBody a(pair.a, &pair.data_a, pair.a.solid.position),
      b(pair.b, &pair.data_b, pair.a.solid.position);
  const double size = std::min(a.size(), b.size());
  ConvexAxes axes;
  if (!best_axes(a, b, item.margin, size, axes) || axes.best.separation >= 0) return true;
  NarrowPhaseStats stats;
  if (const auto axis = detail::certified_axis(a, b, axes, size, method, stats))
    row.taken = std::max(row.taken, (item.truth - axis->separation) / pair.smallest);
  row.calls += stats.ccd_calls;
  row.refused += stats.ccd_rejected;
  row.stopped += stats.ccd_stopped;
  const int budget = detail::support_budget_of(a, b);
  const libccd::Answer answer = detail::ask_libccd(a, b, method, budget);
  if (answer.direction) {
    const double error = (item.truth - separation_along(a, b, *answer.direction)) / pair.smallest;
    row.error = std::max(row.error, error);
    row.over += error > tolerance::libccd_excess + rounding * pair.length / pair.smallest;
  }
  const bool hung = answer.supports > budget + supports_to_end;
  row.hung += hung;
  return !hung;
}

/// Returns whether the contact was found, with the depth of the overlap.
bool judge_contact(const Item& item, const Answer& answer, Row& row) {
  const double slack = rounding * item.pair.length;
  const double allowed =
      oracle::most_given_away(item.truth, item.pair.smallest) + tolerance::same_feature * item.pair.smallest;
  const Manifold& m = answer.manifold;
  if (answer.count == 0) {
    const bool missed = item.truth + allowed + slack < item.margin;
    row.missed += missed;
    return !missed;
  }
  double gap = HUGE_VAL;
  bool finite = m.normal.allFinite();
  for (int k = 0; k < m.count; ++k) {
    finite = finite && m.points[k].position.allFinite() && std::isfinite(m.points[k].gap);
    gap = std::min(gap, m.points[k].gap);
  }
  row.not_finite += !finite;
  const double off = std::fabs(gap - item.truth);
  row.given_away = std::max(row.given_away, (off - slack) / allowed);
  return finite && off <= allowed + slack;
}

void judge(const Item& item, const Method& method, const Answer& answer, Row& row) {
  ++row.pairs;
  bool good = judge_contact(item, answer, row);
  if (method.ccd) {
    good = judge_libccd(item, *method.ccd, row) && good;
  } else {
    judge_axes(item, row);
  }
  row.broken += !good;
  if (!good && row.which.size() < 5) row.which.push_back(item.n);
}

void print_share(std::int64_t part, std::int64_t whole) {
  std::printf(" %7.3f %%", whole > 0 ? 100.0 * static_cast<double>(part) / static_cast<double>(whole) : 0.0);
}

void print(const std::string& name, const Method& method, Row& row) {
  std::printf("%-17s %-7s %7lld %5lld %4lld %8.1e", name.c_str(), method.name,
              static_cast<long long>(row.pairs), static_cast<long long>(row.missed),
              static_cast<long long>(row.not_finite), row.error);
  print_share(row.over, method.ccd ? row.calls : row.pairs);
  std::printf(" %8.1e %10.4f", method.ccd ? row.taken : row.error, row.given_away);
  if (method.ccd) {
    print_share(row.refused, row.calls);
    print_share(row.stopped, row.calls);
    std::printf(" %4lld", static_cast<long long>(row.hung));
  } else {
    std::printf(" %9s %9s %4s", "-", "-", "-");
  }
  const auto middle = row.nanoseconds.begin() + std::ssize(row.nanoseconds) / 2;
  std::nth_element(row.nanoseconds.begin(), middle, row.nanoseconds.end());
  std::printf(" %7.0f", *middle);
  if (row.broken > 0) std::printf("  BROKEN by %lld:", static_cast<long long>(row.broken));
  for (const std::uint64_t n : row.which) std::printf(" %llu", static_cast<unsigned long long>(n));
  std::printf("\n");
  std::fflush(stdout);
}

/// Tests every `step`-th item of the families from `first` on. Returns false if a bound was broken.
bool run(const std::string& name, const std::vector<ConvexFamily>& families, std::uint64_t first,
         std::uint64_t step, std::int64_t pairs) {
  std::vector<Row> rows(std::size(methods));
  std::vector<Item> items;
  std::vector<Answer> answers(batch);
  for (std::int64_t done = 0; done < pairs;) {
    items.clear();
    for (; done < pairs && std::ssize(items) < batch; ++done) {
      const auto k = static_cast<std::uint64_t>(done);
      const std::uint64_t n = first + step * (k / families.size());
      items.push_back({make_pair(families[k % families.size()], n), 0, 0, n});
      items.back().margin = k / families.size() % 2 ? 0.05 * items.back().pair.smallest : 0.0;
      find_truth(items.back());
    }
    for (std::size_t m = 0; m < rows.size(); ++m) {
      const double start = now(CLOCK_PROCESS_CPUTIME_ID);
      for (std::size_t k = 0; k < items.size(); ++k)
        answers[k].count = find(items[k], methods[m], answers[k].manifold);
      const double elapsed = now(CLOCK_PROCESS_CPUTIME_ID) - start;
      rows[m].nanoseconds.push_back(1e9 * elapsed / static_cast<double>(items.size()));
      for (std::size_t k = 0; k < items.size(); ++k) judge(items[k], methods[m], answers[k], rows[m]);
    }
  }
  for (std::size_t m = 0; m < rows.size(); ++m) print(name, methods[m], rows[m]);
  return std::all_of(rows.begin(), rows.end(), [](const Row& row) { return row.broken == 0; });
}

int run_all(int argc, char** argv) {
  const Options options = parse(argc, argv, {{"--pairs", "66000"}, {"--by", "family"}});
  const bool by_kind = options.at("--by") == "kind";
  if (!by_kind && options.at("--by") != "family") throw InputError("--by: must be family or kind");
  std::vector<ConvexFamily> families;
  for (int f = 0; f < static_cast<int>(ConvexFamily::count); ++f)
    families.push_back(static_cast<ConvexFamily>(f));
  const auto rows = by_kind ? static_cast<std::int64_t>(oracle::convex_kinds) : std::ssize(families);
  const std::int64_t each = std::max<std::int64_t>(1, std::stoll(options.at("--pairs")) / rows);
  std::printf("%-17s %-7s %7s %5s %4s %8s %9s %8s %10s %9s %9s %4s %7s\n", by_kind ? "kind" : "family",
              "method", "pairs", "miss", "NaN", "error", "over", "taken", "given away", "refused", "stopped",
              "hang", "ns");
  bool good = true;
  for (std::int64_t r = 0; r < rows; ++r) {
    const auto k = static_cast<std::uint64_t>(r);
    good = (by_kind ? run(oracle::kind_name(k), families, k, oracle::convex_kinds, each)
                    : run(oracle::name_of(families[k]), {families[k]}, 0, 1, each)) &&
           good;
  }
  return good ? 0 : 1;
}

}  // namespace

}  // namespace scree::bench

int main(int argc, char** argv) {
  return scree::bench::status_of("scree_bench_convex", [&] { return scree::bench::run_all(argc, argv); });
}
