import { Matrix4, PerspectiveCamera, Vector3 } from "three";
import { describe, expect, it } from "vitest";
import { Budget } from "../src/view/budget";
import { Camera, type Sights } from "../src/view/camera";
import { fieldSizes } from "../src/view/field_sizes";
import { FrameTimes } from "../src/view/frame_times";
import { Frustum } from "../src/view/frustum";
import { ease, Follower } from "../src/view/motion";
import { Trail } from "../src/view/trail";

const field = fieldSizes(new Map([["FieldLength", 30], ["FieldWidth", 20]]))!;

function sights(more: Partial<Sights> = {}): Sights {
  return { field, extent: 15, ball: null, head: null, aspect: 16 / 9, ...more };
}

/// The position of a world point in the picture, -1..1.
function seen(camera: Camera, aspect: number, point: Vector3): Vector3 {
  const eye = new PerspectiveCamera(camera.pose.angle, aspect, 0.1, 1000);
  eye.position.copy(camera.pose.position);
  eye.quaternion.copy(camera.pose.rotation);
  eye.updateMatrixWorld();
  return point.clone().project(eye);
}

function run(camera: Camera, seconds: number, rate: number): void {
  for (let n = 0; n < seconds * rate; n++) camera.step(1 / rate);
}

describe("the initial view", () => {
  it.each([16 / 9, 4 / 3, 9 / 19])("shows the whole field in pictures of aspect %f", aspect => {
    const camera = new Camera(sights({ aspect }));
    for (const mode of ["orbit", "top"] as const) {
      camera.mode = mode;
      run(camera, 2, 30);
      for (const x of [-15, 15]) for (const y of [-10, 10]) {
        const place = seen(camera, aspect, new Vector3(x, y, 0));
        expect(Math.max(Math.abs(place.x), Math.abs(place.y)), `${mode} ${x} ${y}`).toBeLessThan(1);
      }
    }
  });

  it("shows the left team's goal on the left", () => {
    const camera = new Camera(sights());
    expect(seen(camera, 16 / 9, new Vector3(-15, 0, 0)).x).toBeLessThan(-0.5);
  });
});

describe("camera moves", () => {
  it("give the same result at 10 and at 60 frames per second", () => {
    const ends = [10, 60].map(rate => {
      const ball = new Vector3(0, 0, 0);
      const camera = new Camera(sights({ ball }));
      camera.mode = "broadcast";
      camera.step(1 / rate);
      ball.set(8, 3, 0);
      run(camera, 1.5, rate);
      return camera.pose.position.clone();
    });
    expect(ends[0]!.distanceTo(ends[1]!)).toBeLessThan(0.15);
  });

  it("between cameras are smooth and finite", () => {
    const camera = new Camera(sights());
    run(camera, 1, 60);
    camera.mode = "top";
    let last = camera.pose.position.clone(), longest = 0, way = 0;
    for (let n = 0; n < 60; n++) {
      camera.step(1 / 60);
      const step = camera.pose.position.distanceTo(last);
      longest = Math.max(longest, step);
      way += step;
      last = camera.pose.position.clone();
    }
    expect(longest).toBeLessThan(way / 10);
    expect(camera.step(1 / 60)).toBe(false);
  });

  it("are immediate with reduced motion", () => {
    const camera = new Camera(sights());
    camera.reducedMotion = true;
    camera.mode = "top";
    camera.step(1 / 60);
    expect(seen(camera, 16 / 9, new Vector3(0, 0, 0)).length()).toBeLessThan(1.01);
    expect(camera.pose.position.x).toBeCloseTo(0);
  });

  it("in the broadcast mode keep the ball in view", () => {
    const ball = new Vector3(14, 9, 0.1);
    const camera = new Camera(sights({ ball }));
    camera.mode = "broadcast";
    run(camera, 3, 30);
    for (const place of [[14, 9], [-14, -9], [0, 9]] as const) {
      ball.set(place[0], place[1], 0.1);
      run(camera, 4, 30);
      const at = seen(camera, 16 / 9, ball);
      expect(Math.abs(at.x)).toBeLessThan(0.8);
      expect(Math.abs(at.y)).toBeLessThan(0.8);
    }
  });
});

