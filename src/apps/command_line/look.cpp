#include "command_line/look.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/error.h"
#include "base/log.h"
#include "base/text.h"
#include "scenes/builtin.h"

namespace lightgrid::app {
namespace {

constexpr float glow_of_look = 0.06f;

bool gives(const SceneChoice& choice, const std::string& key) {
  return std::ranges::any_of(choice.set, [&](const std::string& s) { return s.starts_with(key + "="); });
}

// Techniques that draw with OpenGL have shadows only with one sample per pixel.
bool can_sample(const Technique& technique, const SceneChoice& choice) {
  if (!reads_setting(technique, "samples")) return false;
  return choice.shadows == "none" || !draws_with_opengl(technique.needs, chosen_settings(choice));
}

}  // namespace

void add_look_options(Subcommand& command, LookOptions& o) {
  const Subcommand::Heading heading(command, "Picture");
  command.flag(
      "--look", o.look,
      "a picture for looking, not for measuring: shadows of all lights, four samples, a sky instead of "
      "ambient light, exposure for dark scenes, the filmic curve and a glow, each unless given otherwise");
  command.option("--curve", o.curve, "tone map: neutral (default; Khronos PBR Neutral) or filmic (of ACES)");
  command.option("--glow", o.glow, "share of the light that spreads as in a lens, 0 to 1 (default 0)");
}

void choose_look(const LookOptions& o, const std::vector<const Technique*>& techniques, SceneChoice& choice) {
  chosen_display(o);  // reports a fault
  if (!o.look) return;
  std::string changes = "the filmic curve, a glow";
  if (choice.shadows.empty()) {
    choice.shadows = "all";
    changes += ", shadows of all lights";
  }
  if (choice.environment.empty() && choice.ambient.empty()) {
    choice.environment = "sky:ambient";
    changes += ", a sky as bright as the ambient light";
  }
  const bool can_all =
      std::ranges::all_of(techniques, [&](const Technique* t) { return can_sample(*t, choice); });
  if (!gives(choice, "samples") && can_all) {
    choice.set.emplace_back("samples=4");
    changes += ", four samples";
  }
  log_info("look: {}, unless options say otherwise; without --look pictures are those that are measured",
           changes);
}

Exposure exposure_of_look(const LookOptions& o, const SceneChoice& choice, const Image& image) {
  if (!o.look || !choice.exposure.empty() || !find_builtin_scene(choice.scene))
    return chosen_exposure(choice, image);
  Exposure exposure = automatic_exposure(image);
  exposure.ev /= 2;
  return exposure;
}

Display chosen_display(const LookOptions& o, const Exposure& exposure) {
  Display display{.exposure = exposure};
  if (!o.curve.empty() && o.curve != "neutral" && o.curve != "filmic")
    throw input_error("curve {}: neither neutral nor filmic", o.curve);
  if (o.curve == "filmic" || (o.curve.empty() && o.look)) display.curve = DisplayCurve::filmic;
  const auto glow = o.glow.empty() ? (o.look ? glow_of_look : 0.0f) : parse_number<float>(o.glow);
  if (!glow || !(*glow >= 0) || !(*glow <= 1)) throw input_error("glow {}: not a share from 0 to 1", o.glow);
  display.glow = *glow;
  return display;
}

}  // namespace lightgrid::app
