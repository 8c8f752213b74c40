#include "view/command_text.h"

#include <algorithm>

#include <fmt/format.h>

#include "techniques/technique.h"

namespace lightgrid {

std::string shell_word(const std::string& word) {
  const auto plain = [](unsigned char c) {
    return std::isalnum(c) || std::string_view("-_./:,=+@%").find(char(c)) != std::string_view::npos;
  };
  if (!word.empty() && std::ranges::all_of(word, plain)) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

std::string render_command(const std::string& scene_words, int width, int height, const std::string& camera,
                           const std::string& time_words, const SideControls& side) {
  std::string line = fmt::format("lightgrid render {} --size {}x{}", scene_words, width, height);
  if (!camera.empty()) line += " --camera " + shell_word(camera);
  line += time_words + " -t " + side.technique;
  const auto values = to_strings(side.settings);
  const Technique& technique = find_technique(side.technique);
  for (const std::string& key : side.settings.given) {
    if (!reads_setting(technique, key)) continue;
    line += fmt::format(" --set {}={}", key, values.at(json_key(key)));
  }
  return line + " -o view.png";
}

}  // namespace lightgrid
