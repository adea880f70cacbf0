#include "log_server.h"

#include "spark/kernel.h"

namespace spark {

void LogServer::describe(Description<LogServer>& d) {
  d.doc("The log: its level on stderr. Its children are further sinks, with levels of their own.");
  d.property("level", &LogServer::level, &LogServer::setLevel)
      .choices(levelNames())
      .ofProcess()
      .doc("The lowest level that is written to stderr; at the start as --log-level says.");
  d.property("errors", &LogServer::errors).doc("Number of errors logged so far, at any level.");
}

// Objects are also made to read defaults, without a place in the tree; they have a kernel in any case.
const std::string& LogServer::level() const { return nameOf(kernel().log().level()); }
void LogServer::setLevel(const std::string& name) { kernel().log().setLevel(levelFromName(name)); }
std::int64_t LogServer::errors() const { return kernel().log().errors(); }

}  // namespace spark
