#include "see_reader.h"

#include <fmt/format.h>

#include <optional>

#include "long_names.h"

namespace spark::soccer {

namespace {
using Sightings = ISightReader::Sightings;

std::optional<ISightReader::Polar> polarIn(const Element& e) {
  if (!e || e.head() != "pol" || e.size() < 4) return std::nullopt;
  return ISightReader::Polar{e.at(1).number(), e.at(2).number(), e.at(3).number()};
}

void readThing(std::string name, const Element& polar, Sightings& out) {
  if (const auto at = polarIn(polar)) out.things.push_back({std::move(name), *at});
}

/// A player has one position, or one for each visible part.
void readPlayer(const Element& player, Sightings& out) {
  const Element team = player.named("team"), id = player.named("id");
  const std::string name = fmt::format("P {} {}", team ? team.at(1).text() : "", id ? id.at(1).integer() : 0);
  if (const Element whole = player.named("pol")) readThing(name, whole, out);
  for (const Element part : player)
    if (const Element polar = part.named("pol")) readThing(fmt::format("{} {}", name, part.head()), polar, out);
}

void readLine(const Element& line, Sightings& out) {
  const auto from = polarIn(line.at(1)), to = polarIn(line.at(2));
  if (from && to) out.lines.push_back({*from, *to});
}
}  // namespace

void SeeReader::read(const Element& see, Sightings& out) const {
  for (const Element e : see) {
    const std::string label = labelOf(e);
    if (label == "P")
      readPlayer(e, out);
    else if (label == "L")
      readLine(e, out);
    else if (const Element polar = e.named("pol"))
      readThing(label, polar, out);
  }
}

}  // namespace spark::soccer
