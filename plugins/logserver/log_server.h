#pragma once
/// \file
/// The log of the kernel as a node.

#include <string>

#include "spark/describe.h"
#include "spark/node.h"

namespace spark {

/// The log server, at /sys/server/log: the level of the log on stderr. Its children are further sinks.
class LogServer : public Node {
  SPARK_CLASS(LogServer, Node)
 public:
  static void describe(Description<LogServer>& d);

 private:
  const std::string& level() const;
  void setLevel(const std::string& name);
  std::int64_t errors() const;
};

}  // namespace spark
