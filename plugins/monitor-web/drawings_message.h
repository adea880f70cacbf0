#pragma once
/// \file
/// The message with agents' drawings.

#include <span>
#include <string>

#include "api/drawing.h"

namespace spark::web {

/// `{"type":"drawings","sets":{"name":[...],"gone":null}}` with the sets whose version is greater than `since`; an
/// empty set is null.
std::string drawingsMessage(std::span<const IDrawings::Set> sets, std::uint64_t since);

}  // namespace spark::web
