#include "fields.h"

#include <fmt/format.h>

#include <Eigen/Geometry>

namespace spark::webots {

using Kind = Value::Kind;

namespace {

/// What a value is, for errors.
std::string named(const Value& v) {
  switch (v.kind) {
    case Kind::numbers:
      return v.numbers.size() == 1 ? "one number" : fmt::format("{} numbers", v.numbers.size());
    case Kind::texts:
      return v.texts.size() == 1 ? "a text" : fmt::format("{} texts", v.texts.size());
    case Kind::words:
      return v.texts.front();
    case Kind::nodes:
      return v.nodes.size() == 1 ? "a node " + v.nodes.front()->type : fmt::format("{} nodes", v.nodes.size());
    default:
      return "an empty list";
  }
}

}  // namespace

const Field* Fields::find(const char* name) {
  known_.insert(name);
  const Field* const f = node_.field(name);
  if (!f || f->value->kind == Kind::empty) return nullptr;
  const bool null = f->value->kind == Kind::words && f->value->texts.front() == "NULL";
  return null ? nullptr : f;
}

Error Fields::error(const char* name, const std::string& text) const {
  const Field* const f = node_.field(name);
  return errorAt(*node_.file, f ? f->offset : node_.offset, text);
}

void Fields::wrong(const char* name, const std::string& text) const {
  const Field* const f = node_.field(name);
  unsupported_.add({{}, node_.file, f ? f->offset : node_.offset, node_.type, node_.name()}, text);
}

void Fields::expected(const Field& f, const std::string& what) const {
  wrong(f.name.c_str(),
        fmt::format("expected {} for '{}' of {}, found {}; it is ignored", what, f.name, node_.type, named(*f.value)));
}

/// nullptr where it is not there, or has another number of numbers.
const std::vector<double>* Fields::exactly(const char* name, std::size_t count, const char* what) {
  const Field* const f = find(name);
  if (!f) return nullptr;
  if (f->value->kind == Kind::numbers && f->value->numbers.size() == count) return &f->value->numbers;
  expected(*f, what);
  return nullptr;
}

double Fields::number(const char* name, double otherwise) {
  const std::vector<double>* const v = exactly(name, 1, "a number");
  return v ? v->front() : otherwise;
}

double Fields::number(const char* name, double otherwise, double least) {
  const double v = number(name, otherwise);
  if (v >= least) return v;
  wrong(name, fmt::format("expected a number of {} or more for '{}' of {}, found {}; it is ignored", least, name,
                          node_.type, v));
  return otherwise;
}

bool Fields::flag(const char* name, bool otherwise) {
  const Field* const f = find(name);
  if (!f) return otherwise;
  if (f->value->kind == Kind::words && f->value->texts.size() == 1) return f->value->texts.front() == "TRUE";
  expected(*f, "TRUE or FALSE");
  return otherwise;
}

std::string Fields::text(const char* name, const char* otherwise) {
  const Field* const f = find(name);
  if (!f) return otherwise;
  if (f->value->kind == Kind::texts && f->value->texts.size() == 1) return f->value->texts.front();
  expected(*f, "a text in quotes");
  return otherwise;
}

Vec3 Fields::vector(const char* name, const Vec3& otherwise) {
  const std::vector<double>* const v = exactly(name, 3, "3 numbers");
  return v ? Vec3((*v)[0], (*v)[1], (*v)[2]) : otherwise;
}

Mat3 Fields::rotation(const char* name) {
  const std::vector<double>* const v = exactly(name, 4, "4 numbers, an axis and an angle,");
  if (!v || v->back() == 0) return Mat3::Identity();
  const Vec3 axis((*v)[0], (*v)[1], (*v)[2]);
  const double length = axis.norm();
  if (length > 1e-10 && std::isfinite(length)) return Eigen::AngleAxisd(v->back(), axis / length).toRotationMatrix();
  wrong(name, fmt::format("expected an axis that is not 0 for '{}'; it is ignored", name));
  return Mat3::Identity();
}

const std::vector<double>* Fields::numbers(const char* name) {
  const Field* const f = find(name);
  if (!f || f->value->kind == Kind::numbers) return f ? &f->value->numbers : nullptr;
  expected(*f, "numbers");
  return nullptr;
}

const std::vector<std::string>* Fields::texts(const char* name) {
  const Field* const f = find(name);
  if (!f || f->value->kind == Kind::texts) return f ? &f->value->texts : nullptr;
  expected(*f, "texts in quotes");
  return nullptr;
}

const Node* Fields::child(const char* name) {
  const Field* const f = find(name);
  if (!f) return nullptr;
  if (f->value->kind == Kind::nodes && f->value->nodes.size() == 1) return f->value->nodes.front().get();
  expected(*f, "one node, or NULL,");
  return nullptr;
}

const std::vector<NodePtr>& Fields::children(const char* name) {
  static const std::vector<NodePtr> none;
  const Field* const f = find(name);
  if (!f || f->value->kind == Kind::nodes) return f ? f->value->nodes : none;
  expected(*f, "nodes");
  return none;
}

void Fields::finish() {
  for (const Field& f : node_.fields)
    if (!known_.contains(f.name))
      unsupported_.add({{}, node_.file, f.offset, node_.type, {}},
                       f.name.starts_with(kHidden)
                           ? std::string(kHiddenIgnored)
                           : fmt::format("the field '{}' of {} is not supported", f.name, node_.type));
}

}  // namespace spark::webots
