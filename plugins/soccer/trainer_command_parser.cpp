#include "trainer_command_parser.h"

#include <charconv>
#include <cmath>
#include <optional>

namespace spark {

using soccer::Side;

namespace {

/// Largest magnitude of a number in trainer commands. Larger ones make no sense on a field, and percepts have single
/// precision.
constexpr double kMaxNumber = 1e6;

/// The number in `e`; nullopt for lists, texts that are not entirely a number, and numbers beyond kMaxNumber.
std::optional<double> numberIn(const Element& e) {
  if (!e || e.isList()) return {};
  double v = e.number();
  if (e.isText()) {
    std::string_view text = e.text();
    if (text.starts_with('+')) text.remove_prefix(1);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), v);
    if (error != std::errc() || end != text.data() + text.size()) return {};
  }
  if (!(std::abs(v) <= kMaxNumber)) return {};
  return v;
}

/// As numberIn, for integers only.
std::optional<int> integerIn(const Element& e) {
  const auto v = numberIn(e);
  if (!v || *v != std::trunc(*v)) return {};
  return static_cast<int>(*v);
}

/// Reads `count` numbers after the head of a list. Returns false when one is missing or not a number.
bool readList(const Element& list, double* out, int count) {
  if (!list) return false;
  for (int i = 0; i < count; ++i) {
    const auto v = numberIn(list.at(std::size_t(i) + 1));
    if (!v) return false;
    out[i] = *v;
  }
  return true;
}

/// Reads the numbers of `(name n...)` inside a command.
bool readNamed(const Element& command, std::string_view name, double* out, int count) {
  return readList(command.named(name), out, count);
}

/// True for a command without arguments: it is for the selected player.
bool isBare(const Element& command) { return command.size() == 1; }

/// The side in `(team Left)` of a command.
Side sideIn(const Element& command) {
  const Element team = command.named("team");
  return team ? soccer::sideFromTrainer(team.at(1).text()) : Side::none;
}

const char* const kNoSuchPlayer = "no such player";

}  // namespace

const std::vector<std::pair<std::string_view, TrainerCommandParser::Run>>& TrainerCommandParser::table() {
  static const std::vector<std::pair<std::string_view, Run>> kCommands = {
      {"playMode", &TrainerCommandParser::playMode}, {"kickOff", &TrainerCommandParser::kickOff},
      {"dropBall", &TrainerCommandParser::dropBall}, {"ball", &TrainerCommandParser::ball},
      {"agent", &TrainerCommandParser::agent},       {"select", &TrainerCommandParser::select},
      {"kill", &TrainerCommandParser::kill},         {"repos", &TrainerCommandParser::repos},
      {"time", &TrainerCommandParser::time},         {"score", &TrainerCommandParser::score}};
  return kCommands;
}

std::vector<std::string> TrainerCommandParser::commands() const {
  std::vector<std::string> names;
  for (const auto& [name, run] : table()) names.emplace_back(name);
  return names;
}

bool TrainerCommandParser::command(const Element& c, std::string& why) {
  for (const auto& [name, run] : table()) {
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
  const bool place = readNamed(c, "pos", p, 3), push = readNamed(c, "vel", v, 3);
  if (!place && !push) return "expected (pos x y z) or (vel x y z)";
  ball->enable();
  if (place) ball->setPosition(Vec3(p[0], p[1], p[2]));
  if (push) {
    ball->setVelocity(Vec3(v[0], v[1], v[2]));
    ball->setAngularVelocity(Vec3::Zero());
  }
  return {};
}

const soccer::Player* TrainerCommandParser::namedPlayer(const Element& c) {
  const Element unum = c.named("unum");
  const auto number = unum ? integerIn(unum.at(1)) : std::nullopt;
  return number ? match_.game()->pitch().player(sideIn(c), *number) : nullptr;
}

const soccer::Player* TrainerCommandParser::selectedPlayer() {
  for (const Player& p : match_.game()->pitch().players())
    if (p.state->selected()) return &p;
  return nullptr;
}

std::string TrainerCommandParser::agent(const Element& c) {
  const soccer::Pitch& pitch = match_.game()->pitch();
  if (isBare(c)) {
    // Move the selected players away from where they are, towards their own end.
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
  const Player* p = namedPlayer(c);
  if (!p || !p->torso) return kNoSuchPlayer;
  double v[4];
  bool done = false;
  const auto given = [&](std::string_view name, int count) {
    const bool yes = readNamed(c, name, v, count);
    done |= yes;
    return yes;
  };
  if (given("move", 4)) p->moveTo(Vec3(v[0], v[1], v[2]), degToRad(v[3]));
  if (given("pos", 3)) p->moveTo(Vec3(v[0], v[1], v[2]));
  if (given("rot", 3)) p->rotateTo(rotationDeg(float(v[0]), float(v[1]), float(v[2])).block<3, 3>(0, 0).cast<double>());
  if (given("battery", 1)) p->state->setBattery(v[0]);
  if (given("temperature", 1)) p->state->setTemperature(v[0]);
  return done ? std::string() : "expected (pos x y z), (move x y z deg), (rot x y z), (battery v) or (temperature v)";
}

std::string TrainerCommandParser::select(const Element& c) {
  const auto& players = match_.game()->pitch().players();
  const Element unum = c.named("unum");
  const Player* wanted = namedPlayer(c);
  if (!isBare(c) && !wanted && !(unum && integerIn(unum.at(1)) == -1)) return kNoSuchPlayer;
  if (isBare(c) && !players.empty()) {
    // Select the next player in the list; after the last the first.
    const Player* now = selectedPlayer();
    wanted = now && now != &players.back() ? now + 1 : &players.front();
  }
  for (const Player& p : players)
    if (p.state->selected() != (&p == wanted)) p.state->select(&p == wanted);
  return {};
}

std::string TrainerCommandParser::kill(const Element& c) {
  const Player* p = isBare(c) ? selectedPlayer() : namedPlayer(c);
  if (!p) return kNoSuchPlayer;
  // Also close its connection. The installed base leaves it open and repeats the last message forever.
  match_.game()->pitch().gameControl()->removeAgent(*p->agent, true);
  return {};
}

std::string TrainerCommandParser::repos(const Element& c) {
  const Player* p = isBare(c) ? selectedPlayer() : namedPlayer(c);
  if (!p || !p->torso || p->side() == Side::none) return kNoSuchPlayer;
  match_.game()->pitch().moveOffField(*p, 1.0);
  return {};
}

std::string TrainerCommandParser::time(const Element& c) {
  double t;
  if (!readList(c, &t, 1) || t < 0) return fmt::format("expected a time of 0 to {} s", kMaxNumber);
  match_.game()->setTime(t);
  return {};
}

std::string TrainerCommandParser::score(const Element& c) {
  const Element left = c.named("left"), right = c.named("right");
  const auto goals = left && right ? std::pair(integerIn(left.at(1)), integerIn(right.at(1)))
                                   : std::pair<std::optional<int>, std::optional<int>>();
  if (!goals.first || !goals.second || *goals.first < 0 || *goals.second < 0)
    return "expected (left a)(right b), both 0 or more";
  match_.game()->setScores(*goals.first, *goals.second);
  return {};
}

}  // namespace spark
