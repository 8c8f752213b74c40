// Every index of a glTF file, before any is followed.
#pragma once

#include "scene/gltf/document.h"

namespace lightgrid::gltf {

// Indices out of range are errors wherever they are, also in what the scene does not use. That a buffer view
// fits its buffer, an accessor its view and an index value its vertices is checked where it is read.
void check_indices(const Document& doc, size_t buffer_count);

}  // namespace lightgrid::gltf
