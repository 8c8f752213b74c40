// The devices that tests draw with. They are opened once a process and never closed: at exit the drivers may
// be unloaded first.
#pragma once

#include <cstdlib>

#include "base/error.h"
#include "renderer/renderer.h"

namespace lightgrid {

// LIGHTGRID_TEST_DEVICE: a part of the name of the OpenCL device; without it the program's own choice, a
// graphics card if there is one.
inline std::string test_device_name() {
  const char* given = std::getenv("LIGHTGRID_TEST_DEVICE");
  return given ? given : "";
}

// As the program opens them.
inline Renderer& test_devices() {
  static Renderer* const devices = new Renderer(test_device_name(), GlBackend::automatic);
  devices->gl->make_current();  // some tests open others
  return *devices;
}

// Mesa's software renderer, with OSMesa if available: the same picture with and without a graphics card.
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

// Without OpenGL.
inline Renderer& opencl_devices() {
  static Renderer* const devices = new Renderer(test_device_name(), GlBackend::none);
  return *devices;
}

}  // namespace lightgrid
