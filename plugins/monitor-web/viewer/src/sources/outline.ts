import type { Environment, GameEvent } from "../model";
import type { Entry } from "../codec/record";
import { EventReader, isEntry, takeEntries } from "./events";
import { isRecord } from "./scene_message";
import { changeOf } from "./tape";

/// Finds the events of a match in its messages, without its frames.
export class OutlineReader {
  readonly events: GameEvent[] = [];
  private readonly reader = new EventReader();
  private readonly environment: Environment = new Map();

  /// Takes a message of the stream, in chronological order. Others than changes and events are ignored.
  take(message: unknown): void {
    if (!isRecord(message)) return;
    const change = changeOf(message);
    if (change) takeEntries(this.environment, change.entries, change.full);
    const entries = change?.entries ?? (isEntry(message.entry) ? [message.entry as Entry] : []);
    this.events.push(...this.reader.take(this.environment, entries, Number(message.time) || 0));
  }
}
