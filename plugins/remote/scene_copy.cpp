#include "scene_copy.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "spark/access.h"
#include "spark/error.h"
#include "wire.h"

namespace spark::remote {

namespace {
/// The methods that the other host may call here: those with which scene files make looks and shapes.
constexpr std::array kCalls{"load", "setScale", "resetMaterials", "setTransparent", "setParams", "setLocalPose"};

const List& listAt(const List& list, std::size_t index) { return at(list, index, Value::Type::list).toList(); }

/// Throws Error for numbers that no scene should have, whatever the property accepts: NaN, and in vectors and meshes
/// what is not finite or too large.
void check(const Value& value, bool inList = false) {
  if (value.isList())
    for (const Value& each : value.toList()) check(each, true);
  else if (value.type() == Value::Type::number &&
           (std::isnan(value.toNumber()) || (inList && !(std::abs(value.toNumber()) <= Transform::kMaxMagnitude))))
    throw Error(fmt::format("expected finite numbers from -1e9 to 1e9, found {}", value.text()));
}

/// Throws Error unless the numbers are a matrix that a transform of this host may have.
Matrix matrixOf(const List& numbers) {
  Matrix m;
  for (int i = 0; i < 16; ++i) {
    const Value& number = numbers[static_cast<std::size_t>(i)];
    if (!number.isNumber() || !(std::abs(number.toNumber()) <= Transform::kMaxMagnitude))
      throw Error(fmt::format("expected a matrix of finite numbers from -1e9 to 1e9, found {}", number.text()));
    m.data()[i] = static_cast<float>(number.toNumber());
  }
  if (m.row(3) != Eigen::RowVector4f(0, 0, 0, 1)) throw Error("expected a matrix whose last row is 0 0 0 1");
  return m;
}

void call(Leaf& leaf, ClassObject& local, const List& described) {
  const std::string& name = textAt(described, 0);
  const Method* const method = local.method(name);
  if (described.size() < 2 || !method || std::find(kCalls.begin(), kCalls.end(), name) == kCalls.end()) return;
  check(described[1]);
  Args args{listAt(described, 1)};
  method->call(leaf, args);
}

void set(Leaf& leaf, ClassObject& local, const List& described) {
  const Property* const property = local.property(textAt(described, 0));
  if (!property || property->readOnly || property->name == "name" || described.size() < 2) return;
  const Value& value = described[1];
  if (property->get(leaf) == value) return;
  check(value);
  Args args{std::span(&value, 1)};
  writeProperty(*property, leaf, args);
}

void apply(Leaf& leaf, const List& calls, const List& properties) {
  ClassObject& local = *leaf.classObject()->base();
  for (const Value& each : calls)
    if (each.isList()) call(leaf, local, each.toList());
  for (const Value& each : properties)
    if (each.isList()) set(leaf, local, each.toList());
}
}  // namespace

void SceneCopy::make(Leaf& leaf, const List& state) {
  const List& pose = listAt(state, 0);
  if (const auto transform = leaf.as<Transform>(); transform && pose.size() == 16)
    return transform->setLocal(matrixOf(pose));
  apply(leaf, listAt(state, 1), listAt(state, 2));
}

void SceneCopy::place(Leaf& leaf, const List& numbers) {
  const auto transform = leaf.as<Transform>();
  if (!transform) return;
  if (numbers.size() != 16) throw BadMessage("the other host places a node with other than 16 numbers");
  try {
    if (const Matrix m = matrixOf(numbers); m != transform->local()) transform->setLocal(m);
  } catch (const Error& e) {
    warn(leaf.classObject()->name(), leaf.path(), e);
  }
}

void SceneCopy::change(Leaf& leaf, const List& calls, const List& properties) {
  if (!leaf.as<SceneNode>()) return;
  try {
    apply(leaf, calls, properties);
  } catch (const BadMessage&) {
    throw;
  } catch (const std::exception& e) {
    warn(leaf.classObject()->name(), leaf.path(), e);
  }
}

void SceneCopy::warn(const std::string& className, const std::string& node, const std::exception& why) {
  if (!warned_.insert(className).second) return;
  mount_.kernel().log().warning(
      "{}: this scene cannot have what the other host has there. Others of its class may be missing, too, without "
      "another line.\n  because: {}",
      node, why.what());
}

}  // namespace spark::remote
