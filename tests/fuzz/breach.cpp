#include "tests/fuzz/breach.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <sys/mman.h>
#include <unistd.h>

namespace scree {

void breach(const std::string& what) { throw std::logic_error(what); }

void require_message(std::string_view message) {
  if (message.find(": ") == std::string_view::npos) breach(fmt::format("no place: {}", message));
  for (const char c : message)
    if ((c >= 0 && c < ' ' && c != '\n') || c == 0x7F) breach(fmt::format("control character: {}", message));
}

const std::string& file_of(std::string_view bytes) {
  static const int file = memfd_create("hostile", 0);
  static const std::string path = fmt::format("/proc/self/fd/{}", file);
  if (ftruncate(file, 0) != 0 ||
      pwrite(file, bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    throw std::runtime_error("no room for the file");
  return path;
}

}  // namespace scree
