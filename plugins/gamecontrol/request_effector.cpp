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
constexpr const char* kGroup = "CollisionGroup";
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

/// An atom as text.
std::string textOf(const Element& e) {
  return e.token().kind == Token::Kind::integer  ? std::to_string(e.integer())
         : e.token().kind == Token::Kind::number ? fmt::format("{}", e.number())
                                                 : std::string(e.text());
}

/// Appends the words of an element to a text, up to `most` bytes.
void addWords(const Element& e, std::size_t most, std::string& to) {
  if (e.isList()) {
    for (const Element inner : e) addWords(inner, most, to);
  } else if (to.size() < most) {
    to += (to.empty() ? "" : " ") + textOf(e).substr(0, most);
  }
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

/// True for a text that is one word in every language.
bool isPlain(std::string_view text) {
  return isWord(text) && std::all_of(text.begin(), text.end(), [](char c) { return c > 0; });
}

/// True for a name that a node can have, and that is no more than a name in a path.
bool isName(std::string_view name) {
  return isPlain(name) && name != "." && name != ".." && name.find_first_of("/[]") == name.npos;
}

/// True for what game control gives an agent once: another one would undo its limits.
bool isGiven(ClassObject& type) {
  return type.isA("RequestEffector") || type.isA("RequestPerceptor") || type.isA("SceneEffector") ||
         type.isA("DisqualifyEffector");
}

}  // namespace

bool gamecontrol::hasRobot(const AgentAspect& root) {
  const auto* const loader = root.find<SceneEffector>(GameControl::kCreateEffector);
  if (!loader || loader->loaded()) return true;
  return std::any_of(root.children().begin(), root.children().end(), [](const auto& child) {
    return child->name() != GameControl::kCreateEffector && child->name() != RequestEffector::kName &&
           child->name() != RequestPerceptor::kName && !child->classObject()->isA(kGroup);
  });
}

void RequestPerceptor::add(std::string name, std::string why, std::string unused) {
  if (answers_.size() < kMost)
    answers_.push_back({std::move(name), std::move(why), std::move(unused)});
  else
    ++unanswered_;
}

void RequestPerceptor::sense(Predicates& out, const Event&) {
  const auto words = [&out](const char* head, const std::string& line) {
    if (line.empty()) return;
    out.open(head);
    writeWords(out, line);
    out.close();
  };
  for (const Answer& a : answers_) {
    out.open(a.why.empty() ? "granted" : "refused").open("name").add(a.name, !isWord(a.name)).close();
    words("why", a.why);
    words("unused", a.unused);
    out.close();
  }
  if (unanswered_ > 0) {
    out.open("refused");
    words("why", fmt::format("expected fewer requests, found {} more", unanswered_));
    out.close();
  }
  answers_.clear();
  unanswered_ = 0;
}

void RequestPerceptor::saveState(StateWriter& out) const {
  out.write(static_cast<std::int64_t>(answers_.size()));
  for (const auto& [name, why, unused] : answers_) {
    out.write(name);
    out.write(why);
    out.write(unused);
  }
  out.write(unanswered_);
}

