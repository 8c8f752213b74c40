// Flicker of a sequence of pictures in FLIP's terms: how much more visible the step from each frame to the
// next is than the truth's (docs/details/frontier.md#sequences).
#pragma once

#include <functional>
#include <vector>

#include "base/image.h"
#include "measures/flip.h"
#include "measures/results.h"

namespace lightgrid::lab {

// A picture as a display shows it: linear RGB from 0 to 1, exposed and tone-mapped as its PNG file is, but
// not rounded to bytes, since rounding flickers by itself. NaN stays.
Image shown_image(const Image& image, const Exposure& exposure);

// The pixels (x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1) of the frame before that show what this pixel
// shows, and how much each of them counts; those that count nothing may be outside of the image. They add up
// to 1, or are 0: the frame before does not show it.
struct CarriedPixel {
  int x = 0, y = 0;
  float weights[4] = {};
};

// A frame of the truth. All images have one size.
struct TruthFrame {
  Image shown;                             // shown_image
  const SeenByFlip* seen = nullptr;        // `shown`
  std::vector<CarriedPixel> carried = {};  // row 0 at the bottom; empty: each pixel is itself
  std::vector<float> step = {};            // step_map from the frame before; empty: it is the same
};

// FLIP between a frame and the one before carried to it (TruthFrame::carried); where that does not show a
// pixel, the frame itself is put. `seen`: the frame.
std::vector<float> step_map(const Image& frame, const SeenByFlip& seen, const Image& before,
                            const std::vector<CarriedPixel>& carried);

// Means over frames; shares and values as in DisplayedFlip.
struct SequenceFigures {
  DisplayedFlip flicker;       // by how much each step from the frame before exceeds the truth's, if it does
  double largest_flicker = 0;  // the mean over pixels of the frame where that is largest
  DisplayedFlip displayed;     // FLIP against the truth's frame
};

// An exponential mean of a display's linear values over frames: the newest counts this much, and of the first
// frames as much as each other.
inline constexpr float newest_frame_counts = 0.1f;

// Measures one picture frame by frame. It keeps one of them.
class FlickerMeter {
 public:
  // `filtered`: measures the mean over frames (newest_frame_counts) in place of the frames themselves. The
  // mean follows surfaces by TruthFrame::carried; where the frame before does not show them, or is NaN, it
  // begins anew.
  explicit FlickerMeter(bool filtered) : filtered_(filtered) {}

  // The next frame, a shown_image. `counts`: it is one of those that figures() are of.
  void add(const Image& shown, const TruthFrame& truth, bool counts = true);
  // All 0 without a frame.
  SequenceFigures figures() const;

 private:
  Image filtered(const Image& shown, const TruthFrame& truth) const;
  DisplayedFlip flicker(const Image& picture, const TruthFrame& truth,
                        const std::function<const SeenByFlip&()>& seen) const;

  bool filtered_;
  Image last_;
  int frames_ = 0, counted_ = 0, steps_ = 0;
  DisplayedFlip error_;  // error of the last frame
  SequenceFigures sums_;
};

}  // namespace lightgrid::lab
