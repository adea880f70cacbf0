#include "gl_context.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <dlfcn.h>
#include <fmt/format.h>

#include <array>
#include <memory>
#include <string_view>
#include <vector>

#include "spark/error.h"

namespace spark::camera {

namespace {
/// True if the list, words with blanks between them, has that word.
bool lists(const char* list, std::string_view word) {
  const std::string all = fmt::format(" {} ", list ? list : "");
  return all.find(fmt::format(" {} ", word)) != std::string::npos;
}
}  // namespace

/// The functions of EGL.
struct GlContext::Egl {
  decltype(&eglGetProcAddress) getProcAddress;
  decltype(&eglQueryString) queryString;
  decltype(&eglGetDisplay) getDisplay;
  decltype(&eglInitialize) initialize;
  decltype(&eglBindAPI) bindApi;
  decltype(&eglChooseConfig) chooseConfig;
  decltype(&eglCreateContext) createContext;
  decltype(&eglDestroyContext) destroyContext;
  decltype(&eglMakeCurrent) makeCurrent;
  decltype(&eglGetError) getError;

  explicit Egl(const std::string& library) {
    void* const handle = ::dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    if (!handle) throw Error(fmt::format("cannot load EGL: {}", ::dlerror()));
    const auto load = [handle](auto& function, const char* name) {
      function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(::dlsym(handle, name));
      if (!function) throw Error(fmt::format("EGL has no function {}", name));
    };
    load(getProcAddress, "eglGetProcAddress");
    load(queryString, "eglQueryString");
    load(getDisplay, "eglGetDisplay");
    load(initialize, "eglInitialize");
    load(bindApi, "eglBindAPI");
    load(chooseConfig, "eglChooseConfig");
    load(createContext, "eglCreateContext");
    load(destroyContext, "eglDestroyContext");
    load(makeCurrent, "eglMakeCurrent");
    load(getError, "eglGetError");
  }

  template <class F>
  F extension(const char* name) const {
    return reinterpret_cast<F>(getProcAddress(name));
  }

  /// The displays to try, best first: the device that renders on the processor, one without a surface, the usual one.
  std::vector<EGLDisplay> displays() const {
    std::vector<EGLDisplay> out;
    const char* const client = queryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    const auto platform = extension<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
    const auto devices = extension<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
    const auto device = extension<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT");
    if (platform && devices && device && lists(client, "EGL_EXT_platform_device")) {
      std::array<EGLDeviceEXT, 16> found{};
      EGLint count = 0;
      if (devices(static_cast<EGLint>(found.size()), found.data(), &count))
        for (EGLint i = 0; i < count; ++i)
          if (lists(device(found[i], EGL_EXTENSIONS), "EGL_MESA_device_software"))
            out.push_back(platform(EGL_PLATFORM_DEVICE_EXT, found[i], nullptr));
    }
    if (platform && lists(client, "EGL_MESA_platform_surfaceless"))
      out.push_back(platform(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr));
    out.push_back(getDisplay(EGL_DEFAULT_DISPLAY));
    return out;
  }
};

GlContext::GlContext(const std::string& library) : egl_(std::make_unique<Egl>(library)) {
  std::string why = "EGL has no display";
  for (void* display : egl_->displays()) {
    if (!display) continue;
    why = makeOn(display);
    if (why.empty()) break;
  }
  if (!why.empty()) throw Error(why);
}

std::string GlContext::makeOn(void* display) {
  if (!egl_->initialize(display, nullptr, nullptr))
    return fmt::format("EGL cannot initialise its display (error {:#x})", egl_->getError());
  egl_->bindApi(EGL_OPENGL_API);
  const EGLint wanted[] = {EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (!egl_->chooseConfig(display, wanted, &config, 1, &count) || count == 0)
    return "EGL has no configuration for OpenGL";
  const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 3, EGL_NONE};
  void* const context = egl_->createContext(display, config, EGL_NO_CONTEXT, version);
  if (!context) return fmt::format("EGL has no OpenGL 3.3 (error {:#x})", egl_->getError());
  display_ = display, context_ = context;

  // The functions belong to the context, which may not become current without a surface.
  std::string why;
  if (!egl_->makeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) {
    why = fmt::format("EGL cannot use a context without a surface (error {:#x})", egl_->getError());
  } else {
#define SPARK_GL_LOAD(Name, Type)                                                    \
  gl_.Name = reinterpret_cast<decltype(gl_.Name)>(egl_->getProcAddress("gl" #Name)); \
  if (!gl_.Name) why = "OpenGL has no function gl" #Name;
    SPARK_GL_FUNCTIONS(SPARK_GL_LOAD)
#undef SPARK_GL_LOAD
    if (why.empty()) renderer_ = reinterpret_cast<const char*>(gl_.GetString(GL_RENDERER));
    egl_->makeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  }
  if (!why.empty()) egl_->destroyContext(display, context), context_ = nullptr;
  return why;
}

GlContext::~GlContext() { egl_->destroyContext(display_, context_); }

GlContext::Current::Current(const GlContext& context) : context_(context) {
  const Egl& egl = *context.egl_;
  egl.bindApi(EGL_OPENGL_API);
  if (!egl.makeCurrent(context.display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context.context_))
    throw Error(fmt::format("EGL cannot use the context in this thread (error {:#x})", egl.getError()));
}

GlContext::Current::~Current() {
  context_.egl_->makeCurrent(context_.display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
}

}  // namespace spark::camera
