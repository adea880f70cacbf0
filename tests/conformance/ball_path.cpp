#include "ball_path.h"

#include <cmath>
#include <cstdlib>
#include <sstream>

namespace spark::test {
namespace {

/// The adjacent lists at the top level of `text`.
std::vector<std::string> lists(const std::string& text) {
  std::vector<std::string> out;
  int depth = 0;
  std::size_t start = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '(' && depth++ == 0) start = i;
    if (text[i] == ')' && --depth == 0) out.push_back(text.substr(start, i - start + 1));
  }
  return out;
}

/// True while the ball is at the center of the field, its initial position.
bool atCenter(const std::string& position) { return std::abs(std::strtod(position.c_str(), nullptr)) < 0.01; }

}  // namespace

void BallPath::feed(const std::string& message) {
  const auto parts = lists(message);
  if (parts.size() < 3) return;
  const auto nodes = lists(parts[2].substr(1, parts[2].size() - 2));
  if (parts[1].starts_with("(RSG")) {
    node_.reset();
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if (nodes[i].find("soccerball") != std::string::npos) node_ = i;
  }
  if (!node_ || *node_ >= nodes.size()) return;
  const std::size_t at = nodes[*node_].find("(SLT ");
  if (at == std::string::npos) return;
  std::istringstream in(nodes[*node_].substr(at + 5));
  std::string number, position;
  for (int i = 0; i < 15 && in >> number; ++i)
    if (i >= 12) position += (position.empty() ? "" : " ") + number;
  if (positions_.empty() || positions_.back() != position) positions_.push_back(position);
}

bool samePath(const std::vector<std::string>& recorded, const std::vector<std::string>& ours) {
  std::size_t next = 0;
  while (next < ours.size() && atCenter(ours[next])) ++next;
  bool moved = false;
  for (const std::string& position : recorded) {
    if (!moved && atCenter(position)) continue;
    moved = true;
    while (next < ours.size() && ours[next] != position) ++next;
    if (next++ == ours.size()) return false;
  }
  return moved;
}

}  // namespace spark::test
