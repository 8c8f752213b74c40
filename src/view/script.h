// Input that is replayed without a user: one action a line, "FRAME ACTION WORD…" (docs/view.md#scripts).
#pragma once

#include <filesystem>
#include <functional>
#include <string_view>
#include <vector>

#include "view/controls.h"

namespace lightgrid {

struct ScriptAction {
  int frame = 0;
  int line = 0;  // of the file
  std::function<void(Controls&, Input&)> run;
};

class Script {
 public:
  // Throws Error(input) that names `name`, the line and the word.
  Script(std::string_view text, const std::string& name);
  static Script read(const std::filesystem::path& path);

  // The actions of a frame, in the order of the file. Keys and the pointer stay as they are left; the button
  // is held in frames that drag.
  void play(int frame, Controls& controls, Input& input) const;

 private:
  std::vector<ScriptAction> actions_;
};

}  // namespace lightgrid