describe("manual control", () => {
  const key = (type: string, code: string, name: string) => ({ type, code, key: name, ctrlKey: false, metaKey: false, altKey: false, shiftKey: false }) as KeyboardEvent;

  it("by keyboard moves the camera while keys are held", () => {
    const camera = new Camera(sights());
    run(camera, 1, 30);
    const before = camera.pose.position.clone();
    expect(camera.key(key("keydown", "KeyD", "d"))).toBe(true);
    run(camera, 0.5, 30);
    camera.key(key("keyup", "KeyD", "d"));
    run(camera, 1, 30);
    const after = camera.pose.position.clone();
    expect(after.x).toBeGreaterThan(before.x + 1);
    run(camera, 1, 30);
    expect(camera.pose.position.distanceTo(after)).toBeLessThan(0.01);
    expect(camera.key(key("keydown", "KeyX", "x"))).toBe(false);
  });

  it("by dragging takes over from the broadcast camera without a jump", () => {
    const camera = new Camera(sights({ ball: new Vector3(3, 1, 0) }));
    camera.mode = "broadcast";
    run(camera, 2, 30);
    const before = camera.pose.position.clone();
    const heard: string[] = [];
    camera.onmode = mode => heard.push(mode);
    camera.drag(0.001, 0);
    camera.step(1 / 60);
    expect(heard).toEqual(["orbit"]);
    expect(camera.pose.position.distanceTo(before)).toBeLessThan(0.1);
  });
});

describe("the head camera", () => {
  it("faces the robot's direction, upright or fallen", () => {
    const matrix = new Matrix4().makeRotationZ(Math.PI / 2).setPosition(1, 2, 0.5);
    const camera = new Camera(sights({ head: { matrix, rolls: false, radius: 0 } }));
    camera.mode = "head";
    run(camera, 2, 30);
    // The robot faced +y; a quarter turn to the left makes that -x.
    const forward = new Vector3(0, 0, -1).applyQuaternion(camera.pose.rotation);
    expect(forward.x).toBeCloseTo(-1, 3);
    expect(camera.pose.position.distanceTo(new Vector3(1, 2, 0.5))).toBeLessThan(0.12);
  });
});

describe("automatic motion", () => {
  it("of a follower reaches its target and never overshoots", () => {
    const follower = new Follower(3);
    const target = new Vector3(1, 0, 0);
    let last = 0;
    for (let n = 0; n < 300; n++) {
      follower.step(1 / 60, target);
      expect(follower.position.x).toBeGreaterThanOrEqual(last);
      last = follower.position.x;
    }
    expect(last).toBeCloseTo(1, 3);
    expect([ease(-1), ease(0.5), ease(2)]).toEqual([0, 0.5, 1]);
  });

  it("a trail fades, and restarts when the ball is moved", () => {
    const trail = new Trail(10, 1);
    for (let n = 0; n <= 30; n++) trail.add(n * 0.1, n * 0.1, 0, 0);
    expect(trail.count).toBeGreaterThan(5);
    expect(trail.count).toBeLessThanOrEqual(10);
    expect(trail.points[3 * trail.count - 3]).toBeCloseTo(3);
    expect(trail.strength(trail.count - 1, 3)).toBeCloseTo(1);
    expect(trail.strength(0, 3)).toBeLessThan(0.2);
    trail.add(3.1, 90, 0, 0);
    expect(trail.count).toBe(1);
    trail.add(1, 90, 0, 0);
    expect(trail.count).toBe(1);
  });
});

describe("the frustum", () => {
  it("contains spheres that are at least partly in the picture", () => {
    const eye = new PerspectiveCamera(90, 1, 0.1, 100);
    eye.updateMatrixWorld();
    const frustum = new Frustum();
    frustum.set(eye);
    expect(frustum.depth(0, 0, -5, 0.1)).toBeCloseTo(5);
    expect(frustum.depth(6, 0, -5, 0.1)).toBe(-1);
    expect(frustum.depth(6, 0, -5, 1)).toBeCloseTo(5);
    expect(frustum.depth(0, 0, 5, 1)).toBe(-1);
  });
});

describe("the resolution", () => {
  it("falls when frames are slow for some time, and recovers", () => {
    const budget = new Budget();
    let changes = 0;
    for (let n = 0; n < 200; n++) if (budget.heard(60)) changes++;
    expect(changes).toBeGreaterThan(1);
    expect(budget.share).toBe(0.5);
    for (let n = 0; n < 3000; n++) budget.heard(16);
    expect(budget.share).toBe(1);
  });

  it("does not fall after a pause or a few slow frames", () => {
    const budget = new Budget();
    for (let n = 0; n < 500; n++) budget.heard(n % 10 === 0 ? 60 : n % 51 === 0 ? 5000 : 30);
    expect(budget.share).toBe(1);
  });

  it("frame times are summarized", () => {
    const times = new FrameTimes();
    for (let n = 0; n < 100; n++) times.add(n < 90 ? 20 : 40);
    expect(times.summary()).toMatchObject({ pictures: 100, median: 20, p95: 40 });
    expect(times.summary().rate).toBeCloseTo(100000 / 2200);
    times.reset();
    expect(times.summary().pictures).toBe(0);
  });
});
