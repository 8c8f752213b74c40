// The work of a frame around the passes of its technique. Each stage stands in the file of its passes.
#pragma once

#include "passes/common/frame.h"

namespace lightgrid {

struct FrameStage {
  void (*begin)(PassContext&, PassCaches&) = nullptr;  // once per frame
  // Each time that the technique has shaded the frame. May change the image. Returns whether the frame must
  // be shaded again.
  bool (*shaded)(PassContext&, PassCaches&, ShadedImage& image) = nullptr;
  void (*end)(PassContext&, PassCaches&, Frame&) = nullptr;  // adds figures and readers
};

// All stages, in their order.
void begin_stages(PassContext& work, PassCaches& caches);
bool shade_again(PassContext& work, PassCaches& caches, ShadedImage& image);
void end_stages(PassContext& work, PassCaches& caches, Frame& frame);

}  // namespace lightgrid
