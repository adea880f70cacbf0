#include "remote_mount.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/connect.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <chrono>

#include "api/descriptors.h"
#include "api/files.h"
#include "api/scene.h"
#include "messages.h"
#include "spark/error.h"
#include "spark/in_use.h"

namespace spark {

namespace asio = boost::asio;
using namespace remote;  // NOLINT(google-build-using-namespace)

namespace {
constexpr std::size_t kMostHostBytes = 64 << 20;   // of a message of the other host
constexpr std::size_t kMostEventBytes = 64 << 20;  // of its events that wait here
constexpr std::chrono::milliseconds kMostTime{5};  // for what it sends, at a time: the rest waits
constexpr std::chrono::seconds kQuiet{1};          // without a message, after which it is not waited for
constexpr std::uint64_t kNoRequest = ~std::uint64_t{0};
// Decisions on the tape: the other host was quiet; a wait ends; an event waits for the next cycle.
constexpr const char *kIsQuiet = "remote quiet", *kWaitEnds = "remote wait", *kLater = "remote later";
// Kinds of conversations: what came while a config waited, and why there was no connection.
constexpr const char *kCame = "came", *kFailed = "failed";
constexpr const char* kAsked = "another host is asked about it just now";
constexpr const char* kPasses = "it passes an event of another host just now";
}  // namespace

void RemoteMount::describe(Description<RemoteMount>& d) {
  using M = RemoteMount;
  d.doc("A part of another host's tree: the nodes below it are that host's.");
  d.implements<IRemoteLink>();
  d.implements<IConnectionConsumer>();
  d.property("address", &M::address_).ofProcess().doc("Where the other host listens: host:port or a Unix socket.");
  d.property("of", &M::of_).doc("Path of the node in the other host whose children appear here.");
  d.property("clientName", &M::clientName_).doc("How this host introduces itself; the other one's log has it.");
  d.property("waits", &M::waits_).doc("The other host waits until handlers of its events have run here.");
  d.property("timeout", &M::timeout_)
      .unit("s")
      .range(0.001, 3600)
      .doc("How long an answer may take; then the link counts as lost.");
  d.property("patience", &M::patience_)
      .unit("s")
      .range(0, 3600)
      .doc("How long reading a property may take where its last value is known, or where the other host was quiet.");
  d.property("age", &M::age)
      .unit("s")
      .ofProcess()
      .doc(
          "Simulated time since the last values came: in each cycle of the other host, also where nothing has "
          "changed.");
  d.property("connected", &M::isConnected).ofProcess().doc("Whether there is a link.");
  d.property("lostBecause", &M::lostBecause).ofProcess().doc("Why there is none.");
  d.link(&M::simulation_, At<ISimulation>());
  d.link(&M::server_, At<RemoteServer>());
  d.link(&M::tape_, At<IInputTape>()).doc("Records what the other host sends, or plays it.");
  d.method("connect", &M::connect).parameters({"token"}).doc("Connects, and makes the nodes.");
  d.method("close", &M::close).doc("Disconnects.");
}

void RemoteMount::onUnlink() { wire_.reset(); }

std::unique_ptr<Wire> RemoteMount::open() {
  const Address at = Address::read(address_);
  try {
    if (!at.path.empty()) {
      asio::local::stream_protocol::socket socket(io_);
      socket.connect(asio::local::stream_protocol::endpoint(at.path));
      closeOnExec(socket.native_handle());
      return std::make_unique<Wire>(Wire::Socket(std::move(socket)), address_);
    }
    asio::ip::tcp::socket socket(io_);
    asio::connect(socket, asio::ip::tcp::resolver(io_).resolve(at.host, at.port));
    closeOnExec(socket.native_handle());
    socket.set_option(asio::ip::tcp::no_delay(true));
    return std::make_unique<Wire>(Wire::Socket(std::move(socket)), address_);
  } catch (const boost::system::system_error& e) {
    throw Error(
        fmt::format("{}: cannot reach a host at {}; one that says remote{{}} in its config listens", path(), address_),
        Error(e.code().message()));
  }
}

void RemoteMount::connect(const Secret& token) {
  if (isConnected()) throw Error(fmt::format("{} is connected to {} already", path(), address_));
  kernel().root().require<RemoteServer>();  // it serves this mount
  mirror_.clear();
  events_.clear();
  eventBytes_ = 0;
  listeners_.clear();
  sources_.clear();
  handled_ = 0;
  quiet_ = false;
  ++key_;
  ended_ = false;
  replayed_.clear();
  replays_ = tape_ && tape_->playing();
  saidReady_ = false;
  if (!replays_) try {
      wire_ = open();
      wire_->setLimit(kMostHostBytes);
    } catch (const std::exception& e) {
      keep({kFailed, e.what()});
      throw;
    }
  send({kHello, kProtocol, token.text, clientName_, of_, ancestor<SceneNode>() != nullptr});
  lostBecause_.clear();
  awaitReply(0);
  ask(kGet, *this, {"name"});  // the tree comes before this answer
}

void RemoteMount::close() {
  if (!isConnected()) return;
  lose("it was closed");
  tellLost_ = false;
}

void RemoteMount::lose(std::string why) {
  if (tape_ && wire_ && saidReady_) tape_->put({.kind = Input::Kind::leave, .place = path(), .key = key_, .text = why});
  wire_.reset();
  replays_ = false;
  lostBecause_ = std::move(why);
  tellLost_ = true;
}

/// The path below the root of what is mounted.
std::string RemoteMount::pathOf(const Leaf& node) const {
  if (&node == this) return ".";
  return node.path().substr(path().size() + 1);
}

Value RemoteMount::ask(std::string_view request, const Leaf& node, List arguments) {
  refuseIfFrozen(node);
  List reply = askAbout(request, node, std::move(arguments));
  // A method may remove its own node, as it may in this host, and a set may rename it.
  if (request == kCall || request == kSet) mirror_.catchUp();
  return reply.size() > 2 ? std::move(reply[2]) : Value();
}

/// In a cycle the last value counts, which came before it. Otherwise the other host is asked; where it does not answer
/// soon, the last value counts as well.
Value RemoteMount::read(const Leaf& node, const std::string& property) {
  std::optional<Value> last;
  if (const Value* const known = mirror_.value(node, property)) last = *known;
  if (last && (!isConnected() || (server_ && server_->inCycle()) || isQuiet())) return *last;
  const auto unknown = [&] {
    return Error(fmt::format("{}: the host at {} has been quiet {}, and the value was never read before", node.path(),
                             address_, silence()));
  };
  const bool quiet = isQuiet();
  if (isConnected() && !last && quiet_) throw unknown();
  const List reply = askAbout(kGet, node, {property, true},
                              last || quiet ? std::optional(std::min(patience_, timeout_)) : std::nullopt);
  if (reply.empty()) {
    if (last) return *last;
    throw unknown();
  }
  if (reply.size() > 3 && reply[3].isBool() && reply[3].toBool()) mirror_.keep(node, property, reply[2]);
  return reply.size() > 2 ? reply[2] : Value();
}

/// How long it is that a message came, as words.
std::string RemoteMount::silence() const {
  return fmt::format("for {:.1f} s", std::chrono::duration<double>(Clock::now() - came_).count());
}

/// What is set or called must not wait for a host that hangs, nor happen when it goes on: one that was quiet is asked
/// for a name first.
void RemoteMount::refuseIfFrozen(const Leaf& node) {
  if (!isConnected() || !saidReady_ || !isQuiet()) return;
  if (!quiet_ && !askAbout(kGet, *this, {"name"}, std::min(patience_, timeout_)).empty()) return;
  throw Error(fmt::format("{}: the host at {} has been frozen {}: nothing can be set or called there until it goes on",
                          node.path(), address_, silence()));
}

/// True if the other host owes an answer, or has sent nothing for long.
bool RemoteMount::isQuiet() {
  const bool quiet = isQuietNow();
  return tape_ && saidReady_ ? tape_->decide(kIsQuiet, key_, quiet, false) : quiet;
}

bool RemoteMount::isQuietNow() {
  if (!wire_ || !(quiet_ || Clock::now() - came_ > kQuiet)) return false;
  if (server_ && server_->inCycle()) return true;
  List none;
  try {
    wire_->receive();
    while (receiveOne(none, kNoRequest)) {
    }
  } catch (const std::exception& e) {
    lose(e.what());
  }
  return quiet_ || Clock::now() - came_ > kQuiet;
}

/// The answer to a request. Empty if none has come within `patience` [s]; without it the link is lost then.
List RemoteMount::askAbout(std::string_view request, const Leaf& node, List arguments, std::optional<double> patience) {
  const InUse asked(node, kAsked);
  const std::uint64_t number = ++lastRequest_;
  List message{request, number, pathOf(node)};
  std::move(arguments.begin(), arguments.end(), std::back_inserter(message));
  if (!isConnected()) throw Error(fmt::format("the link to the host at {} is lost: {}", address_, lostBecause_));
  send(message);
  List reply = awaitReply(number, patience);
  if (!reply.empty() && reply[0].toString() == kError)
    throw Error(reply.size() > 2 ? reply[2].plain() : "the other host gives no reason");
  return reply;
}

/// Waits for the answer to a request, or to `hello` (0). Changes of the tree are followed meanwhile; events wait.
List RemoteMount::awaitReply(std::uint64_t number, std::optional<double> patience) {
  if (replays_) return awaitRecorded(number, patience.has_value());
  const struct Wait {
    RemoteMount& mount;
    ~Wait() { mount.endWait(); }
  } wait{*this};
  const auto end = Clock::now() + std::chrono::duration<double>(patience.value_or(timeout_));
  List reply;
  try {
    for (;;) {
      if (!wire_->flush()) throw Error("the connection is broken");
      const bool alive = wire_->receive();
      while (Clock::now() < end && receiveOne(reply, number))
        if (!reply.empty()) return reply;
      if (!alive) throw Error("the connection ended");
      const std::chrono::duration<double> left = end - Clock::now();
      if (left.count() > 0 && wire_->waitFor(left.count())) continue;
      quiet_ = true;
      if (patience) return {};
      throw Error(fmt::format("it did not answer for {} s", timeout_));
    }
  } catch (const std::exception& e) {
    lose(e.what());
    throw Error(fmt::format("the link to the host at {} is lost: {}", address_, lostBecause_));
  }
}

/// The same while a recording is played.
List RemoteMount::awaitRecorded(std::uint64_t number, bool patient) {
  List reply;
  const auto handle = [&] {
    while (reply.empty() && receiveOne(reply, number)) {
    }
    return !reply.empty();
  };
  if (!saidReady_) {
    auto* const files = kernel().root().find<IFileServer>();
    if (!files)
      throw Error(
          fmt::format("{}: a recording has what the other host sent as files: expected files() in the config", path()));
    nextConversation();
    for (const Value& message : decode(files->read(conversationName())))
      if (message.isString()) replayed_.push_back(message.toString());
    if (replayed_.front() == kFailed) {
      replays_ = false;
      throw Error(replayed_.back());
    }
    replayed_.pop_front();  // the kind
    if (handle()) return reply;
  } else {
    const bool here = handle();
    if (!here) tape_->play();
    const bool came = here || handle();
    tape_->decide(kWaitEnds, key_, true, false);
    if (came) return reply;
  }
  quiet_ = true;
  if (patient && !ended_) return {};
  lose(ended_ ? "it left in the recorded run" : "it did not answer in the recorded run");
  throw Error(fmt::format("the link to the host at {} is lost: {}", address_, lostBecause_));
}

/// A mount that failed may be made again at the same place: no two waits have one number.
void RemoteMount::nextConversation() { conversations_ = kernel().root().require<RemoteServer>().nextConversation(); }

/// The name as a file of what came while the config waited for an answer.
std::string RemoteMount::conversationName() const { return fmt::format("remote{}.{}", path(), conversations_); }

/// Puts a message on the tape. While the config runs there is none yet: what comes then is kept as texts of the run,
/// one for each time that it waited.
void RemoteMount::note(std::string_view message) {
  if (!tape_ || !wire_) return;
  if (saidReady_)
    tape_->put({.kind = Input::Kind::message, .place = path(), .key = key_, .text = message});
  else
    conversation_.emplace_back(message);
}

void RemoteMount::endWait() {
  if (!tape_ || replays_) return;
  if (saidReady_) {
    tape_->decide(kWaitEnds, key_, true, false);
    return;
  }
  conversation_.insert(conversation_.begin(), kCame);
  keep(std::exchange(conversation_, {}));
}

/// Keeps what came of a wait while the config runs, for recordings.
void RemoteMount::keep(const List& conversation) {
  if (!tape_) return;
  nextConversation();
  kernel().sources().add("file", conversationName(), encode(conversation));
}

/// The next message that has arrived; valid until the next one is taken.
std::optional<std::string_view> RemoteMount::take() {
  if (wire_) {
    const auto bytes = wire_->take();
    if (bytes) note(*bytes);
    return bytes;
  }
  if (replayed_.empty()) return std::nullopt;
  taken_ = std::move(replayed_.front());
  replayed_.pop_front();
  return taken_;
}

void RemoteMount::received(IConnection& connection, std::string_view message) {
  if (connection.id() == key_) replayed_.emplace_back(message);
}

void RemoteMount::disconnected(IConnection& connection) {
  if (connection.id() == key_) ended_ = true;  // not of an earlier link
}

/// Handles one message that has arrived; false if there is none. The answer to request `number` goes to `reply`.
bool RemoteMount::receiveOne(List& reply, std::uint64_t number) {
  const auto bytes = take();
  if (!bytes) return false;
  List message = decode(*bytes);
  const std::string& kind = message[0].toString();
  quiet_ = false;
  came_ = Clock::now();
  cameAt_ = simulation_ ? simulation_->time() : 0;
  if (mirror_.follow(message, bytes->size())) return acknowledge(), true;
  if (kind == kRefused) throw Error(message.size() > 1 ? message[1].plain() : "it refuses");
  if (kind == kEvent) {
    if (events_.empty()) eventBytes_ = 0;
    eventBytes_ += bytes->size();
    if (eventBytes_ > kMostEventBytes) throw Error("it sends events faster than this host can pass them");
    events_.push_back(std::move(message));
  } else if (kind == kWelcome) {
    if (number == 0) reply = std::move(message);
  } else if ((kind == kOk || kind == kError) && message.size() > 1 && message[1].isInteger()) {
    if (static_cast<std::uint64_t>(message[1].toInteger()) == number) reply = std::move(message);
  } else {
    throw Error(fmt::format("it sent a '{}' that is not understood", kind));
  }
  return true;
}

/// Says which values have come: others may follow.
void RemoteMount::acknowledge() {
  if (!wire_ || mirror_.applied() == handled_) return;
  handled_ = mirror_.applied();
  wire_->send({kHandled, handled_});
}

double RemoteMount::age() const { return simulation_ ? std::max(0.0, simulation_->time() - cameAt_) : 0; }

IEventSource* RemoteMount::eventsOf(Leaf& node) {
  std::unique_ptr<Source>& source = sources_[node.id()];
  if (!source) source = std::make_unique<Source>(*this, node);
  return source.get();
}

void RemoteMount::listen(Leaf& node, const std::string& channel) {
  // One subscription for all handlers of a node.
  for (const auto& [number, listener] : listeners_)
    if (listener.node.get() == &node && listener.channel->name() == channel) return;
  const std::uint64_t number = ++lastListener_;
  refuseIfFrozen(node);
  const InUse asked(node, kAsked);
  if (!isConnected()) throw Error(fmt::format("the link to the host at {} is lost: {}", address_, lostBecause_));
  const std::uint64_t request = ++lastRequest_;
  send({kListen, request, number, pathOf(node), channel, waits_});
  const List reply = awaitReply(request);
  if (reply[0].toString() == kError)
    throw Error(reply.size() > 2 ? reply[2].plain() : "the other host gives no reason");
  listeners_.emplace(number, Listener{Ref<Leaf>(&node), &kernel().events().channel(channel)});
}

void RemoteMount::poll() {
  if (passing_) return;  // a handler of an event runs cycles
  passing_ = true;
  const InUse busy(*this, kPasses);
  if (isConnected()) {
    if (!saidReady_) {  // the run loop runs: the config is done
      send({kReady});
      if (tape_ && wire_) tape_->put({.kind = Input::Kind::connect, .place = path(), .key = key_, .text = address_});
    }
    saidReady_ = true;
    try {
      if (wire_ && !wire_->flush()) throw Error("the connection is broken");
      mirror_.catchUp();
      acknowledge();
      const bool alive = wire_ ? wire_->receive() : !ended_;
      if (handleWhatCame() && !alive) throw Error("the connection ended");
    } catch (const std::exception& e) {
      lose(e.what());
    }
  }
  if (wire_) wire_->flush();
  passing_ = false;
  if (!tellLost_) return;
  tellLost_ = false;
  kernel().log().warning("{}: the link to the host at {} is lost: {}", path(), address_, lostBecause_);
  Channel& lost = kernel().events().channel(kRemoteLost);
  const Value data = List{address_, lostBecause_};
  lost.emitAt(*this, {.name = lost.name(), .data = &data});
}

/// Follows changes of the tree and passes events, in the order in which they came, but not for long: a host that sends
/// without end must not keep this one from its cycles. True if nothing is left.
bool RemoteMount::handleWhatCame() {
  List none;
  const auto end = Clock::now() + kMostTime;
  while (isConnected()) {
    const bool late = Clock::now() >= end;
    if (!events_.empty()) {
      if (tape_ ? tape_->decide(kLater, key_, late, false) : late) return false;
      const List event = std::move(events_.front());
      events_.pop_front();
      pass(event);
    } else if (late && !replays_) {
      return false;
    } else if (!receiveOne(none, kNoRequest)) {
      return true;
    }
  }
  return false;
}

/// Runs the handlers of an event, and says that they are done.
void RemoteMount::pass(const List& event) {
  if (event.size() < 8 || !event[1].isInteger() || !event[2].isInteger() || !event[3].isNumber() ||
      !event[4].isNumber() || !event[5].isInteger() || !event[7].isBool())
    return lose("it sent an event that is not understood");
  const std::int64_t number = event[1].toInteger();
  Value answers(List{});
  const std::int64_t faults = kernel().faults();
  const auto at = listeners_.find(static_cast<std::uint64_t>(event[2].toInteger()));
  if (at != listeners_.end() && at->second.node)
    at->second.channel->emitAt(*at->second.node, {.name = at->second.channel->name(),
                                                  .time = event[3].toNumber(),
                                                  .step = event[4].toNumber(),
                                                  .cycle = event[5].toInteger(),
                                                  .data = event[6].isNil() ? nullptr : &event[6],
                                                  .answer = event[7].toBool() ? &answers : nullptr});
  if (number != 0) send({kDone, number, answers, kernel().faults() != faults});
}

}  // namespace spark
