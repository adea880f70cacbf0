#pragma once
/// \file
/// The state of a monitor from the messages received: environment, ball, players, fouls.

#include <array>
#include <map>
#include <optional>

#include "api/math.h"
#include "monitor_message.h"

namespace spark::test {

enum class Side { none, left, right };

class MonitorView {
 public:
  /// `(foul index type team unum)`.
  struct Foul {
    int index, type, team, unum;
    double time;  ///< time of play in the message that reported it [s]
  };

  void read(const std::string& message) {
    frame_.read(message);
    ++messages_;
    if (frame_.update.full) ++fullMessages_;
    last_ = message;
    lastKeys_.clear();
    for (const Element e : frame_.frame.env.predicates) {
      lastKeys_.emplace_back(e.head());
      env_[std::string(e.head())] = e.at(1).isText() ? std::string(e.at(1).text()) : std::to_string(e.at(1).number());
      if (e.head() == "play_modes") names(e);
    }
    for (const Element e : frame_.update.events)
      if (e.head() == "foul")
        fouls_.push_back({int(e.at(1).number()), int(e.at(2).number()), int(e.at(3).number()), int(e.at(4).number()),
                          number("time")});
  }

  /// The last value of an environment key; 0 if it was never sent.
  double number(const std::string& key) const { return env_.count(key) ? std::stod(env_.at(key)) : 0; }
  std::string text(const std::string& key) const { return env_.count(key) ? env_.at(key) : std::string(); }
  /// True if the newest message has this key.
  bool lastMessageHas(std::string_view key) const {
    return std::find(lastKeys_.begin(), lastKeys_.end(), key) != lastKeys_.end();
  }
  /// Name of the play mode from the list that the server sent.
  std::string mode() const { return modes_.empty() ? "" : modes_.at(static_cast<std::size_t>(number("play_mode"))); }
  const std::vector<Foul>& fouls() const { return fouls_; }
  const std::string& lastMessage() const { return last_; }
  int messages() const { return messages_; }
  int fullMessages() const { return fullMessages_; }

  Vec3 ball() const {
    const auto at = find([](const FrameNode& n) { return n.visual && n.visual->load().ends_with("soccerball.obj"); });
    if (!at) throw Error("the monitor sees no ball");
    return worldPosition(*at);
  }
  /// Position of the torso; empty if there is no such player. The materials matLeft and matRight give the side.
  std::optional<Vec3> player(Side side, int unum) const {
    const std::string number = "matNum" + std::to_string(unum), shirt = side == Side::left ? "matLeft" : "matRight";
    const auto at = find([&](const FrameNode& n) {
      if (!n.visual || n.visual->load().find("body") == std::string::npos) return false;
      const auto& m = n.visual->materials();
      return std::find(m.begin(), m.end(), number) != m.end() && std::find(m.begin(), m.end(), shirt) != m.end();
    });
    if (!at) return {};
    return worldPosition(*at);
  }

 private:
  void names(const Element& list) {
    modes_.clear();
    for (std::size_t i = 1; i < list.size(); ++i) modes_.emplace_back(list.at(i).text());
  }
  template <class F>
  std::optional<std::size_t> find(F matches) const {
    for (std::size_t i = 0; i < frame_.frame.nodes.size(); ++i)
      if (matches(frame_.frame.nodes[i])) return i;
    return {};
  }
  /// The position in the world: the product of all transforms above a node.
  Vec3 worldPosition(std::size_t node) const {
    const auto& nodes = frame_.frame.nodes;
    Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
    int depth = nodes[node].depth;
    for (std::size_t i = node; i-- > 0 && depth > 0;) {
      if (nodes[i].depth != depth - 1) continue;
      m = nodes[i].local.cast<double>() * m;
      --depth;
    }
    return m.block<3, 1>(0, 3);
  }

  RecordedFrame frame_;
  std::map<std::string, std::string> env_;
  std::vector<std::string> lastKeys_, modes_;
  std::vector<Foul> fouls_;
  std::string last_;
  int messages_ = 0, fullMessages_ = 0;
};

}  // namespace spark::test
