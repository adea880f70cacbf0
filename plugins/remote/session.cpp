#include "session.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "api/credentials.h"
#include "api/removal.h"
#include "messages.h"
#include "spark/access.h"
#include "spark/error.h"
#include "spark/in_use.h"

// Where a request is answered decides what it does to a match:
//
//   between two cycles (poll)          as requests of sparkctl
//   while an event waits for its       in the middle of the phase, at the place of a handler of this host: a rule that
//   handlers on the remote host        runs there does what it would do here, and the state is the same
//
// What changes something is put on the tape of inputs in that order. A decision on the tape marks the end of each wait,
// so that a recording that is played passes the same requests at the same places.

namespace spark::remote {

namespace {
constexpr std::size_t kMostClientBytes = 4 << 20;  // of a message of a client that has said hello
constexpr std::size_t kMostUnsent = 256 << 20;     // bytes that a client has not read, after which it is given up
constexpr int kMostMessages = 1000;                // handled at a time
constexpr double kHelloTime = 5;                   // within which a client has to say hello [s]
constexpr const char* kAnswers = "it answers a remote host just now";
constexpr const char* kWait = "remote";  // the decision on the tape that ends a wait

/// True for a request of a property that the client also wants to get when it changes.
bool follows(const List& message) {
  return message[0].toString() == kGet && message.size() > 4 && at(message, 4, Value::Type::boolean).toBool();
}

/// True for messages after which the simulation may go another way.
bool isInput(std::string_view kind) { return kind == kSet || kind == kCall || kind == kListen || kind == kDone; }
}  // namespace

Session::Session(const Host& host, std::uint64_t key, std::unique_ptr<Wire> wire, std::string peer)
    : host_(host), key_(key), wire_(std::move(wire)), peer_(std::move(peer)) {
  if (wire_) note(Input::Kind::connect, peer_);
}

Session::~Session() {
  for (const auto& [number, listener] : listeners_) listener.channel->remove(listener.subscription);
}

void Session::note(Input::Kind kind, std::string_view text) {
  if (host_.tape) host_.tape->put({.kind = kind, .place = host_.server.path(), .key = key_, .text = text});
}

void Session::send(const List& message) {
  if (wire_ && !isLost()) wire_->send(message);
}

/// Sends what has changed below the root: its shape, its scene nodes, and what the host reads. `now`: something follows
/// that depends on it.
void Session::feed(bool now) {
  if (!wire_ || !root_ || isLost()) return;
  tree_.update(*root_, scene_, *wire_);
  scene_.update(*root_, now, host_.simulation.get(), *wire_);
}

void Session::lose(std::string why) {
  if (isLost()) return;
  why_ = std::move(why);
  if (wire_) {
    note(Input::Kind::leave, why_);
    wire_->flush();
  }
}

void Session::poll(std::string_view token) {
  if (!wire_ || isLost()) return;
  receive(token);
  if (isLost()) return;
  if (open_) feed(false);
  if (open_ && !root_) return lose("the part of the tree that it had mounted is gone");
  if (!wire_->flush()) return lose("the connection is broken");
  if (wire_->unsent() > kMostUnsent) return lose("it does not read what it gets");
  if (!open_ && Clock::now() - began_ > std::chrono::duration<double>(kHelloTime)) lose("it did not say what it wants");
}

void Session::receive(std::string_view token) {
  const bool connected = wire_->receive();
  try {
    for (int n = 0; n < kMostMessages && !isLost(); ++n) {
      const auto bytes = wire_->take();
      if (!bytes) {
        if (!connected) lose("the connection ended");
        return;
      }
      handle(*bytes, token);
    }
  } catch (const std::exception& e) {
    lose(e.what());
  }
}

void Session::replay(std::string_view message) {
  try {
    handle(message, {});
  } catch (const std::exception& e) {
    lose(e.what());
  }
}

void Session::handle(std::string_view bytes, std::string_view token) {
  const List message = decode(bytes);
  const std::string& kind = message[0].toString();
  if (!open_) return hello(message, token);
  if (wire_ && isInput(kind)) note(Input::Kind::message, bytes);
  if (kind == kReady) {
    ready_ = true;
    return;
  }
  if (kind == kHandled) return scene_.handled(numberAt(message, 1));
  if (kind == kDone) {
    done_ = numberAt(message, 1);
    reply_ = message.size() > 2 ? message[2] : Value();
    replyFails_ = message.size() > 3 && at(message, 3, Value::Type::boolean).toBool();
    return;
  }
  answer(message);
}

void Session::hello(const List& message, std::string_view token) {
  if (message[0].toString() != kHello) throw Error("it did not say hello; only hosts of Spark can mount a tree");
  const std::uint64_t version = numberAt(message, 1);
  const std::string &given = textAt(message, 2), &name = textAt(message, 3), &path = textAt(message, 4);
  std::string why;
  if (version != kProtocol)
    why = fmt::format("it speaks version {} of the protocol, and this host version {}", version, kProtocol);
  else if (wire_ && !token.empty() && !isToken(token, given))
    why = "its token is wrong";
  Leaf* const root = why.empty() ? host_.server.kernel().root().find(path.empty() ? "/" : path) : nullptr;
  if (why.empty() && (!root || !root->asNode())) why = fmt::format("there is no node {}", path);
  if (!why.empty()) {
    send({kRefused, why});
    return lose(why);
  }
  // Without the token: recordings are passed on.
  if (wire_) note(Input::Kind::message, encode({kHello, message[1], "", name, path}));
  open_ = true;
  name_ = name.substr(0, 64);
  root_ = Ref<Node>(root->asNode());
  send({kWelcome, kProtocol});
  if (wire_) {
    wire_->setLimit(kMostClientBytes);
    if (message.size() > 5 && at(message, 5, Value::Type::boolean).toBool()) scene_.wantScene();
    feed(true);
  }
}

void Session::answer(const List& message) {
  const std::uint64_t number = numberAt(message, 1);
  const InUse busy(host_.server, kAnswers);
  const bool outer = handling_;
  handling_ = true;
  List reply;
  try {
    reply = {kOk, number, perform(message)};
    if (follows(message))
      reply.emplace_back(scene_.follow(leafAt(at(message, 2, Value::Type::string)), textAt(message, 3), reply[2]));
  } catch (const std::exception& e) {
    reply = {kError, number, e.what()};
  }
  handling_ = outer;
  // The answer comes behind the changes that it made, so that it can be followed by a look at them.
  feed(true);
  send(reply);
}

Leaf& Session::leafAt(const Value& path) const {
  if (!root_) throw Error("the part of the tree that was mounted is gone");
  return root_->require<Leaf>(path.toString());
}

Value Session::perform(const List& message) {
  const std::string& kind = message[0].toString();
  if (kind == kListen) {
    listen(message);
    return {};
  }
  Leaf& leaf = leafAt(at(message, 2, Value::Type::string));
  if (kind == kGet) return getProperty(leaf, textAt(message, 3));
  if (kind == kRead) {
    List all;
    for (const Property* p : leaf.classObject()->properties()) all.emplace_back(List{p->name, p->get(leaf)});
    return all;
  }
  scene_.touch(leaf);
  if (kind == kSet) {
    if (message.size() < 5) throw Error("expected a value");
    setProperty(leaf, textAt(message, 3), message[4]);
    return {};
  }
  if (kind == kCall) {
    refuseRemovingServers(leaf, textAt(message, 3), host_.server);
    return callMethod(leaf, textAt(message, 3), at(message, 4, Value::Type::list).toList());
  }
  throw Error(fmt::format("there is no request '{}'", kind));
}

void Session::listen(const List& message) {
  const std::uint64_t number = numberAt(message, 2);
  Leaf& leaf = leafAt(at(message, 3, Value::Type::string));
  const bool waits = at(message, 5, Value::Type::boolean).toBool();
  if (listeners_.contains(number)) throw Error(fmt::format("subscription {} exists", number));
  Channel& channel = host_.server.kernel().events().channel(textAt(message, 4));
  const std::uint64_t subscription =
      channel.add(leaf, [this, number, waits](Leaf&, const Event& event) { pass(number, waits, event); });
  listeners_.emplace(number, Listener{&channel, subscription});
}

void Session::pass(std::uint64_t number, bool waits, const Event& event) {
  if (isLost() || !open_) return;
  // In the middle of its own request it could not answer, and one that still owes an answer is not waited for.
  const std::uint64_t asked = waits && !handling_ && asked_ == done_ ? ++asked_ : 0;
  if (wire_) {
    feed(asked != 0);
    send({kEvent, asked, number, event.time, event.step, event.cycle, event.data ? *event.data : Value(),
          event.answer != nullptr});
    if (!wire_->flush()) lose("the connection is broken");
  }
  reply_ = {};
  replyFails_ = false;
  if (asked != 0) await(asked);
  if (!waits || !event.answer) return;
  // An answer that is late, or that a handler there failed to give, is a fault as that of a handler here.
  const bool isAnswered = asked != 0 && done_ == asked && reply_.isList();
  if (!isAnswered || replyFails_)
    fail(event, isAnswered ? "its handlers failed there" : "it came too late or not at all");
  if (!isAnswered) return;
  for (Value& one : reply_.toList())  // of one handler each
    if (event.answer->isList())
      event.answer->toList().push_back(std::move(one));
    else
      *event.answer = std::move(one);
}

/// Each event may fail; the log has the first one.
void Session::fail(const Event& event, std::string_view why) {
  Kernel& kernel = host_.server.kernel();
  kernel.countFault();
  if (!std::exchange(saidFailure_, true))
    kernel.log().warning("{}: an answer to '{}' from remote host {} counts as a fault: {}", host_.server.path(),
                         event.name, name_, why);
}

/// Answers requests until the remote handlers are done with an event.
void Session::await(std::uint64_t event) {
  IInputTape* const tape = host_.tape.get();
  if (!wire_) {
    if (tape) tape->play(), tape->decide(kWait, key_, true, false);
    return;
  }
  const auto end = Clock::now() + std::chrono::duration<double>(host_.patience.seconds);
  while (done_ < event && !isLost()) {
    const std::chrono::duration<double> left = end - Clock::now();
    if (left.count() <= 0 || !wire_->waitFor(left.count())) {
      if (host_.patience.givesUp) lose(fmt::format("its handlers took longer than {} s", host_.patience.seconds));
      ++lateEvents_;
      break;
    }
    receive({});
    if (!isLost() && !wire_->flush()) lose("the connection is broken");
  }
  if (tape) tape->decide(kWait, key_, true, false);
}

}  // namespace spark::remote
