import { expect, test } from "vitest";
import { LiveClock } from "../../src/sources/live_clock";
import { Random } from "../helpers/random";

/// Simulates frames every `period` ms that arrive up to `jitter` ms late, and pictures every 16 ms; returns the steps
/// of the shown time after ten seconds.
function steps(period: number, jitter: number, speed: number): { steps: number[]; behind: number } {
  const random = new Random(4), clock = new LiveClock();
  const arrivals = Array.from({ length: Math.ceil(30_000 / period) }, (_, i) => ({ at: i * period + random.between(0, jitter), time: (i * period * speed) / 1000 }));
  const out: number[] = [];
  let next = 0, last = NaN, behind = 0;
  for (let now = 16; now < 29_000; now += 16) {
    for (; next < arrivals.length && arrivals[next]!.at <= now; ++next) clock.arrived(arrivals[next]!.time, arrivals[next]!.at);
    const time = clock.at(now);
    if (now > 10_000) out.push(time - last);
    last = time;
    behind = now - (1000 * time) / speed;
  }
  return { steps: out, behind };
}

test.each([
  [40, 0, 1],
  [40, 30, 1],
  [20, 15, 1],
  [200, 60, 1],
  [1000, 100, 1],
  [40, 30, 300],
])("frames every %d ms, up to %d ms late, at %d times real time: shown time runs evenly", (period, jitter, speed) => {
  const { steps: shown, behind } = steps(period, jitter, speed);
  const even = (16 * speed) / 1000;
  expect(Math.min(...shown)).toBeGreaterThan(0.5 * even);
  expect(Math.max(...shown)).toBeLessThan(1.5 * even);
  expect(behind).toBeLessThan(2 * period + 2 * jitter);
});

test("a paused time is shown as it is, and resumes without a jump", () => {
  const clock = new LiveClock();
  let last = 0;
  for (let now = 0; now <= 6000; now += 20) {
    const time = (now < 2000 ? now : now < 4000 ? 2000 : now - 2000) / 1000;
    if (now % 40 === 0) clock.arrived(time, now);
    const shown = clock.at(now);
    expect(shown).toBeGreaterThanOrEqual(last - (now === 0 ? 1 : 0));
    expect(shown).toBeLessThanOrEqual(time);
    last = shown;
  }
  expect(last).toBeGreaterThan(3.8);
});

test("a host that goes back in time is followed", () => {
  const clock = new LiveClock();
  for (let now = 0; now < 1000; now += 40) clock.arrived(500 + now / 1000, now);
  expect(clock.at(1000)).toBeGreaterThan(500);
  for (let now = 1000; now < 1400; now += 40) clock.arrived((now - 1000) / 1000, now);
  expect(clock.at(1400)).toBeLessThan(0.4);
});
