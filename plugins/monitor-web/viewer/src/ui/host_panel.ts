/// Status of the host: speed, spectators, latency of agents, the log; also the frame rate of this viewer.
import type { Status } from "../model";
import type { App } from "./app";
import { h, setHidden, setText } from "./dom";
import { count, factor, latency } from "./format";
import { LogView } from "./log_view";

type Agent = Status["agents"][number];

/// The team that an agent's status refers to, by side or by name.
function sideOf(team: string, app: App): string | null {
  const lower = team.toLowerCase();
  if (lower === "left" || lower === "right") return lower;
  if (team !== "" && team === app.world.environment.get("team_left")) return "left";
  return team !== "" && team === app.world.environment.get("team_right") ? "right" : null;
}

export class HostPanel {
  private readonly facts = new Map<string, HTMLElement>();
  private readonly list = h("dl", { class: "facts" });
  private readonly body = h("tbody");
  private readonly table = h(
    "table",
    { class: "latencies", "data-testid": "latency-table" },
    h("caption", {}, "Agents"),
    h("thead", {}, h("tr", {}, h("th", { scope: "col" }, "Agent"), h("th", { scope: "col", title: "Wall time from its percepts to its answer" }, "Answers after"))),
    this.body,
  );
  private readonly log = new LogView();
  private rows = new Map<string, { row: HTMLElement; cell: HTMLElement }>();

  constructor(container: HTMLElement, private readonly app: App) {
    container.classList.add("padded");
    container.append(this.list, this.table, this.log.element);
  }

  /// Call it about once a second. `frameRate`: pictures per second of this viewer.
  update(connection: string, frameRate: number): void {
    const status = this.app.live?.status ?? null;
    this.fact("Source", connection);
    this.fact("Real-time factor", status ? factor(status.realTimeFactor) : "–");
    this.fact("Spectators", status ? count(status.spectators, "viewer", "viewers") : "–");
    this.fact("Cycle", status ? status.cycle.toLocaleString("en") : "–");
    this.fact("Robots", String(this.app.world.robots.length));
    this.fact("Drawn here", `${frameRate.toFixed(0)} pictures/s`);
    for (const [name, value] of status?.facts ?? []) this.fact(name, value);
    this.agents(status?.agents ?? []);
    this.log.update(this.app.live, performance.now());
  }

  private fact(name: string, value: string): void {
    let cell = this.facts.get(name);
    if (!cell) {
      cell = h("dd", { class: "number" });
      this.facts.set(name, cell);
      this.list.append(h("dt", {}, name), cell);
    }
    setText(cell, value);
  }

  private agents(agents: readonly Agent[]): void {
    setHidden(this.table, agents.length === 0);
    const keys = agents.map((a) => `${a.path} ${a.team} ${a.number}`);
    if (keys.join("\n") !== [...this.rows.keys()].join("\n")) this.build(agents, keys);
    agents.forEach((a, i) => setText(this.rows.get(keys[i]!)!.cell, latency(a.latency)));
  }

  private build(agents: readonly Agent[], keys: string[]): void {
    this.rows = new Map();
    agents.forEach((a, i) => {
      const cell = h("td", { class: "number" });
      const who = h("div", { class: "who" }, h("i", { class: "swatch", "data-side": sideOf(a.team, this.app) }), `${a.team || "No team"} ${a.number > 0 ? a.number : ""}`.trim());
      this.rows.set(keys[i]!, { row: h("tr", { "data-testid": "latency-row", "data-path": a.path }, h("td", {}, who), cell), cell });
    });
    this.body.replaceChildren(...[...this.rows.values()].map((r) => r.row));
  }
}
