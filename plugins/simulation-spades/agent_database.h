#pragma once
/// \file
/// The agent database: which programs are started as agents.

#include <map>
#include <string>
#include <vector>

namespace spark::spades {

/// A type of agents.
struct AgentType {
  std::string name;
  int in = 3, out = 4;  ///< descriptors from which the agent reads and to which it writes
  std::string timer;    ///< "fixed 3", "jiffies 2000"; "default" or "": that of the server
  std::string folder;   ///< in which it is started, absolute
  std::vector<std::string> command;
  bool tcp = false;           ///< it connects to the port {port} of its command; otherwise it uses the descriptors
  std::string ends = "(syn";  ///< over TCP: a message that contains this ends a thought; "": each one does
};

/// Reads an agent database in XML, as the middleware SPADES had it: `agent_type_external` elements with the texts
/// inputfd, outputfd, timer, working_dir and exec_line, and those made for plain TCP: `protocol`, which is spades or
/// tcp, and `ends`. Folders are relative to that of the file. Throws Error with file:line:column.
std::map<std::string, AgentType> readAgentDatabase(const std::string& file);

}  // namespace spark::spades
