// The size of the picture while the camera moves, chosen to hold a frame rate.
#pragma once

namespace lightgrid {

class Resolution {
 public:
  // The fraction of the picture's width and height to draw: 1 at rest, and if `rate` (frames a second) is 0.
  // `moving`: the camera moved in this frame. It is at rest `seconds_to_rest` after its last move.
  double next(bool moving, double seconds, double rate);
  bool resting() const { return since_move_s_ >= seconds_to_rest; }
  // Time of a frame drawn at the fraction from the last next().
  void measured(double frame_ms);

  static constexpr double seconds_to_rest = 0.15;

 private:
  double fraction_ = 1;  // while moving
  double full_ms_ = 0;   // estimate for a full picture; 0: not measured yet
  double since_move_s_ = seconds_to_rest;
  double drawn_ = 1;
};

}  // namespace lightgrid
