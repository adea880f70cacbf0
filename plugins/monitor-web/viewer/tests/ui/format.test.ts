import { describe, expect, it } from "vitest";
import type { Environment } from "../../src/model";
import { clock, count, factor, half, latency, modeNames, numberOf, speed, spokenClock, steps, teamTitle } from "../../src/ui/format";

describe("numbers", () => {
  it("are formatted as clocks in whole minutes and seconds", () => {
    expect([0, 7, 59.99, 60, 187.4, 3725].map(clock)).toEqual(["0:00", "0:07", "0:59", "1:00", "3:07", "62:05"]);
  });
  it("are never shown as a negative clock, nor rounded down by an inaccurate value", () => {
    expect(clock(-3)).toBe("0:00");
    expect(clock(29.9999999)).toBe("0:30");
  });
  it("are spoken as clocks in words", () => {
    expect(spokenClock(1)).toBe("1 second");
    expect(spokenClock(42)).toBe("42 seconds");
    expect(spokenClock(61)).toBe("1 minute 1 second");
    expect(spokenClock(180)).toBe("3 minutes 0 seconds");
  });
  it("name two halves", () => {
    expect([0, 1, 2].map(half)).toEqual(["", "1st half", "2nd half"]);
  });
  it("have few digits as real-time factors", () => {
    expect([0.984, 9.99, 42.25, 1234].map(factor)).toEqual(["0.98×", "9.99×", "42.3×", "1234×"]);
    expect([null, undefined, NaN].map(factor)).toEqual(["–", "–", "–"]);
  });
  it("are formatted as latencies in milliseconds, with a dash for unknown ones", () => {
    expect([0.42, 9.94, 41.2].map(latency)).toEqual(["0.4 ms", "9.9 ms", "41 ms"]);
    expect(latency(null)).toBe("–");
    expect([3, 2.55, 12.04, null, NaN].map(steps)).toEqual(["3", "2.5", "12", "–", "–"]);
  });
  it("are formatted as speeds without unnecessary digits", () => {
    expect([0.1, 0.25, 1, 10].map(speed)).toEqual(["0.1×", "0.25×", "1×", "10×"]);
  });
  it("select the singular or plural", () => {
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
  it("may be numbers or text, with a default for missing ones", () => {
    expect(numberOf(environment, "half", 0)).toBe(2);
    expect(numberOf(environment, "score_left", 0)).toBe(3);
    expect(numberOf(environment, "team_left", -1)).toBe(-1);
    expect(numberOf(environment, "nothing", 7)).toBe(7);
  });
  it("name teams by their sides until they have names", () => {
    expect([teamTitle(environment, "left"), teamTitle(environment, "right")]).toEqual(["Red", "Right"]);
  });
  it("list the modes of the host", () => {
    expect(modeNames(environment)).toEqual(["BeforeKickOff", "PlayOn"]);
    expect(modeNames(new Map())).toEqual([]);
  });
});
