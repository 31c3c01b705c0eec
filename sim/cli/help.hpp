// The texts about the command line that are made from CLI11's tables: the help, from which the manual page is
// made, the completion of words in a shell, and complaints about arguments.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace scree::cli {

/// Sets the format of the help of the program and of its commands: an option is shown with all of its names,
/// and a value with the name of its kind. --help-all shows every command, each under a heading that help2man
/// recognises.
void set_help(CLI::App& app);

/// Prints how the last of the words, which may be incomplete, can be completed after the others (which do not
/// include the program's name). The first line says which files may come (`none`, `folders`, `files`, or
/// `files EXTENSION`), or that a word may be continued after its completion (`keys`); each further line is a
/// word, a tab, and its meaning.
int complete(const CLI::App& app, const std::vector<std::string>& words);

/// Returns CLI11's complaint about the arguments in the names that the help shows, and the command whose help
/// has more.
std::string complaint_of(const CLI::App& app, const CLI::ParseError& error);

}  // namespace scree::cli
