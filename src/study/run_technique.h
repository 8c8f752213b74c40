// Runs a technique on a view and measures it.
#pragma once

#include "study/results.h"
#include "techniques/technique.h"

namespace lightgrid {

// A technique made ready on a view: programs built, buffers there. Several may live side by side, so that what is
// compared runs interleaved.
class TechniqueRun {
 public:
  TechniqueRun(Devices& devices, const Scene& scene, const View& view, const Settings& settings, const Technique& technique);

  // One frame, from the first draw to the image read back; its time goes into the result unless `warmup`.
  void run_frame(bool warmup = false);
  // More frames with a wait after each pass, for the time of each: up to five, or as many as a second holds.
  void run_profiled_frames();

  const Image& image() const { return image_; }
  Frame& frame() { return frame_; }
  const Technique& technique() const { return technique_; }

  // All but `pairs` and `error`, which need the oracle and the reference image.
  RunResult result() const;

 private:
  void render();

  const Technique& technique_;
  Frame frame_;
  Image image_;
  std::vector<double> frame_ms_;
};

}  // namespace lightgrid
