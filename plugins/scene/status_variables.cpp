#include "status_variables.h"

#include <algorithm>

namespace spark {

namespace {
constexpr std::string_view kWords[] = {"playMode", "score", "teams"};
}

void StatusVariables::describe(Description<StatusVariables>& d) {
  d.doc(
      "A group of variables with the status of a game: the host's status line, the columns of a batch and the page "
      "show them. playMode, score and teams have a meaning there, all others are shown as name and value.");
  d.implements<IStatus>();
}

void StatusVariables::report(std::vector<StatusEntry>& out) const {
  for (const std::string_view word : kWords)
    if (const auto found = all().find(word); found != all().end()) out.push_back({found->first, found->second, {}});
  for (const auto& [name, value] : all())
    if (std::find(std::begin(kWords), std::end(kWords), name) == std::end(kWords)) out.push_back({name, value, {}});
}

}  // namespace spark
