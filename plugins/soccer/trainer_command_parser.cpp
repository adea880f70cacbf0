#include "trainer_command_parser.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "spark/error.h"

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

constexpr std::size_t kMaxQuote = 40;  ///< bytes of a command that a message repeats

/// The arguments that `usage` names: "(pos x y z)" is {pos, 3}; without brackets, as in "(time seconds)", {"", 1}.
std::vector<std::pair<std::string_view, std::size_t>> partsOf(std::string_view usage) {
  std::vector<std::pair<std::string_view, std::size_t>> parts;
  for (std::size_t at = usage.find('(', 1); at != usage.npos; at = usage.find('(', at + 1)) {
    const std::string_view part = usage.substr(at + 1, usage.find(')', at) - at - 1);
    parts.emplace_back(part.substr(0, part.find(' ')), std::count(part.begin(), part.end(), ' '));
  }
  return parts;
}

/// What is wrong with a part of a command that has an effect all the same: it is ignored. "" if nothing is.
std::string wrongPart(const Element& command, std::string_view usage) {
  const auto parts = partsOf(usage);
  const std::size_t words = parts.empty() ? std::count(usage.begin(), usage.end(), ' ') : 0;
  if (parts.empty() && command.size() != words + 1)
    return fmt::format("expected {} argument{}, found {}: the rest is ignored", words, words == 1 ? "" : "s",
                       command.size() - 1);
  if (parts.empty()) return {};
  for (std::size_t i = 1; i < command.size(); ++i) {
    const Element part = command.at(i);
    const std::string_view name = (part.isList() ? part.head() : part.text()).substr(0, kMaxQuote);
    const auto known = std::find_if(parts.begin(), parts.end(), [&](const auto& p) { return p.first == name; });
    if (!part.isList() || known == parts.end()) return fmt::format("found '{}', which is ignored", name);
    if (const Element first = command.named(name); first && first.index() < part.index())
      return fmt::format("found '{}' again, which is ignored", name);
    double numbers[4];
    const auto count = static_cast<int>(known->second);
    if (name == "team" && part.size() != 2)
      return "expected (team Left) or (team Right), found another number of words";
    if (part.size() != known->second + 1 || (name != "team" && !readList(part, numbers, count)))
      return fmt::format("expected {} numbers of at most {} after {}, found something else, which is ignored", count,
                         kMaxNumber, name);
    if (name == "battery" && (numbers[0] < 0 || numbers[0] > AgentState::kFullBattery))
      return fmt::format("expected 0 to {} after battery, found {}: it is clamped", AgentState::kFullBattery,
                         numbers[0]);
  }
  return {};
}

}  // namespace

const std::vector<TrainerCommandParser::Command>& TrainerCommandParser::table() {
  using T = TrainerCommandParser;
  static const std::vector<Command> kCommands = {
      {"playMode", "(playMode <mode>)", &T::playMode},
      {"kickOff", "(kickOff Left|Right|None)", &T::kickOff},
      {"dropBall", "(dropBall)", &T::dropBall},
      {"ball", "(ball (pos x y z) (vel x y z))", &T::ball},
      {"agent",
       "(agent (unum n) (team Left|Right) (pos x y z) (move x y z deg) (rot x y z) (battery v) (temperature v))",
       &T::agent},
      {"select", "(select (unum n) (team Left|Right))", &T::select},
      {"kill", "(kill (unum n) (team Left|Right))", &T::kill},
      {"repos", "(repos (unum n) (team Left|Right))", &T::repos},
      {"time", "(time seconds)", &T::time},
      {"score", "(score (left n) (right n))", &T::score}};
  return kCommands;
}

const TrainerCommandParser::Command* TrainerCommandParser::find(const Element& command) {
  for (const Command& c : table())
    if (command.head() == c.name) return &c;
  return nullptr;
}

std::vector<std::string> TrainerCommandParser::commands() const {
  std::vector<std::string> names;
  for (const Command& c : table()) names.emplace_back(c.name);
  return names;
}

std::string TrainerCommandParser::run(const Command& command, const Element& c) {
  match_.refresh(*this);
  if (!match_.game() || !match_.game()->pitch().ready()) return "there is no match";
  return (this->*command.run)(c);
}

