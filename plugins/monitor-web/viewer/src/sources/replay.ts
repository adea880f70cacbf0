import type { Environment, GameEvent, ReplaySource, Sound, World } from "../model";
import { DrawingBoard } from "../codec/packets";
import { RecordReader } from "../codec/record";
import { Blend } from "./blend";
import { takeEntries } from "./events";
import { type LogIndex, LogPages, type LogRecord } from "./log";
import { Poses } from "./poses";
import { kNoScene, makeScene, sameNodes, type Scene } from "./scene";
import { addShapes } from "./shapes";
import { Hearing } from "./sounds";
import { emptyWorld, showScene } from "./world";

/// A recorded match. Time is that of the log's own clock. The world is interpolated between two records, which are
/// decoded on demand, starting from the nearest of the last decoded record, the previous full record and a snapshot in
/// between.

/// Maximum time spent on decoding per picture [ms]: a seek over many records takes several pictures.
const kBudget = 10;
/// Distance between snapshots [records], unless a full record is nearer.
const kSnapshots = 64;
/// Maximum time step of a picture [ms]; after a longer delay playback does not catch up.
const kLongestPicture = 1000;

/// The decoded state of the log at one record.
class Moment {
  index = -1;
  scene: Scene = kNoScene;
  poses = new Poses();
  environment: Environment = new Map();

  copy(other: Moment): void {
    this.index = other.index;
    this.scene = other.scene;
    this.poses.copy(other.poses);
    this.environment = other.environment;
  }
}

export class Replay implements ReplaySource {
  readonly kind = "replay";
  readonly world: World = emptyWorld();
  readonly timeline: GameEvent[];
  readonly start: number;
  readonly end: number;

  private readonly pages: LogPages;
  private readonly records: LogRecord[];
  private readonly reader = new RecordReader();
  private readonly blend = new Blend();
  private readonly sounds: readonly Sound[];
  private readonly hearing = new Hearing();
  private readonly snapshots = new Map<number, Moment>();
  /// The scene is interpolated between these two; the second one is the first one's successor, or the same at the end.
  private from = new Moment();
  private to = new Moment();
  /// The record that `blend` was prepared for, and the last fraction that was written.
  private prepared = -1;
  private shownShare = -1;
  private shownTime = NaN;
  private shownEvents = 0;
  private readonly board = new DrawingBoard();
  /// The first record whose drawings are not yet on the board.
  private drawn = 0;
  /// Number of packets of that record that are already on the board.
  private taken = 0;
  private position: number;
  private running = false;
  private rate = 1;
  private last = NaN;
  private late = true;
  private passedOver: number;
  private readonly bad = new Set<number>();
  /// `to` is not adjacent to the record that is decoded next.
  private leaping = true;

  constructor(
    readonly name: string,
    data: Blob,
    index: LogIndex,
  ) {
    this.records = index.records;
    this.timeline = index.events;
    this.sounds = index.sounds;
    this.passedOver = index.damaged;
    this.start = this.position = this.records[0]!.clock;
    this.end = this.records[this.records.length - 1]!.clock;
    this.pages = new LogPages(data, this.records);
  }

  get damaged(): number {
    return this.passedOver;
  }

  get lacks(): string | null {
    if (this.passedOver === 0) return null;
    return this.passedOver === 1 ? "A damaged line of the log is left out." : `${this.passedOver} damaged lines of the log are left out.`;
  }

  /// True while the requested time is not shown yet.
  get busy(): boolean {
    return this.late && !this.pages.error;
  }

  get error(): string | null {
    return this.pages.error;
  }

  get following(): boolean {
    return false;
  }

  get time(): number {
    return this.position;
  }

  get playing(): boolean {
    return this.running;
  }

  set playing(on: boolean) {
    if (on && this.position >= this.end) this.seek(this.start);
    this.running = on;
  }

  get speed(): number {
    return this.rate;
  }

