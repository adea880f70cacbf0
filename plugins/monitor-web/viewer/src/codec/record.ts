/// One message of the monitor protocol: environment, header and nodes, either complete ("RSG") or only the changes
/// ("RDS"). Environment and header are cheap to read and sufficient for an index. The nodes are read when they are
/// shown.

import type { SceneNode, Value } from "../model";
import { Poses } from "../sources/poses";
import { Token, Tokens } from "./tokens";

export type Entry = [string, ...Value[]];

export interface Head {
  full: boolean;
  environment: Entry[];
}

const kMostNodes = 50_000;
const kDeepest = 64;
/// Events since the record before included, such as sounds.
const kMaxEntries = 2048;

/// These values stay strings: team names may look like numbers.
const kWords = new Set(["team_left", "team_right", "play_modes"]);

export class RecordReader {
  private readonly tokens = new Tokens();
  private readonly matrix = new Float64Array(16);
  private readonly stack = new Int32Array(kDeepest);

  /// Reads environment and header of the message in bytes [from, end); null if it is not a message. The nodes follow.
  head(bytes: Uint8Array, from: number, end: number): Head | null {
    const { tokens } = this;
    tokens.start(bytes, from, end);
    // A JSON message is a list of three elements.
    if (bytes[tokens.at] === 0x5b) tokens.next();
    const environment = this.environment();
    if (!environment || tokens.next() !== Token.open || tokens.next() !== Token.atom) return null;
    const full = tokens.is("RSG");
    if (!full && !tokens.is("RDS")) return null;
    return tokens.skip() ? { full, environment } : null;
  }

  /// Reads the nodes of a full message, after head(); null if they are malformed.
  nodes(): { nodes: SceneNode[]; poses: Poses } | null {
    const nodes: SceneNode[] = [];
    const matrices: number[] = [];
    if (!this.walk((parent) => this.begin(nodes, matrices, parent), (node) => this.attribute(nodes[node]!, matrices, node))) return null;
    if (nodes.some((n) => n.kind === "mesh" && !n.load)) return null;
    const poses = new Poses(nodes.length);
    for (let i = 0; i < nodes.length; ++i) {
      poses.visible[i] = nodes[i]!.kind !== "mesh" || nodes[i]!.visible ? 1 : 0;
      if (nodes[i]!.kind === "transform") poses.setMatrix(i, matrices.slice(16 * i, 16 * i + 16));
    }
    return { nodes, poses };
  }

  /// Applies a partial message to the poses, after head(). Returns false if it is malformed or belongs to other nodes;
  /// the poses are invalid then.
  patch(nodes: SceneNode[], poses: Poses): boolean {
    let next = 0;
    const sound = this.walk(
      (parent) => (next < nodes.length && nodes[next]!.parent === parent ? next++ : -1),
      (node) => {
        if (nodes[node]!.kind === "transform" && this.tokens.is("SLT")) return this.place(poses, node);
        if (nodes[node]!.kind !== "mesh" || !this.tokens.is("setVisible")) return this.tokens.skip();
        if (this.tokens.next() !== Token.atom) return false;
        poses.visible[node] = this.tokens.number() === 1 ? 1 : 0;
        return this.tokens.skip();
      },
    );
    return sound && next === nodes.length;
  }

  /// Iterates over the list of nodes: begin(parent) returns a new node's index or -1, attribute(node) reads the list
  /// whose name was just read.
  private walk(begin: (parent: number) => number, attribute: (node: number) => boolean): boolean {
    const { tokens, stack } = this;
    if (tokens.next() !== Token.open) return false;
    for (let depth = 0; ; ) {
      const token = tokens.next();
      if (token === Token.end) return false;
      if (token === Token.atom) continue;
      if (token === Token.close) {
        if (depth-- === 0) return true;
        continue;
      }
      if (tokens.next() !== Token.atom) return false;
      const parent = depth > 0 ? stack[depth - 1]! : -1;
      if (tokens.is("nd")) {
        const node = depth < kDeepest ? begin(parent) : -1;
        if (node < 0) return false;
        stack[depth++] = node;
      } else if (parent < 0 ? !tokens.skip() : !attribute(parent)) {
        return false;
      }
    }
  }

  private begin(nodes: SceneNode[], matrices: number[], parent: number): number {
    const { tokens } = this;
    if (nodes.length >= kMostNodes || tokens.next() !== Token.atom) return -1;
    if (tokens.is("TRF")) nodes.push({ parent, kind: "transform" });
    else if (tokens.is("Light")) nodes.push({ parent, kind: "light" });
    else if (tokens.is("StaticMesh") || tokens.is("SMN")) nodes.push({ parent, kind: "mesh", visible: false });
    else return -1;
    for (let i = 0; i < 16; ++i) matrices.push(i % 5 === 0 ? 1 : 0);
    return nodes.length - 1;
  }

  private attribute(node: SceneNode, matrices: number[], index: number): boolean {
    const { tokens } = this;
    if (tokens.is("SLT") && node.kind === "transform") return this.numbers(matrices, 16 * index, 16);
    if (node.kind !== "mesh") return tokens.skip();
    if (tokens.is("setVisible")) {
      if (tokens.next() !== Token.atom) return false;
      node.visible = tokens.number() === 1;
    } else if (tokens.is("setTransparent")) {
      node.transparent = true;
    } else if (tokens.is("sSc")) {
      node.scale = [1, 1, 1];
      return this.numbers(node.scale, 0, 3);
    } else if (tokens.is("load")) {
      const words = this.words();
      node.load = words?.join(" ");
      return words !== null;
    } else if (tokens.is("resetMaterials") || tokens.is("sMat")) {
      const words = this.words();
      if (words) node.materials = words;
      return words !== null;
    }
    return tokens.skip();
  }

  /// Reads `count` numbers and the end of the list. The values may be "nan" after the simulation of a robot became
  /// unstable; the message is still valid.
  private numbers(out: number[] | Float64Array, at: number, count: number): boolean {
    for (let i = 0; i < count; ++i) {
      if (this.tokens.next() !== Token.atom) return false;
      out[at + i] = this.tokens.number();
    }
    return this.tokens.skip();
  }

  /// Reads all atoms up to the end of the list.
  private words(): string[] | null {
    const words: string[] = [];
    for (;;) {
      const token = this.tokens.next();
      if (token === Token.close) return words;
      if (token !== Token.atom) return null;
      words.push(this.tokens.text());
    }
  }

  private place(poses: Poses, node: number): boolean {
    if (!this.numbers(this.matrix, 0, 16)) return false;
    poses.setMatrix(node, this.matrix);
    return true;
  }

  private environment(): Entry[] | null {
    const { tokens } = this;
    const entries: Entry[] = [];
    if (tokens.next() !== Token.open) return null;
    for (;;) {
      const token = tokens.next();
      if (token === Token.close) return entries;
      if (token === Token.end || entries.length >= kMaxEntries) return null;
      if (token === Token.atom) continue;
      const entry = this.entry();
      if (entry === null) return null;
      if (entry.length > 0) entries.push(entry as Entry);
    }
  }

  /// Reads name and values; nested lists are skipped.
  private entry(): Value[] | null {
    const { tokens } = this;
    const values: Value[] = [];
    for (;;) {
      const token = tokens.next();
      if (token === Token.close) return typeof values[0] === "string" ? values : [];
      if (token === Token.end) return null;
      if (token === Token.open) {
        if (!tokens.skip()) return null;
        continue;
      }
      values.push(values.length === 0 || kWords.has(String(values[0])) ? tokens.text() : tokens.value());
    }
  }
}
