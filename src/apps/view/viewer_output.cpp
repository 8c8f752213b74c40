// The output for a drawn frame: maps, the lights at a pixel, the panel; and the files that scripts
// request.
#include <algorithm>

#include "base/display.h"
#include "base/error.h"
#include "base/write_file.h"
#include "run/scene_choice.h"
#include "view/viewer.h"

namespace lightgrid::app {
using namespace lab;
namespace {

constexpr PicturePixel no_pixel{-1, -1};
constexpr float opacity_over_picture = 0.6f;
constexpr double note_s = 3;
constexpr int dropped_shown = 10;  // lights that culling dropped at the clicked pixel

}  // namespace

// Maps need a full picture at rest. One that blocks the window is announced a frame before.
void Viewer::follow_maps() {
  if (!resolution_.resting() || controls_.playing) return;
  for (int i = 0; i < 2; ++i) {
    const MapChoice wanted = wanted_map(i);
    if (wanted.map == SideMap::picture || !side(i).ready() || shows_map(i)) continue;
    if (wanted.map == SideMap::difference && !job_.scripted && !std::exchange(map_announced_[i], true))
      continue;
    map_announced_[i] = false;
    maps_[i].follow(wanted, side(i), job_.scripted, [&]() -> const Image& {
      return reference_.draw(side(i).run().view().view, controls_.sides[i].settings);
    });
  }
}

void Viewer::follow_pixel() {
  pixel_is_new_ = false;
  if (!controls_.pixel) {
    pixel_ = {};
    pixel_shown_ = no_pixel;
    return;
  }
  const bool moved = *controls_.pixel != pixel_shown_;
  pixel_is_new_ = moved;
  pixel_shown_ = *controls_.pixel;
  for (int i = 0; i < 2; ++i) {
    const bool current = pixel_[i] && !moved && pixel_picture_[i] == side(i).pictures();
    if (current) continue;
    pixel_[i].reset();
    if (!resolution_.resting() || controls_.playing || !side(i).ready()) continue;
    const ListedFrame listed = read_listed_frame(side(i).run());
    pixel_[i] = lights_at(listed, *controls_.pixel);
    if (const auto inspection = inspect_pixel(side(i).run(), listed.frame, *controls_.pixel))
      add_margins(*pixel_[i], *inspection, dropped_shown);
    if (std::ranges::any_of(job_.scene.lights, &Light::casts_shadow)) {
      const FrameShadows shadows = read_frame_shadows(side(i).run());
      const PicturePixel& pixel = *controls_.pixel;
      add_shadows(*pixel_[i], job_.scene, shadows.at(pixel.x, flipped_row(pixel.y, height_), occlusion_));
      put_hidden_first(*pixel_[i]);
    }
    pixel_picture_[i] = side(i).pictures();
  }
}

// As the panel shows them.
void Viewer::write_pixel(const std::string& file) const {
  std::string text;
  for (int i = 0; i < 2; ++i) {
    text += fmt::format("{} {}\n", i == 0 ? "left" : "right", controls_.sides[i].technique);
    if (!pixel_[i]) continue;
    text +=
        fmt::format("{} listed, {} lit, {} lost\n", pixel_[i]->listed(), pixel_[i]->lit(), pixel_[i]->lost());
    const std::string shadows = shadows_at_pixel(*pixel_[i]);
    if (!shadows.empty()) text += shadows + "\n";
    for (const LightVerdict& light : pixel_[i]->lights) {
      const auto [where, decided, shadow] = lines_of(light, job_.scene);
      text += fmt::format("{}\n  {}\n", where, decided);
      if (!shadow.empty()) text += fmt::format("  {}\n", shadow);
    }
    for (const DirectionalShadow& light : pixel_[i]->directional_shadows) {
      const auto [name, shadow] = lines_of(light, job_.scene);
      text += fmt::format("{}\n  {}\n", name, shadow);
    }
  }
  write_file(file, text);
}

// As the panel shows them.
void Viewer::write_casting(const std::string& file) {
  std::string text;
  for (int i = 0; i < 2; ++i) {
    text += fmt::format("{} {}\n", i == 0 ? "left" : "right", controls_.sides[i].technique);
    const FramePlan& plan = side(i).run().view().plan;
    text += casting_summary(plan) + "\n";
    for (const LightShadow& light : plan.shadows.casting)
      text += casting_line(light, plan, job_.scene) + "\n";
  }
  write_file(file, text);
}

void Viewer::write_times(const std::string& file) const {
  std::string text;
  for (int i = 0; i < 2; ++i) {
    const Side& s = side(i);
    text += fmt::format("{} {}: {}x{}, {:.3f} ms, slowest of {} {:.3f} ms\n", i == 0 ? "left" : "right",
                        controls_.sides[i].technique, s.width(), s.height(), s.frame_ms(), s.figures(),
                        s.slowest_ms());
  }
  text += fmt::format("window: {:.3f} frames a second, compiled {}\n", frames_a_second(), compiled_.size());
  write_file(file, text);
}

double Viewer::frames_a_second() const {
  if (between_ms_.empty()) return 0;
  return 1000 / spread_of({between_ms_.begin(), between_ms_.end()}).median;
}

Shown Viewer::shown() {
  Shown shown{.scene = job_.scene,
              .camera = camera_,
              .motion = motion_,
              .sides = {&side(0), &side(1)},
              .maps = {&maps_[0], &maps_[1]},
              .notes = {},
              .plans = plans_,
              .pixel = pixel_,
              .pixel_is_new = pixel_is_new_,
              .commands = {},
              .note = note_,
              .note_is_new = now_s_ - told_s_ < note_s,
              .scene_name = job_.name,
              .scenes = job_.scenes,
              .start_camera = job_.camera,
              .view = view_,
              .pointer = {input_.x, input_.y},
              .picture_width = width_,
              .picture_height = height_,
              .fraction = fraction_,
              .now_s = now_s_,
              .rate = frames_a_second()};
  for (int i = 0; i < 2; ++i) {
    const SideControls& wanted = controls_.sides[i];
    if (i == 1 && same_ && wanted.technique != controls_.sides[0].technique)
      shown.notes[i] = "(not drawn yet)";
    if (wanted.map != SideMap::picture && !shows_map(i)) {
      const double done = maps_[i].progress();
      shown.notes[i] = !resolution_.resting() ? "(when the camera rests)"
                       : controls_.playing    ? "(when paused)"
                       : done > 0             ? fmt::format("(computing, {:.0f} %)", 100 * done)
                                              : "(computing)";
    }
    shown.commands[i] =
        render_command(job_.scene_words + (casters_.empty() ? "" : " --shadows " + shell_word(casters_)),
                       width_, height_, camera_.text(), motion_.words(), wanted);
  }
  return shown;
}

void Viewer::expose() {
  const Side& left = side(0);
  if (exposed_ || left.picture() == 0) return;
  exposed_ = true;
  Exposure exposure = job_.expose ? job_.expose({}) : Exposure();
  if (exposure.automatic) {
    exposure = job_.expose(left.read_picture());
    if (exposure.ev != 0) tell(fmt::format("pictures are exposed by {:+g} EV (--exposure)", exposure.ev));
  }
  screen_.exposure = exposure.scale();
  screen_.filmic = job_.filmic;
}

GLuint Viewer::displayed_picture(int i) {
  const Side& shown = side(i);
  if (job_.glow == 0 || shown.picture() == 0) return shown.picture();
  auto& [texture, picture] = glowing_[same_ ? 0 : i];
  if (texture.name() == 0 || picture != shown.pictures()) {
    const Image image = with_glow(shown.read_picture(), job_.glow);
    texture = make_texture_2d(GL_RGBA32F, image.width, image.height);
    glTextureSubImage2D(texture.name(), 0, 0, 0, image.width, image.height, GL_RGBA, GL_FLOAT,
                        image.pixels.data());
    picture = shown.pictures();
  }
  return texture.name();
}

void Viewer::show(const Shown& shown) {
  expose();
  ScreenImage images[2], pictures[2];
  for (int i = 0; i < 2; ++i) {
    const bool map = controls_.sides[i].map != SideMap::picture && shows_map(i);
    pictures[i] = {displayed_picture(i), false};
    images[i] = map ? ScreenImage{maps_[i].texture(), true} : pictures[i];
  }
  screen_.begin(width_ + panel_width, height_);
  const PixelGrid drawn{drawn_width_, drawn_height_};
  const bool under = controls_.picture_under && (images[0].is_map || images[1].is_map);
  if (under) screen_.draw(pictures[0], pictures[1], controls_.line, width_, drawn);
  screen_.draw(images[0], images[1], controls_.line, width_, drawn, under ? opacity_over_picture : 1);
  show_overlay(controls_, shown);
  show_panels(controls_, shown);
  interface_.end();
  screen_.finish();
}

void Viewer::tell(const std::string& note) {
  note_ = note;
  told_s_ = now_s_;
}

void Viewer::take_screenshot() {
  std::filesystem::path path;
  std::error_code unreadable;
  int number = 0;
  do {
    path = fmt::format("{}_{:03}.png", screenshot_name(job_.name, controls_.sides), number++);
  } while (std::filesystem::exists(path, unreadable));
  screen_.save(path);
  tell(path.string());
}

}  // namespace lightgrid::app
