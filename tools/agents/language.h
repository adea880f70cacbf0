#pragma once
/// \file
/// The language that an agent speaks with its server.

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "spark/predicates.h"

namespace spark::agent {

/// Messages to predicates and back. Not thread safe; one object may serve many agents of a program.
class Language {
 public:
  virtual ~Language() = default;
  /// Appends what the message holds; what cannot be read is left out.
  virtual void read(std::string_view message, Predicates& out) = 0;
  /// Appends the message for `predicates`.
  virtual void write(const Predicates& predicates, std::string& out) = 0;
};

/// The language of a server whose parser is of class `parser`. "SexpParser" needs nothing but core/; any other class
/// comes from a plugin in one of the folders and needs the methods parse and write. Throws spark::Error when there is
/// no such class.
std::unique_ptr<Language> makeLanguage(const std::string& parser,
                                       const std::vector<std::filesystem::path>& pluginFolders);

}  // namespace spark::agent
