#include "gamecontrol/request_effector.h"

#include <fmt/format.h>

#include <algorithm>

#include "gamecontrol/judged_import.h"
#include "gamecontrol/scene_effector.h"
#include "spark/error.h"

namespace spark {

namespace {

using Kind = PartRequest::Kind;

constexpr const char* kCamera = "ImagePerceptor";
constexpr const char* kUsage =
    "expected (request (perceptor <class>) (name <name>) (at <node>)), or effector in its place, or (request (scene "
    "<file>) (at <node>))";

/// Writes a line as words, without what would end the list.
void writeWords(Predicates& out, std::string_view line) {
  std::string word;
  const auto flush = [&] {
    if (!word.empty()) out.add(std::string_view(word));
    word.clear();
  };
  for (const char c : line)
    if (c == ' ' || c == '(' || c == ')' || c == '"' || static_cast<unsigned char>(c) < 0x20)
      flush();
    else
      word += c;
  flush();
}

/// The number of nodes of a class below `node`.
int countBelow(const Node& node, std::string_view className) {
  int count = 0;
  for (const auto& child : node.children()) {
    count += child->classObject()->isA(className);
    if (const Node* const inner = child->asNode()) count += countBelow(*inner, className);
  }
  return count;
}

std::string_view textOf(const Element& action, std::string_view name) {
  const Element e = action.named(name);
  return e && e.at(1) && e.at(1).isText() ? e.at(1).text() : std::string_view();
}

/// The first node of that name below `node`, in tree order.
Node* findBelow(Node& node, std::string_view name) {
  for (const auto& child : node.children())
    if (Node* below = child->asNode()) {
      if (below->name() == name) return below;
      if (Node* found = findBelow(*below, name)) return found;
    }
  return nullptr;
}

/// True for names that are one word in every language, and for none.
bool isPlain(std::string_view name) {
  return name.empty() || (isWord(name) && std::all_of(name.begin(), name.end(), [](char c) { return c > 0; }));
}

/// True for what game control gives an agent once: another one would undo its limits.
bool isGiven(ClassObject& type) {
  return type.isA("RequestEffector") || type.isA("RequestPerceptor") || type.isA("SceneEffector") ||
         type.isA("DisqualifyEffector");
}

/// True if the agent has a robot, loaded by itself or made by a rule: more than what game control gives it. Objects
/// that are agents need none.
bool hasRobot(const AgentAspect& root) {
  const auto* const loader = root.find<SceneEffector>(GameControl::kCreateEffector);
  if (!loader || loader->loaded()) return true;
  return std::any_of(root.children().begin(), root.children().end(), [](const auto& child) {
    return child->name() != GameControl::kCreateEffector && child->name() != RequestEffector::kName &&
           child->name() != RequestPerceptor::kName;
  });
}

}  // namespace

void RequestPerceptor::sense(Predicates& out, const Event&) {
  for (const auto& [name, why] : answers_) {
    out.open(why.empty() ? "granted" : "refused").pair("name", std::string_view(name));
    if (!why.empty()) {
      out.open("why");
      writeWords(out, why);
      out.close();
    }
    out.close();
  }
  answers_.clear();
}

void RequestPerceptor::saveState(StateWriter& out) const {
  out.write(static_cast<std::int64_t>(answers_.size()));
  for (const auto& [name, why] : answers_) {
    out.write(name);
    out.write(why);
  }
}

void RequestPerceptor::loadState(StateReader& in) {
  answers_.clear();
  for (std::size_t n = in.readCount(); n > 0; --n) {
    std::string name = in.readString();
    answers_.emplace_back(std::move(name), in.readString());
  }
}

void RequestEffector::describe(Description<RequestEffector>& d) {
  using R = RequestEffector;
  d.doc("(request (perceptor <class>) (name <name>) (at <node>)): gives the agent a perceptor or an effector.");
  d.property("maxCameras", &R::maxCameras_)
      .min(0)
      .doc("An agent with as many cameras gets no more: each picture takes time of the simulation's thread.");
  d.property("maxParts", &R::maxParts_)
      .range(0, 1000)
      .doc("Number of requests that are granted; further ones are not.");
  d.property("folder", &R::folder_).doc("Scene files that are asked for are below this folder.");
  d.on<&R::prepare>(phase::kPrepare);
}

void RequestEffector::addTo(AgentAspect& aspect, const std::string& folder) {
  aspect.create<RequestEffector>("RequestEffector", kName).folder_ = folder;
  aspect.create("RequestPerceptor", RequestPerceptor::kName);
}

std::string RequestEffector::act(const Element& action) {
  if (pending_.size() >= kMaxPending)
    return fmt::format("expected at most {} requests in a cycle, found more: this one is lost.", kMaxPending);
  for (const auto& [word, kind] :
       {std::pair("perceptor", Kind::perceptor), {"effector", Kind::effector}, {"scene", Kind::scene}}) {
    if (!action.named(word)) continue;
    Request request{kind, std::string(textOf(action, word)), std::string(textOf(action, "name")),
                    std::string(textOf(action, "at")), false};
    if (request.type.empty() || (kind != Kind::scene && request.name.empty())) return kUsage;
    if (std::max({request.type.size(), request.name.size(), request.at.size()}) > kMaxText)
      return fmt::format("expected texts of at most {} bytes, found a longer one.", kMaxText);
    if (!isPlain(request.type) || !isPlain(request.name) || !isPlain(request.at))
      return "expected names of printable ASCII characters, found others, a blank, a bracket or a quote.";
    if (const auto* const control = find<GameControl>(IGameControl::kPath); control && agent())
      request.required = control->requiresWhatItAsks(agent()->outermost());
    pending_.push_back(std::move(request));
    return {};
  }
  return kUsage;
}

void RequestEffector::prepare(const Event&) {
  if (pending_.empty()) return;
  AgentAspect* const nearest = agent();
  const std::vector<Request> requests = std::exchange(pending_, {});
  if (!nearest) return;
  const Ref<AgentAspect> root(&nearest->outermost());
  const Ref<RequestPerceptor> answers(find<RequestPerceptor>(fmt::format("../{}", RequestPerceptor::kName)));
  const Ref<RequestEffector> self(this);  // a judge may be a script that removes the agent
  for (const Request& request : requests) {
    const bool early = !hasRobot(*root);
    std::string why;
    try {
      why = early ? "there is no robot yet: expected (scene <file>) first" : grant(request, *root);
    } catch (const std::exception& e) {
      // The agent need not know the host's folders.
      why = "it cannot be made, the log of the host says why";
      if (self) refuse(static_cast<int>(request.kind), [&] { return fmt::format("{}: {}", request.type, e.what()); });
    }
    if (!self || !root) return;
    if (!why.empty() && request.required && !early)
      if (auto* const control = find<GameControl>(IGameControl::kPath))
        control->reject(*root, fmt::format("it requires {}, which is refused: {}", request.type, why));
    if (answers) answers->add(request.kind == Kind::scene ? request.type : request.name, std::move(why));
  }
}

Node* RequestEffector::parentFor(const Request& request, AgentAspect& root) const {
  if (request.at.empty()) return &root;
  Node* const found =
      request.at.find('/') == std::string::npos ? findBelow(root, request.at) : root.find<Node>(request.at);
  return found && isBelow(*found, root) ? found : nullptr;
}

std::string RequestEffector::grant(const Request& request, AgentAspect& root) {
  // What it is, and where it goes.
  if (parts_ >= maxParts_) return fmt::format("{} requests were granted, no more are", maxParts_);
  Node* const parent = parentFor(request, root);
  if (!parent) return fmt::format("there is no node {} in this robot", request.at);
  if (request.kind == Kind::scene) {
    if (!request.type.starts_with(folder_) || request.type.find("..") != std::string::npos)
      return fmt::format("expected a file below {}, found {}", folder_, request.type);
  } else {
    const char* const base = request.kind == Kind::perceptor ? "Perceptor" : "Effector";
    ClassObject* const type = kernel().findClass(request.type);
    if (!type || type->isAbstract() || !type->isA(base) || isGiven(*type))
      return fmt::format("expected the class of {} {}, found {}",
                         request.kind == Kind::perceptor ? "a perceptor," : "an effector,",
                         request.kind == Kind::perceptor ? "such as GPS" : "such as HingeEffector", request.type);
    if (type->isA(kCamera) && countBelow(root, kCamera) >= maxCameras_)
      return fmt::format("the robot has {} cameras, more are not granted", maxCameras_);
    if (parent->find(request.name)) return fmt::format("there is a node {} already", request.name);
  }

  // The judges, then the tree.
  const Ref<RequestEffector> self(this);
  if (request.kind == Kind::scene) {
    std::string why = gamecontrol::importJudged(root, *parent, request.type, {});
    if (self && why.empty()) ++parts_;
    return why;
  }
  if (auto* const control = find<IGameControl>(IGameControl::kPath))
    if (std::string why = control->judgeRequest(root, {request.kind, request.type, request.name, *parent});
        !why.empty() || !self)
      return why;
  ++parts_;
  parent->create(request.type, request.name);
  if (auto* const scenes = kernel().root().find<ISceneServer>()) scenes->markModified();
  return {};
}

}  // namespace spark
