#include "document.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>

#include "base_nodes.h"
#include "known_protos.h"
#include "template_fields.h"

namespace spark::webots {

Document::Document(const std::string& name, const Sources& sources, mjcf::Unsupported& unsupported)
    : from_(sources), unsupported_(unsupported) {
  main_ = name;
  const Source* const source = load(name);
  if (!source) throw Error(fmt::format("there is no file '{}'", name));
  std::map<const Node*, NodePtr> done;
  const Scope scope{*source, nullptr, done};
  coordinates_ = coordinatesOf(source->parsed);
  for (const NodePtr& node : source->parsed.nodes) nodes_.push_back(expand(node, scope));
  const auto& protos = source->parsed.protos;
  if (!nodes_.empty() || protos.empty()) return;
  Node only{protos.back()->name, "", &source->file, protos.back()->offset};
  nodes_.push_back(instance(only, {source, protos.back()}, scope));
  coordinates_ = nodes_.back()->yUp ? "NUE" : "ENU";  // of the file that has the node itself
}

/// Before R2022a the field was not always there, and y was up by default; before R2020b gravity was a vector.
std::string Document::coordinatesOf(const Parsed& parsed) {
  std::string out = parsed.yUp ? "NUE" : "ENU";
  for (const NodePtr& node : parsed.nodes) {
    if (node->type != "WorldInfo") continue;
    if (const Field* const f = node->field("gravity"); f && f->value->numbers.size() == 3)
      out = f->value->numbers[2] < 0 ? "ENU" : "NUE";
    if (const Field* const f = node->field("coordinateSystem"); f && f->value->kind == Value::Kind::texts)
      out = f->value->texts.front();
  }
  return out;
}

const Document::Source* Document::load(const std::string& name) {
  if (const auto known = sources_.find(name); known != sources_.end()) return known->second.get();
  std::unique_ptr<Source>& source = sources_[name];  // also what is not there, or cannot be read
  std::optional<std::string> text = from_.read(name);
  if (!text) return nullptr;
  if (++files_ > kMaxFiles) throw Error(fmt::format("{}:1:1: expected at most {} files", name, kMaxFiles));
  if ((texts_ += text->size()) > kMaxTexts)
    throw Error(fmt::format("{}:1:1: expected at most {} bytes in all files", name, kMaxTexts));
  auto read = std::make_unique<Source>();
  read->file.name = name;
  read->file.text = std::move(*text);
  read->parsed = parsed(read->file);
  this->name(read->parsed.problems, read->file);
  source = std::move(read);
  return source.get();
}

void Document::name(const std::vector<Problem>& problems, const mjcf::File& file) {
  for (const Problem& p : problems) unsupported_.add({{}, &file, p.offset, {}, {}}, p.text);
}

void Document::missing(const std::string& type, std::string why) { missing_.emplace(type, std::move(why)); }

std::string Document::whyMissing(const std::string& type) const {
  const auto found = missing_.find(type);
  return found == missing_.end() ? "" : found->second;
}

/// The PROTO of a node: in its own file, by an EXTERNPROTO of that file, or beside it.
Document::Found Document::find(const Node& node, const Source& source) {
  for (const auto& proto : source.parsed.protos)
    if (proto->name == node.type) return {&source, proto};
  const auto& externs = source.parsed.externs;
  const auto named =
      std::find_if(externs.rbegin(), externs.rend(), [&](const Extern& e) { return e.name == node.type; });
  const std::string url = named == externs.rend() ? node.type + ".proto" : named->url;
  std::vector<std::string> names = fileNames(source.file.name, url, from_.folders);
  Found found = findIn(node.type, names);
  if (!found.proto && named != externs.rend()) {
    // Beside the file, too, where what the name leads to has another PROTO.
    names = fileNames(source.file.name, node.type + ".proto", from_.folders);
    found = findIn(node.type, names);
  }
  if (!found.proto) found = findElsewhere(node, named != externs.rend());
  if (!found.proto) found = findKnown(node);
  if (!found.proto)
    missing(node.type, fmt::format("its PROTO is not there: looked for {}. What to do: put its file in one of these "
                                   "places, nothing is fetched from the web",
                                   fmt::join(names, ", ")));
  return found;
}

Document::Found Document::findIn(const std::string& type, const std::vector<std::string>& names) {
  for (const std::string& name : names) try {
      const Source* const source = load(name);
      if (!source) continue;
      for (const auto& proto : source->parsed.protos)
        if (proto->name == type) return {source, proto};
    } catch (const Error& error) {
      missing(type, error.what());
    }
  return {};
}

/// Before EXTERNPROTO, Webots itself looked in all folders below `protos`.
Document::Found Document::findElsewhere(const Node& node, bool isNamed) {
  if (!from_.called) return {};
  Found found = findIn(node.type, from_.called(node.type + ".proto"));
  if (found.proto && (isNamed || !node.yUp))
    unsupported_.add(node.element(), fmt::format("the PROTO '{}' is not in its place: that in '{}' is taken", node.type,
                                                 found.source->file.name));
  return found;
}

/// One that comes with Webots, and needs no file.
Document::Found Document::findKnown(const Node& node) {
  const char* const text = knownProto(node);
  if (!text) return {};
  std::unique_ptr<Source>& source = sources_[fmt::format("webots: {}", node.type)];
  if (!source) {
    source = std::make_unique<Source>();
    source->file.name = node.type + ".proto of Webots";
    source->file.text = text;
    source->parsed = parsed(source->file);
  }
  return {source.get(), source->parsed.protos.front()};
}

NodePtr Document::expand(const NodePtr& node, const Scope& scope) {
  if (const auto known = scope.done.find(node.get()); known != scope.done.end()) return known->second;
  NodePtr out = expandOnce(*node, scope);
  scope.done.emplace(node.get(), out);
  return out;
}

NodePtr Document::expandOnce(const Node& node, const Scope& scope) {
  if (++expanded_ > kMaxExpanded)
    throw node.element().error(fmt::format("expected at most {} nodes in all PROTOs and files", kMaxExpanded));
  if (scope.depth > kMaxNesting)
    throw node.element().error(fmt::format("expected nodes nested at most {} deep", kMaxNesting));
  auto out = std::make_shared<Node>(node);
  const Scope inside{scope.source, scope.arguments, scope.done, scope.depth + 1};
  for (Field& f : out->fields) f.value = expand(f, node, inside);
  std::erase_if(out->fields, [](const Field& f) { return !f.value; });
  if (isBaseNode(node.type)) return out;
  const Found found = find(node, scope.source);
  if (found.proto) return instance(*out, found, scope);
  if (NodePtr joint = jointWithoutBacklash(*out, unsupported_)) return joint;
  return out;
}

/// nullptr for a field that IS one without a value.
std::shared_ptr<const Value> Document::expand(const Field& f, const Node& node, const Scope& scope) {
  if (f.value->kind == Value::Kind::reference) {
    const std::string& name = f.value->texts.front();
    const auto found = scope.arguments ? scope.arguments->find(name) : Arguments::const_iterator();
    if (scope.arguments && found != scope.arguments->end()) return found->second;
    this->name(
        {{f.offset,
          fmt::format("expected the name of a field of a PROTO behind IS, found '{}'; the field '{}' is left out", name,
                      f.name)}},
        *node.file);
    return nullptr;
  }
  if (f.value->kind != Value::Kind::nodes) return f.value;
  auto out = std::make_shared<Value>();
  out->kind = Value::Kind::nodes;
  out->isList = f.value->isList;
  for (const NodePtr& n : f.value->nodes) out->nodes.push_back(expand(n, scope));
  return out;
}

/// `node`: with its fields expanded.
NodePtr Document::instance(const Node& node, const Found& found, const Scope& scope) {
  const Proto& proto = *found.proto;
  const std::string key = fmt::format("{} {}", proto.file->name, proto.name);
  if (!open_.insert(key).second) throw node.element().error(fmt::format("the PROTO '{}' contains itself", proto.name));
  Arguments arguments;
  std::map<const Node*, NodePtr> done;
  const Scope outside{*found.source, nullptr, done, scope.depth + 1};
  const Node declared{proto.name, "", proto.file, proto.offset};
  for (const Field& f : proto.fields) {
    const Field* const given = node.field(f.name);
    arguments[f.name] = given ? given->value : expand(f, declared, outside);
  }
  for (const Field& f : node.fields)
    if (!arguments.contains(f.name))
      unsupported_.add(node.element(),
                       f.name.starts_with(kHidden)
                           ? std::string(kHiddenIgnored)
                           : fmt::format("the PROTO '{}' has no field '{}', which is ignored", proto.name, f.name));
  // What cannot be made is as a PROTO that is not there: the reader names it.
  NodePtr body;
  try {
    body = this->body(found, arguments, scope);
  } catch (const Error& error) {
    open_.erase(key);
    missing(proto.name, error.what());
    return std::make_shared<Node>(node);
  }
  auto out = std::make_shared<Node>(*expand(body, {*found.source, &arguments, done, scope.depth + 1}));
  out->origin = std::make_shared<Node>(node);
  open_.erase(key);
  return out;
}

NodePtr Document::body(const Found& found, const Arguments& arguments, const Scope& scope) {
  const Proto& proto = *found.proto;
  if (proto.body) return proto.body;
  if (!proto.text) throw errorAt(*proto.file, proto.offset, "expected a node in this PROTO");
  std::map<const Node*, NodePtr> done;
  const Scope outside{*found.source, nullptr, done, scope.depth + 1};
  const Node declared{proto.name, "", proto.file, proto.offset};
  nlohmann::json fields = nlohmann::json::object();
  for (const Field& f : proto.fields) {
    const auto given = arguments.find(f.name);
    const std::shared_ptr<const Value> otherwise = expand(f, declared, outside);
    nlohmann::json& field = fields[f.name] = nlohmann::json::object();
    if (given != arguments.end() && given->second) field["value"] = valueFor(*given->second, f.type);
    if (otherwise) field["defaultValue"] = valueFor(*otherwise, f.type);
  }
  const Parsed& written = run(proto, fields);
  if (written.nodes.empty()) throw errorAt(*proto.file, proto.offset, "the template writes no node");
  return written.nodes.front();
}

/// What the template of a PROTO writes for these fields. Templates are deterministic: each is run once for the same
/// fields, but for those that look at their context, which has the number of the instance.
const Parsed& Document::run(const Proto& proto, const nlohmann::json& fields) {
  const Template& text = *proto.text;
  const auto folder = [](const std::string& file) { return file.substr(0, file.find_last_of('/') + 1); };
  nlohmann::json context = {{"world", main_},
                            {"proto", proto.file->name},
                            {"project_path", folder(main_)},
                            {"webots_version", {{"major", "R2025a"}, {"revision", "0"}}},
                            {"webots_home", ""},
                            {"temporary_files_path", ""},
                            {"os", "linux"},
                            {"id", 1},
                            {"coordinate_system", coordinates_}};
  if (text.program.find("context") != std::string::npos) context["id"] = expanded_;
  const std::string request = nlohmann::json{
      {"language", text.language == Language::lua ? "lua" : "javascript"},
      {"text", text.program},
      {"fields", fields},
      {"context", context}}.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  if (const auto known = written_.find(request); known != written_.end()) return known->second;
  if (!from_.run) throw errorAt(*proto.file, proto.offset, "its template is not run here");
  const nlohmann::json answer = nlohmann::json::parse(from_.run(request), nullptr, false);
  for (const auto& line : answer.value("said", nlohmann::json::array()))
    said_.push_back(fmt::format("{}: {}", proto.file->name, line.get<std::string>()));
  if (answer.contains("error")) throw failure(proto, answer["error"].get<std::string>());
  Expansion out;
  for (const auto& piece : answer.value("pieces", nlohmann::json::array())) {
    if (!text.add(out, *proto.file, piece[0].get<std::size_t>(), piece.size() > 1 ? piece[1].get<std::string>() : ""))
      throw errorAt(*proto.file, proto.offset, "its template writes what it does not have");
    if ((texts_ += 64) > kMaxTexts || out.text.size() > kMaxTexts)
      throw errorAt(*proto.file, proto.offset, "its template writes too much");
  }
  texts_ += out.text.size();
  Parsed written = parsedNode(*proto.file, out);
  name(written.problems, *proto.file);
  return written_.emplace(request, std::move(written)).first->second;
}

/// "line:12: what" with the place in the file.
Error Document::failure(const Proto& proto, std::string what) {
  constexpr std::string_view kLine = "line:";
  std::size_t line = 0;
  const std::size_t colon = what.find(": ");
  if (what.starts_with(kLine) && colon != std::string::npos) {
    std::from_chars(what.data() + kLine.size(), what.data() + colon, line);
    what.erase(0, colon + 2);
  }
  const std::vector<std::size_t>& lines = proto.text->lines;
  const std::size_t offset = line >= 1 && line <= lines.size() ? lines[line - 1] : proto.offset;
  return errorAt(*proto.file, offset, "the template fails: " + what);
}

}  // namespace spark::webots
