#include "passes/frame_stages.h"

namespace lightgrid {

extern const FrameStage sample_stage, shadow_stage;

// A band of shadows is stored with the means of its samples.
static const FrameStage* const stages[] = {&sample_stage, &shadow_stage};

void begin_stages(PassContext& work, PassCaches& caches) {
  for (const FrameStage* stage : stages)
    if (stage->begin) stage->begin(work, caches);
}

bool shade_again(PassContext& work, PassCaches& caches, ShadedImage& image) {
  bool again = false;
  for (const FrameStage* stage : stages) again |= stage->shaded && stage->shaded(work, caches, image);
  return again;
}

void end_stages(PassContext& work, PassCaches& caches, Frame& frame) {
  for (const FrameStage* stage : stages)
    if (stage->end) stage->end(work, caches, frame);
}

}  // namespace lightgrid
