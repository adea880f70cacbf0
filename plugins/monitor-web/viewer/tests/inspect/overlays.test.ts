import { Group, InstancedMesh } from "three";
import { describe, expect, it } from "vitest";
import type { LiveSource, Robot, World } from "../../src/model";
import { OverlaySet } from "../../src/inspect/overlay_set";
import { forceScale, shortName } from "../../src/inspect/overlays/contacts";
import { jointName } from "../../src/inspect/overlays/joints";
import { errorOf, sexp, signsOf } from "../../src/inspect/overlays/percepts";
import type { Surroundings } from "../../src/inspect/overlays/overlay";

describe("force arrows", () => {
  it("have a round scale that changes only when necessary", () => {
    expect(forceScale(0.01, 0)).toBe(0.01);
    expect(forceScale(0.01, 40)).toBe(0.01);
    expect(forceScale(0.01, 100)).toBeCloseTo(0.005);
    expect(forceScale(0.005, 40)).toBe(0.005);
    expect(forceScale(0.01, 3)).toBeCloseTo(0.2);
  });
});

describe("short names", () => {
  it("include the owner of the part", () => {
    expect(shortName("/usr/scene/AgentAspect1/spacenao/body/TorsoCollider")).toBe("AgentAspect1 body");
    expect(shortName("/usr/scene/ground/PlaneCollider")).toBe("ground");
    expect(jointName("/a/neck/HingeJoint")).toBe("neck");
    expect(jointName("/a/neck/HingeJoint[2]")).toBe("neck");
    expect(jointName("/a/neck/turn")).toBe("turn");
  });
});

describe("percepts", () => {
  it("are shown as agents receive them", () => {
    expect(sexp(["See", ["B", ["pol", 3.751, -25, 0.5]]])).toBe("(See (B (pol 3.75 -25 0.50)))");
  });

  it("label each player once, at the head if it is visible", () => {
    expect(signsOf(["B", "P Red 6 lfoot", "P Red 6 head", "P FC Bla u 11 rfoot", "P FC Bla u 11 lfoot"])).toEqual(["B", "", "Red 6", "FC Bla u 11", ""]);
    expect(signsOf(["P Blue 1", "P Blue 2", "P B 04 7"])).toEqual(["Blue 1", "Blue 2", "B 04 7"]);
  });

  it("have an error if the true position is known", () => {
    expect(errorOf({ name: "B", seen: [1, 2, 2], true: [0, 0, 0] })).toBe(3);
    expect(errorOf({ name: "B", seen: [1, 2, 2] })).toBeNull();
  });
});

const kRobot: Robot = { key: "left:1", side: "left", number: 1, node: 0, torso: 0, head: 0, path: "/usr/scene/A" };

function stage() {
  const overlay = new Group();
  const asked: unknown[] = [];
  const answers: Record<string, unknown> = {
    contacts: { contacts: [{ position: [0, 0, 0], normal: [0, 0, 1], depth: 0.002, force: [0, 0, 20], a: "/usr/scene/A/s/foot/c", b: "/usr/scene/ground/p" }, { position: [1, 0, 0], normal: [0, 0, 1], depth: 0, a: "/usr/scene/B/s/foot/c", b: "/usr/scene/ground/p" }] },
    joints: { joints: [{ path: "/usr/scene/A/neck/HingeJoint", type: "hinge", anchor: [0, 0, 1], axes: [[0, 0, 1]], angles: [12.3], rates: [0], low: -120, high: 120 }] },
    percepts: { time: 1, percepts: [["time", ["now", 1]]], cones: [], seen: [{ name: "B", seen: [1, 0, 0], true: [1, 0.5, 0] }] },
  };
  const live = { ask: async (r: { do: string }) => (asked.push(r), answers[r.do]) } as unknown as LiveSource;
  const around: Surroundings = { canvas: { overlay, matrixOf: () => {}, invalidate: () => {} }, world: { robots: [kRobot] } as unknown as World, live, robot: kRobot };
  return { overlay, asked, around };
}
const settle = () => new Promise((done) => queueMicrotask(() => queueMicrotask(() => queueMicrotask(() => done(null)))));

describe("overlays", () => {
  const by = (set: OverlaySet, id: string) => set.overlays.find((o) => o.id === id)!;

  it("send requests only while they are on, and only for a selected robot", async () => {
    const { overlay, asked, around } = stage();
    const set = new OverlaySet(overlay);
    set.update(0, around);
    expect(asked).toEqual([]);
    by(set, "joints").on = true;
    set.update(100, { ...around, robot: null });
    expect(asked).toEqual([]);
    expect(by(set, "joints").note).toContain("Select a robot");
    set.update(200, around);
    await settle();
    set.update(210, around);
    expect(asked).toEqual([{ do: "joints", path: "/usr/scene/A" }]);
    expect(by(set, "joints").listing!.rows).toEqual([["neck", "12.3", "−120 … 120", "0", "–"]]);
    by(set, "joints").on = false;
    set.update(1000, around);
    set.update(2000, around);
    expect(asked.length).toBe(1);
    expect(by(set, "joints").listing).toBeNull();
  });

  it("list the selected robot's contacts, and draw all contacts", async () => {
    const { overlay, around } = stage();
    const set = new OverlaySet(overlay);
    by(set, "contacts").on = true;
    set.update(0, around);
    await settle();
    set.update(10, around);
    const contacts = by(set, "contacts");
    expect(contacts.listing!.rows).toEqual([["left 1 foot – ground", "2.00", "20.0"]]);
    expect(contacts.note).toContain("2 contacts, 1 of the selected robot");
    const dots: number[] = [];
    overlay.traverse((o) => o instanceof InstancedMesh && o.visible && dots.push(o.count));
    expect(dots).toEqual([2]);
    set.update(20, { ...around, robot: null, live: null });
    expect(contacts.listing).toBeNull();
  });

  it("share one request for cones and seen objects", async () => {
    const { overlay, asked, around } = stage();
    const set = new OverlaySet(overlay);
    by(set, "cones").on = true;
    set.update(0, around);
    await settle();
    set.update(10, around);
    expect(asked).toEqual([{ do: "percepts", path: "/usr/scene/A" }]);
    expect(by(set, "cones").note).toContain("no perceptor with a cone");
  });
});
