#include "view/fly_camera.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include <fmt/format.h>

namespace lightgrid::app {
namespace {

constexpr double steepest_rad =
    89.0 / 180 * std::numbers::pi;  // short of straight up, where yaw is undefined
constexpr double times_faster = 4;

double scene_size_m(const Scene& scene) {
  const WorldBox box = world_box(scene);
  const double size = box.empty() ? 1 : glm::length(box.max - box.min);
  return size > 0 && std::isfinite(size) ? size : 1;
}

glm::dvec3 direction(double yaw, double pitch) {
  return {-std::sin(yaw) * std::cos(pitch), std::sin(pitch), -std::cos(yaw) * std::cos(pitch)};
}

}  // namespace

FlyCamera::FlyCamera(const Scene& scene, std::string text, double aspect)
    : scene_(scene), size_m_(scene_size_m(scene)) {
  speed_m = size_m_ / 8;
  go_to(text, aspect);
}

void FlyCamera::go_to(const std::string& text, double aspect) {
  choose_camera(scene_, text, aspect);
  text_ = text;
  aspect_ = aspect;
  moved_ = false;
  const bool is_placed = text.starts_with("eye:") || text.starts_with("target:");
  near_given_ = is_placed && text.find("near:") != std::string::npos;
}

void FlyCamera::hold(double aspect) {
  if (moved_ || !text_.empty() || !scene_.cameras.empty()) return;
  start_from_scene(aspect);
  write_text();
}

// A camera of the scene may be animated: where it is now.
void FlyCamera::start_from_scene(double aspect) {
  if (moved_) return;
  const View view = make_view(choose_camera(scene_, text_, aspect), 1, 1);
  eye_ = view.eye;
  near_m_ = view.near_m;
  const glm::dvec3 forward = -glm::transpose(glm::dmat3(view.view_from_world))[2];
  yaw_ = std::atan2(-forward.x, -forward.z);
  pitch_ = std::clamp(std::asin(std::clamp(forward.y, -1.0, 1.0)), -steepest_rad, steepest_rad);
  if (!view.orthographic) fov_deg_ = 2 * std::atan(1 / view.clip_from_view[1][1]) * (180 / std::numbers::pi);
}

bool FlyCamera::turn(double dx_px, double dy_px, int height) {
  if (dx_px == 0 && dy_px == 0) return false;
  start_from_scene(aspect_);
  const double rad_a_px = fov_deg_ / 180 * std::numbers::pi / height;
  yaw_ = std::remainder(yaw_ + dx_px * rad_a_px, 2 * std::numbers::pi);
  pitch_ = std::clamp(pitch_ + dy_px * rad_a_px, -steepest_rad, steepest_rad);
  write_text();
  return true;
}

bool FlyCamera::move(const std::array<bool, 7>& held, double seconds) {
  const auto axis = [&](FlightKey plus, FlightKey minus) {
    return double(held[int(plus)]) - double(held[int(minus)]);
  };
  if (std::none_of(held.begin(), held.begin() + int(FlightKey::fast), std::identity())) return false;
  start_from_scene(aspect_);
  const glm::dvec3 forward = direction(yaw_, pitch_);
  const glm::dvec3 right(std::cos(yaw_), 0, -std::sin(yaw_));
  const glm::dvec3 way = forward * axis(FlightKey::forward, FlightKey::back) +
                         right * axis(FlightKey::right, FlightKey::left) +
                         glm::dvec3(0, axis(FlightKey::up, FlightKey::down), 0);
  if (way == glm::dvec3(0)) return false;
  eye_ += way * (speed_m * seconds * (held[int(FlightKey::fast)] ? times_faster : 1));
  write_text();
  return true;
}

// A millionth of the scene's size is far below a pixel.
void FlyCamera::write_text() {
  moved_ = true;
  const int decimals = std::clamp(6 - int(std::ceil(std::log10(size_m_))), 0, 12);
  const glm::dvec3 target = eye_ + direction(yaw_, pitch_) * (size_m_ / 4);
  const auto point = [&](const glm::dvec3& p) {
    return fmt::format("{:.{}f},{:.{}f},{:.{}f}", p.x, decimals, p.y, decimals, p.z, decimals);
  };
  const std::string near = near_given_ ? fmt::format(",near:{}", near_m_) : "";
  text_ = fmt::format("eye:{},target:{},fov:{:.6g}{}", point(eye_), point(target), fov_deg_, near);
}

View FlyCamera::view(int width, int height) {
  aspect_ = double(width) / height;
  return make_view(choose_camera(scene_, text_, aspect_), width, height);
}

}  // namespace lightgrid::app
