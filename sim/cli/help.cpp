// Help and completion are made from one table, so that they always agree; the keys of --set come from the
// table of the scene language. The scripts of the shells are in packaging/.
#include "sim/cli/help.hpp"

#include "sim/cli/commands.hpp"
#include "sim/record/outcome.hpp"
#include "sim/scene/completion.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <string_view>

namespace scree::cli {

namespace {

std::vector<std::string> names_of(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

class Help : public CLI::Formatter {
 public:
  // CLI11 would write --no-render{false}, and -o,--output, which help2man takes for one name.
  std::string make_option_name(const CLI::Option* option, bool is_positional) const override {
    if (is_positional) return option->get_type_name();
    return fmt::format("{}", fmt::join(names_of(*option), ", "));
  }
  std::string make_option_opts(const CLI::Option* option) const override {
    if (option->get_positional() || option->get_type_size() == 0) return "";
    return " " + option->get_type_name();
  }
  std::string make_option_desc(const CLI::Option* option) const override {
    const bool is_told = option->get_required() && option->nonpositional();
    return option->get_description() + (is_told ? " (required)" : "");
  }
  std::string make_expanded(const CLI::App* command) const override {
    std::string usage = make_usage(command, "scree " + command->get_name());
    usage.erase(0, usage.find(' ') + 1);
    usage.erase(usage.find_last_not_of('\n') + 1);
    return fmt::format("{}:\n  {}.\n\n{}{}", usage, command->get_description(),
                       without_heading(make_positionals(command)),
                       without_heading(make_groups(command, CLI::AppFormatMode::Sub)));
  }

  std::string make_subcommands(const CLI::App* app, CLI::AppFormatMode mode) const override {
    const std::string text = CLI::Formatter::make_subcommands(app, mode);
    return mode == CLI::AppFormatMode::All ? "\n*Commands*\n" + without_heading(text) : text;
  }
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override {
    const std::string text = CLI::Formatter::make_help(app, name, mode);
    // The manual page has a section of its own for the exit status.
    return mode == CLI::AppFormatMode::All ? text.substr(0, text.rfind(app->get_footer())) : text;
  }

 private:
  static std::string without_heading(const std::string& group) {
    return group.empty() ? group : group.substr(group.find('\n', 1) + 1);
  }
};

/// The completions for a value of some type: files, as the first line of complete() names them, and words.
struct Offer {
  std::string files = "none";
  std::vector<std::string> words = {};
};

Offer offer_of(const std::string& type) {
  if (type == "SCENE" || type == "PATH") return {"files yaml"};
  if (type == "MANIFEST") return {"files json"};
  if (type == "FILE") return {"files"};
  if (type.starts_with("DIR")) return {"folders"};
  if (type == "TEMPLATE" || type == "NAME") return {"none", template_names()};
  if (type.find('|') != std::string::npos) return {"none", CLI::detail::split(type, '|')};
  return {};
}

void print_word(std::string_view typed, const std::string& word, const std::string& meaning) {
  if (word.starts_with(typed)) fmt::print("{}\t{}\n", word, meaning);
}

void print_offer(const Offer& offer, std::string_view typed, const std::string& before = "") {
  fmt::print("{}\n", offer.files);
  for (const std::string& word : offer.words) print_word(typed, before + word, "");
}

/// Prints the completions of an option's value of which `typed` is there. `before` is the text before it in
/// the same word: the option's name and `=`.
void print_values(const std::string& type, std::string_view typed, const std::string& before = "") {
  if (!type.starts_with("KEY=")) return print_offer(offer_of(type), before + std::string(typed), before);
  fmt::print("{}\n", typed.find('=') == typed.npos ? "keys" : "none");
  for (const Continuation& next : continuations_of(typed)) print_word("", before + next.text, next.help);
}

const CLI::Option* option_named(const CLI::App& command, const std::string& name) {
  const CLI::Option* option = name.starts_with('-') ? command.get_option_no_throw(name) : nullptr;
  return option != nullptr && option->get_type_size() != 0 ? option : nullptr;
}

void print_options(const CLI::App& command, std::string_view typed) {
  fmt::print("none\n");
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : names_of(*option)) print_word(typed, name, option->get_description());
}

/// Returns the completions of the positional argument that comes after the words `before`; the last
/// positional argument takes all further words.
Offer positional_after(const CLI::App& command, const std::vector<std::string>& before) {
  std::ptrdiff_t given = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (option_named(command, before[i]) != nullptr)
      ++i;  // skips the option's value
    else if (!before[i].starts_with('-'))
      ++given;
  }
  for (const CLI::Option* option :
       command.get_options([](const CLI::Option* one) { return one->get_positional(); }))
    if (given-- < option->get_expected_max()) return offer_of(option->get_type_name());
  return {};
}

void complete_in(const CLI::App& command, const std::vector<std::string>& before, const std::string& typed) {
  if (const auto* option = before.empty() ? nullptr : option_named(command, before.back()))
    return print_values(option->get_type_name(), typed);
  const std::size_t equals = typed.find('=');
  if (const auto* option = option_named(command, typed.substr(0, equals)); option && equals != typed.npos)
    return print_values(option->get_type_name(), std::string_view(typed).substr(equals + 1),
                        typed.substr(0, equals + 1));
  if (typed.starts_with('-')) return print_options(command, typed);
  if (command.get_name() == "bench")
    return print_offer(before.empty() ? Offer{"none", benchmark_names()} : Offer{"files"}, typed);
  print_offer(positional_after(command, before), typed);
}

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

/// Returns CLI11's message with A and B in other words, if it is "A`between`B`end`"; else as it is.
std::string reworded(const std::string& message, std::string_view between, std::string_view end,
                     fmt::format_string<std::string, std::string> words) {
  const std::size_t at = message.find(between);
  if (at == std::string::npos || !message.ends_with(end)) return message;
  const std::size_t second = at + between.size();
  return fmt::format(words, message.substr(0, at),
                     message.substr(second, message.size() - end.size() - second));
}

std::string words_of(const CLI::ParseError& error) {
  const std::string message = error.what();
  if (dynamic_cast<const CLI::ExcludesError*>(&error) != nullptr)
    return reworded(message, " excludes ", "", "give {} or {}, not both");
  if (dynamic_cast<const CLI::RequiresError*>(&error) != nullptr)
    return reworded(message, " requires ", "", "{} needs {}");
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr)
    return reworded(message, ": 1 required ", " missing", "{}: needs a value, {}");
  return message;
}

