/// The packets of the drawing port, which agents use to draw. A packet contains several commands. Shapes are added to
/// named sets; a swap shows them.
///
///   0 0 name\0                       swap all sets whose name begins so
///   1 0 x y r thick rgb name\0       circle        1 3 x y z r rgb name\0             sphere
///   1 1 x y z x y z thick rgb name\0 line          1 4 n rgba (x y z)*n name\0        polygon
///   1 2 x y z size rgb name\0        point         2 0 x y z rgb text\0 name\0        text
///   2 1 agent rgb text\0             text at an agent (number - 1, plus 128 for the right team)
///   2 2 agent                        remove the text
///
/// Numbers are six characters each, colours one byte per channel.

import type { Colour, Drawing } from "../model";

const kNumber = 6;
/// Limits on what agents may draw. Anything beyond them is ignored.
const kMaxShapes = 20_000, kMaxSets = 2000;
/// Bytes; recorders write some 500.
const kLongestPacket = 8192;

/// The set of texts at agents. It is not double-buffered.
export const kAgentTexts = "agents";

const decoder = new TextDecoder();

class Damaged extends Error {}

export class DrawingBoard {
  /// The visible shapes by set name. Sets without shapes are removed.
  readonly shown = new Map<string, Drawing[]>();
  private readonly hidden = new Map<string, Drawing[]>();
  private readonly texts = new Map<number, Drawing>();
  private bytes: Uint8Array = new Uint8Array();
  private at = 0;
  private shapes = 0;

  clear(): void {
    this.shown.clear();
    this.hidden.clear();
    this.texts.clear();
    this.shapes = 0;
  }

  /// Executes a packet up to the first malformed byte. Returns true if the visible drawings changed.
  take(packet: Uint8Array): boolean {
    this.bytes = packet;
    this.at = 0;
    let changed = false;
    try {
      while (this.at < packet.length) changed = this.command() || changed;
    } catch (error) {
      if (!(error instanceof Damaged)) throw error;
    }
    return changed;
  }

  private command(): boolean {
    const group = this.byte(), kind = this.byte();
    if (group === 0 && kind === 0) return this.swap(this.text());
    if (group === 1 || (group === 2 && kind === 0)) return this.draw(group, kind);
    if (group === 2 && kind === 1) return this.write(this.byte());
    if (group === 2 && kind === 2) return this.erase(this.byte());
    // Selection commands are ignored: the user of this viewer selects.
    if (group === 3 && kind === 0) return this.byte() < 0;
    throw new Damaged();
  }

  private swap(prefix: string): boolean {
    let changed = false;
    for (const name of new Set([...this.shown.keys(), ...this.hidden.keys()])) {
      if (!name.startsWith(prefix) || (name === kAgentTexts && this.texts.size > 0)) continue;
      this.shapes -= this.shown.get(name)?.length ?? 0;
      const next = this.hidden.get(name);
      if (next) this.shown.set(name, next);
      else this.shown.delete(name);
      this.hidden.delete(name);
      changed = true;
    }
    return changed;
  }

  private draw(group: number, kind: number): boolean {
    const drawing = group === 2 ? this.annotation() : this.shape(kind);
    const name = this.text();
    const set = this.hidden.get(name) ?? [];
    if (this.shapes >= kMaxShapes || (set.length === 0 && this.hidden.size >= kMaxSets)) return false;
    set.push(drawing);
    ++this.shapes;
    this.hidden.set(name, set);
    return false;
  }

  private shape(kind: number): Drawing {
    switch (kind) {
      case 0:
        return { kind: "circle", centre: [this.number(), this.number()], radius: this.number(), thickness: this.number(), colour: this.colour(false) };
      case 1:
        return { kind: "line", from: this.point(), to: this.point(), thickness: this.number(), colour: this.colour(false) };
      case 2:
        return { kind: "point", at: this.point(), size: this.number(), colour: this.colour(false) };
      case 3:
        return { kind: "sphere", centre: this.point(), radius: this.number(), colour: this.colour(false) };
      case 4: {
        const count = this.byte(), colour = this.colour(true);
        return { kind: "polygon", points: Array.from({ length: count }, () => this.point()), colour };
      }
      default:
        throw new Damaged();
    }
  }

  private annotation(): Drawing {
    return { kind: "text", at: this.point(), colour: this.colour(false), text: this.text() };
  }

  private write(agent: number): boolean {
    const colour = this.colour(false), text = this.text();
    this.texts.set(agent, { kind: "agentText", side: agent < 128 ? "left" : "right", number: (agent & 127) + 1, text, colour });
    return this.showTexts();
  }

  private erase(agent: number): boolean {
    return this.texts.delete(agent) && this.showTexts();
  }

  private showTexts(): boolean {
    if (this.texts.size > 0) this.shown.set(kAgentTexts, [...this.texts.values()]);
    else this.shown.delete(kAgentTexts);
    return true;
  }

  private byte(): number {
    const byte = this.bytes[this.at++];
    if (byte === undefined) throw new Damaged();
    return byte;
  }

  private number(): number {
    const value = Number(decoder.decode(this.bytes.subarray(this.at, this.at + kNumber)));
    this.at += kNumber;
    if (this.at > this.bytes.length || !Number.isFinite(value)) throw new Damaged();
    return value;
  }

  private point(): [number, number, number] {
    return [this.number(), this.number(), this.number()];
  }

  private colour(alpha: boolean): Colour {
    return [this.byte() / 255, this.byte() / 255, this.byte() / 255, alpha ? this.byte() / 255 : 1];
  }

  private text(): string {
    const end = this.bytes.indexOf(0, this.at);
    if (end < 0) throw new Damaged();
    const text = decoder.decode(this.bytes.subarray(this.at, end));
    this.at = end + 1;
    return text;
  }
}

/// Parses the packets in front of a recorded message: [1, 0, ...][...], bytes from 0 to 255 or -128 to 127. Bytes
/// [from, end) must contain nothing else.
export function readPackets(line: Uint8Array, from: number, end: number): Uint8Array[] {
  const packets: Uint8Array[] = [];
  for (let at = from; at < end; ) {
    const open = line.indexOf(0x5b, at), close = line.indexOf(0x5d, at);
    if (open < 0 || close < open || close >= end) break;
    const numbers = decoder.decode(line.subarray(open + 1, close)).split(",").map(Number);
    if (numbers.length <= kLongestPacket && numbers.every((n) => Number.isInteger(n) && n >= -128 && n <= 255)) packets.push(Uint8Array.from(numbers, (n) => n & 255));
    at = close + 1;
  }
  return packets;
}
