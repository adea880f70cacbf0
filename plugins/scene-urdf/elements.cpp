#include "elements.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <charconv>
#include <cmath>

namespace spark::urdf {

namespace {
constexpr std::string_view kBlanks = " \t\r\n";
}

std::vector<Element> childrenOf(const Element& e) {
  std::vector<Element> out;
  for (const pugi::xml_node node : e.node.children())
    if (node.type() == pugi::node_element) out.push_back({node, e.file});
  return out;
}

std::optional<Element> childOf(const Element& e, const char* tag) {
  const pugi::xml_node node = e.node.child(tag);
  return node ? std::optional(Element{node, e.file}) : std::nullopt;
}

std::string nameOf(const Element& e) {
  std::string name = e.node.attribute("name").value();
  if (name.empty()) throw e.error(fmt::format("expected an attribute 'name' of <{}>", e.tag()));
  return name;
}

std::string_view textOf(const Element& e, const char* attribute) { return e.node.attribute(attribute).value(); }

std::string_view contentOf(const Element& e) {
  std::string_view text = e.node.text().get();
  if (text.empty()) text = textOf(e, "value");
  text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
  return text.substr(0, text.find_last_not_of(kBlanks) + 1);
}

std::optional<std::vector<double>> numbersOf(std::string_view text) {
  std::vector<double> out;
  const auto skip = [&](std::string_view what) {
    text.remove_prefix(std::min(text.find_first_not_of(what), text.size()));
  };
  for (skip(kBlanks); !text.empty(); skip(kBlanks)) {
    if (text.front() == '+') text.remove_prefix(1);
    double v = 0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), v);
    if (failure != std::errc() || !std::isfinite(v)) return std::nullopt;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    if (!text.empty() && kBlanks.find(text.front()) == std::string_view::npos) {
      if (text.front() != ',') return std::nullopt;
      text.remove_prefix(1);
    }
    out.push_back(v);
  }
  return out.empty() ? std::nullopt : std::optional(std::move(out));
}

std::optional<std::vector<double>> Numbers::read(const char* attribute, std::size_t count) {
  if (!element_.node.attribute(attribute)) return std::nullopt;
  const std::string_view text = textOf(element_, attribute);
  auto found = numbersOf(text);
  if (found && found->size() == count) return found;
  unsupported_.add(
      element_, fmt::format("the attribute '{}' of <{}> is ignored: expected {}, found '{}'", attribute, element_.tag(),
                            count == 1 ? "a number" : fmt::format("{} numbers", count), text.substr(0, 80)));
  return std::nullopt;
}

double Numbers::number(const char* attribute, double otherwise) {
  const auto found = read(attribute, 1);
  return found ? found->front() : otherwise;
}

Pose originOf(const Element& e, Unsupported& unsupported) {
  Pose out;
  const auto origin = childOf(e, "origin");
  if (!origin) return out;
  Numbers a(*origin, unsupported);
  a.take("xyz", out.position);
  Vec3 rpy = Vec3::Zero();
  a.take("rpy", rpy);
  out.rotation = (Eigen::AngleAxisd(rpy.z(), Vec3::UnitZ()) * Eigen::AngleAxisd(rpy.y(), Vec3::UnitY()) *
                  Eigen::AngleAxisd(rpy.x(), Vec3::UnitX()))
                     .toRotationMatrix();  // about fixed axes
  return out;
}

}  // namespace spark::urdf
