// The container of a glTF file: plain JSON, or JSON and a binary chunk in a GLB (glTF 2.0, section 4).
#pragma once

#include <span>
#include <string_view>

#include "scene/gltf/reporter.h"

namespace lightgrid::gltf {

struct Container {
  std::string_view json;
  std::span<const uint8_t> binary;  // empty without a binary chunk
  bool is_glb = false;
};

// Decided by content, not by the file's name. The parts point into `bytes`. Chunks of unknown type are
// skipped; a chunk that does not fit is an error.
Container open_container(const Reporter& report, std::span<const uint8_t> bytes);

}  // namespace lightgrid::gltf
