#pragma once
/// \file
/// Names of event channels.

#include <string_view>

#include "spark/abi/spark/channel_name.h"

namespace spark {

/// The name of a channel, a constant that definer and listeners share, so that a misspelt one does not compile:
///
///     inline constexpr ChannelName kGust{"gust"};
class ChannelName {
 public:
  /// `name` outlives the constant (a literal).
  explicit constexpr ChannelName(const char* name) : name_(name) {}
  constexpr operator std::string_view() const { return name_; }
  constexpr const char* text() const { return name_; }

 private:
  const char* name_;
};

}  // namespace spark
