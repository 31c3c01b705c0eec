// The command line: its commands and options, which become calls, and its errors, which become exit statuses.
#include "core/error.hpp"
#include "core/timing.hpp"
#include "sim/cli/commands.hpp"
#include "sim/cli/console.hpp"
#include "sim/cli/help.hpp"
#include "sim/record/build_info.hpp"
#include "sim/record/outcome.hpp"
#include "sim/scene/reader.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <exception>
#include <fcntl.h>
#include <functional>
#include <map>
#include <new>
#include <ranges>
#include <string>
#include <tuple>
#include <unistd.h>
#include <vector>

namespace {

using namespace scree;
using namespace scree::cli;

void add_overrides(CLI::App& command, std::vector<Override>& overrides) {
  const auto take = [&overrides](const std::vector<std::string>& settings) {
    for (const std::string& setting : settings) {
      const std::size_t equals = setting.find('=');
      if (equals == 0 || equals == std::string::npos)
        throw CLI::ValidationError("--set", setting + ": not KEY=VALUE");
      overrides.push_back({setting.substr(0, equals), setting.substr(equals + 1)});
    }
    return true;
  };
  command
      .add_option("--set", CLI::callback_t(take), "Set any key of the scene, e.g. bodies[2].velocity[0]=3")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

/// Requires the value of an option to be one of the names, which help and completion show. `choices` must
/// outlive the option.
template <class T>
void choose(CLI::Option* option, const std::map<std::string, T>& choices) {
  const auto number_of = [&choices](std::string& word) -> std::string {
    const auto found = choices.find(word);
    if (found == choices.end())
      return fmt::format("must be one of {}, not {}", fmt::join(choices | std::views::keys, ", "),
                         printable(word));
    word = std::to_string(static_cast<int>(found->second));
    return {};
  };
  option->transform(CLI::Validator(number_of, ""))
      ->type_name(fmt::format("{}", fmt::join(choices | std::views::keys, "|")));
}

/// Requires a finite number >= 0. CLI11's own validators tell the user the largest double, digit by digit.
CLI::Validator not_negative() {
  const auto complaint = [](const std::string& word) -> std::string {
    double number = 0;
    if (CLI::detail::lexical_cast(word, number) && number >= 0 && std::isfinite(number)) return {};
    return fmt::format("must be a number >= 0, not {}", printable(word));
  };
  return {complaint, ""};
}

/// Requires a whole number > 0 that an int can hold.
CLI::Validator positive() {
  const auto complaint = [](const std::string& word) -> std::string {
    int number = 0;
    if (CLI::detail::lexical_cast(word, number) && number > 0) return {};
    return fmt::format("must be a whole number > 0, not {}", printable(word));
  };
  return {complaint, ""};
}

void add_simulation(CLI::App& command, SimulationOptions& options, const char* threads) {
  options.all_forces = false;  // a run shows no forces but those that its checks measure
  static const std::map<std::string, SpaceChoice> spaces = {
      {"auto", SpaceChoice::automatic}, {"host", SpaceChoice::host}, {"cuda", SpaceChoice::cuda}};
  choose(command.add_option("--device", options.space, "Where to run"), spaces);
  command.add_option("--threads", options.threads, threads)->check(positive())->type_name("N");
}

void add_context(CLI::App& command, render::ContextChoice& context) {
  static const std::map<std::string, render::ContextChoice> contexts = {
      {"auto", render::ContextChoice::automatic},
      {"osmesa", render::ContextChoice::osmesa},
      {"egl", render::ContextChoice::egl}};
  choose(command.add_option(
             "--context", context,
             "What draws: osmesa (the processor), egl (a GPU if there is one), or auto: egl where there is "
             "a GPU, else osmesa"),
         contexts);
}

CLI::App* add_run(CLI::App& app, RunArguments& arguments) {
  CLI::App* command = app.add_subcommand("run", "Run a scene; writes output/NAME/");
  CLI::Option* scene = command->add_option("SCENE", arguments.scene, "Scene file")->type_name("SCENE");
  CLI::Option* reproduce =
      command
          ->add_option("--reproduce", arguments.reproduce,
                       "Run again what this manifest.json tells of, write nothing, compare the states")
          ->excludes(scene)
          ->type_name("MANIFEST");
  command->final_callback([=] {
    if (scene->count() + reproduce->count() != 1) throw CLI::RequiredError("SCENE");
  });
  command->add_option("-o,--output", arguments.output, "Run folder instead of output/NAME")
      ->excludes(reproduce)
      ->type_name("DIR");
  add_overrides(*command, arguments.overrides);
  add_simulation(*command, arguments.simulation,
                 "Threads to use (default: all cores); never changes the result");
  command->add_option("--until", arguments.until, "Stop at this time (s) instead of the scene's end")
      ->check(not_negative())
      ->excludes(reproduce)
      ->type_name("T");
  command->add_flag("!--no-render", arguments.draw, "Draw nothing");
  add_context(*command, arguments.context);
  command->add_flag_callback(
      "--profile", [] { timing::time_calls(true); }, "Time every parallel call too, into the manifest");
  CLI::Option* resume =
      command
          ->add_flag("--resume", arguments.resume,
                     "Continue from the newest checkpoint in the folder; from the start if there is none")
          ->excludes(reproduce);
  command->add_flag("--overwrite", arguments.overwrite, "Replace an earlier run in the folder")
      ->excludes(resume)
      ->excludes(reproduce);
  command
      ->add_option("--max-hours", arguments.max_hours,
                   "Stop after so long, with a checkpoint to resume from (exit status 130)")
      ->check(not_negative())
      ->excludes(reproduce)
      ->type_name("H");
  return command;
}

CLI::App* add_plan(CLI::App& app, PlanArguments& arguments, bool& schema, bool& reference) {
  CLI::App* command =
      app.add_subcommand("plan", "Say what a scene will model and what it needs; runs nothing");
  CLI::Option* scene = command->add_option("SCENE", arguments.scene, "Scene file")->type_name("SCENE");
  add_overrides(*command, arguments.overrides);
  CLI::Option* schema_flag =
      command->add_flag("--schema", schema, "Print the JSON Schema of the scene language");
  CLI::Option* reference_flag =
      command->add_flag("--reference", reference, "Print the reference of the scene language");
  command->final_callback([=] {
    if (scene->count() + schema_flag->count() + reference_flag->count() != 1) {
      throw CLI::RequiredError("one of SCENE, --schema, --reference");
    }
  });
  return command;
}

CLI::App* add_export(CLI::App& app, ExportArguments& arguments) {
  static const std::map<std::string, ExportFormat> formats = {{"vtp", ExportFormat::vtp},
                                                              {"xyz", ExportFormat::xyz},
                                                              {"lammps", ExportFormat::lammps},
                                                              {"csv", ExportFormat::csv}};
  CLI::App* command =
      app.add_subcommand("export", "Write the trajectory of a run in the format of other programs");
  command->add_option("DIR", arguments.run, "Run folder with a trajectory")->required()->type_name("DIR");
  choose(command->add_option("--to", arguments.format, "vtp (ParaView), xyz or lammps (OVITO), or csv")
             ->required(),
         formats);
  command->add_option("-o,--output", arguments.output, "Folder instead of DIR-FORMAT")->type_name("DIR");
  return command;
}

CLI::App* add_render(CLI::App& app, RenderArguments& arguments) {
  CLI::App* command =
      app.add_subcommand("render", "Draw the trajectory of a run again, with another camera, colour or size");
  command->add_option("DIR", arguments.run, "Run folder with a trajectory")->required()->type_name("DIR");
  add_overrides(*command, arguments.overrides);
  command->add_option("-o,--output", arguments.output, "Folder instead of DIR-render")->type_name("DIR");
  add_context(*command, arguments.context);
  command
      ->add_option(
          "--jobs", arguments.jobs,
          "Processes that draw (default: one for each core, as far as memory goes); never changes the "
          "result")
      ->check(positive())
      ->type_name("N");
  command->add_flag("--overwrite", arguments.overwrite, "Replace earlier pictures in the folder");
  return command;
}

CLI::App* add_report(CLI::App& app, std::filesystem::path& run) {
  CLI::App* command = app.add_subcommand("report", "Make the page that tells of a run again");
  command->add_option("DIR", run, "Run folder")->required()->type_name("DIR");
  return command;
}

CLI::App* add_compare(CLI::App& app, CompareArguments& arguments) {
  CLI::App* command =
      app.add_subcommand("compare", "Say how far the numbers of two runs differ, column by column");
  command->add_option("DIR_A", arguments.first, "Run folder")->required()->type_name("DIR_A");
  command->add_option("DIR_B", arguments.second, "Run folder")->required()->type_name("DIR_B");
  command
      ->add_option("--tolerance", arguments.tolerance,
                   "Relative to the largest magnitude in a column (default: 0)")
      ->check(not_negative())
      ->type_name("T");
  command
      ->add_option("--absolute", arguments.absolute,
                   "No more than this, in a column's unit, is within any tolerance (default: 0)")
      ->check(not_negative())
      ->type_name("A");
  return command;
}

void add_variations(CLI::App& command, std::vector<Variation>& variations) {
  const auto take = [&variations](const std::vector<std::string>& texts) {
    for (const std::string& text : texts) variations.push_back(parse_variation(text));
    return true;
  };
  command
      .add_option("--vary", CLI::callback_t(take),
                  "Try each of these values, with all combinations, e.g. response.mode=default,accurate")
      ->type_name("KEY=V1,V2,...")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

CLI::App* add_verify(CLI::App& app, VerifyArguments& arguments) {
  CLI::App* command = app.add_subcommand("verify", "Run every scene that has checks; writes no run folder");
  command->add_option("PATH", arguments.paths, "Scene files, or folders to search")
      ->required()
      ->type_name("PATH");
  add_overrides(*command, arguments.overrides);
  add_variations(*command, arguments.variations);
  add_simulation(*command, arguments.simulation,
                 "Threads for each scene (default: 1, and as many scenes as cores)");
  command->add_option("--json", arguments.json, "Write the table there too")->type_name("FILE");
  CLI::Option* label =
      command->add_option("--label", arguments.label, "Only scenes with this label")->type_name("LABEL");
  command->add_flag("--all", arguments.all, "Scenes labelled long too")->excludes(label);
  return command;
}

CLI::App* add_study(CLI::App& app, StudyArguments& arguments) {
  CLI::App* command = app.add_subcommand(
      "study", "Speed against error: run a scene with checks in all combinations of settings");
  command->add_option("SCENE", arguments.scene, "Scene file, with checks")->required()->type_name("SCENE");
  add_variations(*command, arguments.variations);
  add_overrides(*command, arguments.overrides);
  command->add_option("-o,--output", arguments.output, "Folder instead of output/NAME-study")
      ->type_name("DIR");
  add_simulation(*command, arguments.simulation, "Threads for each run (default: 1)");
  command->add_option("--repeats", arguments.repeats, "Runs of which each time is the median (default: 3)")
      ->check(positive())
      ->type_name("N");
  command->add_flag("--overwrite", arguments.overwrite, "Replace an earlier study in the folder");
  return command;
}

CLI::App* add_new(CLI::App& app, NewArguments& arguments) {
  CLI::App* command = app.add_subcommand("new", "Write a commented scene to start from, NAME.yaml");
  CLI::Option* name =
      command->add_option("NAME", arguments.name, "What to call it; without, lists the templates")
          ->type_name("NAME");
  command->add_option("--from", arguments.from, "Template to copy (default: the one called NAME)")
      ->needs(name)
      ->type_name("TEMPLATE");
  return command;
}

/// Adds a command that reads the words after it itself, --help included.
CLI::App* add_prefix(CLI::App& app, const char* name, const char* description) {
  CLI::App* command = app.add_subcommand(name, description);
  command->prefix_command();
  command->set_help_flag();
  return command;
}

/// Opens /dev/null for each of the three standard streams that is closed: else a file of the run would get
/// its number, and messages would go into that file.
void open_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(stream, F_GETFD) < 0) std::ignore = ::open("/dev/null", O_RDWR);
}

/// Throws RunError if the output could not be written: for commands whose result is what they print. A run
/// does not need this, as its results are in its folder.
int after_printing(int status) {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return status;
  throw RunError(fmt::format("cannot write to standard output: {}", std::strerror(errno)));
}

/// A command, and the function that carries it out once its options are known and returns the exit status.
struct Command {
  const CLI::App* app;
  std::function<int()> run;
};

/// The values of the options of all commands.
struct Arguments {
  RunArguments run;
  PlanArguments plan;
  VerifyArguments verify;
  StudyArguments study;
  ExportArguments trajectory;
  RenderArguments render;
  CompareArguments compare;
  NewArguments scene;
  std::filesystem::path reported;
  bool schema = false, reference = false;
};

/// Adds the commands in the order in which the help shows them.
std::vector<Command> add_commands(CLI::App& app, Arguments& all) {
  std::vector<Command> commands;
  const auto add = [&](const CLI::App* command, auto act) { commands.push_back({command, act}); };
  const auto add_printing = [&](const CLI::App* command, auto act) {
    commands.push_back({command, [act] { return after_printing(act()); }});
  };
  add(add_run(app, all.run), [&] { return run(all.run); });
  add_printing(add_plan(app, all.plan, all.schema, all.reference), [&] {
    return all.schema ? print_schema() : all.reference ? print_reference() : plan(all.plan);
  });
  add_printing(add_verify(app, all.verify), [&] { return verify(all.verify); });
  add_printing(add_study(app, all.study), [&] { return study(all.study); });
  add_printing(add_export(app, all.trajectory), [&] { return export_trajectory(all.trajectory); });
  add_printing(add_render(app, all.render), [&] { return render_again(all.render); });
  add_printing(add_report(app, all.reported), [&] { return report(all.reported); });
  add_printing(add_compare(app, all.compare), [&] { return compare(all.compare); });
  const CLI::App* to_bench =
      add_prefix(app, "bench", "Run a benchmark: scree bench NAME ...; lists them without");
  add(to_bench, [to_bench] { return bench(to_bench->remaining()); });
  add_printing(add_new(app, all.scene), [&] { return write_new_scene(all.scene); });
  add_printing(app.add_subcommand("info", "Say what this program is and what it finds on this machine"),
               [] { return info(); });
  const CLI::App* to_complete = add_prefix(app, "complete", "Tell a shell what may come next")->group("");
  add(to_complete, [&app, to_complete] { return complete(app, to_complete->remaining()); });
  return commands;
}

/// Tells the user what an exception of a command means. Returns the exit status.
int status_of_failure(const CLI::App& app, const std::exception_ptr& failure) {
  try {
    std::rethrow_exception(failure);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help
    print_error(complaint_of(app, error));
    return status_bad_input;
  } catch (const InputError& error) {
    print_error(error.what());
    return status_bad_input;
  } catch (const std::bad_alloc&) {
    print_error("out of memory; `scree plan` says what a scene needs");
    return status_run_failed;
  } catch (const std::exception& error) {
    print_error(error.what());
    return status_run_failed;
  }
}

}  // namespace

int main(int argc, char** argv) {
  open_standard_streams();
  CLI::App app(
      "scree simulates rigid particles, such as spheres and boxes, from a YAML scene to pictures and "
      "numbers.",
      "scree");
  app.footer("Exit status: 0 done; 1 a check failed; 2 bad input; 3 the run failed; 130 interrupted.");
  app.require_subcommand(1);
  app.set_version_flag("--version", "scree " + build_info().version, "Print the version and exit");
  Arguments arguments;
  const std::vector<Command> commands = add_commands(app, arguments);
  set_help(app);
  try {
    app.parse(argc, argv);
    // Exactly one command was given, by require_subcommand(1).
    return std::ranges::find_if(commands, [](const Command& c) { return c.app->parsed(); })->run();
  } catch (const std::exception&) {
    return status_of_failure(app, std::current_exception());
  }
}
