#include "view/viewer.h"

#include <algorithm>
#include <cmath>

#include "base/compiling.h"
#include "base/error.h"
#include "base/timer.h"
#include "base/write_file.h"
#include "scene/shadow_casters.h"
#include "session/scene_choice.h"

namespace lightgrid {
namespace {

constexpr double script_step_s = 1.0 / 60;
constexpr double longest_step_s = 0.1;  // limits the camera's movement after a slow frame
constexpr double idle_wait_s = 1;
constexpr double counting_wait_s = 0.05;  // the oracle counts meanwhile
constexpr int frames_after_event = 3;  // Dear ImGui opens a list one to two frames after a click
constexpr int least_picture_px = 64;
constexpr PicturePixel no_pixel{-1, -1};
constexpr size_t frames_of_rate = 30;
constexpr double least_between_announcements_ms = 30;
constexpr float opacity_over_picture = 0.6f;
constexpr double note_s = 3;
constexpr int dropped_shown = 10;  // lights that culling dropped at the clicked pixel

}  // namespace

Viewer::Viewer(Window& window, Interface& interface, Renderer& renderer, ViewJob job)
    : window_(window),
      job_(std::move(job)),
      interface_(interface),
      renderer_(renderer),
      gpu_(renderer_, job_.scene),
      screen_(renderer_),
      controls_(job_.controls),
      camera_(job_.scene, job_.camera, double(job_.view.width) / job_.view.height),
      motion_(job_.scene, LightMotion::none, job_.seconds),
      resolution_(!job_.scripted),
      reference_(renderer_, gpu_),
      sides_{{renderer_, gpu_}, {renderer_, gpu_}},
      occlusion_(job_.scene),
      maps_{MapOfSide(occlusion_), MapOfSide(occlusion_)},
      width_(job_.view.width),
      height_(job_.view.height) {
  for (const Light& light : job_.scene.lights) own_casters_.push_back(light.casts_shadow);
  if (!job_.scripted) window_.limit_size(panel_width + least_picture_px, least_picture_px);
  before_compiling = [this](const std::string& file) {
    compiled_.insert(file);
    if (announced_.elapsed_ms() < least_between_announcements_ms) return;
    announce(fmt::format("compiling {} ({}; they are kept for the next start)", file, compiled_.size()));
    announced_ = Timer();
  };
}

Viewer::~Viewer() { before_compiling = nullptr; }

std::optional<ViewJob> Viewer::run() {
  Timer timer;
  for (int number = job_.first_frame;
       !window_.closing() && !controls_.quit && (!job_.scripted || number < job_.frames); ++number) {
    const bool settled = !job_.scripted && number > job_.first_frame + 2;
    const bool events = window_.poll(settled ? wait_s() : 0);
    awake_frames_ = events || window_.input_waits() ? frames_after_event : std::max(awake_frames_ - 1, 0);
    const double passed_s = job_.scripted ? script_step_s : timer.elapsed_ms() / 1000;
    seconds_ = std::min(passed_s, longest_step_s);
    timer = Timer();
    now_s_ += passed_s;
    frame(number);
    window_.show();
    if (sides_ms_ > 0) between_ms_.push_back(timer.elapsed_ms());
    if (between_ms_.size() > frames_of_rate) between_ms_.pop_front();
    if (!controls_.scene) continue;
    if (auto next = chosen_scene(number + 1)) return next;
  }
  if (job_.scripted && !job_.screenshot.empty()) screen_.save(job_.screenshot);
  return {};
}

// Empty if it cannot be loaded: the window tells why.
std::optional<ViewJob> Viewer::chosen_scene(int next_frame) {
  const std::string name = *std::exchange(controls_.scene, {});
  try {
    announce("loading " + name);
    ViewJob next = job_.load(name);
    next.scenes = job_.scenes;
    if (std::ranges::find(next.scenes, name) == next.scenes.end()) next.scenes.push_back(name);
    next.controls = controls_;
    next.controls.bookmarks = {};
    next.controls.pixel.reset();
    next.controls.light.reset();
    next.controls.playing = false;
    next.first_frame = next_frame;
    return next;
  } catch (const Error& error) {
    if (job_.scripted) throw;
    tell(error.what());
    return {};
  }
}

double Viewer::wait_s() const {
  if (awake_frames_ > 0 || moved_ || drew_ || !resolution_.resting() || controls_.playing ||
      controls_.draw_always)
    return 0;
  double wait = idle_wait_s;
  for (int i = 0; i < 2; ++i) {
    const bool map_open = controls_.sides[i].map != SideMap::picture && side(i).ready();
    if (map_open && !shows_map(i)) wait = std::min(wait, maps_[i].counts() ? counting_wait_s : 0);
  }
  return wait;
}

MapChoice Viewer::wanted_map(int i) const {
  const SideMap map = controls_.sides[i].map;
  return {map, map == SideMap::difference ? std::nullopt : controls_.light};
}

// The last picture with a text, at once. A pass may be drawing: what this changes it gets back.
void Viewer::announce(const std::string& text) {
  GLint drawn = 0, read = 0, place[4] = {};
  glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &drawn);
  glGetIntegerv(GL_READ_FRAMEBUFFER_BINDING, &read);
  glGetIntegerv(GL_VIEWPORT, place);
  screen_.finish();
  interface_.announce(text);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, GLuint(drawn));
  glBindFramebuffer(GL_READ_FRAMEBUFFER, GLuint(read));
  glViewport(place[0], place[1], place[2], place[3]);
}

