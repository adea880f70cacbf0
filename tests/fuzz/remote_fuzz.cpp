// Both ends of the protocol of remote nodes, run on arbitrary messages: the bytes as they are, and messages that are
// made of kinds, paths and numbers that make sense. For any input a session answers or is lost, and a mirror follows or
// throws an Error.

#include <cstdint>
#include <string>
#include <string_view>

#include "../../plugins/remote/messages.h"
#include "../../plugins/remote/mirror.h"
#include "../../plugins/remote/remote_node.h"
#include "../../plugins/remote/session.h"

using namespace spark;

namespace {
/// Takes values from the input until it ends, then zeros.
struct Source {
  const std::uint8_t* data;
  std::size_t left;

  std::uint8_t byte() { return left ? (--left, *data++) : 0; }
  template <std::size_t N>
  std::string_view oneOf(const std::string_view (&words)[N]) {
    return words[byte() % N];
  }
  Value value(int depth = 0) {
    using namespace remote;
    static constexpr std::string_view kWords[] = {".",       "..", "usr", "usr/a", "name", "unlinkLeaf",     "setName",
                                                  "act",     "",   "/",   "Node",  "a",    "unlinkChildren", "usr/a[2]",
                                                  "usr/a/b", "x"};
    switch (byte() % 7) {
      case 0:
        return {};
      case 1:
        return byte() % 2 == 0;
      case 2:
        return static_cast<std::int64_t>(byte()) - 8;
      case 3:
        return byte() / 16.0;
      case 4: {
        List list;
        for (int n = depth < 4 ? byte() % 8 : 0; n > 0; --n) list.push_back(value(depth + 1));
        return list;
      }
      default:
        return oneOf(kWords);
    }
  }
  List message() {
    using namespace remote;
    static constexpr std::string_view kKinds[] = {kHello, kGet,    kRead,    kSet,     kCall,  kListen,
                                                  kDone,  kReady,  kWelcome, kRefused, kClass, kAdd,
                                                  kMove,  kRename, kRemove,  kOk,      kError, kEvent};
    List out{oneOf(kKinds)};
    for (int n = byte() % 9; n > 0; --n) out.push_back(value());
    return out;
  }
};
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Kernel kernel;
  kernel.log().setSink([](Level, std::string_view) {});
  kernel.registerClass<RemoteNode>();
  Node& server = kernel.create<Node>("Node", "/sys/server/remote");
  Node& mount = kernel.create<Node>("Node", "/usr/mount");
  kernel.create("Node", "/usr/a/b");
  const Link<IInputTape> noTape;
  const remote::Host host{server, noTape, {}};
  remote::Mirror mirror(mount);
  remote::Session session(host, 1, nullptr, "fuzz");
  try {
    mirror.follow(remote::decode({reinterpret_cast<const char*>(data), size}), size);
  } catch (const Error&) {
    // Most inputs are no message.
  }
  session.replay(remote::encode({remote::kHello, remote::kProtocol, "", "fuzz", "/"}));
  Source source{data, size};
  for (int n = 0; n < 100 && source.left > 0 && !session.isLost(); ++n) {
    const List message = source.message();
    const std::string bytes = remote::encode(message);
    session.replay(bytes);
    try {
      mirror.follow(message, bytes.size());
    } catch (const Error&) {
      // The other host is given up.
    }
    kernel.events().channel("act").emit({.name = "act", .cycle = n});
  }
  return 0;
}
