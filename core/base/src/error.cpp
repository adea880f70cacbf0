#include "spark/error.h"

#include <algorithm>

namespace spark {

Error::Error(std::string message) : text_(std::move(message)) {}

Error::Error(std::string_view message, const std::exception& cause) : text_(message) {
  text_.append("\n  because: ").append(cause.what());
}

Error::~Error() = default;

namespace {
char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; }

/// Edit distance without regard to case, insertions and deletions 1, substitutions 1.
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
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
  if (wanted.size() > 200) return {};
  std::vector<std::pair<std::size_t, std::string>> near;
  const std::size_t limit = std::max<std::size_t>(2, wanted.size() / 3);
  for (const std::string& c : candidates)
    if (c.size() <= 200)
      if (const std::size_t d = distance(wanted, c); d <= limit) near.emplace_back(d, c);
  std::sort(near.begin(), near.end());
  near.erase(std::unique(near.begin(), near.end()), near.end());
  if (near.empty()) return {};
  std::string out = " Did you mean ";
  const std::size_t n = std::min<std::size_t>(3, near.size());
  for (std::size_t i = 0; i < n; ++i) out += (i == 0 ? "'" : i + 1 == n ? " or '" : ", '") + near[i].second + "'";
  return out + "?";
}

}  // namespace spark
