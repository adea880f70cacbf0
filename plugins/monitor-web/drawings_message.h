#pragma once
/// \file
/// Agents' drawings as viewers get them.

#include <span>
#include <string>

#include "api/drawing.h"

namespace spark::web {

/// `{"type":"drawings","sets":{"name":[...],"gone":null}}` of the sets that changed after version `since`.
std::string drawingsMessage(std::span<const IDrawings::Set> sets, std::uint64_t since);

}  // namespace spark::web
