#include "remote_node.h"

#include "messages.h"

namespace spark {

TableValue RemoteNode::values() const { return {linkOf(*this).ask(remote::kRead, *this, {})}; }

}  // namespace spark
