// A headless OpenGL 4.5 core context: OSMesa or surfaceless EGL (Mesa's or a vendor's), opened at run time.
// Neither library need be installed.
#pragma once

#include <functional>
#include <memory>
#include <string>

namespace lightgrid {

// none: OpenCL alone.
enum class GlBackend { automatic, osmesa, egl, none };

// "auto", "osmesa", "egl" or "none"; anything else is an input error.
GlBackend parse_gl_backend(const std::string& name);

class GlContext {
 public:
  // Creates a context and makes it current on this thread. automatic: EGL if it offers a hardware device,
  // else OSMesa, else EGL. Throws Error(machine) that lists the attempts and the package that would help;
  // none is an attempt that fails.
  static std::unique_ptr<GlContext> create(GlBackend backend = GlBackend::automatic);
  virtual ~GlContext() = default;
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;

  // Makes it this thread's context and loads the functions of gl.h from its library: OSMesa's and EGL's
  // differ.
  virtual void make_current() = 0;
  // Leaves this thread without a context, so that another one can make this its own.
  virtual void leave() = 0;

  std::string backend;  // "osmesa" or "egl"
  std::string vendor, renderer, version;
  bool software = false;  // llvmpipe or softpipe: renders in the CPU's memory

 protected:
  GlContext() = default;

  // Once a context is current: sets the names above and, in debug builds, the debug output, which prints each
  // OpenGL error and aborts. Throws Error(machine) below OpenGL 4.5.
  void describe();

  // For the backends, once they have a context: makes it current and describes it. Calls `release` before an
  // exception leaves.
  void begin(const std::string& name, const std::function<void()>& release);
};

// The backends, one file each. They open their library at run time; if that fails, they throw Error(machine)
// with the reason in one clause.
std::unique_ptr<GlContext> create_osmesa_context();
// Hardware first. With `hardware_only`, software renderers are rejected.
std::unique_ptr<GlContext> create_egl_context(bool hardware_only);

}  // namespace lightgrid
