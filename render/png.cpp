#include "render/png.hpp"

#include "core/error.hpp"

#include <png.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>
#include <unistd.h>

namespace scree::render {

namespace {

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& reason) {
  throw RunError("cannot write " + file.string() + ": " + reason);
}

// The state of one encoding. libpng is written in C, so no exception of ours may pass through its calls. An
// error stores its message in `error`, and libpng's long jump leads back to encode().
struct Encoding {
  std::FILE* file;
  std::string error;
};

void on_error(png_structp png, png_const_charp message) {
  static_cast<Encoding*>(png_get_error_ptr(png))->error = errno != 0 ? std::strerror(errno) : message;
  png_longjmp(png, 1);
}

// Encodes into an open file. Returns false and sets encoding.error if that fails.
bool encode(Encoding& encoding, const Image& image) {
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &encoding, on_error, nullptr);
  png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
  if (png == nullptr || info == nullptr) {
    png_destroy_write_struct(&png, &info);
    encoding.error = "out of memory";
    return false;
  }
  errno = 0;
  if (setjmp(png_jmpbuf(png))) {
    png_destroy_write_struct(&png, &info);
    return false;
  }
  png_init_io(png, encoding.file);
  // Level 3 takes half the time of the default level, for files a few percent larger.
  png_set_compression_level(png, 3);
  png_set_IHDR(png, info, static_cast<png_uint_32>(image.width), static_cast<png_uint_32>(image.height), 8,
               PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_write_info(png, info);
  const std::size_t row = 3 * static_cast<std::size_t>(image.width);
  for (int y = 0; y < image.height; ++y) {
    png_write_row(png, image.rgb.data() + static_cast<std::size_t>(y) * row);
  }
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return true;
}

}  // namespace

void write_png(const std::filesystem::path& file, const Image& image) {
  std::filesystem::path part = file;
  part += ".part";
  Encoding encoding{std::fopen(part.c_str(), "wb"), {}};
  if (encoding.file == nullptr) fail(file, std::strerror(errno));
  bool written = encode(encoding, image);
  // A full disk may be reported only when the buffers are written out.
  if (written && (std::fflush(encoding.file) != 0 || fsync(fileno(encoding.file)) != 0)) {
    encoding.error = std::strerror(errno);
    written = false;
  }
  if (std::fclose(encoding.file) != 0 && written) {
    encoding.error = std::strerror(errno);
    written = false;
  }
  if (written && std::rename(part.c_str(), file.c_str()) != 0) {
    encoding.error = std::strerror(errno);
    written = false;
  }
  if (!written) {
    std::remove(part.c_str());
    fail(file, encoding.error);
  }
}

}  // namespace scree::render
