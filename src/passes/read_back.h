// The finished image on the host.
#pragma once

#include <optional>

#include "base/image.h"
#include "cl/transfer.h"
#include "passes/common/frame.h"

namespace lightgrid {

// A frame's image where the host can read it: OpenCL's own memory where that is a CPU's, until this object
// goes or the view draws again; else a copy in `copy`, which keeps its memory from frame to frame.
class HostImage {
 public:
  HostImage(Work& work, const ShadedImage& shaded, Image& copy);
  // Row 0 at the bottom. May be written, which changes no later frame.
  glm::vec4* pixels();
  // Into `copy`, if it is not there.
  void keep();

 private:
  Image& copy_;
  std::optional<MappedBuffer> mapped_;
};

// Copies the image to the host.
void read_back(Work& work, const ShadedImage& shaded, Image& image);

}  // namespace lightgrid