  set speed(speed: number) {
    if (speed > 0) this.rate = Math.min(10, Math.max(0.1, speed));
  }

  seek(time: number): void {
    if (!Number.isNaN(time)) this.position = Math.min(this.end, Math.max(this.start, time));
    this.hearing.jump(this.position);
    this.late = true;
  }

  step(direction: 1 | -1): void {
    this.running = false;
    const here = this.recordAt(this.position);
    const between = this.position > this.records[here]!.clock;
    const wanted = here + (direction < 0 && between ? 0 : direction);
    this.seek(this.records[Math.min(this.records.length - 1, Math.max(0, wanted))]!.clock);
  }

  update(now: number): void {
    const passed = Number.isNaN(this.last) ? 0 : Math.min(kLongestPicture, Math.max(0, now - this.last));
    this.last = now;
    const speed = this.running ? this.rate : 0;
    if (this.running && !this.late) {
      this.position = Math.min(this.end, this.position + (passed / 1000) * this.rate);
      if (this.position >= this.end) this.running = false;
    }
    this.world.sounds = [];
    const record = this.recordAt(this.position);
    this.late = !this.reach(record);
    if (this.late) return;
    this.show(record);
    this.world.sounds = this.hearing.pass(this.position, speed, this.sounds, this.timeline);
    this.late = this.drawn <= record;
  }

  close(): void {
    this.running = false;
    this.pages.close();
    this.snapshots.clear();
  }

  /// Resolves when the requested time is shown or showing it has failed.
  async settled(): Promise<void> {
    for (;;) {
      this.update(this.last);
      if (!this.busy) return;
      await new Promise((resolve) => setTimeout(resolve, 0));
    }
  }

