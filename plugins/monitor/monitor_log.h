#pragma once
/// \file
/// Writes logs.

#include <memory>

#include "api/drawing.h"
#include "api/inputs.h"
#include "monitor_view.h"
#include "spark/describe.h"
#include "spark/node.h"
#include "spark/output_file.h"

namespace spark {

/// A child of the monitor server that writes monitor messages into a file, one per line, as SimSpark's
/// `sparkmonitor.log`. It has a view of its own, so the log is complete whatever the monitors were sent. Agents'
/// drawings precede a record, as SimSpark's viewer writes them.
class MonitorLog : public Node, public IFrameTaker {
  SPARK_CLASS(MonitorLog, Node)
 public:
  static void describe(Description<MonitorLog>& d);

  const std::string& file() const { return file_; }
  void setFile(std::string file);
  void event(const Element& event) override;
  void take(const NewestFrame& newest, IMonitorEncoder* encoder, const Event& event) override;

 private:
  bool open(const NewestFrame& newest);
  void recordDrawings();
  void write();
  void fail(std::string_view what);

  std::string file_ = "sparkmonitor.log";
  double interval_ = 0.2, fullInterval_ = 3;

  std::optional<MonitorView> view_;
  Predicates early_;  ///< events before the first frame
  std::unique_ptr<OutputFile> out_;
  std::string record_, drawn_;  ///< message and draw commands of the current record
  Link<IDrawings> drawings_;
  Link<IInputTape> tape_;
  std::uint64_t drawnVersion_ = 0;  ///< IDrawings::version() of the last record
  std::int64_t nextCycle_ = 0;      ///< no record before this cycle
  std::int64_t records_ = 0;
  double lastFull_ = 0;  ///< s, simulated, of the last full record
  bool failed_ = false, whilePlayed_ = false;
};

}  // namespace spark
