#include "language.h"

#include <algorithm>

#include "spark/error.h"
#include "spark/kernel.h"

namespace spark::agent {

namespace {
constexpr int kDecimals = 4;  // of the numbers that agents send

class Sexp : public Language {
 public:
  void read(std::string_view message, Predicates& out) override { readSexp(message, out); }
  void write(const Predicates& predicates, std::string& out) override { writeSexp(predicates, kDecimals, out); }
};

/// A parser from a plugin, in a kernel of its own.
class FromPlugin : public Language {
 public:
  FromPlugin(const std::string& parser, const std::vector<std::filesystem::path>& folders) {
    for (const auto& folder : folders)
      if (std::filesystem::is_directory(folder)) kernel_.plugins().scan(folder);
    if (const Plugin* p = kernel_.plugins().providerOf(parser)) kernel_.plugins().use(p->name());
    parser_ = &kernel_.create(parser, "/parser");
    for (const char* method : {"parse", "write"})
      if (!parser_->classObject()->method(method))
        throw Error(parser + " cannot be used by agents: it has no method '" + method + "'");
    if (parser_->classObject()->property("decimals")) setProperty(*parser_, "decimals", kDecimals);
  }
  void read(std::string_view message, Predicates& out) override {
    const Value text = message;
    append(callMethod(*parser_, "parse", std::span(&text, 1)).toList(), out);
  }
  void write(const Predicates& predicates, std::string& out) override {
    const Value list = toList(predicates);
    out += callMethod(*parser_, "write", std::span(&list, 1)).toString();
  }

 private:
  Kernel kernel_;
  Leaf* parser_ = nullptr;
};
}  // namespace

std::unique_ptr<Language> makeLanguage(const std::string& parser,
                                       const std::vector<std::filesystem::path>& pluginFolders) {
  if (parser == "SexpParser") return std::make_unique<Sexp>();
  return std::make_unique<FromPlugin>(parser, pluginFolders);
}

}  // namespace spark::agent
