#pragma once
/// \file
/// A context of OpenGL without a window, and without a graphics card.
///
/// The library of EGL is loaded when the first context is made, and stays loaded until the process ends: drivers have
/// threads and handlers of their own, so neither this plugin nor the host links them. The display is shared by all
/// contexts of the process and never terminated. A device that renders on the processor is preferred, because all
/// machines then have the same pictures.

#include <memory>
#include <string>

#include "gl_functions.h"

namespace spark::camera {

/// A context of OpenGL 3.3. It is current only while a Current lives, so it may be used by different threads in turn.
class GlContext {
 public:
  /// `library`: file name of EGL. Throws Error that says what is missing.
  explicit GlContext(const std::string& library);
  /// Destroys the context with all its objects. Nothing of it may be current.
  ~GlContext();
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;

  /// The functions.
  const GlFunctions& gl() const { return gl_; }
  /// What renders, for people: "llvmpipe (LLVM 15.0.6, 256 bits)".
  const std::string& renderer() const { return renderer_; }

  /// Makes the context current in this thread while it lives.
  class Current {
   public:
    /// Throws Error if that is refused.
    explicit Current(const GlContext& context);
    ~Current();
    Current(const Current&) = delete;
    Current& operator=(const Current&) = delete;

   private:
    const GlContext& context_;
  };

 private:
  struct Egl;
  /// Makes the context on that display; returns "", or why not.
  std::string makeOn(void* display);
  std::unique_ptr<const Egl> egl_;
  void* display_ = nullptr;
  void* context_ = nullptr;
  GlFunctions gl_;
  std::string renderer_;
};

}  // namespace spark::camera
