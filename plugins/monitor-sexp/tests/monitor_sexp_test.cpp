#include <catch2/catch.hpp>
#include <limits>

#include "monitor_message.h"
#include "test_support.h"

using namespace spark;
using namespace spark::test;

namespace {

struct SexpEncoder : TestHost {
  SexpEncoder() {
    kernel.plugins().use("monitor-sexp");
    encoder = &kernel.create<IMonitorEncoder>("SexpMonitor", "/usr/encoder");
  }
  std::string encode(const MonitorUpdate& update) {
    std::string out;
    encoder->encode(update, out);
    return out;
  }
  IMonitorEncoder* encoder;
};

}  // namespace

TEST_CASE("a full message has the same whitespace as the original server's") {
  SexpEncoder e;
  RecordedFrame f;
  fillFrame(f);
  CHECK(e.encode(f.update) ==
        "((FieldLength 30)(time 0.42)(play_modes A B)(half 1))(RSG 0 1)"
        "((nd Light (setDiffuse 1 1 1 1) (setAmbient 0.8 0.8 0.8 1) (setSpecular 0.1 0.1 0.1 1))"
        "(nd TRF (SLT 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0.0403208 1)(nd StaticMesh (setVisible 1) (setTransparent) "
        "(load StdCapsule 0.015 0.08) (sSc 0.042 1 1)(resetMaterials matLeft naowhite))"
        "(nd TRF (SLT 1 -8.74228e-08 0 0 0 1 0 0 0 0 1 0 0 0 0 1)))"
        "(nd SMN (setVisible 0) (load StdUnitBox) (sSc 1 51 1) (sMat matGrey)))");
}

TEST_CASE("a diff contains only changes, and events follow the environment") {
  SexpEncoder e;
  RecordedFrame f;
  fillFrame(f);
  f.update.full = false;
  f.update.env = {f.update.env[1]};
  f.update.events.open("foul").add(1).add(3).add(2).add(7).close();
  f.update.changed = {0, 0, 0, 1, 1};
  CHECK(e.encode(f.update) ==
        "((time 0.42)(foul 1 3 2 7))(RDS 0 1)((nd)(nd(nd StaticMesh)(nd (SLT 1 -8.74228e-08 0 0 0 1 0 0 0 0 1 0 0 0 0 "
        "1)))(nd SMN (setVisible 0)))");
}

TEST_CASE("numbers are formatted like %g in C") {
  SexpEncoder e;
  MonitorFrame frame;
  MonitorUpdate update{frame, true, {}, {}, {}};
  const double numbers[] = {0.1 + 0.2, 104.8800001, 1e6, 123456789, -0.0, 1e-5, std::numeric_limits<double>::infinity(),
                            2.5e-310};
  for (const double v : numbers) {
    frame.env = {};
    frame.env.put(EnvPolicy::always, "x", v);
    update.env = {0};
    char expected[64];
    std::snprintf(expected, sizeof expected, "((x %g))(RSG 0 1)()", v);
    CHECK(e.encode(update) == expected);
  }
}
