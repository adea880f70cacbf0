#pragma once
/// \file
/// Text of others, as a terminal may print it.

#include <string>
#include <string_view>

#include "spark/abi/spark/printable.h"

namespace spark {

/// `text` with \xNN in place of bytes by which a terminal is told to do something else than print: control characters
/// but tab and end of line, and those of ISO 6429 in UTF-8 (U+0080 to U+009F).
std::string printable(std::string_view text);

}  // namespace spark
