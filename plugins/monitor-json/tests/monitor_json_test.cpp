#include <catch2/catch.hpp>
#include <fstream>
#include <nlohmann/json.hpp>

#include "monitor_message.h"
#include "test_support.h"

using namespace spark;
using namespace spark::test;

namespace {

struct Encoder : TestHost {
  Encoder() {
    kernel.plugins().use("monitor-json");
    encoder = &kernel.create<IMonitorEncoder>("JsonMonitor", "/usr/encoder");
  }
  std::string encode(const MonitorUpdate& update) {
    std::string out;
    encoder->encode(update, out);
    return out;
  }
  IMonitorEncoder* encoder;
};

}  // namespace

TEST_CASE("a full message mirrors the S-expressions with numbers as JSON numbers") {
  Encoder e;
  RecordedFrame f;
  fillFrame(f);
  const auto expected = nlohmann::json::parse(R"([
    [["FieldLength",30],["time",0.42],["play_modes","A","B"],["half",1]],
    ["RSG",0,1],
    [["nd","Light",["setDiffuse",1,1,1,1],["setAmbient",0.8,0.8,0.8,1],["setSpecular",0.1,0.1,0.1,1]],
     ["nd","TRF",["SLT",1,0,0,0,0,1,0,0,0,0,1,0,0,0,0.0403208,1],
       ["nd","StaticMesh",["setVisible",1],["setTransparent"],["load","StdCapsule",0.015,0.08],["sSc",0.042,1,1],["resetMaterials","matLeft","naowhite"]],
       ["nd","TRF",["SLT",1,-8.74228e-08,0,0,0,1,0,0,0,0,1,0,0,0,0,1]]],
     ["nd","SMN",["setVisible",0],["load","StdUnitBox"],["sSc",1,51,1],["sMat","matGrey"]]]])");
  CHECK(nlohmann::json::parse(e.encode(f.update)) == expected);
}

TEST_CASE("a diff contains only changes") {
  Encoder e;
  RecordedFrame f;
  fillFrame(f);
  f.update.full = false;
  f.update.env = {f.update.env[1]};
  f.update.events.open("foul").add(1).add("x").close();
  f.update.changed = {0, 0, 0, 1, 1};
  CHECK(e.encode(f.update) ==
        "[[[\"time\",0.42],[\"foul\",1,\"x\"]],[\"RDS\",0,1],[[\"nd\"],[\"nd\",[\"nd\",\"StaticMesh\"],[\"nd\",["
        "\"SLT\",1,-8.74228e-08,0,0,0,1,0,0,0,0,1,0,"
        "0,0,0,1]]],[\"nd\",\"SMN\",[\"setVisible\",0]]]]");
}

TEST_CASE("unusual names and numbers give valid JSON") {
  Encoder e;
  MonitorFrame frame;
  frame.env.put(EnvPolicy::always, "team_left", "a\"b\\c\x01\n\xff\xc3\xa9");
  frame.env.put(EnvPolicy::always, "nan", std::numeric_limits<double>::quiet_NaN());
  frame.env.put(EnvPolicy::always, "inf", -std::numeric_limits<double>::infinity());
  frame.env.open(EnvPolicy::always, "nested").open("a").add(1).close().close();
  MonitorUpdate update{frame, true, {}, {}, {}};
  for (const auto& entry : frame.env.entries) update.env.push_back(entry.token);
  const auto json = nlohmann::json::parse(e.encode(update));
  CHECK(json[0][0][1] == "a\"b\\c\x01\n\xef\xbf\xbd\xc3\xa9");
  CHECK(json[0][1][1].is_null());
  CHECK(json[0][2][1].is_null());
  CHECK(json[0][3] == nlohmann::json::parse(R"(["nested",["a",1]])"));
  CHECK(json[2].is_array());
  CHECK(json[2].empty());
}
