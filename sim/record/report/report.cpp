#include "sim/record/report/report.hpp"

#include "core/error.hpp"
#include "sim/record/files.hpp"
#include "sim/record/guards.hpp"
#include "sim/record/json.hpp"
#include "sim/record/report/charts.hpp"
#include "sim/record/report/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace scree {

namespace fs = std::filesystem;

namespace report {

namespace {

std::string read_text(const fs::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

std::string text_of(const Json& value) {
  return escaped(value.is_string() ? value.get<std::string>() : value.dump());
}

std::string notice(const char* kind, std::string_view html) {
  return fmt::format("<p class=\"notice {}\">{}</p>\n", kind, html);
}

std::string tile(std::string_view value, std::string_view words) {
  return fmt::format("<div class=\"tile\"><b>{}</b><span>{}</span></div>\n", value, words);
}

/// Returns the greatest value of a column in all rows, without NaN; 0 if there is none.
double worst(const Columns& metrics, const std::string& name) {
  const Column* column = metrics.find(name);
  double worst = 0;
  if (column != nullptr)
    for (const double value : *column) worst = std::fmax(worst, value);
  return worst;
}

std::string count(std::int64_t n) {
  std::string digits = std::to_string(n);
  for (auto at = static_cast<std::int64_t>(digits.size()) - 3; at > 0; at -= 3)
    digits.insert(static_cast<std::size_t>(at), "\u202f");
  return digits;
}

std::string head(const Json& run) {
  const auto status = run.at("status").get<std::string>();
  const char* place = run.at("space") == "cuda" ? "on the GPU (CUDA)" : "on the processor";
  return fmt::format(
      "<h1>{} <span class=\"status {}\">{}</span></h1>\n<p class=\"lead\">{}: {}{}, {} precision</p>\n",
      text_of(run.at("scene").at("name")), status, status, place, text_of(run.at("machine").at("cpu")),
      run.at("machine").contains("gpu") ? ", " + text_of(run.at("machine").at("gpu")) : "",
      text_of(run.at("precision")));
}

std::string tiles(const Json& run, const Columns& metrics) {
  const auto steps = run.at("steps").get<std::int64_t>();
  const double wall = run.at("wall_s");
  const auto bodies = run.at("observation").at("bodies").get<std::int64_t>();
  const auto rate = wall > 0 ? static_cast<double>(steps) / wall : 0;
  return "<div class=\"tiles\">\n" +
         tile(fmt::format("{:.6g} s", run.at("time").get<double>()), "simulated") +
         tile(count(steps), fmt::format("steps of {}", count(run.at("steps_total")))) +
         tile(count(bodies), "bodies at the end") +
         tile(fmt::format("{:.4g} s", wall), fmt::format("of wall time, {:.3g} steps a second", rate)) +
         tile(fmt::format("{:.2g} m", worst(metrics, "penetration_max")),
              fmt::format("largest overlap, {} of the smaller body",
                          percent_words(worst(metrics, "penetration_relative_max")))) +
         tile(fmt::format("{:.2g}", worst(metrics, "energy_unexplained")),
              "largest unexplained energy, as a share of the energy scale") +
         "</div>\n";
}

/// Returns the errors and warnings of the run, which come first on the page.
std::string notices(const Json& run) {
  std::string html;
  if (run.contains("error")) html += notice("bad", "The run failed: " + text_of(run.at("error")));
  if (run.at("status") == "interrupted")
    html += notice(
        "", "The run was interrupted; run the same command with <code>--resume</code> to continue it.");
  for (const Json& check : run.at("checks")) {
    if (check.at("verdict") == "failed") html += notice("bad", "Check failed: " + text_of(check.at("check")));
    if (check.at("verdict") == "not evaluated")
      html += notice("bad", fmt::format("Check not evaluated: {}: {}", text_of(check.at("check")),
                                        text_of(check.at("problem"))));
    if (check.at("verdict") == "not reached")
      html += notice("", fmt::format("Check not reached: {}: {}", text_of(check.at("check")),
                                     text_of(check.at("problem"))));
  }
  for (const Json& warning : run.at("warnings")) html += notice("", text_of(warning));
  for (const auto& [name, guard] : run.at("guards").items())
    if (guard.at("count") > 0 && guard.at("matters") == true)
      html += notice("", fmt::format("{}: {}; {}. To have fewer: {}.", text_of(guard.at("what")),
                                     count(guard.at("count")), text_of(guard.at("effect")),
                                     text_of(guard.at("setting"))));
  return html.empty()
             ? notice("good",
                      "No warnings, no failed checks, and no limit was reached that changes the result.")
             : html;
}

/// Returns a table of what guards and limits have counted, and how much it matters.
std::string guards(const Json& run) {
  std::vector<std::vector<std::string>> rows = {{"count", "event", "effect on the run", "to have fewer"}};
  for (const auto& [name, guard] : run.at("guards").items())
    if (guard.at("count") > 0)
      rows.push_back({count(guard.at("count")), text_of(guard.at("what")),
                      fmt::format("{}{}", guard.at("matters") == true ? "<b>matters</b>: " : "",
                                  text_of(guard.at("effect"))),
                      text_of(guard.at("setting"))});
  return rows.size() > 1 ? table(rows) : std::string();
}

/// Returns the picture of a failure, and the first, the middle and the last frame.
std::string pictures(const Json& run, const fs::path& folder) {
  std::string html;
  if (fs::exists(folder / "failure.png"))
    html += picture(folder / "failure.png", "The bodies named by the error, before the step that failed");
  const auto frames = run.at("frames").get<std::int64_t>();
  std::vector<std::int64_t> numbers = {0, frames / 2, frames - 1};
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  if (frames > 0)
    for (const std::int64_t number : numbers)
      html += picture(folder / "frames" / fmt::format("{:05}.png", number),
                      fmt::format("Frame {} of {}", number + 1, frames));
  if (html.empty()) return {};
  html = "<div class=\"grid\">\n" + html + "</div>\n";
  if (run.contains("movie"))
    html += fmt::format("<p>All of them: <a href=\"{0}\">{0}</a></p>\n", text_of(run.at("movie")));
  return html;
}

/// Returns a number of a check, or a dash if there is none.
std::string number_of(const Json& check, const char* key) {
  const auto found = check.find(key);
  return found != check.end() && found->is_number() ? fmt::format("{:.6g}", found->get<double>()) : "–";
}

std::string checks(const Json& run) {
  if (run.at("checks").empty()) return {};
  std::vector<std::vector<std::string>> rows = {{"", "check", "measured", "expected", "tolerance", "margin"}};
  for (const Json& check : run.at("checks")) {
    const auto verdict = check.at("verdict").get<std::string>();
    const char* kind = verdict == "passed"                                 ? "pass"
                       : verdict == "failed" || verdict == "not evaluated" ? "fail"
                                                                           : "";
    rows.push_back({fmt::format("<span class=\"{}\">{}</span>", kind, escaped(verdict)),
                    text_of(check.at("check")), number_of(check, "measured"), text_of(check.at("expected")),
                    number_of(check, "tolerance"), number_of(check, "margin")});
  }
  return table(rows);
}

std::string stages(const Json& run) {
  std::vector<std::pair<double, std::string>> entries;
  for (const auto& [name, stage] : run.at("stages").items()) entries.emplace_back(stage.at("seconds"), name);
  std::ranges::sort(entries, std::greater());
  const double wall = run.at("wall_s");
  const double most = entries.empty() ? 0 : entries.front().first;
  std::vector<std::vector<std::string>> rows = {{"stage", "seconds", "of the wall time", ""}};
  for (const auto& [seconds, name] : entries)
    rows.push_back({escaped(name), fmt::format("{:.4g}", seconds),
                    fmt::format("{:.1f} %", 100 * seconds / wall),
                    fmt::format("<span class=\"bar\" style=\"width:{:.2f}%\"></span>",
                                most > 0 ? 100 * seconds / most : 0)});
  return table(rows) +
         "<p class=\"lead\">Pictures and the trajectory are made beside the steps, so that the sum may be "
         "more than the wall time.</p>\n";
}

std::string model(const Json& run) {
  std::vector<std::vector<std::string>> rows = {{"feature", "", "because"}};
  for (const auto& [name, feature] : run.at("model").items())
    rows.push_back({escaped(name), feature.at("on") == true ? "on" : "off", text_of(feature.at("reason"))});
  return table(rows);
}

/// Returns what a counter of the manifest counts, where its name does not say it; else an empty text.
std::string_view words_of_counter(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 5> words = {
      {{"cuts", "substeps cut where a sliding contact came to stick"},
       {"scaled", "groups of contacts whose impulses were made smaller, since they would have gained energy"},
       {"long_direct", "groups of contacts solved by a second direct solution, with higher limits"},
       {"pcs_made", "times that the broad phase found new pairs"},
       {"direct_failed", "groups of contacts that the direct solver left to the sweeps"}}};
  const auto found = std::ranges::find(words, name, &std::pair<std::string_view, std::string_view>::first);
  return found == words.end() ? "" : found->second;
}

std::string counters(const Json& run) {
  std::vector<std::vector<std::string>> rows = {{"counter", "value", ""}};
  for (const auto& [name, value] : run.at("counters").items())
    if (value.is_number())
      rows.push_back({escaped(name), text_of(value), std::string(words_of_counter(name))});
  return table(rows);
}

std::string provenance(const Json& run, const fs::path& folder) {
  const Json& program = run.at("program");
  const Json& machine = run.at("machine");
  std::vector<std::vector<std::string>> rows = {{"item", ""}};
  const auto add = [&](const char* what, const std::string& html) {
    rows.push_back({what, "<code>" + html + "</code>"});
  };
  add("program", fmt::format("scree {}, commit {}, {}, {}", text_of(program.at("version")),
                             text_of(program.at("commit")), text_of(program.at("build")),
                             text_of(program.at("compiler"))));
  add("machine", fmt::format("{}, {} cores{}", text_of(machine.at("cpu")), text_of(machine.at("cores")),
                             machine.contains("gpu") ? ", GPU: " + text_of(machine.at("gpu")) : ""));
  add("scene", fmt::format("{}, hash {}, seed {}", text_of(run.at("scene").at("source")),
                           text_of(run.at("scene").at("hash")), text_of(run.at("scene").at("seed"))));
  add("last state", fmt::format("step {}, hash {}", text_of(run.at("steps")), text_of(run.at("state_hash"))));
  if (run.contains("resumed_at")) add("resumed at steps", text_of(run.at("resumed_at")));
  return table(rows) +
         "<p class=\"lead\"><code>scree run --reproduce</code> with this folder's manifest runs it again and "
         "compares the states.</p>\n" +
         folded("The scene as it was run", "<pre>" + escaped(read_text(folder / "scene.yaml")) + "</pre>") +
         folded("Counters of the solver", counters(run));
}

/// Returns a section for each chapter with its plots, or a section that says why there are none.
std::string plots(const std::vector<Chapter>& chapters) try {
  std::vector<Plot> all;
  for (const Chapter& chapter : chapters)
    for (const Chart& chart : chapter.charts) all.push_back(chart.plot);
  const std::vector<std::string> drawn = draw(all);
  std::string html;
  std::size_t next = 0;
  for (const Chapter& chapter : chapters) {
    std::string figures;
    for (const Chart& chart : chapter.charts)
      figures += drawing(drawn[next++], chart.plot.title, chart.caption);
    html += section(chapter.title, "<div class=\"grid wide\">\n" + figures + "</div>\n");
  }
  return html;
} catch (const RunError& error) {
  return section(
      "Plots", notice("", fmt::format("There are none: {}. <code>scree report</code> makes this page again.",
                                      escaped(error.what()))));
}

}  // namespace

}  // namespace report

void write_report(const fs::path& folder) try {
  using namespace report;
  const Json run = parsed_manifest(folder / "manifest.json");
  const Columns metrics = read_columns(folder / "metrics.csv");
  const WallTimes wall = read_wall_times(folder / "timing.csv");
  const std::string body =
      head(run) + notices(run) + tiles(run, metrics) + section("Pictures", pictures(run, folder)) +
      section("Checks", checks(run)) + plots(chapters_of(metrics, wall)) + section("Stages", stages(run)) +
      section("Limits that were reached", guards(run)) + section("What was modelled", model(run)) +
      section("How this run was made", provenance(run, folder));
  write_file(folder / report_name, page(run.at("scene").at("name").get<std::string>() + " – scree", body));
} catch (const Json::exception&) {
  throw InputError(not_a_manifest(folder / "manifest.json"));
}

}  // namespace scree
