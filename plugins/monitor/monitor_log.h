#pragma once

#include <cstdio>
#include <memory>

#include "api/drawing.h"
#include "monitor_view.h"
#include "spark/describe.h"
#include "spark/node.h"

namespace spark {

/// Writes what a monitor would be sent into a file, one message a line: the installed base's `sparkmonitor.log`. Child
/// of the monitor server; a viewer of its own, so the log is complete whatever the monitors were sent. What agents drew
/// stands in front of a record, as the installed base's viewer writes it.
class MonitorLog : public Node, public IFrameTaker {
  SPARK_CLASS(MonitorLog, Node)
 public:
  static void describe(Description<MonitorLog>& d);

  void event(const Element& event) override;
  void take(const NewestFrame& newest, IMonitorEncoder* encoder, const Event& event) override;

 private:
  bool ready(const NewestFrame& newest);
  void recordDrawings();
  void write();
  void fail(std::string_view what);

  std::string file_ = "sparkmonitor.log";
  double interval_ = 0.2, fullInterval_ = 3;

  std::optional<MonitorView> view_;
  Predicates early_;  ///< events of the time before the first frame came
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Close> out_;
  std::string record_, drawn_;
  Link<IDrawings> drawings_;
  std::uint64_t drawnVersion_ = 0;
  std::int64_t next_ = 0, records_ = 0;
  double lastFull_ = 0;
  bool failed_ = false;
};

}  // namespace spark
