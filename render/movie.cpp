#include "render/movie.hpp"

#include "core/error.hpp"
#include "core/program.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <string>
#include <unistd.h>
#include <vector>

namespace scree::render {

namespace {

// Writes the file's contents through to the disk. Returns the value of errno, or 0.
int sync(const std::filesystem::path& file) {
  const int descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC);
  const int error = descriptor >= 0 && fsync(descriptor) == 0 ? 0 : errno;
  if (descriptor >= 0) close(descriptor);
  return error;
}

}  // namespace

void make_movie(const std::filesystem::path& frames, double fps, const std::filesystem::path& file) {
  std::filesystem::path part = file;
  part += ".part";
  // Without -xerror ffmpeg ends with status 0 if the disk gets full while it writes the file's index. With
  // crf 17 small spheres stay crisp. The colour tags name the encoding to which the colours are converted.
  const std::vector<std::string> command = {
      "ffmpeg",
      "-nostdin",
      "-hide_banner",
      "-loglevel",
      "error",
      "-xerror",
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
  try {
    run_program(command);
    if (const int unsynced = sync(part)) throw RunError(std::strerror(unsynced));
    if (std::rename(part.c_str(), file.c_str()) != 0) throw RunError(std::strerror(errno));
  } catch (const RunError& error) {
    std::remove(part.c_str());
    throw RunError("cannot make " + file.string() + ": " + error.what());
  }
}

}  // namespace scree::render
