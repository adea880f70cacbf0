import { describe, expect, it } from "vitest";
import type { GameEvent } from "../../src/model";
import { kSpeeds, marksOf, neighbour, otherSpeed, passed, shareOf, ticksOf, timeAt } from "../../src/ui/timeline_maths";

const event = (time: number, kind: GameEvent["kind"], text: string = kind): GameEvent => ({ time, kind, text });

describe("positions on the timeline", () => {
  it("are fractions of the log's time, and convert back", () => {
    expect(shareOf(15, 10, 20)).toBe(0.5);
    expect(timeAt(0.25, 10, 20)).toBe(12.5);
  });
  it("stay on the timeline, also if a log has only one record", () => {
    expect([shareOf(5, 10, 20), shareOf(25, 10, 20), shareOf(3, 3, 3)]).toEqual([0, 1, 0]);
    expect([timeAt(-1, 10, 20), timeAt(2, 10, 20), timeAt(0.5, 3, 3)]).toEqual([10, 20, 3]);
  });
});

describe("marks", () => {
  const events = [event(10, "mode", "Kick-in"), event(50, "foul", "Foul"), event(50.5, "goal", "Goal"), event(50.6, "mode", "Kick-off"), event(90, "mode", "Play on")];
  it("are separate where there is room", () => {
    expect(marksOf(events, 0, 100, 100_000, 8).map((m) => m.kind)).toEqual(["mode", "foul", "goal", "mode", "mode"]);
  });
  it("are merged where they would overlap, and show the most important event", () => {
    const marks = marksOf(events, 0, 100, 400, 8);
    expect(marks.map((m) => m.kind)).toEqual(["mode", "goal", "mode"]);
    expect(marks[1]).toMatchObject({ time: 50.5, share: 0.505, texts: ["Foul", "Goal", "Kick-off"] });
  });
  it("do not merge into one if each is close to the next", () => {
    const many = [...Array(101).keys()].map((t) => event(t, "mode"));
    expect(marksOf(many, 0, 100, 100, 9.5)).toHaveLength(11);
  });
  it("list a repeated event once", () => {
    expect(marksOf([event(1, "foul", "Foul: self collision"), event(1.1, "foul", "Foul: self collision")], 0, 100, 100, 8)[0]!.texts).toHaveLength(1);
  });
});

describe("the scale", () => {
  it("has round times, as many as there is room for", () => {
    expect(ticksOf(0, 600, 8)).toEqual([0, 120, 240, 360, 480, 600]);
    expect(ticksOf(3.2, 20, 5)).toEqual([5, 10, 15, 20]);
    expect(ticksOf(0, 1e6, 4)).not.toHaveLength(0);
    for (const end of [1e6, 1e9, 1e12]) expect(ticksOf(0, end, 8).length).toBeLessThanOrEqual(9);
  });
});

describe("jumps from event to event", () => {
  const events = [event(5, "mode"), event(10, "goal"), event(20, "foul"), event(30, "mode")];
  it("go to goals and fouls", () => {
    expect(neighbour(events, 0, 1)?.time).toBe(10);
    expect(neighbour(events, 25, -1)?.time).toBe(20);
  });
  it("continue from the event that they reached", () => {
    expect(neighbour(events, 10, 1)?.time).toBe(20);
    expect(neighbour(events, 20.3, -1)?.time).toBe(10);
  });
  it("use mode changes if there is nothing else, and end after the last event", () => {
    expect(neighbour(events, 20, 1)?.time).toBe(30);
    expect(neighbour(events, 30, 1)).toBeNull();
  });
});

describe("speeds", () => {
  it("change in steps from a tenth to tenfold, and stop there", () => {
    expect([kSpeeds[0], kSpeeds.at(-1)]).toEqual([0.1, 10]);
    expect([otherSpeed(1, 1), otherSpeed(1, -1), otherSpeed(10, 1), otherSpeed(0.1, -1)]).toEqual([2, 0.5, 10, 0.1]);
  });
  it("continue from a speed between two steps", () => {
    expect([otherSpeed(1.7, 1), otherSpeed(1.7, -1)]).toEqual([2, 1]);
  });
});

describe("announced events", () => {
  const events = [event(1, "goal"), event(2, "foul"), event(2.5, "mode")];
  it("are those between two pictures, each once", () => {
    expect(passed(events, 0.9, 1, 3).map((e) => e.kind)).toEqual(["goal"]);
    expect(passed(events, 1, 2.5, 3).map((e) => e.kind)).toEqual(["foul", "mode"]);
  });
  it("are none after a jump, backwards, or before the first picture", () => {
    expect(passed(events, 0, 60)).toEqual([]);
    expect(passed(events, 3, 1)).toEqual([]);
    expect(passed(events, NaN, 2)).toEqual([]);
  });
});
