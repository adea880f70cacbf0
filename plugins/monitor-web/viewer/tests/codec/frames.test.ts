import { expect, test } from "vitest";
import { FrameDecoder } from "../../src/codec/frames";
import type { SceneNode } from "../../src/model";
import { Poses } from "../../src/sources/poses";
import { type Frame, writeFrame } from "../helpers/frame_writer";
import { Random } from "../helpers/random";

const kBits: [number, number] = [10, 10];

function decoder(transforms: number[], nodes: number, shape = 1): { decoder: FrameDecoder; poses: Poses; scene: SceneNode[] } {
  const made = new FrameDecoder();
  const scene: SceneNode[] = Array.from({ length: nodes }, () => ({ parent: -1, kind: "transform" }));
  made.setScene(shape, { nodes: scene, transforms: Int32Array.from(transforms) });
  return { decoder: made, poses: new Poses(nodes), scene };
}

const frame = (steps: number[][], rest: Partial<Frame> = {}): Frame => ({ key: true, shape: 1, serial: 1, time: 1, bits: kBits, steps, ...rest });

function randomSteps(random: Random, count: number): number[][] {
  return Array.from({ length: count }, () => Array.from({ length: 7 }, (_, k) => (k < 3 ? random.whole(-60_000, 60_000) : random.whole(-1024, 1024))));
}

function expectPoses(poses: Poses, transforms: number[], steps: number[][], bits: [number, number]): void {
  transforms.forEach((node, i) => {
    const [x, y, z, ...q] = steps[i]!;
    expect([...poses.position.subarray(3 * node, 3 * node + 3)]).toEqual([x, y, z].map((s) => Math.fround(s! / 2 ** bits[0])));
    const length = Math.hypot(...q) || 1;
    const wanted = Math.hypot(...q) > 0 ? q.map((s) => s / length) : [0, 0, 0, 1];
    wanted.forEach((w, k) => expect(poses.rotation[4 * node + k]).toBeCloseTo(w, 5));
  });
}

test("a frame is decoded byte by byte according to the protocol", () => {
  const { decoder: d, poses } = decoder([0, 2], 3);
  // One meter along x, turned by 180 degrees about z; node 1 is hidden.
  const bytes = [1, 3, 4, 0, 1, 0, 0, 0, 9, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x28, 0x40, 1, 1, 0b0100001, 16, 32, 0, 0, 1, 1, 0];
  expect(d.decode(Uint8Array.from(bytes), poses)).toBe("shown");
  expect(d.time).toBe(12);
  expect([...poses.position]).toEqual([0, 0, 0, 0, 0, 0, 1, 0, 0]);
  expect([...poses.rotation.subarray(8)]).toEqual([0, 0, 1, 0]);
  expect([...poses.visible]).toEqual([1, 0, 1]);
});

test("decoded key frames and deltas equal the encoded ones", () => {
  const random = new Random(5);
  for (let run = 0; run < 15; ++run) {
    const nodes = random.whole(1, 30);
    const transforms = Array.from({ length: nodes }, (_, i) => i).filter(() => random.chance(0.7));
    const bits: [number, number] = [random.whole(4, 14), random.whole(4, 14)];
    const { decoder: d, poses } = decoder(transforms, nodes, run);
    let steps = randomSteps(random, transforms.length);
    expect(d.decode(writeFrame({ key: true, shape: run, serial: 7, time: 0, bits, steps }), poses)).toBe("shown");
    for (let serial = 8; serial < 20; ++serial) {
      const before = steps;
      steps = before.map((s) => (random.chance(0.5) ? s : s.map((v) => v + (random.chance(0.5) ? random.whole(-300, 300) : 0))));
      const visible: [number, number][] = random.chance(0.3) ? [[random.whole(0, nodes - 1), random.whole(0, 1)]] : [];
      expect(d.decode(writeFrame({ key: false, shape: run, serial, time: serial / 25, bits, steps, before, visible }), poses)).toBe("shown");
      expect(d.time).toBe(serial / 25);
      expectPoses(poses, transforms, steps, bits);
      for (const [node, shown] of visible) expect(poses.visible[node]).toBe(shown);
    }
  }
});

