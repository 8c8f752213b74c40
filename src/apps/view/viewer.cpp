#include "view/viewer.h"

#include <algorithm>
#include <cmath>

#include "base/compiling.h"
#include "base/error.h"
#include "base/timer.h"
#include "run/scene_choice.h"
#include "scene/shadow_casters.h"

namespace lightgrid::app {
using namespace lab;
namespace {

constexpr double script_step_s = 1.0 / 60;
constexpr double longest_step_s = 0.1;  // limits the camera's movement after a slow frame
constexpr double idle_wait_s = 1;
constexpr double counting_wait_s = 0.05;  // the oracle counts meanwhile
constexpr int frames_after_event = 3;     // Dear ImGui opens a list one to two frames after a click
constexpr int min_picture_px = 64;
constexpr size_t frames_of_rate = 30;
constexpr double min_between_announcements_ms = 30;

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
  if (!job_.scripted) window_.limit_size(panel_width + min_picture_px, min_picture_px);
  before_compiling = [this](const std::string& file) {
    compiled_.insert(file);
    if (announced_.elapsed_ms() < min_between_announcements_ms) return;
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
  return {map, map == SideMap::difference || map == SideMap::edges ? std::nullopt : controls_.light};
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
  SceneChanges changes = motion_.follow(controls_, seconds_);
  if (!changes.empty() && job_.reflect) {
    if (!reflected_) reflected_ = job_.reflect(job_.scene);
    if (reflected_) changes = reflected_->follow(std::move(changes));
  }
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
    } catch (const Error& error) {  // the right side's error: it has no picture to keep
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

}  // namespace lightgrid::app
