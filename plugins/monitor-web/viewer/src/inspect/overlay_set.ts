import type { Group } from "three";
import type { LiveSource } from "../model";
import { ConesOverlay, SeenOverlay, type Percepts } from "./overlays/percepts";
import { ContactsOverlay, type Contacts } from "./overlays/contacts";
import { Feed } from "./overlays/feed";
import { JointsOverlay, type Joints } from "./overlays/joints";
import { LabelsOverlay } from "./overlays/labels";
import type { Overlay, Surroundings } from "./overlays/overlay";

/// The overlays and the requests that feed them. A request is sent only while an overlay needs its answer.
export class OverlaySet {
  readonly overlays: readonly Overlay[];
  private readonly contacts = new Feed<Contacts>(() => this.ask({ do: "contacts" }));
  private readonly joints = new Feed<Joints>((path) => this.ask({ do: "joints", path }));
  private readonly percepts = new Feed<Percepts>((path) => this.ask({ do: "percepts", path }));
  private readonly seen: SeenOverlay;
  private live: LiveSource | null = null;

  constructor(above: Group) {
    this.seen = new SeenOverlay(this.percepts, above);
    this.overlays = [new ContactsOverlay(this.contacts, above), new JointsOverlay(this.joints, above), new ConesOverlay(this.percepts, above), this.seen, new LabelsOverlay(above)];
  }

  update(now: number, around: Surroundings): void {
    if (around.live !== this.live) {
      for (const feed of [this.contacts, this.joints, this.percepts]) feed.tick(now, null);
      this.live = around.live;
    }
    const robot = around.live ? around.robot?.path ?? null : null;
    this.contacts.tick(now, around.live && this.isOn("contacts") ? "/" : null);
    this.joints.tick(now, this.isOn("joints") ? robot : null);
    this.percepts.tick(now, this.isOn("cones") || this.isOn("seen") ? robot : null);
    for (const overlay of this.overlays) overlay.update(now, around);
  }

  dispose(): void {
    for (const overlay of this.overlays) overlay.dispose();
  }

  private isOn(id: string): boolean {
    for (const overlay of this.overlays) if (overlay.id === id) return overlay.on;
    return false;
  }

  private ask<T>(request: Record<string, unknown>): Promise<T> {
    return this.live ? this.live.ask<T>(request) : Promise.reject(new Error("There is no host."));
  }
}
