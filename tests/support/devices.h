// The devices that tests draw with. They are opened once a process and never closed: at exit the drivers may
// be unloaded first.
#pragma once

#include "base/error.h"
#include "renderer/renderer.h"

namespace lightgrid {

// As the program opens them: a graphics card if there is one.
inline Renderer& test_devices() {
  static Renderer* const devices = new Renderer("", GlBackend::automatic);
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

}  // namespace lightgrid
