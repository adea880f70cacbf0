#pragma once

#include "api/monitor.h"

namespace spark {

/// Writes monitor messages as S-expressions, to the blank as the installed base's monitors (RoboViz, rcssmonitor3d)
/// have been sent them:
///
///     ((time 0.8)(round 3))(RDS 0 1)((nd(nd))(nd (SLT 1 0 ... 1)(nd StaticMesh (setVisible 1))))
///
/// Environment, header (RSG full, RDS diff), nodes; numbers with six significant digits.
class SexpMonitor : public Node, public IMonitorEncoder {
  SPARK_CLASS(SexpMonitor, Node)
 public:
  static void describe(Description<SexpMonitor>& d) {
    d.doc("Encodes monitor messages as S-expressions: (environment)(RSG|RDS 0 1)(nodes).");
    d.implements<IMonitorEncoder>();
  }
  void encode(const MonitorUpdate& update, std::string& out) override;
};

}  // namespace spark
