// The progress bar of long work: on a terminal, and nowhere else.
#pragma once

#include <functional>
#include <string>

namespace lightgrid {

// Draws the bar on stderr, with an estimate of the time left; clears it when `done` reaches 1. Null where stderr is no terminal.
std::function<void(double done, const std::string& step)> progress_bar();

}  // namespace lightgrid