void RequestPerceptor::loadState(StateReader& in) {
  answers_.clear();
  for (std::size_t n = in.readCount(); n > 0; --n) {
    std::string name = in.readString(), why = in.readString();
    answers_.push_back({std::move(name), std::move(why), in.readString()});
  }
  unanswered_ = in.readInteger();
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

std::string RequestEffector::read(const Element& action, Request& request) {
  std::string why;
  const auto fail = [&why](std::string_view line) {
    if (why.empty()) why = line;
  };
  // What it says, once each. All of it is read, so that the answer can name the request.
  int kinds = 0;
  for (auto it = ++action.begin(); it != action.end(); ++it) {
    const Element e = *it;
    const std::string_view word = e.isList() ? e.head() : std::string_view();
    std::string* to = word == "name" ? &request.name : word == "at" ? &request.at : nullptr;
    for (const auto& [name, kind] :
         {std::pair("perceptor", Kind::perceptor), {"effector", Kind::effector}, {"scene", Kind::scene}}) {
      if (word != name) continue;
      if (++kinds > 1) fail("expected one of (perceptor ...), (effector ...) and (scene ...), found more than one");
      request.kind = kind;
      to = &request.type;
    }
    if (!to) {
      addWords(e, kMaxText, request.unused);
      continue;
    }
    const Element value = e.at(1);
    if (!value || value.isList()) {
      fail(kUsage);
      continue;
    }
    if (!to->empty()) fail(fmt::format("expected ({} ...) once, found it more than once", word));
    *to = textOf(value);
    for (auto rest = ++ ++e.begin(); rest != e.end(); ++rest) addWords(*rest, kMaxText, request.unused);
  }
  if (kinds == 0) fail(kUsage);

  // What can be no name, class or file.
  const bool isScene = request.kind == Kind::scene;
  if (std::max({request.type.size(), request.name.size(), request.at.size()}) > kMaxText)
    fail(fmt::format("expected texts of at most {} bytes, found a longer one", kMaxText));
  for (std::string* const text : {&request.type, &request.name, &request.at}) {
    if (text->size() > kMaxText) text->resize(kMaxText);
    const bool isNeeded = text == &request.type || (text == &request.name && !isScene);
    if ((isNeeded || !text->empty()) && !isPlain(*text))
      fail(text->empty() ? kUsage
                         : "expected names of printable ASCII characters, found others, a blank, a bracket or a quote");
  }
  if (isScene && !request.name.empty()) request.unused += (request.unused.empty() ? "name " : " name ") + request.name;
  if (!isScene && !isName(request.name))
    fail(fmt::format("expected a name without /, [ and ], and neither . nor .., found {}", request.name));
  return why;
}

std::string RequestEffector::act(const Element& action) {
  AgentAspect* const nearest = agent();
  if (!nearest) return "expected an agent above this effector, found none";
  AgentAspect& root = nearest->outermost();
  Request request;
  std::string why = read(action, request);
  const auto* const control = find<GameControl>(IGameControl::kPath);
  request.required = control && control->requiresWhatItAsks(root);
  if (why.empty() && pending_.size() >= kMaxPending)
    why = fmt::format("expected at most {} requests in a cycle, found more", kMaxPending);
  if (!why.empty()) {
    answer(root, request, why);
    return why;
  }
  const std::string unused = request.unused;
  pending_.push_back(std::move(request));
  return unused.empty() ? std::string() : fmt::format("{}, found {} beside, which has no effect", kUsage, unused);
}

void RequestEffector::answerRefused(const Element& action, const std::string& why) {
  AgentAspect* const nearest = agent();
  if (!nearest) return;
  AgentAspect& root = nearest->outermost();
  Request request;
  read(action, request);
  const auto* const control = find<GameControl>(IGameControl::kPath);
  request.required = control && control->requiresWhatItAsks(root);
  answer(root, request, why);
}

void RequestEffector::answer(AgentAspect& root, const Request& request, std::string why) {
  const bool isScene = request.kind == Kind::scene;
  if (!why.empty() && request.required)
    if (auto* const control = find<GameControl>(IGameControl::kPath))
      control->reject(root, fmt::format("it requires {}, which is refused: {}",
                                        request.type.empty() ? "a part" : request.type, why));
  if (auto* const answers = find<RequestPerceptor>(fmt::format("../{}", RequestPerceptor::kName)))
    answers->add(isScene || request.name.empty() ? request.type : request.name, std::move(why), request.unused);
}

void RequestEffector::saveState(StateWriter& out) const {
  out.write(parts_);
  out.write(static_cast<std::int64_t>(pending_.size()));
  for (const Request& r : pending_) {
    out.write(static_cast<int>(r.kind));
    for (const std::string* text : {&r.type, &r.name, &r.at, &r.unused}) out.write(*text);
    out.write(r.required);
  }
}

void RequestEffector::loadState(StateReader& in) {
  parts_ = static_cast<int>(in.readInteger());
  pending_.clear();
  for (std::size_t n = in.readCount(); n > 0; --n) {
    Request r;
    r.kind = static_cast<Kind>(in.readInteger());
    for (std::string* text : {&r.type, &r.name, &r.at, &r.unused}) *text = in.readString();
    r.required = in.readBool();
    pending_.push_back(std::move(r));
  }
}

void RequestEffector::prepare(const Event&) {
  AgentAspect* const nearest = pending_.empty() ? nullptr : agent();
  if (!nearest) return;
  const Ref<AgentAspect> root(&nearest->outermost());
  // What it asks for beside its robot waits with it.
  if (const auto* const loader = root->find<SceneEffector>(GameControl::kCreateEffector);
      loader && loader->late() && !loader->loaded())
    return;
  const std::vector<Request> requests = std::exchange(pending_, {});
  const Ref<RequestEffector> self(this);  // a judge may be a script that removes the agent
  for (const Request& request : requests) {
    std::string why;
    try {
      why =
          gamecontrol::hasRobot(*root) ? grant(request, *root) : "there is no robot yet: expected (scene <file>) first";
    } catch (const std::exception& e) {
      // The agent need not know the host's folders.
      why = "it cannot be made, the log of the host says why";
      if (self) refuse(static_cast<int>(request.kind), [&] { return fmt::format("{}: {}", request.type, e.what()); });
    }
    if (!self || !root) return;
    answer(*root, request, std::move(why));
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
    if (parent->child(request.name)) return fmt::format("there is a node {} already", request.name);
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
  if (parent->child(request.name)) return fmt::format("a rule has made a node {} there", request.name);
  ++parts_;
  parent->create(request.type, request.name);
  if (auto* const scenes = kernel().root().find<ISceneServer>()) scenes->markModified();
  return {};
}

}  // namespace spark
