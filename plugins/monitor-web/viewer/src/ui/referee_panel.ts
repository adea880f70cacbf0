/// The referee's console with all trainer commands, preceded by the input field for the token.
import type { Side } from "../model";
import { modeName, modeWords } from "../sources";
import type { App } from "./app";
import { h, setAttribute, setHidden, setText } from "./dom";
import { modeNames, numberOf, teamTitle } from "./format";
import { icon } from "./icons";
import { placeOf, type Point } from "./places";
import { inOrder } from "./players_panel";
import { RuleSwitches } from "./rule_switches";
import * as trainer from "./trainer";

export interface RefereeActions {
  login(token: string): Promise<boolean>;
  /// Waits for a click on the field; null if it was cancelled.
  pick(what: string): Promise<Point | null>;
}

/// A second press within this time removes the agent [ms].
const kArmedFor = 3000;
/// A command without effect on the match after this time has failed [ms].
const kPatience = 2500;

function numberField(testid: string, text: string, value = ""): { label: HTMLElement; name: HTMLElement; input: HTMLInputElement } {
  const name = h("span", {}, text);
  const input = h("input", { class: "field number", type: "text", inputmode: "decimal", autocomplete: "off", "data-testid": testid, value });
  return { label: h("label", { class: "labelled" }, name, input), name, input };
}

export class RefereePanel {
  private readonly absent = h("p", { class: "empty" }, "The referee's console works in a live match.");
  private readonly token = h("input", { class: "field", type: "password", autocomplete: "off", spellcheck: "false", "data-testid": "token-field", id: "token-field" });
  private readonly loginMessage = h("p", { class: "dim", role: "status", "data-testid": "login-message" });
  private readonly login: HTMLFormElement;
  private readonly console: HTMLElement;
  private readonly message = h("div", { class: "answer", role: "status", "data-testid": "referee-message" }, "Commands and the host's answers appear here.");

  private readonly kickLeft = h("span", {}, "Left");
  private readonly kickRight = h("span", {}, "Right");
  private readonly modes = h("select", { class: "field", "data-testid": "mode-select", "aria-label": "Play mode" });
  private readonly players = h("select", { class: "field", "data-testid": "player-select", "aria-label": "Player" });
  private readonly ball = { x: numberField("ball-x", "x [m]", "0"), y: numberField("ball-y", "y [m]", "0"), z: numberField("ball-z", "z [m]", "0.05") };
  private readonly player = {
    x: numberField("player-x", "x [m]"),
    y: numberField("player-y", "y [m]"),
    z: numberField("player-z", "z [m]"),
    angle: numberField("player-angle", "Turn [°]"),
  };
  private readonly score = { left: numberField("score-left-field", "Left"), right: numberField("score-right-field", "Right") };
  private readonly time = h("input", { class: "field number", type: "text", autocomplete: "off", "data-testid": "time-field", placeholder: "m:ss" });
  private readonly raw = h("input", { class: "field", type: "text", autocomplete: "off", spellcheck: "false", "data-testid": "command-field", "aria-label": "Trainer's command", placeholder: "(playMode PlayOn)" });
  private readonly rules = new RuleSwitches((text, ok) => this.say(text, ok));
  private awaited: { what: string; done: () => boolean; until: number | null } | null = null;
  private shownModes = "";
  private shownPlayers = "";
  private shownScore = "";

  constructor(container: HTMLElement, private readonly app: App, private readonly does: RefereeActions) {
    container.classList.add("padded");
    this.login = h(
      "form",
      { class: "login", "data-testid": "referee-login", onsubmit: (event: SubmitEvent) => void this.tryLogin(event) },
      h("p", { class: "dim" }, "The host prints a token when it starts. Who has it may referee; everybody else watches."),
      h("label", { class: "labelled", for: "token-field" }, "Token"),
      h("div", { class: "line" }, this.token, h("button", { type: "submit", class: "button main", "data-testid": "token-submit" }, "Referee")),
      this.loginMessage,
    );
    this.console = h(
      "div",
      { class: "console", "data-testid": "referee-console", hidden: true },
      this.restarts(),
      this.modeSection(),
      this.ballSection(),
      this.playerSection(),
      this.scoreSection(),
      this.section("Rules", this.rules.element),
      this.rawSection(),
      h("div", { class: "stuck" }, this.message),
    );
    container.append(this.absent, this.login, this.console);
  }

  /// A few times a second while the panel is open.
  update(): void {
    const { live, world } = this.app;
    const referee = live?.referee ?? false;
    setHidden(this.absent, live !== null);
    setHidden(this.login, live === null || referee);
    setHidden(this.console, !referee);
    if (!referee) return;
    const { environment } = world;
    setText(this.kickLeft, teamTitle(environment, "left"));
    setText(this.kickRight, teamTitle(environment, "right"));
    setText(this.score.left.name, teamTitle(environment, "left"));
    setText(this.score.right.name, teamTitle(environment, "right"));
    this.listModes();
    this.listPlayers();
    this.showScore();
    this.rules.update(live!, performance.now());
  }