bool TrainerCommandParser::command(const Element& c, std::string& why) {
  const Command* const known = find(c);
  if (known) why = run(*known, c);
  return known;
}

std::string TrainerCommandParser::check(const Element& c) {
  const Command* const known = find(c);
  if (!known) return {};
  acts_ = false;
  std::string why = run(*known, c);
  acts_ = true;
  if (why.empty()) why = wrongPart(c, known->usage);
  return why.empty() ? why : fmt::format("{}{} The command is {}", why, why.back() == '?' ? "" : ".", known->usage);
}

std::string TrainerCommandParser::playMode(const Element& c) {
  soccer::PlayMode mode;
  const std::string_view name = c.at(1) ? c.at(1).text().substr(0, kMaxQuote) : std::string_view();
  if (!soccer::playModeFromName(name, mode)) {
    static const std::vector<std::string> kNames(soccer::kPlayModeNames.begin(), soccer::kPlayModeNames.end());
    const std::string guess = didYouMean(name, kNames);
    return fmt::format("expected a play mode, found '{}'{}{}", name, guess.empty() ? "" : ".", guess);
  }
  if (acts_) match_.game()->setMode(mode);
  return {};
}

std::string TrainerCommandParser::kickOff(const Element& c) {
  const std::string_view side = c.at(1) ? c.at(1).text() : std::string_view();
  if (side != "Left" && side != "Right" && side != "None")
    return fmt::format("expected Left, Right or None, found '{}'", side.substr(0, kMaxQuote));
  if (acts_) match_.game()->kickOff(soccer::sideFromTrainer(side));
  return {};
}

std::string TrainerCommandParser::dropBall(const Element&) {
  if (!match_.referee()) return "there is no referee";
  if (acts_) match_.referee()->dropBall(match_.game()->pitch().ballPosition());
  return {};
}

std::string TrainerCommandParser::ball(const Element& c) {
  IRigidBody* ball = match_.game()->pitch().ball();
  if (!ball) return "there is no ball";
  double p[3], v[3];
  const bool place = readNamed(c, "pos", p, 3), push = readNamed(c, "vel", v, 3);
  if (!place && !push) return "expected (pos x y z) or (vel x y z)";
  if (!acts_) return {};
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
    if (!selectedPlayer()) return kNoSuchPlayer;
    // Move the selected players away from where they are, towards their own end.
    const double distance = pitch.settings().freeKickMoveDist;
    for (const Player& p : pitch.players()) {
      if (!acts_ || !p.state->selected() || !p.torso) continue;
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
    return yes && acts_;
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
  if (isBare(c) && !wanted) return kNoSuchPlayer;
  for (const Player& p : players)
    if (acts_ && p.state->selected() != (&p == wanted)) p.state->select(&p == wanted);
  return {};
}

std::string TrainerCommandParser::kill(const Element& c) {
  const Player* p = isBare(c) ? selectedPlayer() : namedPlayer(c);
  if (!p) return kNoSuchPlayer;
  // Also close its connection. The installed base leaves it open and repeats the last message forever.
  if (acts_) match_.game()->pitch().gameControl()->removeAgent(*p->agent, true);
  return {};
}

std::string TrainerCommandParser::repos(const Element& c) {
  const Player* p = isBare(c) ? selectedPlayer() : namedPlayer(c);
  if (!p || !p->torso || p->side() == Side::none) return kNoSuchPlayer;
  if (acts_) match_.game()->pitch().moveOffField(*p, 1.0);
  return {};
}

std::string TrainerCommandParser::time(const Element& c) {
  double t;
  if (!readList(c, &t, 1) || t < 0) return fmt::format("expected a time of 0 to {} s", kMaxNumber);
  if (acts_) match_.game()->setTime(t);
  return {};
}

std::string TrainerCommandParser::score(const Element& c) {
  const Element left = c.named("left"), right = c.named("right");
  const auto goals = left && right ? std::pair(integerIn(left.at(1)), integerIn(right.at(1)))
                                   : std::pair<std::optional<int>, std::optional<int>>();
  if (!goals.first || !goals.second || *goals.first < 0 || *goals.second < 0)
    return "expected (left a)(right b), both 0 or more";
  if (acts_) match_.game()->setScores(*goals.first, *goals.second);
  return {};
}

}  // namespace spark
