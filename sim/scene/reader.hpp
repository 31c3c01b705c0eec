// The position of the reader in a scene, and the error messages about that position.
#pragma once

#include "core/error.hpp"
#include "sim/scene/document.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace scree {

/// Returns the candidate nearest to the word by edit distance, or empty if none is near enough to be meant.
std::string_view nearest(std::string_view word, const std::vector<std::string_view>& candidates);

/// Returns " (did you mean x?)", or an empty text.
std::string suggestion(std::string_view word, const std::vector<std::string_view>& candidates);

/// Returns the hint about a word that a section does not have: the advice in the table of hints, else
/// suggestion().
std::string hint_for(std::string_view section, std::string_view word,
                     const std::vector<std::string_view>& candidates);

/// One part of a path such as bodies[2].velocity: a key, or an index into a list.
struct PathPart {
  std::string_view key;
  std::int64_t index = -1;  ///< negative: a key
};

std::string to_text(const std::vector<PathPart>& path);

/// Returns the text on one line, with control characters written out, so that a terminal shows them as text.
std::string printable(std::string_view text);

class Reader {
 public:
  Reader(std::string file, std::vector<Override> overrides)
      : file_(std::move(file)), overrides_(std::move(overrides)) {}

  /// Extends the path in messages by a key or list index, for as long as the Step exists.
  class [[nodiscard]] Step {
   public:
    Step(Reader& reader, std::string_view key) : path_(reader.path_) { path_.push_back({key, -1}); }
    Step(Reader& reader, std::size_t index) : path_(reader.path_) {
      path_.push_back({{}, static_cast<std::int64_t>(index)});
    }
    ~Step() { path_.pop_back(); }
    Step(const Step&) = delete;
    Step& operator=(const Step&) = delete;

   private:
    std::vector<PathPart>& path_;
  };

  /// Throws InputError: file:line:column: key: what.
  [[noreturn]] void fail(const SourceMark& mark, std::string_view what) const;

  /// Throws InputError about an item of the map given, with the line and column of the map if the item is
  /// absent.
  [[noreturn]] void fail_at(std::string_view key, const Node& map, std::string_view what);

  /// Keeps an error, so that more can be found.
  void note(const InputError& error);
  std::size_t errors() const { return errors_; }
  /// Returns whether so many errors are kept that reading on is of no use.
  bool gives_up() const { return errors_ >= most_errors; }
  /// Throws InputError with the first few errors noted, if there are any.
  void finish() const;

  /// Returns "file:line:column", or the --set that gave the value.
  std::string place(const SourceMark& mark) const;

  /// Marks a value and everything in it as given by an override.
  static void mark_override(Node& node, std::size_t index);

 private:
  static constexpr std::size_t most_errors = 1000;

  friend class Step;
  std::string file_;
  std::vector<Override> overrides_;
  std::vector<PathPart> path_;
  std::vector<std::string> told_;
  std::size_t errors_ = 0;
};

}  // namespace scree
