#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "api/agents.h"
#include "parser-json/json_reader.h"
#include "spark/describe.h"
#include "spark/numbers.h"
#include "spark/plugin.h"

namespace spark {

namespace {

/// True if the text needs no escapes in JSON.
bool isPlain(std::string_view text) {
  for (const unsigned char c : text)
    if (c < 0x20 || c > 0x7E || c == '"' || c == '\\') return false;
  return true;
}

/// Writes a character U+0000 to U+00FF for each byte.
void writeBytes(std::string_view bytes, ByteWriter& out) {
  out.put('"');
  for (const char c : bytes) {
    if (isPlain({&c, 1}))
      out.put(c);
    else
      out.put(fmt::format("\\u{:04x}", static_cast<unsigned char>(c)));
  }
  out.put('"');
}

/// How values are written.
struct Style {
  int decimals;
  bool binary;
};

void writeText(std::string_view text, const Style& style, ByteWriter& out) {
  if (!isPlain(text) && style.binary) return writeBytes(text, out);
  if (!isPlain(text))
    return out.put(nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  out.put('"');
  out.put(text);
  out.put('"');
}

void writeNumber(double v, int decimals, ByteWriter& out) {
  if (!std::isfinite(decimals < 0 ? v : static_cast<float>(v))) return out.put("null");
  if (decimals >= 0) return out.fixed(v, decimals, kLateClocks);
  char* to = out.room(kGeneralRoom);
  out.end(std::to_chars(to, to + kGeneralRoom, v).ptr);
}

void writeElement(const Element& e, const Style& style, ByteWriter& out) {
  const Token& t = e.token();
  switch (t.kind) {
    case Token::Kind::text:
      return writeText(e.text(), style, out);
    case Token::Kind::number:
      return writeNumber(t.number, style.decimals, out);
    case Token::Kind::integer:
      return out.integer(t.integer);
    case Token::Kind::list:
      break;
  }
  out.put('[');
  bool first = true;
  for (const Element inner : e) {
    if (!first) out.put(',');
    first = false;
    writeElement(inner, style, out);
  }
  out.put(']');
}

}  // namespace

/// The messages of SexpParser as JSON: `[["he1",1.2],["init",["number",7],["team","A"]]]`.
class JsonParser : public Leaf, public IParser {
  SPARK_CLASS(JsonParser, Leaf)
 public:
  static void describe(Description<JsonParser>& d) {
    d.doc("Reads and writes JSON that mirrors the S-expressions.");
    d.property("decimals", &JsonParser::decimals_)
        .range(-1, 9)
        .doc("Decimals of numbers that are not integers, as in S-expressions; -1: all digits.");
    d.property("binary", &JsonParser::binary_)
        .doc(
            "Texts are bytes, each a character U+0000 to U+00FF. Otherwise they are UTF-8, and what is not becomes "
            "U+FFFD.");
    d.property("maxDepth", &JsonParser::maxDepth_).range(1, 1000).doc("Messages with deeper nesting are refused.");
    d.property("maxTokens", &JsonParser::maxTokens_).range(1, 1e6).doc("Longer messages are refused.");
    d.method("parse", &JsonParser::parseText)
        .parameters({"text"})
        .doc("Parses a text; returns its top-level elements without those that have a mistake.");
    d.method("write", &JsonParser::writeText)
        .parameters({"elements"})
        .doc("Writes a list of top-level elements as a message.");
    d.implements<IParser>();
  }

  ReadResult parse(std::string_view message, Predicates& out) override {
    return json::read(message, out, {static_cast<std::uint32_t>(maxDepth_), static_cast<std::uint32_t>(maxTokens_)},
                      binary_);
  }
  void write(const Predicates& predicates, std::string& bytes) override {
    ByteWriter out(bytes);
    out.put('[');
    bool first = true;
    for (const Element e : predicates) {
      if (!first) out.put(',');
      first = false;
      writeElement(e, {decimals_, binary_}, out);
    }
    out.put(']');
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
  bool binary_ = false;
  int decimals_ = 2, maxDepth_ = 64, maxTokens_ = 65536;
};

}  // namespace spark

SPARK_PLUGIN("parser-json", "1.0", "JSON between bytes and predicates.", spark::JsonParser)
