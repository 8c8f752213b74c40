#include <dlfcn.h>

#include <array>

#include "base/error.h"
#include "gl/context.h"
#include "gl/gl.h"

namespace lightgrid {
namespace {

// From Mesa's header osmesa.h, which conflicts with glcorearb.h and is missing from newer Mesa packages.
using OsmesaContext = struct OsmesaContextData*;
constexpr int osmesa_format = 0x22, osmesa_depth_bits = 0x30, osmesa_stencil_bits = 0x31,
              osmesa_profile = 0x33, osmesa_core_profile = 0x34, osmesa_context_major_version = 0x36,
              osmesa_context_minor_version = 0x37;

struct Osmesa {
  OsmesaContext (*create)(const int* attributes, OsmesaContext share) = nullptr;
  void (*destroy)(OsmesaContext) = nullptr;
  GLboolean (*make_current)(OsmesaContext, void* buffer, GLenum type, GLsizei width,
                            GLsizei height) = nullptr;
  OsmesaContext (*current)() = nullptr;
  void* (*get_proc_address)(const char*) = nullptr;
};

// Never closed: Mesa's threads and LLVM crash when their library is unloaded.
const Osmesa& osmesa() {
  static const Osmesa functions = [] {
    void* library = nullptr;
    for (const char* name : {"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"}) {
      library = dlopen(name, RTLD_NOW | RTLD_LOCAL);
      if (library) break;
    }
    if (!library) throw machine_error("libOSMesa.so.8 is not installed");
    Osmesa found;
    auto find = [&](auto& function, const char* name) {
      function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(dlsym(library, name));
      if (!function) throw machine_error("libOSMesa has no {}", name);
    };
    find(found.create, "OSMesaCreateContextAttribs");
    find(found.destroy, "OSMesaDestroyContext");
    find(found.make_current, "OSMesaMakeCurrent");
    find(found.current, "OSMesaGetCurrentContext");
    find(found.get_proc_address, "OSMesaGetProcAddress");
    return found;
  }();
  return functions;
}

class OsmesaGlContext final : public GlContext {
 public:
  OsmesaGlContext() {
    const int attributes[] = {osmesa_format,
                              GL_RGBA,
                              osmesa_depth_bits,
                              0,
                              osmesa_stencil_bits,
                              0,
                              osmesa_profile,
                              osmesa_core_profile,
                              osmesa_context_major_version,
                              4,
                              osmesa_context_minor_version,
                              5,
                              0};
    context_ = osmesa().create(attributes, nullptr);
    if (!context_) throw machine_error("OSMesa could not make an OpenGL 4.5 core context");
    begin("osmesa", [this] { release(); });
  }

  ~OsmesaGlContext() override { release(); }

  void make_current() override {
    if (!osmesa().make_current(context_, window_.data(), GL_UNSIGNED_BYTE, window_size, window_size))
      throw machine_error("OSMesaMakeCurrent failed");
    load_gl_functions(osmesa().get_proc_address);
  }

  void leave() override { osmesa().make_current(nullptr, nullptr, 0, 0, 0); }

 private:
  void release() {
    if (osmesa().current() == context_) OsmesaGlContext::leave();
    osmesa().destroy(context_);
  }

  // OSMesa requires memory for a window; all drawing goes to framebuffer objects.
  static constexpr int window_size = 8;
  std::array<unsigned char, window_size* window_size* 4> window_ = {};
  OsmesaContext context_ = nullptr;
};

}  // namespace

std::unique_ptr<GlContext> create_osmesa_context() { return std::make_unique<OsmesaGlContext>(); }

}  // namespace lightgrid
