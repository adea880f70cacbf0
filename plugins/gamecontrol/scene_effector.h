#pragma once
/// \file
/// The effector with which an agent requests its robot: `(scene file arguments...)`.

#include "api/agents.h"
#include "gamecontrol/game_control.h"
#include "gamecontrol/judged_import.h"
#include "gamecontrol/request_effector.h"
#include "spark/error.h"

namespace spark {

/// Every agent has this effector from the start. The action is stored; the file is imported below the agent's aspect in
/// the prepare phase.
class SceneEffector : public Effector {
  SPARK_CLASS(SceneEffector, Effector)
 public:
  static void describe(Description<SceneEffector>& d) {
    d.doc("(scene file arguments...): loads the agent's robot, once.");
    d.property("folder", &SceneEffector::folder_).doc("Robots are files below this folder; empty: any folder.");
    d.on<&SceneEffector::prepare>(phase::kPrepare);
  }
  std::string predicate() const override { return "scene"; }
  /// Restricts robots to files below `folder`; "": no restriction.
  void setFolder(std::string folder) { folder_ = std::move(folder); }

  /// True while its robot waits to be loaded, and in the cycle after a robot that had to wait was loaded.
  bool late() const { return late_; }
  /// True if the agent has its robot.
  bool loaded() const { return loaded_; }

  std::string act(const Element& action) override {
    if (loaded_)
      return "expected one robot, found a request for another: it has a robot already; a second one is refused.";
    if (failures_ >= kMaxFailures) return "no robot could be built too often; connect again to try once more.";
    const Element file = action.at(1);
    if (!file || !file.isText() || file.text().empty())
      return "expected (scene <file> <arguments>...), found no file name after scene.";
    if (file.text().size() > kMaxNameLength)
      return fmt::format("expected a file name of at most {} bytes, found {}.", kMaxNameLength, file.text().size());
    if (!allowed(file.text()))
      return fmt::format("expected a file below {}, found '{}': others are refused.", folder_, file.text());
    file_ = file.text();
    arguments_.clear();
    for (auto it = ++ ++action.begin(); it != action.end(); ++it) arguments_.push_back(value(*it));
    return {};
  }

 protected:
  void saveState(StateWriter& out) const override {
    out.write(file_);
    out.write(Value(arguments_));
    out.write(loaded_);
    out.write(late_);
    out.write(failures_);
  }
  void loadState(StateReader& in) override {
    file_ = in.readString();
    arguments_ = in.readValue().toList();
    loaded_ = in.readBool();
    late_ = in.readBool();
    failures_ = static_cast<int>(in.readInteger());
  }

 private:
  static constexpr std::size_t kMaxNameLength = 512;

  /// True if the file is below the folder. Also true for absolute names, folders and names with `..`: the file server
  /// refuses these with a better message.
  bool allowed(std::string_view file) const {
    const bool hasParent = ("/" + std::string(file) + "/").find("/../") != std::string::npos;
    return file.starts_with(folder_) || folder_ == std::string(file) + "/" || file.starts_with("/") || hasParent;
  }

  static Value value(const Element& e) {
    switch (e.token().kind) {
      case Token::Kind::text:
        return e.text();
      case Token::Kind::number:
        return e.number();
      case Token::Kind::integer:
        return e.integer();
      case Token::Kind::list:
        break;
    }
    List out;
    for (const Element inner : e) out.push_back(value(inner));
    return out;
  }

  void prepare(const Event&) {
    if (file_.empty()) {
      late_ = false;
      return;
    }
    auto* control = find<GameControl>(IGameControl::kPath);
    AgentAspect* nearest = agent();
    if (control && nearest && !control->mayLoad(nearest->outermost())) {
      late_ = true;
      return;
    }
    const std::string file = std::move(file_);
    file_.clear();
    if (!nearest) return kernel().log().error("{}: (scene {}) needs an agent aspect above the effector.", path(), file);
    AgentAspect& root = nearest->outermost();
    const int number = root.number();
    Log& log = kernel().log();
    const Ref<SceneEffector> self(this);  // a judge may be a script that removes the agent
    std::string why;
    try {
      why = gamecontrol::importJudged(root, root, file, arguments_);
      if (self && !why.empty()) report(file, why);
    } catch (const std::exception& e) {
      why = e.what();
    }
    if (why.empty() && self) loaded_ = true;
    if (why.empty()) return;
    if (self) ++failures_;
    const std::string line = fmt::format("Agent {} gets no robot: {}", number, why);
    control ? control->logError(line) : log.write(Level::error, line);
  }

  /// Tells an agent that may ask for parts that a rule refuses its robot.
  void report(const std::string& file, const std::string& why) {
    if (auto* const answers = find<RequestPerceptor>(fmt::format("../{}", RequestPerceptor::kName)))
      answers->add(file, why);
  }

  static constexpr int kMaxFailures = 10;
  std::string folder_;
  std::string file_;  ///< to load in the next prepare phase; "": none
  List arguments_;
  bool loaded_ = false, late_ = false;
  int failures_ = 0;
};

}  // namespace spark
