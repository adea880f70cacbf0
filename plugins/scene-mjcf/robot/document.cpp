#include "document.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>

namespace spark::mjcf {

namespace {

std::string folderOf(const std::string& name) {
  const std::size_t slash = name.rfind('/');
  return slash == std::string::npos ? "" : name.substr(0, slash + 1);
}

}  // namespace

std::string lineAndColumn(std::string_view text, std::size_t offset) {
  const std::string_view before = text.substr(0, std::min(offset, text.size()));
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::size_t start = before.rfind('\n');
  return fmt::format("{}:{}", line, before.size() - (start == std::string_view::npos ? 0 : start + 1) + 1);
}

void parse(File& file) {
  const pugi::xml_parse_result result = file.xml.load_buffer(file.text.data(), file.text.size());
  if (!result)
    throw Error(
        fmt::format("{}:{}: this is not XML: {}", file.name,
                    lineAndColumn(file.text, static_cast<std::size_t>(std::max<std::ptrdiff_t>(result.offset, 0))),
                    result.description()));
  if (!file.xml.document_element()) throw Error(fmt::format("{}:1:1: expected an element, found none", file.name));
}

std::string_view firstTag(std::string_view text) {
  constexpr std::string_view kMark = "\xef\xbb\xbf";  // of UTF-8
  if (text.starts_with(kMark)) text.remove_prefix(kMark.size());
  // Declaration and comments come first.
  while (true) {
    text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
    const std::string_view end = text.starts_with("<!--") ? "-->"
                                 : text.starts_with("<?") ? "?>"
                                 : text.starts_with("<!") ? ">"
                                                          : "";
    if (end.empty()) {
      if (!text.starts_with('<')) return {};
      return text.substr(1, std::min(text.find_first_of(" \t\r\n/>", 1), text.size()) - 1);
    }
    const std::size_t at = text.find(end);
    if (at == std::string_view::npos) return {};
    text.remove_prefix(at + end.size());
  }
}

std::string Element::where() const {
  // The offset of XML is that of the tag's name, behind the bracket.
  const auto begin = node ? static_cast<std::size_t>(std::max<std::ptrdiff_t>(node.offset_debug() - 1, 0)) : offset;
  return fmt::format("{}:{}", file->name, lineAndColumn(file->text, begin));
}

std::string Element::named() const {
  const std::string_view given = node ? node.attribute("name").value() : name;
  const std::string kind = node ? fmt::format("<{}>", tag()) : std::string(tag());
  return given.empty() ? kind : fmt::format("{} '{}'", kind, given);
}

// ---- documents ----

Document::Document(const std::string& name, ReadFile read) : folder_(folderOf(name)), read_(std::move(read)) {
  const Element root = load(name, nullptr);
  if (root.tag() != "mujoco") throw root.error(fmt::format("expected the element <mujoco>, found <{}>", root.tag()));
}

Element Document::load(const std::string& name, const Element* from) {
  auto file = std::make_unique<File>();
  file->name = name;
  file->text = read_(name);
  parse(*file);
  if (from && files_.size() > kMaxFiles)
    throw from->error(fmt::format("expected at most {} included files", kMaxFiles));
  files_.push_back(std::move(file));
  return {files_.back()->xml.document_element(), files_.back().get()};
}

std::vector<Element> Document::children(const Element& e) {
  std::vector<Element> out;
  append(e, out, 0);
  return out;
}

void Document::append(const Element& e, std::vector<Element>& out, int depth) {
  for (const pugi::xml_node node : e.node.children()) {
    if (node.type() != pugi::node_element) continue;
    const Element child{node, e.file};
    if (++listed_ > kMaxListed)
      throw child.error(fmt::format("expected at most {} elements, included ones counted each time", kMaxListed));
    if (child.tag() != "include") {
      out.push_back(child);
      continue;
    }
    const char* const given = node.attribute("file").value();
    if (!*given) throw child.error("expected an attribute 'file'");
    const std::string name = std::filesystem::path(folder_ + given).lexically_normal().generic_string();
    // The elements of a file that was loaded before, when this list is made again.
    const auto loaded = std::find_if(files_.begin(), files_.end(), [&](const auto& f) { return f->name == name; });
    if (depth >= kMaxDepth || loaded == files_.begin()) throw child.error("a file includes itself: '" + name + "'");
    Element root;
    try {
      root = loaded != files_.end() ? Element{(*loaded)->xml.document_element(), loaded->get()} : load(name, &child);
    } catch (const Error& error) {
      throw Error(fmt::format("{}: cannot include '{}'", child.where(), name), error);
    }
    append(root, out, depth + 1);
  }
}

// ---- defaults ----

void Defaults::add(Document& document, const Element& element) { add(document, element, "", 0); }

void Defaults::add(Document& document, const Element& element, const std::string& parent, int depth) {
  if (depth > Document::kMaxDepth) throw element.error("default classes are nested too deep");
  const char* const given = element.node.attribute("class").value();
  if (depth > 0 && !*given) throw element.error("expected an attribute 'class'");
  const std::string name = depth == 0 ? "" : given;  // the outermost class has any name, or none
  classes_[name].parent = parent;
  if (depth == 0 && *given) classes_[given].parent = "";
  for (const Element& child : document.children(element))
    if (child.tag() == "default")
      add(document, child, name, depth + 1);
    else
      classes_[name].elements.push_back(child);
}

void Defaults::forEach(const Element& user, std::span<const std::string_view> tags, const std::string& name,
                       const std::function<void(const Element&)>& visit) const {
  // The outermost class is called main, whatever else it is called.
  std::string at = name == "main" && !classes_.contains(name) ? "" : name;
  for (int i = 0; i <= Document::kMaxDepth + 1; ++i) {
    const auto found = classes_.find(at);
    if (found == classes_.end()) {
      if (!at.empty()) throw user.error(fmt::format("there is no default class '{}'", at));
      return;
    }
    // Of several elements in one class the last one counts first.
    const std::vector<Element>& elements = found->second.elements;
    for (auto e = elements.rbegin(); e != elements.rend(); ++e)
      if (std::find(tags.begin(), tags.end(), e->tag()) != tags.end()) visit(*e);
    if (at.empty()) return;
    at = found->second.parent;
  }
}

// ---- what is not supported ----

void Unsupported::add(const Element& e, const std::string& what, const std::string& kind) {
  const void* const place =
      e.node ? static_cast<const void*>(e.node.internal_object()) : e.file->text.data() + e.offset;
  if (!seen_.emplace(place, kind).second) return;
  if (const auto known = known_.find(kind); known != known_.end())
    ++entries_[known->second].times;
  else if (entries_.size() == kMaxKinds)
    ++more_;
  else
    known_.emplace(kind, entries_.size()), entries_.push_back({what, e.where(), 1});
}

bool Unsupported::attempt(const Element& e, const std::function<void()>& work) {
  try {
    work();
    return true;
  } catch (const LimitError&) {
    throw;
  } catch (const Error& error) {
    std::string why = error.what();
    const std::string place = e.where() + ": ";
    const bool here = why.starts_with(place);
    if (here) why.erase(0, place.size());
    constexpr std::string_view kBecause = "\n  because: ";
    for (std::size_t at = why.find(kBecause); at != std::string::npos; at = why.find(kBecause, at))
      why.replace(at, kBecause.size(), ": ");
    const std::string what = fmt::format("{} is left out: {}", e.named(), why);
    add(e, what, here ? what : fmt::format("<{}> is left out: {}", e.tag(), why));
    return false;
  }
}

void Unsupported::element(const Element& e) { add(e, fmt::format("the element <{}> is not supported", e.tag())); }

void Unsupported::attribute(const Element& e, const std::string& name) {
  add(e, fmt::format("the attribute '{}' of <{}> is not supported", name, e.tag()));
}

std::vector<std::string> Unsupported::sentences() const {
  std::vector<std::string> out;
  for (const Entry& x : entries_)
    out.push_back(
        fmt::format("{}: {}{}", x.where, x.what, x.times > 1 ? fmt::format(" (and {} more)", x.times - 1) : ""));
  if (more_ > 0) out.push_back(fmt::format("{} more elements and attributes are not supported", more_));
  return out;
}

// ---- attributes ----

Attributes::Attributes(const Element& e, const Defaults& defaults, const std::string& className,
                       Unsupported& unsupported, std::string_view tag)
    : element_(e), chain_{e}, unsupported_(unsupported) {
  const std::string_view tags[] = {tag.empty() ? e.tag() : tag};
  defaults.forEach(e, tags, className, [&](const Element& d) { chain_.push_back(d); });
}

const char* Attributes::find(const char* name) {
  known_.insert(name);
  for (const Element& e : chain_)
    if (const pugi::xml_attribute a = e.node.attribute(name)) return a.value();
  return nullptr;
}

std::string Attributes::text(const char* name, const char* otherwise) {
  const char* const found = find(name);
  return found ? found : otherwise;
}

std::string Attributes::word(const char* name, std::initializer_list<const char*> words, const char* otherwise) {
  std::string found = text(name, otherwise);
  if (std::find(words.begin(), words.end(), found) == words.end())
    throw element_.error(
        fmt::format("expected {} for '{}' of <{}>, found '{}'", fmt::join(words, " or "), name, element_.tag(), found));
  return found;
}

bool Attributes::flag(const char* name, bool otherwise) {
  return word(name, {"true", "false"}, otherwise ? "true" : "false") == "true";
}

std::optional<std::vector<double>> Attributes::numbers(const char* name, std::size_t least, std::size_t most) {
  known_.insert(name);
  for (const Element& e : chain_)
    if (auto found = parse(e, name, least, most)) return found;
  return std::nullopt;
}

std::optional<std::vector<double>> Attributes::parse(const Element& e, const char* name, std::size_t least,
                                                     std::size_t most) {
  const pugi::xml_attribute attribute = e.node.attribute(name);
  if (!attribute) return std::nullopt;
  const std::string_view text(attribute.value());
  std::vector<double> out;
  const auto refuse = [&]() -> std::optional<std::vector<double>> {
    const std::string expected = least == most ? (most == 1 ? "a number" : fmt::format("{} numbers", most))
                                               : fmt::format("{} to {} numbers", least, most);
    const std::string_view found = text.substr(0, 80);
    if (!forgiving_)
      throw e.error(fmt::format("expected {} for '{}' of <{}>, found '{}'", expected, name, e.tag(), found));
    unsupported_.add(
        e, fmt::format("'{}' of <{}> is ignored: expected {}, found '{}'", name, element_.tag(), expected, found));
    return std::nullopt;
  };
  std::size_t at = 0;
  while (true) {
    at = text.find_first_not_of(" \t\r\n", at);
    if (at == std::string_view::npos) break;
    if (text[at] == '+') ++at;
    double v = 0;
    const auto [end, failure] = std::from_chars(text.data() + at, text.data() + text.size(), v);
    // What is next to 0 is 0.
    if (failure == std::errc::result_out_of_range) v = std::strtod(text.data() + at, nullptr);
    const bool isNumber = failure == std::errc() || failure == std::errc::result_out_of_range;
    if (!isNumber || !std::isfinite(v) || out.size() == most) return refuse();
    at = static_cast<std::size_t>(end - text.data());
    if (at < text.size() && !std::strchr(" \t\r\n", text[at])) return refuse();
    out.push_back(v);
  }
  if (out.size() < least) return refuse();
  return out;
}

double Attributes::number(const char* name, double otherwise) {
  const auto found = numbers(name, 1, 1);
  return found ? found->front() : otherwise;
}

double Attributes::within(const char* name, double otherwise, double least, double most) {
  const double v = number(name, otherwise), taken = std::clamp(v, least, most);
  if (v != taken)
    note(fmt::format("'{}' of <{}> is taken as {}: expected {} to {}, found {}", name, element_.tag(), taken, least,
                     most, v));
  return taken;
}

int Attributes::integer(const char* name, int otherwise) {
  const double v = number(name, otherwise);
  if (std::abs(v) > 1e9 && forgiving_) {
    note(fmt::format("'{}' of <{}> is ignored: expected a whole number, found {:g}", name, element_.tag(), v));
    return otherwise;
  }
  if (std::abs(v) > 1e9)
    throw element_.error(fmt::format("expected a whole number for '{}' of <{}>, found {}", name, element_.tag(), v));
  if (v != std::floor(v))
    note(fmt::format("'{}' of <{}> is taken without its fraction: expected a whole number", name, element_.tag()));
  return static_cast<int>(v);
}

void Attributes::finish() {
  for (const Element& e : chain_)
    for (const pugi::xml_attribute a : e.node.attributes())
      if (!known_.contains(a.name())) unsupported_.attribute(e, a.name());
}

}  // namespace spark::mjcf
