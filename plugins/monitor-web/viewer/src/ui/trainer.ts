/// Builds the referee's commands in the format of the host. Empty fields are null; if a required field is missing, an
/// error names it.
import type { Side } from "../model";

export class Incomplete extends Error {}

const kLargest = 1e6;

/// The typed number; null if the field is empty.
export function typed(text: string, name: string): number | null {
  const trimmed = text.trim().replace(",", ".");
  if (trimmed === "") return null;
  const value = Number(trimmed);
  if (!Number.isFinite(value) || Math.abs(value) > kLargest) throw new Incomplete(`${name}: a number is expected, not "${text}"`);
  return value;
}

function needed(value: number | null, name: string): number {
  if (value === null) throw new Incomplete(`${name} is missing`);
  return value;
}

function natural(value: number | null, name: string): number {
  const number = needed(value, name);
  if (!Number.isInteger(number) || number < 0) throw new Incomplete(`${name}: 0, 1, 2 ... is expected`);
  return number;
}

/// Formats with at most three decimals (millimetres).
const shown = (value: number) => String(Number(value.toFixed(3)));
const sideWord = (side: Side) => (side === "left" ? "Left" : "Right");

export interface Who {
  side: Side;
  number: number;
}

const whoText = ({ side, number }: Who) => `(unum ${number})(team ${sideWord(side)})`;

export const kickOff = (side: Side) => `(kickOff ${sideWord(side)})`;
export const dropBall = () => "(dropBall)";
export const playMode = (name: string) => `(playMode ${name})`;
export const kill = (who: Who) => `(kill ${whoText(who)})`;
export const repos = (who: Who) => `(repos ${whoText(who)})`;

/// Places the ball at a position, at rest.
export function moveBall(x: number | null, y: number | null, z: number | null): string {
  const place = [needed(x, "x"), needed(y, "y"), needed(z, "z")].map(shown).join(" ");
  return `(ball (pos ${place})(vel 0 0 0))`;
}

/// Places a player at a position, and with an angle [deg] also rotates it.
export function movePlayer(who: Who, x: number | null, y: number | null, z: number | null, angleDeg: number | null): string {
  const place = [needed(x, "x"), needed(y, "y"), needed(z, "z")].map(shown).join(" ");
  return `(agent ${whoText(who)}${angleDeg === null ? `(pos ${place})` : `(move ${place} ${shown(angleDeg)})`})`;
}

export function score(left: number | null, right: number | null): string {
  return `(score (left ${natural(left, "left score")})(right ${natural(right, "right score")}))`;
}

/// Game time: seconds, or minutes and seconds as "4:30".
export function time(text: string): string {
  const parts = /^\s*(\d+):([0-5]?\d(?:\.\d+)?)\s*$/.exec(text);
  const seconds = parts ? Number(parts[1]) * 60 + Number(parts[2]) : needed(typed(text, "time"), "time");
  if (seconds < 0) throw new Incomplete("time: 0 or more is expected");
  return `(time ${shown(seconds)})`;
}

/// A command typed by the user. Enclosing parentheses are added if they are missing; they must be balanced.
export function raw(text: string): string {
  const trimmed = text.trim();
  if (trimmed === "") throw new Incomplete("type a command, such as (dropBall)");
  const whole = trimmed.startsWith("(") ? trimmed : `(${trimmed})`;
  let depth = 0;
  for (const character of whole) {
    if (character === "(") ++depth;
    if (character === ")" && --depth < 0) break;
  }
  if (depth !== 0) throw new Incomplete("parentheses do not match");
  return whole;
}
