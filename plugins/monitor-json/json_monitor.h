#pragma once
/// \file
/// Monitor messages as JSON.

#include "api/monitor.h"

namespace spark {

/// Encodes monitor messages as JSON that mirrors the S-expressions of SexpMonitor:
///
///     [[["time",0.8],["round",3]],["RDS",0,1],
///      [["nd",["nd"]],["nd",["SLT",1,0,...,1],["nd","StaticMesh",["setVisible",1]]]]]
///
/// Numbers have six significant digits; those that are not finite are null. Stateless.
class JsonMonitor : public Node, public IMonitorEncoder {
  SPARK_CLASS(JsonMonitor, Node)
 public:
  static void describe(Description<JsonMonitor>& d) {
    d.doc("Encodes monitor messages as JSON: [[environment],[\"RSG\"|\"RDS\",0,1],[nodes]].");
    d.implements<IMonitorEncoder>();
  }
  void encode(const MonitorUpdate& update, std::string& out) override;
};

}  // namespace spark
