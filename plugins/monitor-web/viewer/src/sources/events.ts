import type { Environment, GameEvent, Side, Value } from "../model";
import type { Entry } from "../codec/record";

/// Adds entries to an environment. A full message replaces all entries.
export function takeEntries(environment: Environment, entries: Entry[], full: boolean): void {
  if (full) environment.clear();
  for (const [name, ...values] of entries) if (!kOnce.has(name)) environment.set(name, values.length === 1 ? values[0]! : values);
}

export function isEntry(from: unknown): from is Entry {
  return Array.isArray(from) && typeof from[0] === "string";
}

/// Entries that are events, not state.
const kOnce = new Set(["foul", "messages", "sound"]);

/// Protocol names of play modes, by number, if a message does not contain its own list.
const kModes =
  "BeforeKickOff KickOff_Left KickOff_Right PlayOn KickIn_Left KickIn_Right corner_kick_left corner_kick_right goal_kick_left goal_kick_right offside_left offside_right GameOver Goal_Left Goal_Right free_kick_left free_kick_right direct_free_kick_left direct_free_kick_right pass_left pass_right".split(
    " ",
  );

const kModeWords: Record<string, string> = {
  beforekickoff: "Before kick-off",
  kickoff: "Kick-off",
  playon: "Play on",
  kickin: "Kick-in",
  cornerkick: "Corner kick",
  goalkick: "Goal kick",
  offside: "Offside",
  gameover: "Game over",
  goal: "Goal",
  freekick: "Free kick",
  directfreekick: "Direct free kick",
  pass: "Pass",
};

/// Fouls of the same player within this time are one foul [s].
const kSameFoul = 1;
const kFouls = ["crowding", "touching", "illegal defence", "illegal attack", "incapable", "illegal kick-off", "charging", "self collision", "ball holding", "double touching", "hand"];

/// The play mode's protocol name; "" if unknown.
export function modeName(environment: Environment): string {
  const mode = environment.get("play_mode");
  const names = environment.get("play_modes");
  if (typeof mode === "string") return mode;
  return typeof mode === "number" ? String((Array.isArray(names) ? names : kModes)[mode] ?? "") : "";
}

export function modeSide(name: string): Side | undefined {
  const side = /_(left|right)$/i.exec(name)?.[1];
  return side === undefined ? undefined : (side.toLowerCase() as Side);
}

/// The display text of a mode: "Corner kick for Red".
export function modeWords(name: string, environment: Environment): string {
  const side = modeSide(name);
  const plain = name.replace(/_(left|right)$/i, "");
  const words = kModeWords[plain.replace(/_/g, "").toLowerCase()] ?? plain.replace(/_/g, " ");
  if (side === undefined) return words;
  return `${words} ${words === "Offside" ? "of" : "for"} ${teamName(environment, side)}`;
}

/// The word for what a team scores: a goal, unless the game has modes of its own and none of them mentions goals or
/// kicks.
function pointWord(environment: Environment): string {
  const names = environment.get("play_modes");
  return Array.isArray(names) && !names.some((name) => /goal|kick/i.test(String(name))) ? "Point" : "Goal";
}

/// "Red", or "left" while the team has no name.
export function teamName(environment: Environment, side: Side): string {
  const name = environment.get(`team_${side}`);
  return name === undefined || name === "" ? side : String(name);
}

/// Detects events by comparing successive environments.
export class EventReader {
  private score: Record<Side, number | null> = { left: null, right: null };
  private mode: string | null = null;
  /// Time when each foul was last received. While a player is held, its foul is repeated in every message.
  private readonly fouls = new Map<string, number>();

  /// `environment` already contains these entries; `entries` are searched for fouls. `time` [s] may be of any clock,
  /// but the same for all calls.
  take(environment: Environment, entries: Entry[], time: number): GameEvent[] {
    const events: GameEvent[] = [];
    for (const entry of entries) if (entry[0] === "foul") this.takeFoul(foul(entry, environment, time), events);
    for (const side of ["left", "right"] as const) {
      const score = environment.get(`score_${side}`);
      if (typeof score !== "number") continue;
      const before = this.score[side];
      this.score[side] = score;
      if (before !== null && score > before) events.push({ time, kind: "goal", text: `${pointWord(environment)} for ${teamName(environment, side)}`, side });
    }
    const mode = modeName(environment);
    const changed = this.mode !== null && mode !== "" && mode !== this.mode;
    if (mode !== "") this.mode = mode;
    // A goal is detected by the score.
    if (changed && !/^goal_(left|right)$/i.test(mode)) events.push(withSide({ time, kind: "mode", text: modeWords(mode, environment) }, modeSide(mode)));
    return events;
  }

  private takeFoul(event: GameEvent, events: GameEvent[]): void {
    const before = this.fouls.get(event.text);
    this.fouls.set(event.text, event.time);
    if (before === undefined || Math.abs(event.time - before) > kSameFoul) events.push(event);
  }
}

/// Parses (foul index type team number); older logs have no index.
function foul(entry: Entry, environment: Environment, time: number): GameEvent {
  const values = entry.slice(entry.length > 4 ? 2 : 1) as Value[];
  const what = kFouls[Number(values[0])] ?? "unknown";
  const side: Side | undefined = values[1] === 1 || values[1] === "left" ? "left" : values[1] === 2 || values[1] === "right" ? "right" : undefined;
  const who = side === undefined ? "" : ` of ${teamName(environment, side)} ${values[2] ?? ""}`.trimEnd();
  return withSide({ time, kind: "foul", text: `Foul: ${what}${who}` }, side);
}

function withSide(event: GameEvent, side: Side | undefined): GameEvent {
  return side === undefined ? event : { ...event, side };
}
