#pragma once
/// \file
/// Names of event channels.

#include <string_view>

#include "spark/abi/spark/channel_name.h"

namespace spark {

/// The name of a channel, as a constant that all code shares, so that a misspelt name does not compile:
///
///     inline constexpr ChannelName kGust{"gust"};
class ChannelName {
 public:
  /// `name` must outlive the constant (a literal).
  explicit constexpr ChannelName(const char* name) : name_(name) {}
  /// The name.
  constexpr operator std::string_view() const { return name_; }
  /// The name, ended by a zero.
  constexpr const char* text() const { return name_; }

 private:
  const char* name_;
};

}  // namespace spark
