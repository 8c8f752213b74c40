// Checks every index of a glTF file before any is used.
#pragma once

#include "scene/gltf/document.h"

namespace lightgrid::gltf {

// Indices out of range are errors everywhere, also in unused parts, but for those of animations, which their
// reader checks. The readers check that a buffer view fits its buffer, an accessor its view and an index
// value its vertices.
void check_indices(const Document& doc, size_t buffer_count);

}  // namespace lightgrid::gltf
