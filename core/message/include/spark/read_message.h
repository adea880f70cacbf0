#pragma once
/// \file
/// Messages of agents and monitors. Unlike a scene file, a message is read around its mistakes: an agent in lockstep
/// must not wait for a `(syn)` that follows a bad byte.

#include "spark/abi/spark/read_message.h"
#include "spark/predicates.h"

namespace spark {

/// Adds the expressions of a message to `out` as readSexp() does, but a mistake costs only the top-level expression
/// that contains it: `(say a\x01)(syn)` is `(syn)`. The rest of the message is lost after the limit of tokens, in a
/// list without its ')', and after 100 mistakes. Returns the first mistake and the bytes read. Never throws for bad
/// bytes.
ReadResult readMessage(std::string_view bytes, Predicates& out, const ReadLimits& limits = {});

}  // namespace spark
