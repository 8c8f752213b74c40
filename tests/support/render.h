// Pictures made in the test's own process.
#pragma once

#include <string>

#include "run/technique_run.h"
#include "scene/camera.h"
#include "support/devices.h"

namespace lightgrid {

inline Image render_image(const Scene& scene, const View& view, const char* technique = "forward_plus",
                          const Settings& settings = {}) {
  TechniqueRun run(software_devices(), scene, view, settings, find_technique(technique));
  run.run_frame();
  return run.image();
}

}  // namespace lightgrid