  kickOff(side: Side): void {
    void this.send(`Kick-off for ${teamTitle(this.app.world.environment, side)}`, () => trainer.kickOff(side), () => this.modeIs(side === "left" ? "KickOff_Left" : "KickOff_Right", "PlayOn"));
  }

  dropBall(): void {
    void this.send("Drop ball", trainer.dropBall, () => this.modeIs("PlayOn"));
  }

  private async tryLogin(event: SubmitEvent): Promise<void> {
    event.preventDefault();
    const token = this.token.value.trim();
    if (token === "") return setText(this.loginMessage, "Type the token that the host printed.");
    setText(this.loginMessage, "Asking the host ...");
    const taken = await this.does.login(token).catch(() => false);
    setAttribute(this.token, "aria-invalid", taken ? null : "true");
    setText(this.loginMessage, taken ? "" : "The host does not know this token.");
    if (taken) this.token.value = "";
    this.update();
  }

  /// Call it ten times a second: checks whether commands have taken effect.
  follow(now: number): void {
    const { awaited } = this;
    if (!awaited) return;
    awaited.until ??= now + kPatience;
    const done = awaited.done();
    if (!done && now < awaited.until) return;
    this.awaited = null;
    this.say(done ? `${awaited.what}: done.` : `${awaited.what}: sent, but the match did not follow.`, done);
  }

  /// Sends the command that `build` returns and reports the result; `what` describes the command. The host does not
  /// report the effect of a command, so the panel waits until `done` recognizes it from the match, if given.
  private async send(what: string, build: () => string, done?: () => boolean): Promise<void> {
    this.awaited = null;
    try {
      const text = build();
      this.say(`${what} ...`, null);
      await this.app.live?.command(text);
      if (done) this.awaited = { what, done, until: null };
      else this.say(`${what}: sent.`, true);
    } catch (error) {
      const why = error instanceof Error ? error.message : String(error);
      this.say(error instanceof trainer.Incomplete ? why : `${what}: refused, ${why}`, false);
    }
  }

  private modeIs(...names: string[]): boolean {
    return names.includes(modeName(this.app.world.environment));
  }

  private say(text: string, ok: boolean | null): void {
    setText(this.message, text);
    setAttribute(this.message, "data-ok", ok === null ? null : String(ok));
  }

  private section(title: string, ...children: HTMLElement[]): HTMLElement {
    return h("section", {}, h("h3", {}, title), ...children);
  }

  private button(testid: string, text: string, run: () => void): HTMLButtonElement {
    return h("button", { type: "button", class: "button", "data-testid": testid, onclick: run }, text);
  }

  private restarts(): HTMLElement {
    const kick = (side: Side, name: HTMLElement) =>
      h("button", { type: "button", class: `button kick ${side}`, "data-testid": `kickoff-${side}`, onclick: () => this.kickOff(side) }, name);
    return this.section("Kick-off", h("div", { class: "line" }, kick("left", this.kickLeft), this.button("drop-ball", "Drop ball", () => this.dropBall()), kick("right", this.kickRight)));
  }

  private modeSection(): HTMLElement {
    const set = () => {
      const name = this.modes.value;
      void this.send(modeWords(name, this.app.world.environment), () => trainer.playMode(name), () => this.modeIs(name));
    };
    return this.section("Play mode", h("div", { class: "line" }, this.modes, this.button("mode-set", "Set", set)));
  }

  private ballSection(): HTMLElement {
    const { x, y, z } = this.ball;
    const move = () => void this.send("Move the ball", () => trainer.moveBall(trainer.typed(x.input.value, "x"), trainer.typed(y.input.value, "y"), trainer.typed(z.input.value, "z")));
    const pick = async () => {
      const place = await this.does.pick("Click where the ball shall lie");
      if (!place) return;
      this.fill(place, x.input, y.input);
      z.input.value = String(numberOf(this.app.world.environment, "BallRadius", 0.042));
      move();
    };
    return this.section(
      "Ball",
      h("div", { class: "line" }, x.label, y.label, z.label),
      h("div", { class: "line" }, this.button("ball-move", "Move", move), this.picker("ball-pick", () => void pick())),
    );
  }