  private recordAt(time: number): number {
    const { records } = this;
    let low = 0, high = records.length - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (records[middle]!.clock <= time) low = middle;
      else high = middle - 1;
    }
    return low;
  }

  /// Decodes until `from` is this record and `to` the next one. False: decoding continues in the next picture.
  private reach(record: number): boolean {
    const next = Math.min(record + 1, this.records.length - 1);
    if (this.from.index === record && this.to.index === next) return true;
    const began = performance.now();
    if (this.to.index > record || this.nearest(record) > this.to.index) this.begin(record);
    while (this.to.index < next) {
      if (!this.advance(record)) return false;
      if (this.to.index < record && performance.now() - began > kBudget) return false;
    }
    // At the end, or if there is only one record, both are the same.
    if (this.to.index === record) this.from.copy(this.to);
    this.prepared = -1;
    return this.from.index === record;
  }

  /// The latest record at or before this one from which decoding may begin.
  private nearest(record: number): number {
    for (let k = record; k > 0; --k) if ((this.records[k]!.full && !this.bad.has(k)) || this.snapshots.has(k)) return k;
    return 0;
  }

  private begin(record: number): void {
    const nearest = this.nearest(record);
    const snapshot = this.snapshots.get(nearest);
    this.prepared = -1;
    this.from.index = -1;
    this.leaping = !snapshot;
    if (snapshot) this.to.copy(snapshot);
    // Keep the scene: most full records repeat the same one.
    else this.to.index = nearest - 1;
  }

  /// Decodes the record after `to`, which becomes `from`, on the way to the requested record. False: its bytes are not
  /// loaded yet.
  private advance(wanted: number): boolean {
    const index = this.to.index + 1, record = this.records[index]!;
    const page = this.pages.page(record);
    if (!page) return false;
    this.pages.foresee(record.page + 1);
    const moment = this.from;
    this.from = this.to;
    this.to = moment;
    moment.copy(this.from);
    moment.index = index;
    const sound = this.decode(page, record, moment);
    if (!sound) this.passOver(index, moment);
    const lost = this.leaping && !sound;
    this.leaping = false;
    if (lost && index > 0) this.begin(wanted);
    if (!lost && index % kSnapshots === 0 && !record.full && !this.snapshots.has(index)) this.keep(moment);
    return true;
  }

  private decode(page: Uint8Array, record: LogRecord, moment: Moment): boolean {
    const at = record.offset - this.pages.start(record.page);
    const head = this.reader.head(page, at + record.drawings, at + record.size);
    if (!head) return false;
    if (head.full) {
      const scene = this.reader.nodes();
      if (!scene) return false;
      if (!sameNodes(moment.scene.nodes, scene.nodes)) {
        addShapes(scene.nodes, scene.poses);
        moment.scene = makeScene(scene.nodes);
      }
      moment.poses.copy(scene.poses);
    } else if (!this.reader.patch(moment.scene.nodes, moment.poses)) {
      return false;
    }
    const environment: Environment = head.full ? new Map() : new Map(moment.environment);
    takeEntries(environment, head.environment, head.full);
    moment.environment = environment;
    return true;
  }

  /// A damaged record repeats the previous state.
  private passOver(index: number, moment: Moment): void {
    if (!this.bad.has(index)) ++this.passedOver;
    this.bad.add(index);
    moment.copy(this.from);
    moment.index = index;
  }

  private keep(moment: Moment): void {
    const snapshot = new Moment();
    snapshot.copy(moment);
    this.snapshots.set(moment.index, snapshot);
  }

  private show(record: number): void {
    const { world, from, to, records } = this;
    const begin = records[record]!, end = records[Math.min(record + 1, records.length - 1)]!;
    const seconds = end.clock - begin.clock;
    if (this.prepared !== record) {
      showScene(world, from.scene);
      const comparable = from.scene === to.scene ? seconds : 0;
      this.blend.prepare(from.scene, from.poses, to.poses, comparable, begin.free && end.free, world.local);
      this.showVisibility(from);
      this.showEvents(begin.clock);
      if (world.environment !== from.environment) {
        world.environment = from.environment;
        ++world.versions.environment;
      }
      this.prepared = record;
      this.shownShare = 0;
      ++world.versions.frame;
    }
    if (this.drawn !== record + 1) this.showDrawings(record);
    const share = seconds > 0 ? Math.min(1, Math.max(0, (this.position - begin.clock) / seconds)) : 0;
    if (share !== this.shownShare) {
      this.shownShare = share;
      this.blend.write(share, world.local);
      ++world.versions.frame;
    }
    world.time = this.position;
  }

  private showVisibility(moment: Moment): void {
    const { nodes } = moment.scene;
    for (let i = 0; i < nodes.length; ++i) if (nodes[i]!.kind === "mesh") nodes[i]!.visible = moment.poses.visible[i] === 1;
  }

  /// Applies the drawings of the records since the last call. Starts over after a step back, or at a record with
  /// complete drawings.
  private showDrawings(record: number): void {
    const { board, records, world } = this;
    const back = record + 1 < this.drawn;
    let begin = record;
    while (begin > (back ? 0 : this.drawn) && !records[begin]!.redrawn) --begin;
    let changed = false;
    const within = begin === this.drawn && this.taken > 0;
    if (back || (records[begin]!.redrawn && !within)) {
      changed = board.shown.size > 0;
      board.clear();
      this.drawn = begin;
      this.taken = 0;
    }
    const began = performance.now();
    while (this.drawn <= record && performance.now() - began < kBudget) {
      const packet = records[this.drawn]!.packets[this.taken++];
      if (packet) changed = board.take(packet) || changed;
      else [this.drawn, this.taken] = [this.drawn + 1, 0];
    }
    if (!changed) return;
    world.drawings = new Map(board.shown);
    ++world.versions.drawings;
  }

  private showEvents(clock: number): void {
    let count = this.shownTime <= clock ? this.shownEvents : 0;
    while (count < this.timeline.length && this.timeline[count]!.time <= clock) ++count;
    this.shownTime = clock;
    if (count === this.shownEvents) return;
    this.shownEvents = count;
    this.world.events = this.timeline.slice(0, count);
    ++this.world.versions.events;
  }
}
