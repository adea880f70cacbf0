#pragma once
/// \file
/// The message language between an agent and its server.

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "spark/predicates.h"

namespace spark::agent {

/// Converts messages to predicates and back. Not thread safe. All agents of a program can share one.
class Language {
 public:
  virtual ~Language() = default;
  /// Appends the predicates of a message. Skips what it cannot parse.
  virtual void read(std::string_view message, Predicates& out) = 0;
  /// Appends the message for `predicates`.
  virtual void write(const Predicates& predicates, std::string& out) = 0;
};

/// The language of a server whose parser has class `parser`. "SexpParser" is built in; any other class must come from a
/// plugin in one of the folders and have the methods parse and write. Throws spark::Error when there is no such class.
std::unique_ptr<Language> makeLanguage(const std::string& parser,
                                       const std::vector<std::filesystem::path>& pluginFolders);

}  // namespace spark::agent