  private playerSection(): HTMLElement {
    const { x, y, z, angle } = this.player;
    const who = (): trainer.Who => {
      const robot = this.app.world.robots.find((r) => r.key === this.players.value);
      if (!robot?.side) throw new trainer.Incomplete("choose a player");
      return { side: robot.side, number: robot.number };
    };
    const name = () => this.players.selectedOptions[0]?.textContent ?? "Player";
    // without a height, the player keeps its own
    const height = () => trainer.typed(z.input.value, "z") ?? this.heightOf(this.players.value);
    const move = () =>
      void this.send(`Move ${name()}`, () => trainer.movePlayer(who(), trainer.typed(x.input.value, "x"), trainer.typed(y.input.value, "y"), height(), trainer.typed(angle.input.value, "turn")));
    const pick = async () => {
      const place = await this.does.pick(`Click where ${name()} shall stand`);
      if (!place) return;
      this.fill(place, x.input, y.input);
      move();
    };
    z.input.placeholder = "as now";
    angle.input.placeholder = "as now";
    const aside = this.button("player-repos", "Put aside", () => void this.send(`Put ${name()} aside`, () => trainer.repos(who())));
    return this.section(
      "Player",
      this.players,
      h("div", { class: "line" }, x.label, y.label, z.label, angle.label),
      h("div", { class: "line" }, this.button("player-move", "Move", move), this.picker("player-pick", () => void pick())),
      h("div", { class: "line" }, aside, this.removal(() => void this.send(`Remove ${name()}`, () => trainer.kill(who())))),
    );
  }

  private scoreSection(): HTMLElement {
    const { left, right } = this.score;
    const goals = () => [trainer.typed(left.input.value, "left score"), trainer.typed(right.input.value, "right score")] as const;
    const shown = (side: Side) => numberOf(this.app.world.environment, `score_${side}`, 0);
    const set = () => void this.send("Score", () => trainer.score(...goals()), () => goals()[0] === shown("left") && goals()[1] === shown("right"));
    const setTime = () => void this.send("Game time", () => trainer.time(this.time.value));
    return this.section(
      "Score and time",
      h("div", { class: "line" }, left.label, right.label, this.button("score-set", "Set score", set)),
      h("div", { class: "line" }, h("label", { class: "labelled" }, "Game time", this.time), this.button("time-set", "Set time", setTime)),
    );
  }

  private rawSection(): HTMLElement {
    const send = (event: SubmitEvent) => {
      event.preventDefault();
      void this.send(this.raw.value.trim() || "Command", () => trainer.raw(this.raw.value));
    };
    const form = h("form", { class: "line", onsubmit: send }, this.raw, h("button", { type: "submit", class: "button", "data-testid": "command-send" }, "Send"));
    return this.section("Any command", form);
  }

  private picker(testid: string, run: () => void): HTMLElement {
    return h("button", { type: "button", class: "button", "data-testid": testid, onclick: run }, icon("target"), "Pick on the field");
  }

  /// Removing an agent cannot be undone, so it needs a second press.
  private removal(run: () => void): HTMLElement {
    const button = h("button", { type: "button", class: "button careful", "data-testid": "player-kill" }, "Remove");
    const disarm = () => {
      setAttribute(button, "data-armed", null);
      setText(button, "Remove");
    };
    button.addEventListener("click", () => {
      const armed = button.hasAttribute("data-armed");
      disarm();
      if (armed) return run();
      setAttribute(button, "data-armed", "");
      setText(button, "Really remove?");
      window.setTimeout(disarm, kArmedFor);
    });
    button.addEventListener("blur", disarm);
    return button;
  }

  private fill([px, py]: Point, x: HTMLInputElement, y: HTMLInputElement): void {
    x.value = px.toFixed(2);
    y.value = py.toFixed(2);
  }

  private heightOf(key: string): number | null {
    const robot = this.app.world.robots.find((r) => r.key === key);
    return robot ? placeOf(this.app.world, robot.torso)[2] : null;
  }

  private listModes(): void {
    const { environment } = this.app.world;
    const names = modeNames(environment);
    const texts = names.map((n) => modeWords(n, environment));
    if (texts.join("\n") === this.shownModes) return;
    const kept = this.modes.value || modeName(environment);
    this.shownModes = texts.join("\n");
    this.modes.replaceChildren(...names.map((name, i) => h("option", { value: name }, texts[i]!)));
    if (names.includes(kept)) this.modes.value = kept;
  }

  /// Follows the selection in the picture.
  private listPlayers(): void {
    const { environment, robots } = this.app.world;
    const players = inOrder(robots).filter((r) => r.side !== null);
    const texts = players.map((r) => `${teamTitle(environment, r.side!)} ${r.number}`);
    const selected = this.app.selection?.robot ?? "";
    const now = [selected, ...texts].join("\n");
    if (now === this.shownPlayers) return;
    this.shownPlayers = now;
    const kept = selected || this.players.value;
    this.players.replaceChildren(...players.map((r, i) => h("option", { value: r.key }, texts[i]!)));
    if (players.some((r) => r.key === kept)) this.players.value = kept;
  }

  /// The input fields show the score until the user edits them.
  private showScore(): void {
    const { environment } = this.app.world;
    const goals = [numberOf(environment, "score_left", 0), numberOf(environment, "score_right", 0)].map(String);
    if (goals.join() === this.shownScore) return;
    this.shownScore = goals.join();
    this.score.left.input.value = goals[0]!;
    this.score.right.input.value = goals[1]!;
  }
}
