#include "format.h"

#include <fmt/format.h>

#include "spark/error.h"

namespace sparkbatch {

using spark::Error;

namespace {
/// A value as the text of a cell; "" for null.
std::string plain(const Json& value) {
  if (value.is_null()) return "";
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number_float()) return fmt::format("{}", value.get<double>());
  return value.dump();
}

/// Quotes a cell as in RFC 4180, but replaces control characters, so that a row is one line.
std::string cell(const std::string& text) {
  std::string out;
  bool quoted = false;
  for (const char c : text) {
    if (c == '\n')
      out += "\\n";
    else if (static_cast<unsigned char>(c) < 0x20)
      out += ' ';
    else if (c == '"')
      out += "\"\"";
    else
      out += c;
    quoted |= c == '"' || c == ',';
  }
  return quoted ? "\"" + out + "\"" : out;
}

/// A line of cells.
std::string joined(const std::vector<std::string>& cells) {
  std::string out;
  for (const std::string& c : cells) out += (out.empty() && &c == &cells.front() ? "" : ",") + cell(c);
  return out + "\n";
}

/// Splits a line into cells.
std::vector<std::string> cells(std::string_view line) {
  std::vector<std::string> out(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"')
      out.back() += line[i++];
    else if (line[i] == '"')
      quoted = !quoted;
    else if (line[i] == ',' && !quoted)
      out.emplace_back();
    else
      out.back() += line[i];
  }
  if (quoted) throw Error("a quote does not end");
  return out;
}

std::int64_t number(const std::string& text) {
  try {
    return std::stoll(text);
  } catch (const std::exception&) {
    throw Error(fmt::format("expected the number of a run, found '{}'", text));
  }
}

Row fromCsv(std::string_view line, const std::vector<std::string>& columns) {
  const std::vector<std::string> texts = cells(line);
  if (texts.size() != columns.size())
    throw Error(fmt::format("expected {} cells, found {}", columns.size(), texts.size()));
  Row row;
  for (std::size_t i = 0; i < texts.size(); ++i)
    if (!texts[i].empty()) row[columns[i]] = texts[i];
  row["run"] = number(row.value("run", ""));
  return row;
}
}  // namespace

Format::Format(const std::string& file) : csv_(file.ends_with(".csv")) {}

std::string Format::header(const std::vector<std::string>& columns) const { return csv_ ? joined(columns) : ""; }

std::string Format::line(const Row& row, const std::vector<std::string>& columns) const {
  if (!csv_) return row.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
  std::vector<std::string> texts;
  texts.reserve(columns.size());
  for (const std::string& c : columns) texts.push_back(row.contains(c) ? plain(row[c]) : "");
  return joined(texts);
}

std::vector<std::string> Format::columns(std::string_view header) const {
  return csv_ ? cells(header) : std::vector<std::string>{};
}

Row Format::row(std::string_view line, const std::vector<std::string>& columns) const {
  if (csv_) return fromCsv(line, columns);
  try {
    Row row = Json::parse(line);
    row.at("run").get<std::int64_t>();
    return row;
  } catch (const Json::exception& e) {
    throw Error("expected a JSON object with a run", e);
  }
}

}  // namespace sparkbatch
