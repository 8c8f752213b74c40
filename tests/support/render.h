// Pictures made in the test's own process.
#pragma once

#include <string>

#include "base/error.h"
#include "scene/camera.h"
#include "compare/run_technique.h"

namespace lightgrid {

// Opened once a process and never closed: at exit the drivers may go first. Mesa's software renderer, by OSMesa
// where it is there: the same picture with and without a graphics card in the machine.
inline Renderer& software_devices() {
  static Renderer* const devices = [] {
    try {
      return new Renderer("", GlBackend::osmesa);
    } catch (const Error&) {
      return new Renderer("", GlBackend::egl);
    }
  }();
  return *devices;
}

inline Image render_image(const Scene& scene, const View& view, const char* technique = "forward_plus",
                          const Settings& settings = {}) {
  TechniqueRun run(software_devices(), scene, view, settings, find_technique(technique));
  run.run_frame();
  return run.image();
}

}  // namespace lightgrid
