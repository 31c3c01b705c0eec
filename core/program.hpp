// Runs other programs that scree needs: ffmpeg, gnuplot.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace scree {

/// Runs a program of the PATH without a shell, with `input` as its standard input, and waits for it. Returns
/// what it wrote to its standard output. Throws RunError if it is not installed, does not start or fails. The
/// message says which of these happened; if the program failed, it ends with the program's last messages.
std::string run_program(const std::vector<std::string>& command, std::string_view input = {});

}  // namespace scree
