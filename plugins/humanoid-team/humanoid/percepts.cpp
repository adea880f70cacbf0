#include "percepts.h"

#include <cmath>

namespace humanoid {

using spark::Element;

namespace {
Vec3 vector(const Element& list) { return {list.at(1).number(), list.at(2).number(), list.at(3).number()}; }

Vec3 polarOf(const Element& item) {
  const Element pol = item.named("pol");
  return polar(pol.at(1).number(), pol.at(2).number(), pol.at(3).number());
}

void readGameState(const Element& gs, Percepts& out) {
  if (const Element e = gs.named("unum")) out.unum = static_cast<int>(e.at(1).integer());
  if (const Element e = gs.named("team")) out.side = e.at(1).text();
  if (const Element e = gs.named("sl")) out.scoreLeft = static_cast<int>(e.at(1).integer());
  if (const Element e = gs.named("sr")) out.scoreRight = static_cast<int>(e.at(1).integer());
  if (const Element e = gs.named("t")) out.gameTime = e.at(1).number();
  if (const Element e = gs.named("pm")) out.playMode = e.at(1).text();
}

void readJoint(const Element& hj, Percepts& out) {
  const Element name = hj.named("n"), angle = hj.named("ax");
  if (!name || !angle) return;
  for (std::size_t i = 0; i < kJoints; ++i)
    if (kJointFacts[i].perceptor == name.at(1).text()) out.joints.at(i) = radians(angle.at(1).number());
}

void readFoot(const Element& frp, Percepts& out) {
  const Element name = frp.named("n");
  if (!name) return;
  if (name.at(1).text() == "rf") out.rightFoot = true;
  if (name.at(1).text() == "lf") out.leftFoot = true;
}

/// The position of a player is that of the first part that is seen.
void readPlayer(const Element& p, Percepts& out) {
  const Element team = p.named("team"), id = p.named("id");
  if (!team || !id) return;
  for (const Element part : p)
    if (part.isList() && part.named("pol")) {
      out.players.push_back({std::string(team.at(1).text()), static_cast<int>(id.at(1).integer()), polarOf(part)});
      return;
    }
}

void readVision(const Element& see, Percepts& out) {
  out.seeing = true;
  for (const Element item : see) {
    if (!item.isList()) continue;
    if (item.head() == "B") out.ball = polarOf(item);
    if (item.head() == "P") readPlayer(item, out);
    for (const Landmark& mark : landmarks())
      if (mark.name == item.head()) out.sightings.push_back({&mark, polarOf(item)});
  }
}

/// `(hear TEAM TIME self|DIRECTION TEXT)`.
void readHearing(const Element& hear, std::string_view team, Percepts& out) {
  if (hear.size() == 5 && hear.at(1).text() == team && hear.at(3).text() != "self")
    out.heard.emplace_back(hear.at(4).text());
}
}  // namespace

const std::vector<Landmark>& landmarks() {
  static const std::vector<Landmark> all{
      {"F1L", {-15, 10, 0}},     {"F2L", {-15, -10, 0}},     {"F1R", {15, 10, 0}},     {"F2R", {15, -10, 0}},
      {"G1L", {-15, 1.05, 0.8}}, {"G2L", {-15, -1.05, 0.8}}, {"G1R", {15, 1.05, 0.8}}, {"G2R", {15, -1.05, 0.8}}};
  return all;
}

Vec3 polar(double d, double h, double v) {
  const double a = radians(h), e = radians(v);
  return Vec3(-std::sin(a) * std::cos(e), std::cos(a) * std::cos(e), std::sin(e)) * d;
}

void read(const spark::Predicates& message, std::string_view team, Percepts& out) {
  out.seeing = out.rightFoot = out.leftFoot = false;
  out.sightings.clear();
  out.players.clear();
  out.heard.clear();
  out.ball.reset();
  for (const Element e : message) {
    if (!e.isList()) continue;
    const std::string_view head = e.head();
    if (head == "HJ")
      readJoint(e, out);
    else if (head == "time" && e.named("now"))
      out.now = e.named("now").at(1).number();
    else if (head == "GS")
      readGameState(e, out);
    else if (head == "GYR" && e.named("rt"))
      out.gyro = vector(e.named("rt")) * radians(1);
    else if (head == "ACC" && e.named("a"))
      out.acceleration = vector(e.named("a"));
    else if (head == "FRP")
      readFoot(e, out);
    else if (head == "hear")
      readHearing(e, team, out);
    else if (head == "See")
      readVision(e, out);
  }
}

}  // namespace humanoid
