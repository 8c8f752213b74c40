// The kernels, shaders and page templates, built into the program.
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace lightgrid {

// Text by path: "kernels/culling/cpu/depth_bounds.cl", "shaders/forward.frag", "shared/light_grid.h".
const std::map<std::string, std::string, std::less<>>& embedded_files();

// One file's text; asserts that it is there.
const std::string& embedded_file(std::string_view path);

// The text with each #include "path" replaced by the file of that path, each file once.
std::string with_includes(std::string_view path);

}  // namespace lightgrid
