// The finished image on the host.
#pragma once

#include <optional>
#include <vector>

#include "base/image.h"
#include "cl/transfer.h"
#include "passes/common/frame.h"

namespace lightgrid {

// A frame's pixels where the host can read them, row 0 at the bottom: OpenCL's own memory where that is a
// CPU's, until this object goes or the view draws again; else a copy in `copy`, which keeps its memory from
// frame to frame.
template <typename Pixel>
class HostPixels {
 public:
  // May be written, which changes no later frame.
  Pixel* pixels() { return mapped_ ? static_cast<Pixel*>(mapped_->data()) : copy_.data(); }
  // Into `copy`, if they are not there.
  void keep();

 protected:
  HostPixels(PassContext& work, SharedBuffer* in_cl, GLuint framebuffer, GLenum type,
             std::vector<Pixel>& copy);

 private:
  std::vector<Pixel>& copy_;
  std::optional<MappedBuffer> mapped_;
};

// Its light.
struct HostImage : HostPixels<glm::vec4> {
  HostImage(PassContext& work, const ShadedImage& shaded, Image& copy);
};

// Its picture in bytes (passes/tone_map.h).
struct HostPicture : HostPixels<glm::u8vec4> {
  HostPicture(PassContext& work, const DisplayedImage& displayed, std::vector<glm::u8vec4>& copy);
};

// Copies the image to the host.
void read_back(PassContext& work, const ShadedImage& shaded, Image& image);

}  // namespace lightgrid
