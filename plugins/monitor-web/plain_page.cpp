#include "plain_page.h"

#include <fmt/format.h>

namespace spark::web {

namespace {
/// Escapes text for HTML.
std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '<')
      out += "&lt;";
    else if (c == '&')
      out += "&amp;";
    else
      out += c;
  }
  return out;
}
}  // namespace

std::string plainPage(std::string_view missing) {
  return fmt::format(R"(<!doctype html>
<html lang="en">
<meta charset="utf-8">
<meta name="viewport" content="width=device-width">
<title>Spark</title>
<style>
  :root {{ color-scheme: light dark; font: 1.1rem/1.5 system-ui, sans-serif }}
  body {{ max-width: 40rem; margin: 2rem auto; padding: 0 1rem }}
  table {{ border-spacing: 1rem .2rem; margin-left: -1rem; font-variant-numeric: tabular-nums }}
  td:first-child {{ opacity: .7 }}
</style>
<h1>Spark</h1>
<table id="numbers"><tr><td>waiting for the host</table>
<p>The viewer was not built{}{}. Build it with <code>tools/play</code>, which installs what it needs, or with
<code>cmake --build --preset release --target viewer</code>, and load this page again.
<script src="plain.js"></script>
</html>
)",
                     missing.empty() ? "" : ": missing is ", escaped(missing));
}

const char* const kPlainScript = R"(const table = document.getElementById("numbers");
const shown = {
  "simulated time": s => s.time.toFixed(1) + " s",
  "real-time factor": s => s.realTimeFactor.toFixed(2),
  "play mode": s => s.playMode ?? "",
  "score": s => s.score ? s.score.join(" : ") : "",
  "agents": s => s.agents.length,
  "spectators": s => s.spectators,
};
async function refresh() {
  try {
    const status = await (await fetch("status.json", { cache: "no-store" })).json();
    const others = (status.status ?? []).map(([name, value]) => [name, () => [value].flat().join(" ")]);
    if (status.teams) others.unshift(["teams", () => status.teams.join(" : ")]);
    const rows = [...Object.entries(shown), ...others].map(([name, text]) => {
      const row = document.createElement("tr");
      for (const cell of [name, status.time === undefined ? "" : text(status)]) row.insertCell().textContent = cell;
      return row;
    });
    table.replaceChildren(...rows);
  } catch (e) {
    table.textContent = "the host does not answer";
  }
}
refresh();
setInterval(refresh, 1000);
)";

}  // namespace spark::web
