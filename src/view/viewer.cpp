#include "view/viewer.h"

#include <algorithm>
#include <cmath>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "base/error.h"
#include "base/timer.h"
#include "base/write_file.h"
#include "view/controls.h"
#include "view/interface.h"

namespace lightgrid {
namespace {

constexpr double script_step_s = 1.0 / 60;
constexpr double longest_step_s = 0.1;  // limits the camera's movement after a slow frame
constexpr double idle_wait_s = 1;
constexpr int frames_after_event = 3;  // Dear ImGui opens a list one to two frames after a click
constexpr int least_picture_px = 64;
constexpr PicturePixel no_pixel{-1, -1};
constexpr int dropped_shown = 10;  // lights that culling dropped at the clicked pixel

}  // namespace

Viewer::Viewer(Window& window, ViewJob job)
    : window_(window),
      job_(std::move(job)),
      renderer_(job_.device, window.make_context()),
      gpu_(renderer_, job_.scene),
      screen_(renderer_),
      interface_(std::make_unique<Interface>(window, job_.scripted)),
      controls_(job_.controls),
      camera_(job_.scene, job_.camera, double(job_.view.width) / job_.view.height),
      motion_(job_.scene, LightMotion::none, job_.seconds),
      reference_(renderer_, gpu_),
      sides_{{renderer_, gpu_}, {renderer_, gpu_}},
      width_(job_.view.width),
      height_(job_.view.height) {
  if (!job_.scripted) window_.limit_size(panel_width + least_picture_px, least_picture_px);
}

Viewer::~Viewer() = default;

void Viewer::run() {
  Timer timer;
  for (int number = 0; !window_.closing() && !controls_.quit && (!job_.scripted || number < job_.frames);
       ++number) {
    const bool events = window_.poll(!job_.scripted && number > 2 && idle() ? idle_wait_s : 0);
    awake_frames_ = events || window_.input_waits() ? frames_after_event : std::max(awake_frames_ - 1, 0);
    seconds_ = job_.scripted ? script_step_s : std::min(timer.elapsed_ms() / 1000, longest_step_s);
    timer = Timer();
    now_s_ += seconds_;
    frame(number);
    window_.show();
  }
  if (job_.scripted && !job_.screenshot.empty()) screen_.save(job_.screenshot);
}

bool Viewer::idle() const {
  bool waits = true;
  for (int i = 0; i < 2; ++i) {
    const bool map_open = controls_.sides[i].map != SideMap::picture && sides_[i].ready();
    waits = waits && !(map_open && !controls_.playing && !maps_[i].shows(controls_.sides[i].map, sides_[i]));
  }
  return waits && awake_frames_ == 0 && !moved_ && !drew_ && resolution_.resting() && !controls_.playing &&
         !controls_.draw_always;
}

void Viewer::frame(int number) {
  if (!job_.scripted) {
    width_ = std::max(window_.width() - panel_width, 1);
    height_ = std::max(window_.height(), 1);
  }
  take_input(number);
  draw_sides();
  follow_maps();
  follow_pixel();
  if (!controls_.pixel_file.empty()) write_pixel(std::exchange(controls_.pixel_file, {}));
  show(shown());
  if (std::exchange(controls_.screenshot, false)) take_screenshot();
}

void Viewer::take_input(int number) {
  if (job_.scripted) job_.script.play(number, controls_, script_input_);
  const Input input = job_.scripted ? script_input_ : window_.input();
  interface_->begin(input, width_ + panel_width, height_);
  const PointerResult pointed =
      pointer_.follow(input, width_, height_, controls_.line, !interface_->takes_pointer());
  if (pointed.line) controls_.line = *pointed.line;
  if (pointed.click) controls_.pixel = pointed.click;
  moved_ = camera_.turn(pointed.turn_x, pointed.turn_y, height_);
  if (!interface_->takes_keys()) {
    moved_ |= camera_.move(input.held, seconds_);
    if (!job_.scripted) {
      if (window_.was_pressed(GLFW_KEY_SPACE)) controls_.playing = !controls_.playing;
      if (window_.was_pressed(GLFW_KEY_PERIOD)) controls_.step = true;
      if (window_.was_pressed(GLFW_KEY_F12)) controls_.screenshot = true;
    }
  } else {
    window_.forget_presses();
  }
  if (controls_.camera) {
    camera_.go_to(*controls_.camera, double(width_) / height_);
    controls_.camera.reset();
    moved_ = true;
  }
  if (controls_.pixel) {
    controls_.pixel = PicturePixel{std::clamp(controls_.pixel->x, 0, width_ - 1),
                                   std::clamp(controls_.pixel->y, 0, height_ - 1)};
  }
}

void Viewer::draw_sides() {
  if (controls_.playing || controls_.step || controls_.seconds) camera_.hold(double(width_) / height_);
  const SceneChanges changes = motion_.follow(controls_, seconds_);
  if (!motion_.can_play()) controls_.playing = false;
  gpu_.update(changes);
  if (!changes.empty()) reference_.scene_changed();
  fraction_ = resolution_.next(moved_, seconds_, controls_.rate);
  const int width = std::max(int(std::lround(width_ * fraction_)), 1);
  const int height = std::max(int(std::lround(height_ * fraction_)), 1);
  const bool resized = width != drawn_width_ || height != drawn_height_;
  drawn_width_ = width;
  drawn_height_ = height;
  const bool looks = moved_ || resized || !changes.empty();
  if (looks) view_ = camera_.view(width, height);
  drew_ = false;
  double ms = 0;
  for (int i = 0; i < 2; ++i) {
    const bool made = sides_[i].choose(controls_.sides[i], view_);
    if (!made && looks) sides_[i].look(view_, changes);
    if (sides_[i].draw(controls_.draw_always, controls_.measure_passes)) drew_ = true;
    if (job_.scripted && !sides_[i].problem().empty()) throw input_error("view: {}", sides_[i].problem());
    plans_[i].follow(sides_[i].run().view().plan, now_s_);
    ms += sides_[i].frame_ms();
  }
  if (drew_) resolution_.measured(ms);
}

// Maps need a full picture at rest. One that blocks the window is announced a frame before.
void Viewer::follow_maps() {
  if (!resolution_.resting() || controls_.playing) return;
  for (int i = 0; i < 2; ++i) {
    const SideMap wanted = controls_.sides[i].map;
    if (wanted == SideMap::picture || !sides_[i].ready() || maps_[i].shows(wanted, sides_[i])) continue;
    if (wanted == SideMap::difference && !job_.scripted && !std::exchange(map_announced_[i], true)) continue;
    map_announced_[i] = false;
    maps_[i].follow(wanted, sides_[i], job_.scripted, [&]() -> const Image& {
      return reference_.draw(sides_[i].run().view().view, controls_.sides[i].settings);
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
    const bool current = pixel_[i] && !moved && pixel_picture_[i] == sides_[i].pictures();
    if (current) continue;
    pixel_[i].reset();
    if (!resolution_.resting() || controls_.playing || !sides_[i].ready()) continue;
    const ListedFrame listed = read_listed_frame(sides_[i].run());
    pixel_[i] = lights_at(listed, *controls_.pixel);
    if (const auto inspection = inspect_pixel(sides_[i].run(), listed.frame, *controls_.pixel))
      add_margins(*pixel_[i], *inspection, dropped_shown);
    pixel_picture_[i] = sides_[i].pictures();
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
    for (const LightVerdict& light : pixel_[i]->lights) {
      const auto [where, decided] = lines_of(light, job_.scene);
      text += fmt::format("{}\n  {}\n", where, decided);
    }
  }
  write_file(file, text);
}

Shown Viewer::shown() {
  Shown shown{.scene = job_.scene,
              .camera = camera_,
              .motion = motion_,
              .sides = {&sides_[0], &sides_[1]},
              .maps = {&maps_[0], &maps_[1]},
              .map_notes = {},
              .plans = plans_,
              .pixel = pixel_,
              .pixel_is_new = pixel_is_new_,
              .commands = {},
              .note = note_,
              .picture_width = width_,
              .picture_height = height_,
              .fraction = fraction_,
              .now_s = now_s_};
  for (int i = 0; i < 2; ++i) {
    const SideControls& side = controls_.sides[i];
    if (side.map != SideMap::picture && !maps_[i].shows(side.map, sides_[i])) {
      shown.map_notes[i] = !resolution_.resting() ? "(when the camera rests)"
                           : controls_.playing    ? "(when paused)"
                                                  : "(computing)";
    }
    shown.commands[i] =
        render_command(job_.scene_words, width_, height_, camera_.text(), motion_.words(), side);
  }
  return shown;
}

void Viewer::show(const Shown& shown) {
  ScreenImage images[2];
  for (int i = 0; i < 2; ++i) {
    const bool map =
        controls_.sides[i].map != SideMap::picture && maps_[i].shows(controls_.sides[i].map, sides_[i]);
    images[i] = {map ? maps_[i].texture() : sides_[i].picture(), map};
  }
  screen_.begin(width_ + panel_width, height_);
  screen_.draw(images[0], images[1], controls_.line, width_);
  show_overlay(controls_, shown);
  show_panels(controls_, shown);
  interface_->end();
  screen_.finish();
}

void Viewer::take_screenshot() {
  std::filesystem::path path;
  std::error_code unreadable;
  do {
    path = fmt::format("lightgrid_view_{:03}.png", screenshots_++);
  } while (std::filesystem::exists(path, unreadable));
  screen_.save(path);
  note_ = path.string();
}

}  // namespace lightgrid
