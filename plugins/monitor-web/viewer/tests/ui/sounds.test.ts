import { describe, expect, test } from "vitest";
import type { Sound } from "../../src/model";
import { heardFrom, Sounds } from "../../src/ui/sounds";
import { timbreOf } from "../../src/ui/synthesizer";

/// A camera at the origin that looks along y.
const camera = [1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1];
const sound = (name: string, at: Sound["at"] = [0, 6, 0], volume = 1): Sound => ({ time: 0, name, volume, at });

/// Records which sources started, at what pitches and where.
class FakeContext {
  state = "running";
  readonly currentTime = 1;
  readonly sampleRate = 8000;
  readonly destination = {};
  readonly started: string[] = [];
  private node(kind: string, more: object = {}): object {
    const nothing = () => undefined;
    const ramps = { linearRampToValueAtTime: nothing, exponentialRampToValueAtTime: nothing };
    const param = () => ({ value: 0, setValueAtTime: nothing, ...ramps });
    const start = () => this.started.push(kind);
    return { gain: param(), frequency: param(), connect: (to: object) => to, start, stop: nothing, ...more };
  }
  createOscillator = () => this.node("tone");
  createBufferSource = () => this.node("noise");
  createGain = () => this.node("gain");
  createBiquadFilter = () => this.node("filter");
  createDynamicsCompressor = () => this.node("compressor");
  createBuffer = (_: number, length: number) => ({ getChannelData: () => new Float32Array(length) });
  createStereoPanner = () => this.node("panner", { pan: { set value(pan: number) { pans.push(pan); } } });
  suspend = () => Promise.resolve(void (this.state = "suspended"));
  resume = () => Promise.resolve(void (this.state = "running"));
}
let pans: number[] = [];

function made(): { sounds: Sounds; contexts: FakeContext[] } {
  const contexts: FakeContext[] = [];
  pans = [];
  const make = () => (contexts.push(new FakeContext()), contexts.at(-1) as unknown as AudioContext);
  return { sounds: new Sounds(make), contexts };
}

describe("a timbre", () => {
  test("follows from the name, always in the same way", () => {
    expect(timbreOf("whistle").pitch).toBeGreaterThan(5 * timbreOf("ball").pitch);
    expect(timbreOf("bump").pitch).toBeLessThan(timbreOf("ball").pitch);
    expect(timbreOf("rubble").noise).toBeGreaterThan(0.5);
    const names = ["gong", "engine", "door", "splash", "horn", "clap"];
    const pitches = names.map((name) => timbreOf(name).pitch);
    expect(names.map((name) => timbreOf(name).pitch)).toEqual(pitches);
    expect(new Set(pitches).size).toBeGreaterThan(3);
    for (const pitch of pitches) expect(pitch > 100 && pitch < 1800).toBe(true);
  });
});

describe("from the camera", () => {
  test("a sound is softer the farther it is, and comes from its side", () => {
    expect(heardFrom(camera, sound("bump"))).toEqual({ gain: 0.5, pan: 0 });
    expect(heardFrom(camera, sound("bump", [0, 60, 0])).gain).toBeLessThan(0.1);
    expect(heardFrom(camera, sound("bump", [3, 3, 0])).pan).toBeGreaterThan(0.5);
    expect(heardFrom(camera, sound("bump", [-3, 3, 0])).pan).toBeLessThan(-0.5);
    expect(heardFrom(camera, sound("bump", [0, 0, 0], 0.3))).toEqual({ gain: 0.3, pan: 0 });
    expect(heardFrom(camera, sound("whistle", null)).pan).toBe(0);
  });
});

describe("sounds", () => {
  test("are off at first, and make no audio context before they are switched on", () => {
    const { sounds, contexts } = made();
    sounds.play([sound("bump")], camera, 0);
    sounds.switch(false);
    expect([sounds.played, contexts.length]).toEqual([0, 0]);
    sounds.switch(true);
    sounds.play([sound("bump", [3, 3, 0])], camera, 0);
    sounds.switch(false);
    sounds.play([sound("bump")], camera, 1000);
    sounds.switch(true);
    expect([sounds.played, contexts.length]).toEqual([1, 1]);
    expect(contexts[0]!.started).toEqual(["tone", "noise"]);
    expect(pans[0]).toBeGreaterThan(0.5);
  });
  test("that were on in the last visit get their context at the first key or click", () => {
    const { sounds, contexts } = made(), page = new EventTarget();
    sounds.restore(true, page);
    sounds.play([sound("bump")], camera, 0);
    expect([sounds.played, contexts.length]).toEqual([1, 0]);
    page.dispatchEvent(new Event("click"));
    page.dispatchEvent(new Event("keydown"));
    expect(contexts.length).toBe(1);
    const other = made();
    other.sounds.restore(false, page);
    page.dispatchEvent(new Event("keydown"));
    expect(other.contexts.length).toBe(0);
  });
  test("are counted without audio, too, and nothing waits for a context that sleeps", () => {
    const silent = new Sounds(() => null);
    silent.switch(true);
    silent.play([sound("gong")], camera, 0);
    expect(silent.played).toBe(1);
    const { sounds, contexts } = made();
    sounds.switch(true);
    contexts[0]!.state = "suspended";
    sounds.play([sound("gong")], camera, 0);
    expect([sounds.played, contexts[0]!.started]).toEqual([1, []]);
  });
  test("of a burst are thinned out: the loudest of each name, and few at once", () => {
    const { sounds, contexts } = made();
    sounds.switch(true);
    sounds.play([sound("a", [-9, 9, 0]), sound("a", [9, 9, 0], 0.2), sound("a", [-1, 1, 0])], camera, 0);
    expect(sounds.played).toBe(1);
    expect(pans[0]).toBeCloseTo(-0.8 * Math.SQRT1_2, 5);
    sounds.play([sound("a"), sound("faint", [0, 1e6, 0]), sound("mute", null, 0)], camera, 20);
    expect(sounds.played).toBe(1);
    sounds.play(Array.from({ length: 40 }, (_, i) => sound(`b${i}`)), camera, 100);
    expect(sounds.played).toBe(16);
    expect(contexts[0]!.started.length).toBe(16);
    sounds.play([sound("a")], camera, 2000);
    expect(sounds.played).toBe(17);
  });
});
