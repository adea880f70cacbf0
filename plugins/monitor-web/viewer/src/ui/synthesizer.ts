/// Makes sounds with Web Audio: a tone that may fall and trill, and filtered noise.

export interface Timbre {
  wave: OscillatorType;
  /// Frequency of the tone at its beginning [Hz]; at the end it is `fall` times that.
  pitch: number;
  fall: number;
  /// Share of noise, 0..1, and up to which frequency [Hz].
  noise: number;
  cutoff: number;
  /// Length [s], and the fraction of it after which the sound fades.
  seconds: number;
  hold: number;
  /// Frequency of the trill [Hz]; 0: none.
  trill: number;
}

const kTone = { wave: "triangle", pitch: 440, fall: 1, seconds: 0.25, hold: 0, trill: 0 } as const;
const kPlain: Timbre = { ...kTone, noise: 0, cutoff: 800 };

const kKnown = new Map<string, Partial<Timbre>>([
  ["bump", { wave: "sine", pitch: 130, fall: 0.5, noise: 0.5, cutoff: 500, seconds: 0.18 }],
  ["ball", { wave: "sine", pitch: 330, fall: 0.5, noise: 0.3, cutoff: 1500, seconds: 0.14 }],
  ["whistle", { wave: "sine", pitch: 2600, noise: 0.1, cutoff: 6000, seconds: 0.5, hold: 0.8, trill: 38 }],
  ["rubble", { pitch: 60, fall: 0.7, noise: 0.9, cutoff: 700, seconds: 0.7 }],
]);

/// Pitches of other names: four octaves of a pentatonic scale, so that several sound well together.
const kScale = [0, 2, 4, 7, 9], kLowest = 110, kPitches = 4 * kScale.length;
/// Largest deviation of a trill, as a fraction of the pitch.
const kTrill = 0.06;
const kAttack = 0.004, kSilence = 1e-4;

/// How a name sounds, always in the same way.
export function timbreOf(name: string): Timbre {
  const known = kKnown.get(name);
  if (known) return { ...kPlain, ...known };
  const step = hashOf(name) % kPitches;
  const halftones = 12 * Math.floor(step / kScale.length) + kScale[step % kScale.length]!;
  return { ...kPlain, pitch: kLowest * 2 ** (halftones / 12) };
}

/// FNV-1a, 32 bits (Fowler, Noll, Vo 1991).
function hashOf(text: string): number {
  let hash = 0x811c9dc5;
  for (let i = 0; i < text.length; ++i) hash = Math.imul(hash ^ text.charCodeAt(i), 0x01000193);
  return hash >>> 0;
}

/// A source, and the last node behind it.
type Voice = [AudioScheduledSourceNode, AudioNode];

export class Synthesizer {
  private readonly output: AudioNode;
  private readonly noise: AudioBuffer;

  constructor(readonly context: AudioContext) {
    // Many sounds at once are made softer, and are not clipped.
    this.output = context.createDynamicsCompressor();
    this.output.connect(context.destination);
    this.noise = context.createBuffer(1, context.sampleRate, context.sampleRate);
    const samples = this.noise.getChannelData(0);
    for (let i = 0; i < samples.length; ++i) samples[i] = 2 * Math.random() - 1;
  }

  /// `gain`: 0..1; `pan`: -1 (left) to 1. Does nothing while the browser does not allow audio: sounds would wait, and
  /// be played together later.
  play(timbre: Timbre, gain: number, pan: number): void {
    const { context } = this;
    if (context.state !== "running") return;
    const panner = context.createStereoPanner();
    panner.pan.value = pan;
    panner.connect(this.output);
    if (timbre.noise < 1) this.start(this.tone(timbre), (1 - timbre.noise) * gain, timbre, panner);
    if (timbre.noise > 0) this.start(this.hiss(timbre), timbre.noise * gain, timbre, panner);
  }

  private tone({ wave, pitch, fall, seconds, trill }: Timbre): Voice {
    const { context } = this, begin = context.currentTime;
    const tone = context.createOscillator();
    tone.type = wave;
    tone.frequency.setValueAtTime(pitch, begin);
    tone.frequency.exponentialRampToValueAtTime(pitch * fall, begin + seconds);
    if (trill > 0) {
      const trills = context.createOscillator(), depth = context.createGain();
      trills.frequency.value = trill;
      depth.gain.value = kTrill * pitch;
      trills.connect(depth).connect(tone.frequency);
      trills.start(begin);
      trills.stop(begin + seconds);
    }
    return [tone, tone];
  }

  private hiss({ cutoff }: Timbre): Voice {
    const hiss = this.context.createBufferSource(), filter = this.context.createBiquadFilter();
    hiss.buffer = this.noise;
    hiss.loop = true;
    filter.type = "lowpass";
    filter.frequency.value = cutoff;
    return [hiss, hiss.connect(filter)];
  }

  private start([source, last]: Voice, level: number, { seconds, hold }: Timbre, to: AudioNode): void {
    const begin = this.context.currentTime, envelope = this.context.createGain();
    envelope.gain.setValueAtTime(kSilence, begin);
    envelope.gain.linearRampToValueAtTime(level, begin + kAttack);
    envelope.gain.setValueAtTime(level, begin + Math.max(kAttack, hold * seconds));
    envelope.gain.exponentialRampToValueAtTime(kSilence, begin + seconds);
    last.connect(envelope).connect(to);
    source.start(begin);
    source.stop(begin + seconds);
  }
}
