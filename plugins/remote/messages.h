#pragma once
/// \file
/// The protocol of remote nodes, version 1: the kinds of messages, with what follows them in the list. Paths are
/// relative to the root of the served subtree; "." is the root itself. `n` numbers requests: the answer has the same
/// number.

#include <cstdint>
#include <string_view>

namespace spark::remote {

/// The version, in `hello`.
inline constexpr std::int64_t kProtocol = 1;

// From the host that mounts.

/// version, token, name of the client, path of the subtree, whether it wants scene nodes (may be missing: no).
inline constexpr std::string_view kHello{"hello"};
/// n, path, property, whether it wants the values that come (may be missing: no).
inline constexpr std::string_view kGet{"get"};
/// n, path. The answer is a list of {property, value}.
inline constexpr std::string_view kRead{"read"};
/// n, path, property, value.
inline constexpr std::string_view kSet{"set"};
/// n, path, method, list of arguments.
inline constexpr std::string_view kCall{"call"};
/// n, number of the subscription, path, channel, whether the host waits for its handlers.
inline constexpr std::string_view kListen{"listen"};
/// number of the event, what the handlers answer (nil: nothing), whether one failed (may be missing: no).
inline constexpr std::string_view kDone{"done"};
/// number of a message kScene that it has handled.
inline constexpr std::string_view kHandled{"handled"};
/// Its config has been run: all handlers are there.
inline constexpr std::string_view kReady{"ready"};

// From the host that is mounted.

/// version of the protocol. The first answer to `hello`; the tree follows.
inline constexpr std::string_view kWelcome{"welcome"};
/// why. The connection ends.
inline constexpr std::string_view kRefused{"refused"};
/// name, doc, base, plugin, version of the plugin, properties {name, type, unit, doc, readOnly, state, scalars},
/// methods {name, doc, parameters, returns, minScalars, maxScalars, surplusIgnored}, names of all bases, the nearest
/// first (empty: its nodes are no scene nodes that another host can have). Before the first node of the class, and
/// again if it has changed.
inline constexpr std::string_view kClass{"class"};
/// id, id of the parent, name, class, what it is as a scene node (nil: it is none): a new last child. What it is: pose
/// in the frame of the transform above (16 numbers, column by column; empty: it is no transform), calls {method,
/// arguments} and properties {name, value} that make it of a new node of its class.
inline constexpr std::string_view kAdd{"add"};
/// id, id of the new parent: it is the last child there now.
inline constexpr std::string_view kMove{"move"};
/// id, new name.
inline constexpr std::string_view kRename{"rename"};
/// id: it is gone with all below it.
inline constexpr std::string_view kRemove{"remove"};
/// number, poses {id, 16 numbers}, {id, calls, properties} of other scene nodes, values {id, property, value}: what has
/// changed. Where the client does not wait for an event or an answer, it has handled the message before.
inline constexpr std::string_view kScene{"scene"};
/// n, value, and for a kGet that wants them whether the values that follow come.
inline constexpr std::string_view kOk{"ok"};
/// n, why it failed.
inline constexpr std::string_view kError{"error"};
/// number of the event (0: no answer is expected), number of the subscription, time, step, cycle, data, whether an
/// answer is wanted.
inline constexpr std::string_view kEvent{"event"};

}  // namespace spark::remote