void Viewer::frame(int number) {
  const Timer timer;
  if (!job_.scripted) {
    width_ = std::max(window_.width() - panel_width, 1);
    height_ = std::max(window_.height(), 1);
  }
  take_input(number);
  draw_sides();
  follow_maps();
  follow_pixel();
  if (!controls_.pixel_file.empty()) write_pixel(std::exchange(controls_.pixel_file, {}));
  if (!controls_.casting_file.empty()) write_casting(std::exchange(controls_.casting_file, {}));
  if (!controls_.times_file.empty()) write_times(std::exchange(controls_.times_file, {}));
  show(shown());
  glFinish();
  if (sides_ms_ > 0) resolution_.measured(sides_ms_, timer.elapsed_ms() - sides_ms_);
  if (std::exchange(controls_.screenshot, false)) take_screenshot();
}

void Viewer::press(const std::string& key, bool shift) {
  if (key == "space") controls_.playing = !controls_.playing;
  if (key == "period") controls_.step = true;
  if (key == "f12") controls_.screenshot = true;
  if (key == "f11" && !job_.scripted) window_.fill_screen();
  if (key == "g") controls_.show_lights = !controls_.show_lights;
  if (key == "h") controls_.show_keys = !controls_.show_keys;
  if (key == "r") controls_.camera = job_.camera;
  if (key == "escape") controls_.close_lists = true;
  if (key != "1" && key != "2" && key != "3") return;
  auto& bookmark = controls_.bookmarks[key[0] - '1'];
  if (shift) bookmark = camera_.text();
  tell(shift ? "kept as bookmark " + key : bookmark ? "" : fmt::format("shift+{} keeps this camera", key));
  if (!shift && bookmark) controls_.camera = bookmark;
}

