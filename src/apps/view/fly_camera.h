// A camera turned by the mouse and moved by keys, always upright.
#pragma once

#include <array>
#include <string>

#include "scene/camera.h"
#include "view/controls.h"

namespace lightgrid::app {

// Its state is the text for --camera, with decimals that suit the scene's size. The view is computed from
// that text, so that a command line with it gives the same picture to the bit.
class FlyCamera {
 public:
  // The scene outlives it. `text`: the value of --camera, for an image of this aspect. Until the user moves
  // it, it is that camera of the scene, of any kind, and follows its animation; then it is upright and
  // perspective, with the near plane from the text or else from choose_camera. Throws Error(input) as
  // choose_camera does.
  FlyCamera(const Scene& scene, std::string text, double aspect);

  // Jumps to another camera, in the form of --camera. Throws Error(input) as choose_camera does.
  void go_to(const std::string& text, double aspect);

  // Call before the scene moves: a camera that was placed to show the whole scene then stays where it is.
  void hold(double aspect);

  // Turns by pixels of a picture of this height, as if the scene were dragged. Returns whether it turned.
  bool turn(double dx_px, double dy_px, int height);
  // Moves for `seconds` by the held keys (FlightKey). Returns whether it moved.
  bool move(const std::array<bool, 7>& held, double seconds);

  View view(int width, int height);
  const std::string& text() const { return text_; }  // empty: the scene's own first camera

  double speed_m = 1;  // metres a second

 private:
  void start_from_scene(double aspect);
  void write_text();

  const Scene& scene_;
  bool moved_ = false;  // text_ is that of the members below
  std::string text_;
  double aspect_ = 1;  // the last view's
  glm::dvec3 eye_{0};
  double yaw_ = 0, pitch_ = 0, fov_deg_ = 60;  // yaw about y from -z, pitch upwards; radians
  double near_m_ = 0;
  bool near_given_ = false;  // by the text: the camera keeps it when it moves
  double size_m_ = 1;        // the scene's
};

}  // namespace lightgrid::app
