import { describe, expect, it } from "vitest";
import type { Environment } from "../../src/model";
import { clock, count, factor, half, latency, modeNames, numberOf, speed, spokenClock, teamTitle } from "../../src/ui/format";

describe("numbers for people", () => {
  it("writes clocks as minutes and seconds, whole ones", () => {
    expect([0, 7, 59.99, 60, 187.4, 3725].map(clock)).toEqual(["0:00", "0:07", "0:59", "1:00", "3:07", "62:05"]);
  });
  it("never shows a clock before the start, nor one that is late by rounding", () => {
    expect(clock(-3)).toBe("0:00");
    expect(clock(29.9999999)).toBe("0:30");
  });
  it("says clocks in words", () => {
    expect(spokenClock(1)).toBe("1 second");
    expect(spokenClock(42)).toBe("42 seconds");
    expect(spokenClock(61)).toBe("1 minute 1 second");
    expect(spokenClock(180)).toBe("3 minutes 0 seconds");
  });
  it("knows two halves", () => {
    expect([0, 1, 2].map(half)).toEqual(["", "1st half", "2nd half"]);
  });
  it("gives real-time factors as many digits as they are worth", () => {
    expect([0.984, 9.99, 42.25, 1234].map(factor)).toEqual(["0.98×", "9.99×", "42.3×", "1234×"]);
    expect([null, undefined, NaN].map(factor)).toEqual(["–", "–", "–"]);
  });
  it("writes latencies in milliseconds, and a dash where none is known", () => {
    expect([0.42, 9.94, 41.2].map(latency)).toEqual(["0.4 ms", "9.9 ms", "41 ms"]);
    expect(latency(null)).toBe("–");
  });
  it("writes speeds without needless digits", () => {
    expect([0.1, 0.25, 1, 10].map(speed)).toEqual(["0.1×", "0.25×", "1×", "10×"]);
  });
  it("counts one and many", () => {
    expect([count(1, "spectator", "spectators"), count(0, "spectator", "spectators")]).toEqual(["1 spectator", "0 spectators"]);
  });
});

describe("values of the environment", () => {
  const environment: Environment = new Map<string, string | number | (string | number)[]>([
    ["half", 2],
    ["score_left", "3"],
    ["team_left", "Red"],
    ["play_modes", ["BeforeKickOff", "PlayOn"]],
  ]);
  it("takes numbers from either kind of value, and something else where there is none", () => {
    expect(numberOf(environment, "half", 0)).toBe(2);
    expect(numberOf(environment, "score_left", 0)).toBe(3);
    expect(numberOf(environment, "team_left", -1)).toBe(-1);
    expect(numberOf(environment, "nothing", 7)).toBe(7);
  });
  it("names teams by their sides until they have names", () => {
    expect([teamTitle(environment, "left"), teamTitle(environment, "right")]).toEqual(["Red", "Right"]);
  });
  it("lists the modes that the host knows", () => {
    expect(modeNames(environment)).toEqual(["BeforeKickOff", "PlayOn"]);
    expect(modeNames(new Map())).toEqual([]);
  });
});
