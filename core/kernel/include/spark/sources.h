#pragma once
/// \file
/// The texts that a simulation was made of.

#include <compare>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>

#include "spark/abi/spark/sources.h"

namespace spark {

/// Which scripts ran and which files were read, by the hashes of their texts. Part of the configuration
/// (configurationHash()). The simulation's thread only.
class Sources {
 public:
  struct Source {
    std::string kind;        ///< "script" or "file"
    std::string name;        ///< as it was asked for
    std::uint64_t hash = 0;  ///< of the text: hashBytes()
    auto operator<=>(const Source&) const = default;
  };
  /// Notes a text that was run or read; the same one again changes nothing.
  void add(std::string_view kind, std::string_view name, std::string_view text);
  /// The text with that hash, for recordings and snapshots; nullptr if there is none.
  const std::string* text(std::uint64_t hash) const;
  /// All, by kind and name; a name has several entries where its text changed.
  const std::set<Source>& all() const { return all_; }

 private:
  std::set<Source> all_;
  std::map<std::uint64_t, std::string> texts_;
};

}  // namespace spark
