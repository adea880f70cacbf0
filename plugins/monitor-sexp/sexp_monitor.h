#pragma once
/// \file
/// Monitor messages as S-expressions.

#include "api/monitor.h"

namespace spark {

/// Encodes monitor messages as S-expressions, byte for byte as SimSpark does for RoboViz and rcssmonitor3d:
///
///     ((time 0.8)(round 3))(RDS 0 1)((nd(nd))(nd (SLT 1 0 ... 1)(nd StaticMesh (setVisible 1))))
///
/// Environment, header (RSG: full, RDS: diff), nodes; numbers with six significant digits. Stateless.
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
