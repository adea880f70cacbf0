#include "api/agents.h"
#include "spark/describe.h"
#include "spark/plugin.h"
#include "spark/read_message.h"

namespace spark {

/// The language of SimSpark's agents: S-expressions.
class SexpParser : public Leaf, public IParser {
  SPARK_CLASS(SexpParser, Leaf)
 public:
  static void describe(Description<SexpParser>& d) {
    d.doc("Reads and writes S-expressions as SimSpark does.");
    d.property("decimals", &SexpParser::decimals_)
        .range(-1, 9)
        .doc(
            "Decimals of numbers that are not integers; the mainline server has 2, the SPL build 3. -1: as many digits "
            "as it takes to read back the same number.");
    d.property("maxDepth", &SexpParser::maxDepth_).range(1, 1000).doc("Messages with deeper nesting are refused.");
    d.property("maxTokens", &SexpParser::maxTokens_).range(1, 1e6).doc("Longer messages are refused.");
    d.method("parse", &SexpParser::parseText)
        .parameters({"text"})
        .doc("Parses a text; returns its top-level elements without those that have a mistake.");
    d.method("write", &SexpParser::writeText)
        .parameters({"elements"})
        .doc("Writes a list of top-level elements as a message.");
    d.implements<IParser>();
  }

  ReadResult parse(std::string_view message, Predicates& out) override {
    return readMessage(message, out,
                       {static_cast<std::uint32_t>(maxDepth_), static_cast<std::uint32_t>(maxTokens_), false});
  }
  void write(const Predicates& predicates, std::string& out) override {
    writeSexp(predicates, decimals_, out, kLateClocks);
  }

 private:
  List parseText(const std::string& text) {
    Predicates out;
    parse(text, out);
    return toList(out);
  }
  std::string writeText(const List& elements) {
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
