#include "gamecontrol/judged_import.h"

#include <vector>

#include "spark/error.h"

namespace spark::gamecontrol {

namespace {

using Kind = PartRequest::Kind;

/// Asks the judges about what the import has made, which has ids above `mark`.
template <class Part>
std::string judgeParts(IGameControl& control, const Ref<AgentAspect>& agent, const Ref<Node>& parent, Kind kind,
                       std::uint64_t mark, const std::string& file) {
  std::vector<Part*> parts;
  parent->collect(parts);
  const std::vector<Ref<Part>> all(parts.begin(), parts.end());
  for (const Ref<Part>& part : all) {
    if (!agent || !parent) return "the place of the new nodes was removed";
    if (!part || part->id() <= mark) continue;
    std::string why =
        control.judgeRequest(*agent, {kind, part->classObject()->name(), part->messageName(), *part->parent(), file});
    if (!why.empty()) return why;
  }
  return {};
}

/// Removes what the import has made, also where a judge has changed the children meanwhile.
void removeSince(Node& parent, std::uint64_t mark) {
  for (std::size_t i = parent.children().size(); i-- > 0;)
    if (Leaf& child = *parent.children()[i]; child.id() > mark) parent.remove(child);
}

}  // namespace

std::string importJudged(AgentAspect& agent, Node& parent, const std::string& file, const List& arguments) {
  Kernel& kernel = parent.kernel();
  auto& scenes = kernel.root().require<ISceneServer>();
  auto* const control = kernel.root().find<IGameControl>(IGameControl::kPath);
  const Ref<AgentAspect> asking(&agent);
  const Ref<Node> place(&parent);
  if (control)
    if (std::string why = control->judgeRequest(agent, {Kind::scene, file, "", parent}); !why.empty()) return why;
  if (!asking || !place) return "the place of the new nodes was removed";

  const std::uint64_t mark = kernel.lastId();
  std::string why;
  try {
    scenes.importScene(file, parent, arguments);
    if (control && place) why = judgeParts<Perceptor>(*control, asking, place, Kind::perceptor, mark, file);
    if (control && place && why.empty())
      why = judgeParts<Effector>(*control, asking, place, Kind::effector, mark, file);
  } catch (...) {
    if (place) removeSince(parent, mark);
    throw;
  }
  if (!why.empty() && place) removeSince(parent, mark);
  scenes.markModified();
  return why;
}

}  // namespace spark::gamecontrol
