/// A list of the robots of both teams, for selection.
import type { Robot } from "../model";
import type { App } from "./app";
import { h, setAttribute, setHidden, setText } from "./dom";
import { teamTitle } from "./format";
import { icon } from "./icons";
import { distance, placeOf } from "./places";

/// Orders by side (left, right, none), then by number.
export function inOrder(robots: readonly Robot[]): Robot[] {
  const rank = (r: Robot) => (r.side === "left" ? 0 : r.side === "right" ? 1 : 2);
  return [...robots].sort((a, b) => rank(a) - rank(b) || a.number - b.number || a.node - b.node);
}

/// The next (1) or previous (-1) robot of the list, wrapping around; the first one if none is selected.
export function neighbourOf(robots: readonly Robot[], key: string | null, direction: 1 | -1): Robot | null {
  const order = inOrder(robots);
  const at = order.findIndex((r) => r.key === key);
  if (order.length === 0) return null;
  return at < 0 ? order[direction > 0 ? 0 : order.length - 1]! : order[(at + direction + order.length) % order.length]!;
}

export interface PlayerActions {
  select(robot: Robot): void;
  headCamera(): void;
  inspect(): void;
}

export class PlayersPanel {
  private readonly list = h("div", { class: "teams", role: "listbox", "aria-label": "Players", "data-testid": "robot-list" });
  private readonly empty = h("p", { class: "empty" }, "No robots yet. They appear here when agents connect.");
  private readonly actions: HTMLElement;
  private rows: { robot: Robot; row: HTMLElement; far: HTMLElement }[] = [];
  private shown = "";

  constructor(container: HTMLElement, private readonly app: App, private readonly does: PlayerActions) {
    const button = (testid: string, picture: "head" | "inspect", text: string, run: () => void) =>
      h("button", { type: "button", class: "button", "data-testid": testid, onclick: run }, icon(picture), text);
    this.actions = h("div", { class: "actions" }, button("see-head", "head", "Its view", does.headCamera), button("see-inside", "inspect", "Inspect", does.inspect));
    container.append(this.empty, this.list, this.actions);
    this.list.addEventListener("keydown", (event) => this.roam(event));
  }

  /// A few times a second while the panel is open.
  update(): void {
    const { world } = this.app;
    const names = [teamTitle(world.environment, "left"), teamTitle(world.environment, "right")];
    const order = inOrder(world.robots);
    const now = [...names, ...order.map((r) => `${r.key} ${r.node}`)].join("\n");
    if (now !== this.shown) {
      this.shown = now;
      this.build(order, names);
    }
    this.mark();
    const ball = world.ball >= 0 ? placeOf(world, world.ball) : null;
    for (const { robot, far } of this.rows) setText(far, ball ? `${distance(placeOf(world, robot.torso), ball).toFixed(1)} m` : "");
  }

  private build(order: Robot[], names: string[]): void {
    const hadFocus = this.list.contains(document.activeElement);
    this.rows = [];
    this.list.replaceChildren();
    for (const side of ["left", "right", null] as const) {
      const robots = order.filter((r) => r.side === side);
      if (robots.length === 0) continue;
      const name = side === "left" ? names[0]! : side === "right" ? names[1]! : "No team yet";
      const group = h("div", { role: "group", "aria-label": name }, h("div", { class: "group-head", "aria-hidden": "true" }, h("i", { class: "swatch", "data-side": side }), h("span", {}, name)));
      for (const robot of robots) group.append(this.row(robot, name));
      this.list.append(group);
    }
    setHidden(this.empty, order.length > 0);
    if (hadFocus) this.rows.find((r) => r.robot.key === this.app.selection?.robot)?.row.focus();
  }

  private row(robot: Robot, team: string): HTMLElement {
    const far = h("span", { class: "number dim", title: "Distance to the ball" });
    const title = robot.number > 0 ? `${team} ${robot.number}` : "Robot";
    const row = h(
      "div",
      { class: "entry", role: "option", "data-testid": "robot-entry", "data-key": robot.key, "aria-label": title, "aria-selected": "false", tabindex: "-1", onclick: () => this.does.select(robot) },
      h("span", { class: "badge", "data-side": robot.side }, robot.number > 0 ? String(robot.number) : "?"),
      far,
    );
    this.rows.push({ robot, row, far });
    return row;
  }

  private mark(): void {
    const key = this.app.selection?.robot ?? null;
    const chosen = this.rows.some((r) => r.robot.key === key);
    for (const [i, { robot, row }] of this.rows.entries()) {
      setAttribute(row, "aria-selected", String(robot.key === key));
      setAttribute(row, "tabindex", (chosen ? robot.key === key : i === 0) ? "0" : "-1");
    }
    setHidden(this.actions, !chosen);
  }

  private roam(event: KeyboardEvent): void {
    const at = this.rows.findIndex((r) => r.row === document.activeElement);
    const beside = this.rows.findIndex((r, i) => i !== at && r.robot.side !== this.rows[at]?.robot.side && r.robot.number === this.rows[at]?.robot.number);
    const next = { ArrowDown: at + 1, ArrowUp: at - 1, ArrowLeft: beside, ArrowRight: beside, Home: 0, End: this.rows.length - 1, Enter: at, " ": at }[event.key];
    const row = next === undefined || at < 0 ? undefined : this.rows[next];
    if (next === undefined) return;
    event.preventDefault();
    if (!row) return;
    this.does.select(row.robot);
    this.mark();
    row.row.focus();
  }
}
