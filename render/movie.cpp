#include "render/movie.hpp"

#include "core/error.hpp"

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <spawn.h>
#include <string>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

extern char** environ;

namespace scree::render {

namespace {

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& reason) {
  throw RunError("cannot make " + file.string() + ": " + reason);
}

// A file descriptor that closes itself.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  void close() {
    if (fd_ >= 0) ::close(fd_);
    fd_ = -1;
  }
  int get() const { return fd_; }

 private:
  int fd_;
};

struct Outcome {
  int status = 0;     // as waitpid gives it
  std::string words;  // the last that it wrote to standard error
};

// Runs a program from the PATH without a shell and waits for it. Returns errno's value if it cannot start.
int run(const std::vector<std::string>& command, Outcome& outcome) {
  std::array<int, 2> ends;
  if (pipe2(ends.data(), O_CLOEXEC) != 0) return errno;
  Descriptor from(ends[0]), to(ends[1]);
  std::vector<char*> arguments;
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, to.get(), STDERR_FILENO);
  pid_t child = 0;
  const int error = posix_spawnp(&child, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) return error;

  to.close();
  constexpr std::size_t kept = 2000;
  std::array<char, 4096> chunk;
  for (;;) {
    const ssize_t got = read(from.get(), chunk.data(), chunk.size());
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) break;
    outcome.words.append(chunk.data(), static_cast<std::size_t>(got));
    if (outcome.words.size() > kept) outcome.words.erase(0, outcome.words.size() - kept);
  }
  while (waitpid(child, &outcome.status, 0) < 0 && errno == EINTR) {
  }
  return 0;
}

// Makes the file's contents safe on the disk. Returns errno's value.
int sync(const std::filesystem::path& file) {
  const Descriptor descriptor(open(file.c_str(), O_RDONLY | O_CLOEXEC));
  return descriptor.get() >= 0 && fsync(descriptor.get()) == 0 ? 0 : errno;
}

}  // namespace

void make_movie(const std::filesystem::path& frames, double fps, const std::filesystem::path& file) {
  std::filesystem::path part = file;
  part += ".part";
  // crf 17 keeps small spheres crisp; the colours are tagged as what they are converted to.
  const std::vector<std::string> command = {
      "ffmpeg",
      "-nostdin",
      "-hide_banner",
      "-loglevel",
      "error",
      "-y",
      "-framerate",
      std::to_string(fps),
      "-i",
      (frames / "%05d.png").string(),
      "-vf",
      "crop=trunc(iw/2)*2:trunc(ih/2)*2:0:0,scale=out_color_matrix=bt709:out_range=tv,format=yuv420p",
      "-c:v",
      "libx264",
      "-crf",
      "17",
      "-preset",
      "medium",
      "-colorspace",
      "bt709",
      "-color_primaries",
      "bt709",
      "-color_trc",
      "iec61966-2-1",
      "-color_range",
      "tv",
      "-movflags",
      "+faststart",
      "-f",
      "mp4",
      part.string()};
  Outcome outcome;
  const int error = run(command, outcome);
  if (error == ENOENT) fail(file, "the program ffmpeg is not installed");
  if (error != 0) fail(file, std::string("ffmpeg does not start: ") + std::strerror(error));
  std::string reason;
  if (WIFSIGNALED(outcome.status)) {
    reason = "ffmpeg was ended by signal " + std::to_string(WTERMSIG(outcome.status));
  } else if (WEXITSTATUS(outcome.status) != 0) {
    reason = "ffmpeg failed: " + outcome.words;
  } else if (const int unsynced = sync(part)) {
    reason = std::strerror(unsynced);
  } else if (std::rename(part.c_str(), file.c_str()) != 0) {
    reason = std::strerror(errno);
  }
  if (!reason.empty()) {
    std::remove(part.c_str());
    fail(file, reason);
  }
}

}  // namespace scree::render
