// Replayed input: one action a line, "FRAME ACTION WORD…" (docs/view.md#scripts).
#pragma once

#include <filesystem>
#include <functional>
#include <string_view>
#include <vector>

#include "view/controls.h"

namespace lightgrid::app {

struct ScriptAction {
  int frame = 0;
  int line = 0;  // in the file
  std::function<void(Controls&, Input&)> run;
};

class Script {
 public:
  // Throws Error(input) that names `name`, the line and the word.
  Script(std::string_view text, const std::string& name);
  static Script read(const std::filesystem::path& path);

  // Applies the actions of a frame, in the order of the file. Keys and the pointer keep their state; the
  // button is held in frames that drag.
  void play(int frame, Controls& controls, Input& input) const;

 private:
  std::vector<ScriptAction> actions_;
};

}  // namespace lightgrid::app
