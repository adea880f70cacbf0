/// Plays the sounds of a match, as they are heard from the camera.
import type { Sound } from "../model";
import { Synthesizer, timbreOf } from "./synthesizer";

/// Limit of sounds at once.
const kMost = 16;
/// Of one name, a sound that begins sooner after another one than this is left out [ms].
const kGap = 40;
/// Distance from the camera at which a sound has half its volume [m].
const kHalf = 6;
/// Gain of what is heard everywhere, and the one below which a sound is not heard.
const kEverywhere = 0.4, kFaintest = 0.004;
const kWidest = 0.8;

/// Gain and pan of a sound. `camera`: its matrix, column by column; it looks along -z, x is to the right.
export function heardFrom(camera: ArrayLike<number>, { at, volume }: Sound): { gain: number; pan: number } {
  if (!at) return { gain: kEverywhere * volume, pan: 0 };
  const away = at.map((x, i) => x - camera[12 + i]!), distance = Math.hypot(...away);
  const right = away.reduce((sum, x, i) => sum + x * camera[i]!, 0);
  return { gain: (volume * kHalf) / (kHalf + distance), pan: distance > 0 ? (kWidest * right) / distance : 0 };
}

/// null: this browser has no audio.
function newContext(): AudioContext | null {
  try {
    return typeof AudioContext === "undefined" ? null : new AudioContext();
  } catch {
    return null;
  }
}

export class Sounds {
  /// Number of sounds played while they were on, with or without audio.
  played = 0;

  private on = false;
  private synthesizer: Synthesizer | null = null;
  /// What is heard now: begin and end [ms].
  private voices: { name: string; begin: number; end: number }[] = [];

  constructor(private readonly make: () => AudioContext | null = newContext) {}

  /// Call it while a key or a click is handled: only then browsers allow audio.
  switch(on: boolean): void {
    this.on = on;
    if (on) this.wake();
    else void this.synthesizer?.context.suspend().catch(() => undefined);
  }

  /// Sounds that were on in the last visit are heard from the first key or click on.
  restore(on: boolean, page: EventTarget): void {
    this.on = on;
    for (const gesture of ["click", "keydown"]) page.addEventListener(gesture, () => this.wake());
  }

  /// Plays what begins now [ms], the loudest first; a burst is thinned out.
  play(sounds: readonly Sound[], camera: ArrayLike<number>, now: number): void {
    if (!this.on || sounds.length === 0) return;
    this.voices = this.voices.filter((v) => v.end > now);
    const heard = sounds.map((sound) => ({ name: sound.name, ...heardFrom(camera, sound) }));
    for (const { name, gain, pan } of heard.sort((a, b) => b.gain - a.gain)) {
      const again = this.voices.some((v) => v.name === name && now - v.begin < kGap);
      if (again || gain < kFaintest || this.voices.length >= kMost) continue;
      const timbre = timbreOf(name);
      this.voices.push({ name, begin: now, end: now + 1000 * timbre.seconds });
      ++this.played;
      this.synthesizer?.play(timbre, gain, pan);
    }
  }

  private wake(): void {
    if (!this.on) return;
    if (!this.synthesizer) {
      const context = this.make();
      if (context) this.synthesizer = new Synthesizer(context);
    }
    void this.synthesizer?.context.resume().catch(() => undefined);
  }
}
