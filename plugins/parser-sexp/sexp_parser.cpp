#include "api/agents.h"
#include "spark/describe.h"
#include "spark/plugin.h"

namespace spark {

/// The language of the installed base: S-expressions both ways.
class SexpParser : public Leaf, public IParser {
  SPARK_CLASS(SexpParser, Leaf)
 public:
  static void describe(Description<SexpParser>& d) {
    d.doc("Reads and writes S-expressions as agents of the installed base do.");
    d.property("decimals", &SexpParser::decimals_)
        .range(0, 9)
        .doc("Decimals of every number that is no integer; the mainline server has 2, the SPL build 3.");
    d.property("maxDepth", &SexpParser::maxDepth_).range(1, 1000).doc("Lists nested deeper are refused.");
    d.property("maxTokens", &SexpParser::maxTokens_).range(1, 1e6).doc("Longer messages are refused.");
    d.method("parse", &SexpParser::parseText)
        .parameters({"text"})
        .doc("The text's top-level elements, as far as it can be read.");
    d.method("write", &SexpParser::writeText)
        .parameters({"elements"})
        .doc("The message for a list of top-level elements.");
    d.implements<IParser>();
  }

  ReadResult parse(std::string_view message, Predicates& out) override {
    return readSexp(message, out,
                    {static_cast<std::uint32_t>(maxDepth_), static_cast<std::uint32_t>(maxTokens_), false});
  }
  void write(const Predicates& predicates, std::string& out) override {
    writeSexp(predicates, decimals_, out, kLateClocks);
  }

 private:
  List parseText(std::string text) {
    Predicates out;
    parse(text, out);
    return toList(out);
  }
  std::string writeText(List elements) {
    Predicates in;
    append(elements, in);
    std::string out;
    write(in, out);
    return out;
  }
  int decimals_ = 2, maxDepth_ = 64, maxTokens_ = 65536;
};

}  // namespace spark

SPARK_PLUGIN("parser-sexp", "1.0", "S-expressions between bytes and predicates.", spark::SexpParser)
