/// Formats numbers and clocks for display.
import type { Environment, Side, Value } from "../model";
import { teamName } from "../sources";

/// "3:07"; never negative.
export function clock(seconds: number): string {
  const whole = Math.max(0, Math.floor(seconds + 1e-6));
  const rest = String(whole % 60).padStart(2, "0");
  return `${Math.floor(whole / 60)}:${rest}`;
}

/// "3 minutes 7 seconds", for screen readers.
export function spokenClock(seconds: number): string {
  const whole = Math.max(0, Math.floor(seconds + 1e-6));
  const count = (n: number, what: string) => `${n} ${what}${n === 1 ? "" : "s"}`;
  return whole < 60 ? count(whole, "second") : `${count(Math.floor(whole / 60), "minute")} ${count(whole % 60, "second")}`;
}

export function half(number: number): string {
  return number === 1 ? "1st half" : number === 2 ? "2nd half" : "";
}

/// "0.98×"; "–" while unknown.
export function factor(value: number | null | undefined): string {
  if (value == null || !Number.isFinite(value)) return "–";
  return `${value < 10 ? value.toFixed(2) : value < 100 ? value.toFixed(1) : value.toFixed(0)}×`;
}

/// "3.2 ms", "41 ms"; "–" while unknown.
export function latency(milliseconds: number | null): string {
  if (milliseconds == null || !Number.isFinite(milliseconds)) return "–";
  return `${milliseconds < 10 ? milliseconds.toFixed(1) : milliseconds.toFixed(0)} ms`;
}

/// A number of steps, "3", "2.6"; "–" while unknown.
export function steps(number: number | null): string {
  return number == null || !Number.isFinite(number) ? "–" : String(Number(number.toFixed(1)));
}

/// The playing speed, "0.5×".
export function speed(value: number): string {
  return `${Number(value.toFixed(2))}×`;
}

export function count(n: number, one: string, many: string): string {
  return `${n} ${n === 1 ? one : many}`;
}

function single(environment: Environment, key: string): Value | undefined {
  const value = environment.get(key);
  return Array.isArray(value) ? value[0] : value;
}

/// A number of the environment; `otherwise` if there is none.
export function numberOf(environment: Environment, key: string, otherwise: number): number {
  const value = single(environment, key);
  const number = value === undefined || value === "" ? NaN : Number(value);
  return Number.isFinite(number) ? number : otherwise;
}

/// The team's name; "Left" or "Right" while it has none.
export function teamTitle(environment: Environment, side: Side): string {
  const name = teamName(environment, side);
  return name === side ? name[0]!.toUpperCase() + name.slice(1) : name;
}

/// The names of all modes of the host; empty before the host has sent them.
export function modeNames(environment: Environment): string[] {
  const names = environment.get("play_modes");
  return Array.isArray(names) ? names.map(String) : [];
}
