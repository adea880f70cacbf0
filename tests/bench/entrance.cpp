#include "entrance.h"

#include "spark/kernel.h"

namespace spark::bench {

void LocalEntrance::open(Kernel& kernel) {
  if (Node* net = kernel.root().find<Node>("/sys/server/net")) net->parent()->remove(*net);
  kernel.registerClass<LocalPort>();
  port_ = &kernel.create<LocalPort>("LocalPort", "/sys/server/bench");
}

}  // namespace spark::bench
