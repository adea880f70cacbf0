#pragma once
/// \file
/// The process that runs programs of templates.

#include <sys/types.h>

#include <string>

namespace spark::webots {

/// Runs the program sparktemplate, which has limits, no files and no sockets. It starts with the first template, and
/// ends with this object.
class TemplateProcess {
 public:
  /// `program`: the path of sparktemplate. `seconds`: CPU time of one template.
  explicit TemplateProcess(std::string program, int seconds = 5) : program_(std::move(program)), seconds_(seconds) {}
  ~TemplateProcess();
  TemplateProcess(const TemplateProcess&) = delete;
  TemplateProcess& operator=(const TemplateProcess&) = delete;
  /// Its answer to a request (template/request.h). Throws Error when it ends, and from then on.
  std::string ask(const std::string& request);
  /// The path of the program: beside the running one, or where the build or an installation has it as seen from the
  /// plugin.
  static std::string path();

 private:
  void start();
  void stop();
  [[noreturn]] void fail();

  const std::string program_;
  const int seconds_;
  pid_t pid_ = -1;
  int socket_ = -1;
  bool ended_ = false;
};

}  // namespace spark::webots
