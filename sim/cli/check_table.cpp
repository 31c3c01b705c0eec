#include "sim/cli/check_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace scree::cli {

namespace {

/// The words in the order of Verdict.
constexpr std::array<const char*, 5> verdict_words = {"pass", "FAIL", "ERROR", "-", "seeds"};
constexpr const char* row = "  {:<5}  {:<48}  {:>16}  {:>24}  {:>10}  {:>10}";

std::string words_of_measured(const CheckResult& check) {
  if (!check.half_width) return fmt::format("{:.10g}", check.measured);
  return fmt::format("{:.6g} +-{:.2g}", check.measured, *check.half_width);
}

}  // namespace

std::string check_header() {
  return fmt::format(row, "", "check", "measured", "expected", "tolerance", "margin");
}

std::vector<std::string> check_lines(const std::vector<CheckResult>& checks) {
  std::vector<std::string> lines;
  for (const CheckResult& check : checks) {
    const char* verdict = verdict_words[static_cast<std::size_t>(check.verdict)];
    if (!check.problem.empty()) {
      lines.push_back(fmt::format("  {:<5}  {:<48}  {}", verdict, check.check, check.problem));
      continue;
    }
    lines.push_back(fmt::format(row, verdict, check.check, words_of_measured(check), check.expected,
                                check.tolerance ? fmt::format("{:.3g}", *check.tolerance) : "-",
                                fmt::format("{:.3g}", check.margin)));
  }
  return lines;
}

std::string check_counts(const std::vector<CheckResult>& checks) {
  const auto count = [&](Verdict verdict) {
    return std::ranges::count(checks, verdict, &CheckResult::verdict);
  };
  std::string words = fmt::format("{} passed, {} failed", count(Verdict::passed),
                                  count(Verdict::failed) + count(Verdict::not_evaluated));
  if (const auto n = count(Verdict::not_reached); n > 0) words += fmt::format(", {} not reached", n);
  if (const auto n = count(Verdict::of_seeds); n > 0)
    words += fmt::format(", {} need{} all seeds: use scree verify", n, n == 1 ? "s" : "");
  return words;
}

}  // namespace scree::cli
