// lightgrid verify --hunt: the random search for lost lights.
#pragma once

#include <string>

#include "command_line/command_line.h"
#include "verify/engine.h"

namespace lightgrid::app {

struct HuntCommand {
  std::string minutes, save;
  uint64_t contacts = 0, seed = 1;
  bool shadows = false, cases = false;
  bool asked() const { return !minutes.empty(); }
};

void add_hunt_options(Subcommand& command, HuntCommand& options);

// Runs on one device, for the classes whose name matches `filter`. Returns the exit status: 1 if a light was
// lost, a shadow wrong, a frame stale or a case failed, a view was refused or the kernel shapes differed.
int run_hunt(const HuntCommand& options, lab::verify::CullEngine& engine, const std::string& filter,
             const std::string& json);

}  // namespace lightgrid::app
