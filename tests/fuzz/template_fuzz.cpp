// The reader of templates, run on arbitrary texts. For any input, it is no template, or is cut into pieces that lie in
// the text one behind the other, and into a program with a place in the text for each line; what the program writes has
// places in the text; and the fields become JSON. Or the reader throws an Error.

#include <cstdint>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>

#include "../../plugins/scene-webots/syntax.h"
#include "../../plugins/scene-webots/template_fields.h"

using namespace spark;

namespace {

void check(bool holds) {
  if (!holds) std::abort();
}

void checkTemplate(const mjcf::File& file, const webots::Template& text) {
  std::size_t at = 0;
  for (const auto& piece : text.pieces) {
    check(piece.offset >= at && piece.offset + piece.size <= file.text.size());
    at = piece.offset + piece.size;
  }
  std::size_t lines = 1;
  for (const char c : text.program) lines += c == '\n' ? 1 : 0;
  check(lines == text.lines.size());
  for (const std::size_t offset : text.lines) check(offset <= file.text.size());
  webots::Expansion out;
  for (std::size_t i = 0; i < text.pieces.size(); ++i) check(text.add(out, file, i, "1 \"a\" "));
  check(!text.add(out, file, text.pieces.size(), ""));
  for (std::size_t i = 0; i <= out.text.size(); ++i) check(out.offsetOf(i) <= file.text.size());
  try {
    for (const auto& node : webots::parsedNode(file, out).nodes)
      for (const auto& field : node->fields) webots::valueFor(*field.value, "");
  } catch (const Error&) {
    // Most pieces are no nodes.
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  mjcf::File file;
  file.name = "a.proto";
  file.text.assign(reinterpret_cast<const char*>(data), size);
  try {
    for (const auto& proto : webots::parsed(file).protos) {
      for (const auto& field : proto->fields) webots::valueFor(*field.value, field.type).dump();
      if (proto->text) checkTemplate(file, *proto->text);
    }
  } catch (const Error&) {
    // Most inputs are invalid.
  } catch (const nlohmann::json::type_error&) {
    // A text that is no UTF-8.
  }
  return 0;
}
