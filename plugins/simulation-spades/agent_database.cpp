#include "agent_database.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <pugixml.hpp>
#include <sstream>

#include "spark/error.h"

namespace spark::spades {

namespace fs = std::filesystem;

namespace {
constexpr std::uintmax_t kMostBytes = 1 << 20;

/// A file that is read: it knows where its errors are.
struct Database {
  std::string file, text;

  [[noreturn]] void fail(std::ptrdiff_t offset, const std::string& what) const {
    const std::string_view before =
        std::string_view(text).substr(0, static_cast<std::size_t>(std::max<std::ptrdiff_t>(offset, 0)));
    const auto line = std::count(before.begin(), before.end(), '\n') + 1;
    const std::size_t start = before.rfind('\n');
    throw Error(
        fmt::format("{}:{}:{}: {}", file, line, before.size() - (start == before.npos ? 0 : start + 1) + 1, what));
  }
  int descriptor(const pugi::xml_node& type, const char* name, int usual) const {
    const pugi::xml_node node = type.child(name);
    if (!node) return usual;
    const std::string_view word = node.text().get();
    int value = -1;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || value < 3 || value > 255)
      fail(node.offset_debug(), fmt::format("expected a descriptor from 3 to 255 in {}, found '{}'", name, word));
    return value;
  }
};

std::vector<std::string> words(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> out;
  for (std::string word; in >> word;) out.push_back(word);
  return out;
}
}  // namespace

std::map<std::string, AgentType> readAgentDatabase(const std::string& file) {
  Database db{file, {}};
  std::error_code ec;
  if (const auto size = fs::file_size(file, ec); ec)
    throw Error(fmt::format("cannot read the agent database {}: {}", file, ec.message()));
  else if (size > kMostBytes)
    throw Error(fmt::format("the agent database {} is longer than {} bytes", file, kMostBytes));
  std::ifstream in(file, std::ios::binary);
  db.text.assign(std::istreambuf_iterator<char>(in), {});

  pugi::xml_document document;
  if (const auto result = document.load_buffer(db.text.data(), db.text.size()); !result)
    db.fail(result.offset, result.description());
  const pugi::xml_node root = document.child("agentdb");
  if (!root) db.fail(document.document_element().offset_debug(), "expected the element agentdb at the top");
  const fs::path home = fs::absolute(file).parent_path();
  std::map<std::string, AgentType> types;
  for (const pugi::xml_node node : root.children("agent_type_external")) {
    AgentType type;
    type.name = node.attribute("name").value();
    if (type.name.empty()) db.fail(node.offset_debug(), "expected an attribute name of the agent type");
    type.in = db.descriptor(node, "inputfd", type.in);
    type.out = db.descriptor(node, "outputfd", type.out);
    if (type.in == type.out)
      db.fail(node.offset_debug(), fmt::format("expected two descriptors, found {} as inputfd and outputfd", type.in));
    type.timer = fmt::format("{}", fmt::join(words(node.child("timer").text().get()), " "));
    type.folder = (home / node.child("working_dir").text().as_string(".")).lexically_normal().string();
    type.command = words(node.child("exec_line").text().get());
    if (type.command.empty())
      db.fail(node.offset_debug(), fmt::format("agent type '{}' has no exec_line: expected a program", type.name));
    const std::string protocol = node.child("protocol").text().as_string("spades");
    type.tcp = protocol == "tcp";
    if (!type.tcp && protocol != "spades")
      db.fail(node.child("protocol").offset_debug(),
              fmt::format("expected the protocol spades or tcp, found '{}'", protocol));
    if (node.child("ends")) type.ends = node.child("ends").text().get();
    const auto hasPort = [](const std::string& word) { return word.find("{port}") != word.npos; };
    if (type.tcp && std::none_of(type.command.begin(), type.command.end(), hasPort))
      db.fail(node.offset_debug(),
              fmt::format("agent type '{}' connects over TCP: expected {{port}} in its exec_line, where "
                          "the program gets the port",
                          type.name));
    if (!types.emplace(type.name, type).second)
      db.fail(node.offset_debug(), fmt::format("agent type '{}' is there twice", type.name));
  }
  return types;
}

}  // namespace spark::spades
