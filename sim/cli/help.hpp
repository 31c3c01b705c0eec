// What the program tells of its own command line, from CLI11's tables: help, which the manual page is made
// of, and the completion of words in a shell.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace scree::cli {

/// Help of the program and of its commands: options by all of their names, values by what they are.
/// --help-all tells of every command, each under a heading that help2man takes for one.
void set_help(CLI::App& app);

/// Prints what the last word, as far as it is typed, may become after the others (without the program's
/// name): first a line that says what files there may be (`none`, `folders`, `files`, or `files EXTENSION`),
/// or that the words go on (`keys`); then a line for each word: the word, a tab, what it means.
int complete(const CLI::App& app, const std::vector<std::string>& words);

}  // namespace scree::cli
