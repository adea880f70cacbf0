/// Status of the host: speed, spectators, latency and think time of agents, the log; also the frame rate of this viewer.
import type { AgentStatus, Thinking } from "../model";
import type { App } from "./app";
import { h, setHidden, setText } from "./dom";
import { count, factor, latency, steps } from "./format";
import { LogView } from "./log_view";

/// A column of the agents' table.
interface Column {
  title: string;
  hint: string;
  /// The value of an agent, and below it what it is in other words. `step`: simulated time of a step [s].
  of(agent: AgentStatus, step: number): [string, string?];
}

const kAnswers: Column = { title: "Answers after", hint: "Wall time from its percepts to its answer", of: (agent) => [latency(agent.latency)] };
const kThinking: readonly Column[] = [
  inSteps("Thought", "How long its last thought took, in steps and in simulated time", (t) => t.last),
  inSteps("Mean", "Mean of its recent thoughts", (t) => t.mean),
  inSteps("Sense", "Latency from sensing to the arrival of the sensation", (t) => t.senseLatency),
  inSteps("Act", "Latency from the end of a thought until its acts take effect", (t) => t.actLatency),
  { title: "Missed", hint: "Sensations that were dropped because it thought for too long", of: ({ thinking }) => [thinking ? String(thinking.dropped) : "–"] },
];

function inSteps(title: string, hint: string, read: (thinking: Thinking) => number | null): Column {
  return {
    title,
    hint,
    of: ({ thinking }, step) => {
      const value = thinking && read(thinking);
      return value === null ? ["–"] : [steps(value), latency(value * step * 1000)];
    },
  };
}

/// The columns that these agents have values for.
export function columnsFor(agents: readonly AgentStatus[]): Column[] {
  return [...(agents.every((a) => a.thinking) ? [] : [kAnswers]), ...(agents.some((a) => a.thinking) ? kThinking : [])];
}

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
  private readonly units = h("span", { class: "dim" }, "steps, and simulated time");
  private readonly head = h("thead");
  private readonly body = h("tbody");
  private readonly table = h(
    "table",
    { class: "latencies", "data-testid": "latency-table" },
    h("caption", {}, "Agents", this.units),
    this.head,
    this.body,
  );
  private readonly log = new LogView();
  private rows: { value: HTMLElement; note: HTMLElement }[][] = [];
  private shown = "";

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
    this.agents(status?.agents ?? [], status?.step ?? NaN);
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

  private agents(agents: readonly AgentStatus[], step: number): void {
    setHidden(this.table, agents.length === 0);
    const columns = columnsFor(agents);
    const now = [...columns.map((c) => c.title), ...agents.map((a) => `${a.path} ${a.team} ${a.number}`)].join("\n");
    if (now !== this.shown) {
      this.shown = now;
      this.build(agents, columns);
    }
    agents.forEach((agent, i) =>
      columns.forEach((column, j) => {
        const [value, note = ""] = column.of(agent, step);
        setText(this.rows[i]![j]!.value, value);
        setText(this.rows[i]![j]!.note, note);
      }),
    );
  }

  private build(agents: readonly AgentStatus[], columns: readonly Column[]): void {
    const heads = columns.map(({ title, hint }) => h("th", { scope: "col", title: hint }, title));
    setHidden(this.units, !agents.some((a) => a.thinking));
    this.head.replaceChildren(h("tr", {}, h("th", { scope: "col" }, "Agent"), ...heads));
    this.rows = agents.map(() => columns.map(() => ({ value: h("div"), note: h("div", { class: "dim" }) })));
    const rows = agents.map((a, i) => {
      const who = h("div", { class: "who" }, h("i", { class: "swatch", "data-side": sideOf(a.team, this.app) }), `${a.team || "No team"} ${a.number > 0 ? a.number : ""}`.trim());
      const cells = this.rows[i]!.map(({ value, note }) => h("td", { class: "number" }, value, note));
      return h("tr", { "data-testid": "latency-row", "data-path": a.path }, h("td", {}, who), ...cells);
    });
    this.body.replaceChildren(...rows);
  }
}
