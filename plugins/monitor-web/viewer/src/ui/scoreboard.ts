/// The score board: team names, score, clock and play mode.
import type { World } from "../model";
import { modeName, modeSide, modeWords } from "../sources";
import { h, setAttribute, setText } from "./dom";
import { clock, half, numberOf, teamTitle } from "./format";

export class Scoreboard {
  private readonly left = h("span", { "data-testid": "team-left" });
  private readonly right = h("span", { "data-testid": "team-right" });
  private readonly goalsLeft = h("span", { "data-testid": "score-left", class: "number" }, "–");
  private readonly goalsRight = h("span", { "data-testid": "score-right", class: "number" }, "–");
  private readonly clock = h("span", { "data-testid": "clock", class: "clock number" }, "0:00");
  private readonly half = h("span", { "data-testid": "half", class: "dim" });
  private readonly mode = h("span", { "data-testid": "play-mode", class: "mode" });
  readonly element = h(
    "section",
    { class: "scoreboard card", "data-testid": "scoreboard", "aria-label": "Score board" },
    h("div", { class: "team left" }, this.left),
    h("div", { class: "goals" }, this.goalsLeft, h("i", {}, ":"), this.goalsRight),
    h("div", { class: "team right" }, this.right),
    h("div", { class: "match" }, this.half, this.clock, this.mode),
  );
  private seen = -1;
  private world: World | null = null;

  update(world: World): void {
    if (this.world === world && this.seen === world.versions.environment) return;
    this.world = world;
    this.seen = world.versions.environment;
    const environment = world.environment;
    const hasMode = environment.has("play_mode");
    const known = hasMode || environment.has("score_left");
    const mode = modeName(environment);
    setText(this.left, teamTitle(environment, "left"));
    setText(this.right, teamTitle(environment, "right"));
    setText(this.goalsLeft, known ? String(numberOf(environment, "score_left", 0)) : "–");
    setText(this.goalsRight, known ? String(numberOf(environment, "score_right", 0)) : "–");
    setText(this.clock, clock(numberOf(environment, "time", 0)));
    setText(this.half, half(numberOf(environment, "half", 0)));
    setText(this.mode, hasMode ? modeWords(mode, environment) : known ? "" : "No match yet");
    setAttribute(this.mode, "data-mode", mode);
    setAttribute(this.mode, "data-side", modeSide(mode) ?? "none");
  }
}
