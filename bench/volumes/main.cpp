// The benchmark of bounding volumes around boxes: their tightness, the false pairs in their PCS, and their
// costs. It uses one thread.
//
//   scree_bench_volumes [--family cubes,rods_10,...] [--n 30000] [--overlaps 4] [--margin 0]
//                       [--rounds 9]
//
// It prints a row for each kind of volume, for each family of bodies (bodies.hpp). The exit status is 1 if a
// volume misses a pair of bodies that overlap. Times are CPU times, medians of interleaved rounds after one
// to warm up. --margin is the distance by which the volumes exceed the bodies, relative to the bodies'
// smallest half extents. --overlaps is the number of others that each body would overlap without walls: twice
// the pairs per body.
//   bytes         size of one volume
//   tight         mean ratio of a volume to the body's own
//   pairs         pairs of volumes that overlap, per body
//   false         false ones of these, per pair of bodies that overlap (by the 15 axes of the narrow phase)
//   missed        pairs of bodies that overlap although their volumes do not
//   update        ns: one volume from position and orientation
//   random, near  ns: one test, of random bodies, and of bodies as near as those that a grid tests
//   tests         tests that scree's grid makes, per body
//   narrow        ns: narrow phase of a false pair; - if there are under 200
//   alone         ns per body: update + tests x near + false pairs x narrow
//   second, left  if AABBs make the PCS, and this volume is tested for each pair of it: ns of that test,
//                 and false pairs that are left, per true pair
//   after         ns per body: AABBs alone up to their PCS + update + pairs x second + left x narrow phase
#include "bench/options.hpp"
#include "bench/volumes/comparison.hpp"

#include <tbb/global_control.h>

#include <algorithm>
#include <cstdio>
#include <string>

namespace scree::bench {

namespace {

std::string title_of(BoxFamily family) {
  std::string name = name_of(family);
  std::ranges::replace(name, ' ', '_');
  return name;
}

BoxFamily find_family(const std::string& name) {
  for (int f = 0; f < static_cast<int>(BoxFamily::count); ++f) {
    if (name == title_of(static_cast<BoxFamily>(f))) return static_cast<BoxFamily>(f);
  }
  throw InputError("--family " + name + ": unknown");
}

void print(const FamilyReport& report, const VolumeRow& row) {
  std::printf("%-15s %5zu %8.2f %7.2f %7.3f %6lld %7.1f %7.1f %6.1f %7.1f", row.name, row.bytes,
              row.tightness, row.pairs, row.false_pairs / report.true_pairs,
              static_cast<long long>(row.missed), row.update, row.random_test, row.near_test, row.tests);
  if (row.narrow > 0) {
    std::printf(" %7.0f", row.narrow);
  } else {
    std::printf(" %7s", "-");
  }
  std::printf(" %8.0f", FamilyReport::alone(row));
  if (&row != &report.rows.front()) {
    std::printf(" %7.1f %7.3f %8.0f", row.second_test, row.left / report.true_pairs, report.after_aabb(row));
  }
  std::printf("\n");
}

/// Prints the rows of a family. Returns false if a pair was missed.
bool run(BoxFamily family, const ComparisonSettings& settings) {
  const FamilyReport report = compare_volumes(family, settings);
  std::printf("\n%s: %.3g of the volume filled, %.2f pairs per body (%.2f without walls)\n", name_of(family),
              report.fraction, report.true_pairs, report.random_pairs);
  std::printf("%-15s %5s %8s %7s %7s %6s %7s %7s %6s %7s %7s %8s %7s %7s %8s\n", "", "bytes", "tight",
              "pairs", "false", "missed", "update", "random", "near", "tests", "narrow", "alone", "second",
              "left", "after");
  for (const VolumeRow& row : report.rows) print(report, row);
  std::fflush(stdout);
  return std::ranges::all_of(report.rows, [](const VolumeRow& row) { return row.missed == 0; });
}

int run_all(int argc, char** argv) {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  std::string every_family;
  for (int f = 0; f < static_cast<int>(BoxFamily::count); ++f)
    every_family += title_of(static_cast<BoxFamily>(f)) + ",";
  const Options options = parse(argc, argv,
                                {{"--family", every_family},
                                 {"--n", "30000"},
                                 {"--overlaps", "4"},
                                 {"--margin", "0"},
                                 {"--rounds", "9"}});
  const ComparisonSettings settings = {.bodies = std::stoll(options.at("--n")),
                                       .overlaps_per_body = std::stod(options.at("--overlaps")),
                                       .margin = std::stod(options.at("--margin")),
                                       .rounds = std::stoi(options.at("--rounds"))};
  if (settings.bodies < 2 || settings.rounds < 1 || !(settings.overlaps_per_body > 0 && settings.margin >= 0))
    throw InputError("--n must be at least 2, --rounds 1, --overlaps over 0, --margin not under 0");
  bool good = true;
  for (const std::string& name : split(options.at("--family")))
    good = run(find_family(name), settings) && good;
  return good ? 0 : 1;
}

}  // namespace

}  // namespace scree::bench

int main(int argc, char** argv) {
  return scree::bench::status_of("scree_bench_volumes", [&] { return scree::bench::run_all(argc, argv); });
}
