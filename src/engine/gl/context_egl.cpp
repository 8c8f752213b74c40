#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <dlfcn.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "gl/context.h"
#include "gl/gl.h"

namespace lightgrid {
namespace {

// clang-format off
#define LIGHTGRID_EGL_FUNCTIONS(X) \
  X(PFNEGLGETPROCADDRESSPROC, eglGetProcAddress) \
  X(PFNEGLQUERYSTRINGPROC, eglQueryString) \
  X(PFNEGLGETPLATFORMDISPLAYPROC, eglGetPlatformDisplay) \
  X(PFNEGLINITIALIZEPROC, eglInitialize) \
  X(PFNEGLBINDAPIPROC, eglBindAPI) \
  X(PFNEGLCHOOSECONFIGPROC, eglChooseConfig) \
  X(PFNEGLCREATECONTEXTPROC, eglCreateContext) \
  X(PFNEGLDESTROYCONTEXTPROC, eglDestroyContext) \
  X(PFNEGLMAKECURRENTPROC, eglMakeCurrent) \
  X(PFNEGLGETCURRENTCONTEXTPROC, eglGetCurrentContext) \
  X(PFNEGLGETERRORPROC, eglGetError)
// clang-format on

struct Egl {
#define LIGHTGRID_EGL_MEMBER(type, name) type name = nullptr;
  LIGHTGRID_EGL_FUNCTIONS(LIGHTGRID_EGL_MEMBER)
#undef LIGHTGRID_EGL_MEMBER
};

// Never closed: drivers' threads crash when their library is unloaded.
const Egl& egl() {
  static const Egl functions = [] {
    void* library = dlopen("libEGL.so.1", RTLD_NOW | RTLD_LOCAL);
    if (!library) throw machine_error("libEGL.so.1 is not installed");
    Egl found;
#define LIGHTGRID_EGL_LOAD(type, name)                        \
  found.name = reinterpret_cast<type>(dlsym(library, #name)); \
  if (!found.name) throw machine_error("libEGL has no {}, it is older than EGL 1.5", #name);
    LIGHTGRID_EGL_FUNCTIONS(LIGHTGRID_EGL_LOAD)
#undef LIGHTGRID_EGL_LOAD
    return found;
  }();
  return functions;
}

bool has_extension(const char* list, std::string_view name) {
  for (std::string_view rest = list ? list : ""; !rest.empty();) {
    const std::string_view word = rest.substr(0, rest.find(' '));
    if (word == name) return true;
    rest.remove_prefix(std::min(rest.size(), word.size() + 1));
  }
  return false;
}

void* get_gl_function(const char* name) { return reinterpret_cast<void*>(egl().eglGetProcAddress(name)); }

class EglGlContext final : public GlContext {
 public:
  // Displays are not terminated: EGL returns the same one to every caller in the process.
  explicit EglGlContext(EGLDisplay display) : display_(display) {
    if (!egl().eglInitialize(display, nullptr, nullptr)) throw failure("eglInitialize");
    if (!has_extension(egl().eglQueryString(display, EGL_EXTENSIONS), "EGL_KHR_surfaceless_context"))
      throw machine_error("a display has no EGL_KHR_surfaceless_context");
    if (!egl().eglBindAPI(EGL_OPENGL_API)) throw failure("eglBindAPI");
    const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                                 4,
                                 EGL_CONTEXT_MINOR_VERSION,
                                 5,
                                 EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                 EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
#ifndef NDEBUG
                                 EGL_CONTEXT_OPENGL_DEBUG,
                                 EGL_TRUE,
#endif
                                 EGL_NONE};
    context_ = egl().eglCreateContext(display, config(), EGL_NO_CONTEXT, attributes);
    if (context_ == EGL_NO_CONTEXT) throw failure("eglCreateContext for OpenGL 4.5 core");
    begin("egl", [this] { release(); });
  }

  ~EglGlContext() override { release(); }

  void make_current() override {
    // The bound API belongs to the thread, which may differ from the thread that created the context.
    egl().eglBindAPI(EGL_OPENGL_API);
    if (!egl().eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_))
      throw failure("eglMakeCurrent");
    load_gl_functions(get_gl_function);
  }

  void leave() override { egl().eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT); }

 private:
  static Error failure(const char* call) {
    return machine_error("{} failed with EGL error {:#x}", call, egl().eglGetError());
  }

  EGLConfig config() const {
    if (has_extension(egl().eglQueryString(display_, EGL_EXTENSIONS), "EGL_KHR_no_config_context"))
      return EGL_NO_CONFIG_KHR;
    const EGLint wanted[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, EGL_PBUFFER_BIT,
                             EGL_NONE};
    EGLConfig chosen = nullptr;
    EGLint count = 0;
    if (!egl().eglChooseConfig(display_, wanted, &chosen, 1, &count) || count == 0)
      throw machine_error("a display has no configuration for OpenGL");
    return chosen;
  }

  void release() {
    if (egl().eglGetCurrentContext() == context_) EglGlContext::leave();
    egl().eglDestroyContext(display_, context_);
  }

  EGLDisplay display_;
  EGLContext context_ = EGL_NO_CONTEXT;
};

// Displays of the graphics cards, in the driver's order; software renderers are excluded.
std::vector<EGLDisplay> hardware_displays(const char* client_extensions) {
  if (!has_extension(client_extensions, "EGL_EXT_platform_device")) return {};
  const auto query_devices =
      reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(egl().eglGetProcAddress("eglQueryDevicesEXT"));
  const auto query_device_string =
      reinterpret_cast<PFNEGLQUERYDEVICESTRINGEXTPROC>(egl().eglGetProcAddress("eglQueryDeviceStringEXT"));
  if (!query_devices || !query_device_string) return {};
  EGLint count = 0;
  query_devices(0, nullptr, &count);
  std::vector<EGLDeviceEXT> devices(count);
  query_devices(count, devices.data(), &count);
  devices.resize(count);
  std::vector<EGLDisplay> displays;
  for (EGLDeviceEXT device : devices) {
    if (has_extension(query_device_string(device, EGL_EXTENSIONS), "EGL_MESA_device_software")) continue;
    displays.push_back(egl().eglGetPlatformDisplay(EGL_PLATFORM_DEVICE_EXT, device, nullptr));
  }
  return displays;
}

}  // namespace

std::unique_ptr<GlContext> create_egl_context(bool hardware_only) {
  const char* extensions = egl().eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  std::vector<EGLDisplay> displays = hardware_displays(extensions);
  if (!hardware_only && has_extension(extensions, "EGL_MESA_platform_surfaceless"))
    displays.push_back(
        egl().eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr));
  std::string why =
      hardware_only ? "no graphics card that EGL can use" : "EGL has no device and no surfaceless platform";
  for (EGLDisplay display : displays) {
    if (display == EGL_NO_DISPLAY) continue;
    try {
      auto context = std::make_unique<EglGlContext>(display);
      if (!hardware_only || !context->software) return context;
    } catch (const Error& error) {
      why = error.what();
    }
  }
  throw machine_error("{}", why);
}

}  // namespace lightgrid
