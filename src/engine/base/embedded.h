// The kernels, shaders and page templates, built into the program.
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace lightgrid {

// Text by path: "kernels/culling/cpu/depth_bounds.cl", "shaders/forward.frag", "shared/light_grid.h".
using EmbeddedFiles = std::map<std::string, std::string, std::less<>>;
const EmbeddedFiles& embedded_files();

// One file's text; asserts that it is there.
const std::string& embedded_file(std::string_view path, const EmbeddedFiles& files = embedded_files());

// The text with each #include "path" replaced by the file of that path. The preprocessor reads each file at
// most once, at the first #include whose #if branches are all taken. "shared/effects.h" is made from the
// files of shared/effects (shared/inputs.h says what it defines).
std::string with_includes(std::string_view path, const EmbeddedFiles& files = embedded_files());

}  // namespace lightgrid
