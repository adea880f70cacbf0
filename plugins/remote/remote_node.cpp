#include "remote_node.h"

#include "messages.h"

namespace spark {

TableValue RemoteNode::values() const { return {link().ask(remote::kRead, *this, {})}; }

}  // namespace spark
