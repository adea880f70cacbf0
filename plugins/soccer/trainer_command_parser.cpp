#include "trainer_command_parser.h"

#include <algorithm>
#include <cmath>

namespace spark {

using soccer::Side;

namespace {

/// Greatest number that a trainer may give: what agents and monitors are told has single precision and a field's size.
constexpr double kLargest = 1e6;

/// The `count` numbers of `(name n...)` inside a command; false when it is not there, or they are not finite or too large.
bool numbers(const Element& command, std::string_view name, double* out, int count) {
  const Element list = command.named(name);
  return list && readNumbers(list, out, count).empty() && std::all_of(out, out + count, [](double v) { return std::abs(v) <= kLargest; });
}

Side sideIn(const Element& command) {
  const Element team = command.named("team");
  return team ? soccer::sideFromTrainer(team.at(1).text()) : Side::none;
}

const char* const kNoSuchPlayer = "no such player";

}  // namespace

bool TrainerCommandParser::command(const Element& c, std::string& why) {
  using Run = std::string (TrainerCommandParser::*)(const Element&);
  static constexpr std::pair<std::string_view, Run> kCommands[] = {
      {"playMode", &TrainerCommandParser::playMode}, {"kickOff", &TrainerCommandParser::kickOff},
      {"dropBall", &TrainerCommandParser::dropBall}, {"ball", &TrainerCommandParser::ball},
      {"agent", &TrainerCommandParser::agent},       {"select", &TrainerCommandParser::select},
      {"kill", &TrainerCommandParser::kill},         {"repos", &TrainerCommandParser::repos},
      {"time", &TrainerCommandParser::time},         {"score", &TrainerCommandParser::score}};
  for (const auto& [name, run] : kCommands) {
    if (c.head() != name) continue;
    match_.refresh(*this);
    if (!match_.game() || !match_.game()->pitch().ready())
      why = "there is no match";
    else
      why = (this->*run)(c);
    return true;
  }
  return false;
}

std::string TrainerCommandParser::playMode(const Element& c) {
  soccer::PlayMode mode;
  if (!c.at(1) || !soccer::playModeFromName(c.at(1).text(), mode)) return "no such play mode";
  match_.game()->setMode(mode);
  return {};
}

std::string TrainerCommandParser::kickOff(const Element& c) {
  const std::string_view side = c.at(1) ? c.at(1).text() : std::string_view();
  if (side != "Left" && side != "Right" && side != "None") return "expected Left, Right or None";
  match_.game()->kickOff(soccer::sideFromTrainer(side));
  return {};
}

std::string TrainerCommandParser::dropBall(const Element&) {
  if (match_.referee()) match_.referee()->dropBall(match_.game()->pitch().ballPosition());
  return {};
}

std::string TrainerCommandParser::ball(const Element& c) {
  IRigidBody* ball = match_.game()->pitch().ball();
  if (!ball) return "there is no ball";
  double p[3], v[3];
  const bool place = numbers(c, "pos", p, 3), push = numbers(c, "vel", v, 3);
  if (!place && !push) return "expected (pos x y z) or (vel x y z)";
  ball->enable();
  if (place) ball->setPose({Vec3(p[0], p[1], p[2]), ball->state().rotation});
  if (push) {
    ball->setVelocity(Vec3(v[0], v[1], v[2]));
    ball->setAngularVelocity(Vec3::Zero());
  }
  return {};
}

const soccer::Player* TrainerCommandParser::named(const Element& c) {
  const Element unum = c.named("unum");
  if (!unum) return nullptr;
  return match_.game()->pitch().player(sideIn(c), static_cast<int>(unum.at(1).integer()));
}

const soccer::Player* TrainerCommandParser::selected() {
  for (const Player& p : match_.game()->pitch().players())
    if (p.state->selected()) return &p;
  return nullptr;
}

std::string TrainerCommandParser::agent(const Element& c) {
  const soccer::Pitch& pitch = match_.game()->pitch();
  if (!c.named("unum") && !c.named("team")) {
    const double distance = pitch.settings().freeKickMoveDist;
    for (const Player& p : pitch.players()) {
      if (!p.state->selected() || !p.torso) continue;
      const double d = direction(p.side());
      Vec3 target = p.position();
      if (std::abs(target.x() - d * distance) <= pitch.settings().fieldLength / 2)
        target.x() -= d * distance;
      else
        target.y() += target.y() > 0 ? -distance : distance;
      p.moveTo(target);
    }
    return {};
  }
  const Player* p = named(c);
  if (!p || !p->torso) return kNoSuchPlayer;
  double v[4];
  if (numbers(c, "move", v, 4)) p->moveTo(Vec3(v[0], v[1], v[2]), degToRad(v[3]));
  if (numbers(c, "pos", v, 3)) p->moveTo(Vec3(v[0], v[1], v[2]));
  if (numbers(c, "battery", v, 1)) p->state->setBattery(v[0]);
  if (numbers(c, "temperature", v, 1)) p->state->setTemperature(v[0]);
  return {};
}

std::string TrainerCommandParser::select(const Element& c) {
  const auto& players = match_.game()->pitch().players();
  const Element unum = c.named("unum");
  const Player* wanted = named(c);
  if (unum && !wanted && unum.at(1).integer() != -1) return kNoSuchPlayer;
  if (!unum && !players.empty()) {
    // the next in the list after the one that is selected, and round again
    const Player* now = selected();
    wanted = now && now != &players.back() ? now + 1 : &players.front();
  }
  for (const Player& p : players)
    if (p.state->selected() != (&p == wanted)) p.state->select(&p == wanted);
  return {};
}

std::string TrainerCommandParser::kill(const Element& c) {
  const Player* p = c.named("unum") ? named(c) : selected();
  if (!p) return kNoSuchPlayer;
  match_.game()->pitch().gameControl()->removeAgent(*p->agent, true);
  return {};
}

std::string TrainerCommandParser::repos(const Element& c) {
  const Player* p = c.named("unum") ? named(c) : selected();
  if (!p || !p->torso || p->side() == Side::none) return kNoSuchPlayer;
  match_.game()->pitch().putOutside(*p, 1.0);
  return {};
}

std::string TrainerCommandParser::time(const Element& c) {
  double t;
  if (const std::string wrong = readNumbers(c, &t, 1); !wrong.empty() || t < 0) return "expected a time of 0 s or more";
  if (t > kLargest) return fmt::format("expected a time of at most {} s", kLargest);
  match_.game()->setTime(t);
  return {};
}

std::string TrainerCommandParser::score(const Element& c) {
  const Element left = c.named("left"), right = c.named("right");
  if (!left || !right || left.at(1).integer() < 0 || right.at(1).integer() < 0) return "expected (left a)(right b), both 0 or more";
  const auto goals = [](const Element& e) { return static_cast<int>(std::min<std::int64_t>(e.at(1).integer(), 1000000)); };
  match_.game()->setScores(goals(left), goals(right));
  return {};
}

}  // namespace spark