void Viewer::take_input(int number) {
  if (job_.scripted) job_.script.play(number, controls_, script_input_);
  input_ = job_.scripted ? script_input_ : window_.input();
  interface_.begin(input_, width_ + panel_width, height_);
  const bool over_picture = !interface_.takes_pointer();
  const PointerResult pointed = pointer_.follow(input_, width_, height_, controls_.line, over_picture);
  if (pointed.line) controls_.line = *pointed.line;
  if (pointed.click) controls_.pixel = pointed.click;
  if (!input_.dropped.empty()) controls_.scene = input_.dropped;
  if (input_.wheel != 0 && over_picture) {
    camera_.speed_m = std::clamp(camera_.speed_m * std::pow(1.2, input_.wheel), 1e-3, 1e5);
    tell(fmt::format("{:.3g} m/s", camera_.speed_m));
  }
  moved_ = camera_.turn(pointed.turn_x, pointed.turn_y, height_);
  if (!interface_.takes_keys()) {
    moved_ |= camera_.move(input_.held, seconds_);
    for (const std::string& key : input_.presses) press(key, input_.held[int(FlightKey::fast)]);
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

void Viewer::leave_scene() {
  for (MapOfSide& map : maps_) map.leave_scene();
}

void Viewer::choose_casters() {
  if (controls_.light && *controls_.light >= int(job_.scene.lights.size())) {
    if (job_.scripted)
      throw input_error("view: light {}: the scene has {}", *controls_.light, job_.scene.lights.size());
    controls_.light.reset();
  }
  if (controls_.casters == casters_) return;
  casters_ = controls_.casters;
  leave_scene();
  for (size_t i = 0; i < own_casters_.size(); ++i) job_.scene.lights[i].casts_shadow = own_casters_[i];
  if (const auto count = chosen_casters(casters_)) choose_shadow_casters(job_.scene, *count);
  for (Side& side : sides_) side.forget();
  reference_.scene_changed();
}

void Viewer::draw_sides() {
  choose_casters();
  if (controls_.playing || controls_.step || controls_.seconds) camera_.hold(double(width_) / height_);
  const bool moves =
      controls_.playing || controls_.step || controls_.seconds || motion_.lights() != controls_.lights;
  if (moves) leave_scene();
  const SceneChanges changes = motion_.follow(controls_, seconds_);
  if (!changes.instances.empty() || !changes.meshes.empty()) occlusion_.scene_moved();
  if (!motion_.can_play()) controls_.playing = false;
  gpu_.update(changes);
  if (!changes.empty()) reference_.scene_changed();
  fraction_ = resolution_.next(moved_ || controls_.playing, seconds_, controls_.rate);
  const int width = std::max(int(std::lround(width_ * fraction_)), 1);
  const int height = std::max(int(std::lround(height_ * fraction_)), 1);
  const bool resized = width != drawn_width_ || height != drawn_height_;
  drawn_width_ = width;
  drawn_height_ = height;
  const bool looks = moved_ || resized || !changes.empty();
  if (looks) view_ = camera_.view(width, height);
  drew_ = false;
  sides_ms_ = 0;
  // Until the left picture is there, nothing is compiled for the right one.
  const bool first = !job_.scripted && sides_[0].pictures() == 0;
  same_ = first || (controls_.sides[0].technique == controls_.sides[1].technique &&
                    to_strings(controls_.sides[0].settings) == to_strings(controls_.sides[1].settings));
  if (same_) sides_[1].forget();
  bool figures = true;
  for (int i = 0; i < 2 - same_; ++i) {
    const int count = sides_[i].figures();
    try {
      const bool made = sides_[i].choose(controls_.sides[i], view_);
      if (!made && looks) sides_[i].look(view_, changes);
      if (sides_[i].draw(controls_.draw_always, controls_.measure_passes)) drew_ = true;
    } catch (const Error& error) {  // of the right side, which has no picture to keep
      if (job_.scripted || sides_[0].figures() == 0) throw;
      tell(error.what());
      controls_.sides[1] = controls_.sides[0];
      same_ = true;
      break;
    }
    figures = figures && sides_[i].figures() > count;
    sides_ms_ += sides_[i].last_ms();
    if (job_.scripted && !sides_[i].problem().empty()) throw input_error("view: {}", sides_[i].problem());
  }
  if (!figures) sides_ms_ = 0;
  for (int i = 0; i < 2; ++i) plans_[i].follow(side(i).run().view().plan, now_s_);
}

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
      add_shadows(*pixel_[i], job_.scene, shadows.at(pixel.x, pixel.y, job_.scene, occlusion_.get()));
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
    for (const LightShadow& light : plan.casting) text += casting_line(light, plan, job_.scene) + "\n";
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
    Image image(left.width(), left.height());
    glGetTextureImage(left.picture(), 0, GL_RGBA, GL_FLOAT,
                      GLsizei(image.pixels.size() * sizeof image.pixels[0]), image.pixels.data());
    exposure = job_.expose(image);
    if (exposure.ev != 0) tell(fmt::format("pictures are exposed by {:+g} EV (--exposure)", exposure.ev));
  }
  screen_.exposure = exposure.scale();
}

void Viewer::show(const Shown& shown) {
  expose();
  ScreenImage images[2], pictures[2];
  for (int i = 0; i < 2; ++i) {
    const bool map = controls_.sides[i].map != SideMap::picture && shows_map(i);
    pictures[i] = {side(i).picture(), false};
    images[i] = {map ? maps_[i].texture() : side(i).picture(), map};
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

}  // namespace lightgrid