void complete_command(const CLI::App& app, const std::string& typed) {
  if (typed.starts_with('-')) return print_options(app, typed);
  fmt::print("none\n");
  for (const CLI::App* command : commands_of(app))
    if (!command->get_group().empty()) print_word(typed, command->get_name(), command->get_description());
}

}  // namespace

void set_help(CLI::App& app) {
  const auto help = std::make_shared<Help>();
  app.formatter(help);
  for (CLI::App* command : app.get_subcommands([](CLI::App*) { return true; })) command->formatter(help);
  app.set_help_all_flag("--help-all", "Print the help of every command and exit");
}

int complete(const CLI::App& app, const std::vector<std::string>& words) {
  const std::string typed = words.empty() ? "" : words.back();
  const auto commands = commands_of(app);
  const auto found =
      words.size() < 2 ? commands.end() : std::ranges::find(commands, words.front(), &CLI::App::get_name);
  if (words.size() < 2)
    complete_command(app, typed);
  else if (found != commands.end())
    complete_in(**found, {words.begin() + 1, words.end() - 1}, typed);
  else
    fmt::print("none\n");
  return status_done;
}

std::string complaint_of(const CLI::App& app, const CLI::ParseError& error) {
  const std::vector<CLI::App*> given = app.get_subcommands();
  return fmt::format("{}; see scree {}--help", words_of(error),
                     given.empty() ? "" : given.front()->get_name() + " ");
}

}  // namespace scree::cli
