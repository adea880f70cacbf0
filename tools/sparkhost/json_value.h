#pragma once
/// \file
/// Values of the tree as JSON, which tables have in their cells.

#include <nlohmann/json.hpp>

#include "spark/value.h"

namespace sparkhost {

inline nlohmann::ordered_json toJson(const spark::Value& v) {
  switch (v.type()) {
    case spark::Value::Type::nil:
      return nullptr;
    case spark::Value::Type::boolean:
      return v.toBool();
    case spark::Value::Type::integer:
      return v.toInteger();
    case spark::Value::Type::number:
      return v.toNumber();
    case spark::Value::Type::string:
      return v.toString();
    case spark::Value::Type::list:
      break;
  }
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const spark::Value& e : v.toList()) list.push_back(toJson(e));
  return list;
}

}  // namespace sparkhost
