#include "visible_nodes.h"

namespace spark {

bool VisibleNodes::fresh(Kernel& kernel) const {
  return !tree_.isStale(kernel.root()) && (!server_ || server_->modifiedCount() == modified_);
}

bool VisibleNodes::refresh(Kernel& kernel) {
  if (fresh(kernel)) return false;
  auto* server = kernel.root().find<ISceneServer>();
  std::swap(ids_, lastIds_);
  std::swap(depths_, lastDepths_);
  entries_.clear();
  ids_.clear();
  depths_.clear();
  if (Node* scene = server ? server->activeScene() : nullptr) collect(*scene, 0);
  const std::uint64_t modified = server ? server->modifiedCount() : 0;
  const bool changed = modified != modified_ || ids_ != lastIds_ || depths_ != lastDepths_;
  server_ = server;
  modified_ = modified;
  tree_.changed(kernel.root());
  return changed;
}

void VisibleNodes::collect(const Node& parent, int depth) {
  for (const auto& child : parent.children()) {
    Entry entry{child->as<Transform>(), child->as<IVisual>(), depth};
    const bool visible = entry.transform || entry.visual;
    if (visible) {
      entries_.push_back(entry);
      ids_.push_back(child->id());
      depths_.push_back(depth);
    }
    if (child->asNode()) collect(*child->asNode(), visible ? depth + 1 : depth);
  }
}

void VisibleNodes::copyTo(std::vector<FrameNode>& out) const {
  out.resize(entries_.size());
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const Entry& entry = entries_[i];
    FrameNode& node = out[i];
    node.depth = entry.depth;
    node.visual = entry.transform ? nullptr : entry.visual;
    node.transform = entry.transform;
    if (entry.transform) {
      node.kind = FrameNode::Kind::transform;
      node.local = entry.transform->local();
      continue;
    }
    switch (entry.visual->kind()) {
      case IVisual::Kind::light:
        node.kind = FrameNode::Kind::light;
        break;
      case IVisual::Kind::mesh:
        node.kind = FrameNode::Kind::mesh;
        break;
      case IVisual::Kind::singleMaterial:
        node.kind = FrameNode::Kind::singleMaterial;
        break;
    }
    node.visible = entry.visual->visible();
    node.transparent = entry.visual->transparent();
  }
}

}  // namespace spark
