#include "spark/error.h"

#include <fmt/format.h>

#include <algorithm>

namespace spark {

Error::Error(std::string message) : text_(std::move(message)) {}

Error::Error(std::string_view message, const std::exception& cause) : text_(message) {
  text_.append("\n  because: ").append(cause.what());
}

Error::~Error() = default;

namespace {
char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; }

/// The Levenshtein distance of two names, ignoring case: the minimum number of insertions, deletions and substitutions
/// that turn one into the other. Wagner and Fischer 1974, with one row of the table in memory.
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);  // row[j]: distance of a's first i letters from b's first j
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t above = row[j];
      row[j] = std::min({above + 1, row[j - 1] + 1, diagonal + (lower(a[i - 1]) == lower(b[j - 1]) ? 0 : 1)});
      diagonal = above;
    }
  }
  return row[b.size()];
}
}  // namespace

std::string didYouMean(std::string_view wanted, const std::vector<std::string>& candidates) {
  constexpr std::size_t kLongestName = 200;  // the distance takes quadratic time
  constexpr std::size_t kSuggestions = 3;
  if (wanted.size() > kLongestName) return {};
  // A third of the letters may differ, two in short names.
  const std::size_t limit = std::max<std::size_t>(2, wanted.size() / 3);
  std::vector<std::pair<std::size_t, std::string>> near;
  for (const std::string& c : candidates)
    if (c.size() <= kLongestName)
      if (const std::size_t d = distance(wanted, c); d <= limit) near.emplace_back(d, c);
  std::sort(near.begin(), near.end());
  near.erase(std::unique(near.begin(), near.end()), near.end());
  if (near.empty()) return {};
  std::string out = " Did you mean ";
  const std::size_t n = std::min(kSuggestions, near.size());
  for (std::size_t i = 0; i < n; ++i)
    out += fmt::format("{}'{}'", i == 0 ? "" : i + 1 == n ? " or " : ", ", near[i].second);
  return out + "?";
}

}  // namespace spark
