import { describe, expect, it } from "vitest";
import * as trainer from "../../src/ui/trainer";

const who: trainer.Who = { side: "right", number: 3 };

describe("trainer commands", () => {
  it("have the format that the host expects", () => {
    expect(trainer.kickOff("left")).toBe("(kickOff Left)");
    expect(trainer.kickOff("right")).toBe("(kickOff Right)");
    expect(trainer.dropBall()).toBe("(dropBall)");
    expect(trainer.playMode("corner_kick_left")).toBe("(playMode corner_kick_left)");
    expect(trainer.kill(who)).toBe("(kill (unum 3)(team Right))");
    expect(trainer.repos(who)).toBe("(repos (unum 3)(team Right))");
    expect(trainer.score(2, 0)).toBe("(score (left 2)(right 0))");
  });
  it("place the ball at rest, with millimeter precision", () => {
    expect(trainer.moveBall(-3.14159, 1, 0.042)).toBe("(ball (pos -3.142 1 0.042)(vel 0 0 0))");
  });
  it("move players, and turn them only if an angle is given", () => {
    expect(trainer.movePlayer(who, 1, 2, 0.4, null)).toBe("(agent (unum 3)(team Right)(pos 1 2 0.4))");
    expect(trainer.movePlayer(who, 1, 2, 0.4, -90)).toBe("(agent (unum 3)(team Right)(move 1 2 0.4 -90))");
  });
  it("accept the game time in seconds or as a clock", () => {
    expect(trainer.time("275.5")).toBe("(time 275.5)");
    expect(trainer.time("4:05")).toBe("(time 245)");
    expect(() => trainer.time("-1")).toThrow("0 or more");
    expect(() => trainer.time("")).toThrow("missing");
  });
  it("are not sent if a value is missing or invalid, with an explanation", () => {
    expect(() => trainer.moveBall(1, null, 0)).toThrow(new trainer.Incomplete("y is missing"));
    expect(() => trainer.score(1, 1.5)).toThrow("0, 1, 2");
    expect(() => trainer.score(-1, 0)).toThrow("left score");
  });
  it("accept numbers with a point or a comma, and refuse other text", () => {
    expect(trainer.typed(" 1,5 ", "x")).toBe(1.5);
    expect(trainer.typed("", "x")).toBeNull();
    expect(() => trainer.typed("two", "x")).toThrow('x: a number is expected, not "two"');
    expect(() => trainer.typed("1e9", "x")).toThrow(trainer.Incomplete);
  });
  it("typed by hand get outer parentheses, and unbalanced ones are refused", () => {
    expect(trainer.raw(" dropBall ")).toBe("(dropBall)");
    expect(trainer.raw("(kickOff Left)")).toBe("(kickOff Left)");
    expect(() => trainer.raw("(kickOff Left")).toThrow("parentheses");
    expect(() => trainer.raw("(a))(")).toThrow("parentheses");
    expect(() => trainer.raw("  ")).toThrow("type a command");
  });
});
