// The command line that renders the picture of one side.
#pragma once

#include <string>

#include "view/controls.h"

namespace lightgrid {

// Quotes a word for a shell.
std::string shell_word(const std::string& word);

// `scene_words`: the scene and its lights, as options. `camera`: --camera's text, or empty. `time_words`:
// Motion::words.
std::string render_command(const std::string& scene_words, int width, int height, const std::string& camera,
                           const std::string& time_words, const SideControls& side);

}  // namespace lightgrid
