#include "think_time.h"

#include <charconv>

#include "spark/error.h"

namespace spark::spades {

namespace {
constexpr Time kMostInTimer = 1'000'000'000;
}

std::optional<ThinkModel> readTimer(std::string_view timer) {
  const std::size_t blank = std::min(timer.find(' '), timer.size());
  const std::string_view name = timer.substr(0, blank), text = timer.substr(std::min(blank + 1, timer.size()));
  if (name.empty() || name == "default") return std::nullopt;
  Time n = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), n);
  const bool isNumber = error == std::errc() && end == text.data() + text.size() && n >= 0 && n <= kMostInTimer;
  if (isNumber && name == "fixed") return ThinkModel{n, 0};
  if (isNumber && n > 0 && name == "instructions") return ThinkModel{std::nullopt, static_cast<double>(n), true};
  if (isNumber && n > 0 && (name == "jiffies" || name.starts_with("perfctr")))
    return ThinkModel{std::nullopt, 1e-6 * static_cast<double>(n)};
  throw Error(
      fmt::format("expected a timer such as 'fixed 3' (steps), 'jiffies 10000' (microseconds of CPU time per step), "
                  "'instructions 10000000' (per step) or 'default', found '{}'",
                  timer));
}

}  // namespace spark::spades