test("a transform that is on another one turns with it about the pin", () => {
  const { decoder: d, poses, scene } = decoder([0, 2, 3], 4);
  Object.assign(scene[2]!, { on: 0, pin: [0, 0, 1] });
  Object.assign(scene[3]!, { on: 1, pin: [0, 2, 0] });
  const half = Math.SQRT1_2 * 1024, quarter = 2 * Math.tan(Math.PI / 8) * 1024;
  const steps = [
    [1024, 0, 0, 0, 0, half, half], // at (1, 0, 0), turned by 90 degrees about z
    [2048, 0, 0, quarter, 0, 0, 0], // 2 m ahead of that one, which is y, is the pin; turned by 90 degrees about its x, which is y
    [0, 0, 1024, 0, 0, 0, 0], // its pin is 1 m above the second one, in the frame of that one
  ];
  expect(d.decode(writeFrame(frame(steps.map((s) => s.map(Math.round)))), poses)).toBe("shown");
  const near = (from: Float32Array, wanted: number[]) => wanted.forEach((w, k) => expect(from[k]).toBeCloseTo(w, 2));
  // The z axis of the second one is x now.
  near(poses.position.subarray(6), [0, 2, 0]);
  near(poses.rotation.subarray(8), [0.5, 0.5, 0.5, 0.5]);
  // The third one's pin is at (1, 2, 0); its y axis is z.
  near(poses.position.subarray(9), [1, 2, -2]);
  near(poses.rotation.subarray(12), [0.5, 0.5, 0.5, 0.5]);
});

test("a delta without its base waits for the next key frame", () => {
  const { decoder: d, poses } = decoder([0], 1);
  const a = [[1, 2, 3, 0, 0, 0, 1024]], b = [[2, 2, 3, 0, 0, 0, 1024]];
  const delta = (serial: number) => writeFrame(frame(b, { key: false, serial, before: a }));
  expect(d.decode(delta(1), poses)).toBe("waits");
  expect(d.decode(writeFrame(frame(a)), poses)).toBe("shown");
  expect(d.decode(delta(3), poses)).toBe("waits");
  // Even a delta that would fit waits, because the frame before was missed.
  expect(d.decode(delta(2), poses)).toBe("waits");
  expect(d.decode(writeFrame(frame(b, { serial: 4 })), poses)).toBe("shown");
  expect(d.decode(writeFrame(frame(b, { shape: 2, serial: 5 })), poses)).toBe("waits");
});

test("an invalid frame is refused", () => {
  const good = writeFrame(frame([[1, 2, 3, 0, 0, 0, 1024]]));
  const refused = (change: (bytes: number[]) => void) => {
    const { decoder: d, poses } = decoder([0], 1);
    const bytes = [...good];
    change(bytes);
    return d.decode(Uint8Array.from(bytes), poses);
  };
  expect(refused(() => {})).toBe("shown");
  expect(refused((b) => (b[0] = 3))).toBe("broken");
  expect(refused((b) => (b[1] = 60))).toBe("broken");
  expect(refused((b) => (b[3] = 1))).toBe("broken");
  expect(refused((b) => b.push(0))).toBe("broken");
  expect(refused((b) => b.pop())).toBe("broken");
  expect(refused((b) => (b[21] = 2))).toBe("broken");   // a run beyond the transforms
  expect(refused((b) => (b[22] = 0xff))).toBe("broken");   // a mask of eight bits
  expect(refused((b) => b.splice(23, 1, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 1))).toBe("broken");   // a number that does not end
  expect(refused((b) => b.splice(12, 8, 0, 0, 0, 0, 0, 0, 0xf0, 0x7f))).toBe("broken");   // an infinite time
});

test("random and damaged bytes never throw and never give numbers that are not finite", () => {
  const random = new Random(11);
  const { decoder: d, poses } = decoder([0, 1, 3], 4);
  let shown = 0;
  for (let run = 0; run < 5000; ++run) {
    const bytes = random.chance(0.2) ? Uint8Array.from({ length: random.whole(0, 60) }, () => random.whole(0, 255)) : writeFrame(frame(randomSteps(random, 3), { serial: run }));
    for (let k = random.whole(0, 3); k > 0; --k) bytes[random.whole(0, bytes.length - 1)] = random.whole(0, 255);
    if (d.decode(bytes.subarray(0, random.chance(0.1) ? random.whole(0, bytes.length) : bytes.length), poses) === "shown") ++shown;
    expect(poses.position.every(Number.isFinite) && poses.rotation.every(Number.isFinite)).toBe(true);
  }
  expect(shown).toBeGreaterThan(300);
});
