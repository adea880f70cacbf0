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

Error Fields::expected(const Field& f, const std::string& what) const {
  return errorAt(*node_.file, f.offset,
                 fmt::format("expected {} for '{}' of {}, found {}", what, f.name, node_.type, named(*f.value)));
}

const std::vector<double>& Fields::exactly(const Field& f, std::size_t count, const char* what) const {
  if (f.value->kind != Kind::numbers || f.value->numbers.size() != count) throw expected(f, what);
  return f.value->numbers;
}

double Fields::number(const char* name, double otherwise) {
  const Field* const f = find(name);
  return f ? exactly(*f, 1, "a number").front() : otherwise;
}

double Fields::number(const char* name, double otherwise, double least) {
  const double v = number(name, otherwise);
  if (v < least)
    throw error(name,
                fmt::format("expected a number of {} or more for '{}' of {}, found {}", least, name, node_.type, v));
  return v;
}

bool Fields::flag(const char* name, bool otherwise) {
  const Field* const f = find(name);
  if (!f) return otherwise;
  if (f->value->kind != Kind::words || f->value->texts.size() != 1) throw expected(*f, "TRUE or FALSE");
  return f->value->texts.front() == "TRUE";
}

std::string Fields::text(const char* name, const char* otherwise) {
  const Field* const f = find(name);
  if (!f) return otherwise;
  if (f->value->kind != Kind::texts || f->value->texts.size() != 1) throw expected(*f, "a text in quotes");
  return f->value->texts.front();
}

Vec3 Fields::vector(const char* name, const Vec3& otherwise) {
  const Field* const f = find(name);
  if (!f) return otherwise;
  const std::vector<double>& v = exactly(*f, 3, "3 numbers");
  return {v[0], v[1], v[2]};
}

Mat3 Fields::rotation(const char* name) {
  const Field* const f = find(name);
  if (!f) return Mat3::Identity();
  const std::vector<double>& v = exactly(*f, 4, "4 numbers, an axis and an angle,");
  const Vec3 axis(v[0], v[1], v[2]);
  if (v[3] == 0) return Mat3::Identity();
  const double length = axis.norm();
  if (!(length > 1e-10) || !std::isfinite(length)) throw error(name, "expected an axis that is not 0");
  return Eigen::AngleAxisd(v[3], axis / length).toRotationMatrix();
}

const std::vector<double>* Fields::numbers(const char* name) {
  const Field* const f = find(name);
  if (!f) return nullptr;
  if (f->value->kind != Kind::numbers) throw expected(*f, "numbers");
  return &f->value->numbers;
}

const std::vector<std::string>* Fields::texts(const char* name) {
  const Field* const f = find(name);
  if (!f) return nullptr;
  if (f->value->kind != Kind::texts) throw expected(*f, "texts in quotes");
  return &f->value->texts;
}

const Node* Fields::child(const char* name) {
  const Field* const f = find(name);
  if (!f) return nullptr;
  if (f->value->kind != Kind::nodes || f->value->nodes.size() != 1) throw expected(*f, "one node, or NULL,");
  return f->value->nodes.front().get();
}

const std::vector<NodePtr>& Fields::children(const char* name) {
  static const std::vector<NodePtr> none;
  const Field* const f = find(name);
  if (!f) return none;
  if (f->value->kind != Kind::nodes) throw expected(*f, "nodes");
  return f->value->nodes;
}

void Fields::finish() {
  for (const Field& f : node_.fields)
    if (!known_.contains(f.name))
      unsupported_.add({{}, node_.file, f.offset, node_.type, {}},
                       fmt::format("the field '{}' of {} is not supported", f.name, node_.type));
}

}  // namespace spark::webots
