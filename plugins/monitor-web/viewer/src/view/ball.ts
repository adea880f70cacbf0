import { BufferAttribute, BufferGeometry, DynamicDrawUsage, Group, Mesh, MeshStandardMaterial, ShaderMaterial, SphereGeometry, Vector3 } from "three";
import type { World } from "../model";
import type { Surroundings } from "./palette";
import { towardsSun } from "./shade";
import type { Quality } from "./stage";
import { Trail } from "./trail";

const trailPoints = 48;
const trailSeconds = 1.6;

/// Twelve dark patches around the corners of an icosahedron.
const pattern = /* glsl */ `
  float patches(vec3 n) {
    vec3 a = abs(n);
    float nearest = max(max(dot(a, vec3(0.0, 0.5257, 0.8507)), dot(a, vec3(0.5257, 0.8507, 0.0))), dot(a, vec3(0.8507, 0.0, 0.5257)));
    return smoothstep(0.925, 0.945, nearest);
  }`;

/// The ball, drawn at least a few pixels wide, and its trail.
export class Ball {
  readonly group = new Group();
  readonly trail = new Trail(trailPoints, trailSeconds);
  radius = 0.05;
  readonly position = new Vector3();
  private readonly ball: Mesh;
  private readonly ribbon: Mesh<BufferGeometry, ShaderMaterial>;

  constructor(quality: Quality, around: Surroundings) {
    const fine = quality === "quality";
    this.ball = new Mesh(new SphereGeometry(1, fine ? 40 : 18, fine ? 28 : 12), fine ? fineBall() : flatBall(around));
    this.ball.matrixAutoUpdate = false;
    this.ball.castShadow = this.ball.receiveShadow = fine;
    this.ribbon = new Mesh(ribbonGeometry(), ribbonMaterial());
    for (const mesh of [this.ball, this.ribbon]) {
      mesh.frustumCulled = false;
      this.group.add(mesh);
    }
  }

  setRadius(world: World): void {
    const told = world.environment.get("BallRadius");
    const shape = world.nodes[world.ball]?.shapes?.find(s => s.kind === "sphere");
    const mesh = world.nodes.find(node => node.kind === "mesh" && node.parent === world.ball);
    this.radius = shape?.size[0] ?? (typeof told === "number" && told > 0 ? told : mesh?.scale?.[0]) ?? 0.05;
  }

  /// Updates the position of the ball for a new frame.
  update(worlds: Float32Array, node: number, time: number): void {
    this.group.visible = node >= 0;
    if (node < 0) return;
    this.ball.matrix.fromArray(worlds, 16 * node);
    this.position.setFromMatrixPosition(this.ball.matrix);
    this.trail.add(time, this.position.x, this.position.y, this.position.z);
  }

  /// Call it for every picture. `pixel`: size of a pixel at a distance of one metre [m].
  fit(eye: Vector3, pixel: number, time: number, withTrail: boolean): void {
    if (!this.group.visible) return;
    const size = Math.max(this.radius, 4.2 * pixel * eye.distanceTo(this.position));
    const { elements } = this.ball.matrix;
    for (const column of [0, 4, 8]) {
      const length = Math.hypot(elements[column]!, elements[column + 1]!, elements[column + 2]!) || 1;
      for (let k = column; k < column + 3; k++) elements[k]! *= size / length;
    }
    this.ball.matrixWorldNeedsUpdate = true;
    this.ribbon.visible = withTrail && this.trail.count > 1;
    if (this.ribbon.visible) this.layRibbon(eye, size, time);
  }

  dispose(): void {
    for (const mesh of [this.ball, this.ribbon] as Mesh[]) {
      mesh.geometry.dispose();
      (mesh.material as { dispose(): void }).dispose();
    }
  }

  /// A strip through the trail's points that faces the camera and gets thinner towards its end.
  private layRibbon(eye: Vector3, size: number, time: number): void {
    const { points, count } = this.trail;
    const position = this.ribbon.geometry.getAttribute("position") as BufferAttribute, strength = this.ribbon.geometry.getAttribute("strength") as BufferAttribute;
    for (let n = 0; n < count; n++) {
      const before = 3 * Math.max(0, n - 1), after = 3 * Math.min(count - 1, n + 1), here = 3 * n;
      along.set(points[after]! - points[before]!, points[after + 1]! - points[before + 1]!, points[after + 2]! - points[before + 2]!);
      toEye.set(eye.x - points[here]!, eye.y - points[here + 1]!, eye.z - points[here + 2]!);
      const share = this.trail.strength(n, time);
      across.crossVectors(along, toEye).setLength(0.85 * size * (0.25 + 0.75 * share));
      if (along.lengthSq() < 1e-8) across.set(0, 0, 0);
      position.setXYZ(2 * n, points[here]! + across.x, points[here + 1]! + across.y, points[here + 2]! + across.z);
      position.setXYZ(2 * n + 1, points[here]! - across.x, points[here + 1]! - across.y, points[here + 2]! - across.z);
      strength.setX(2 * n, share);
      strength.setX(2 * n + 1, share);
    }
    position.needsUpdate = strength.needsUpdate = true;
    this.ribbon.geometry.setDrawRange(0, 6 * (count - 1));
  }
}

const along = new Vector3(), toEye = new Vector3(), across = new Vector3();

function flatBall(around: Surroundings): ShaderMaterial {
  return new ShaderMaterial({
    uniforms: { sun: { value: towardsSun }, light: { value: new Vector3(around.below, around.above, around.sun) } },
    vertexShader: /* glsl */ `
      varying vec3 place;
      varying float lit;
      uniform vec3 sun;
      uniform vec3 light;
      void main() {
        place = normal;
        vec3 n = normalize(mat3(modelMatrix) * normal);
        lit = min(1.0, 0.15 + mix(light.x, light.y, 0.5 + 0.5 * n.z) + light.z * max(dot(n, sun), 0.0));
        gl_Position = projectionMatrix * (modelViewMatrix * vec4(position, 1.0));
      }`,
    fragmentShader: /* glsl */ `
      varying vec3 place;
      varying float lit;
      ${pattern}
      void main() { gl_FragColor = vec4(mix(vec3(1.0), vec3(0.12), patches(normalize(place))) * lit, 1.0); }`,
  });
}

function fineBall(): MeshStandardMaterial {
  const material = new MeshStandardMaterial({ roughness: 0.35 });
  material.onBeforeCompile = shader => {
    shader.vertexShader = shader.vertexShader
      .replace("#include <common>", "#include <common>\nvarying vec3 vPlace;")
      .replace("#include <begin_vertex>", "#include <begin_vertex>\nvPlace = normal;");
    shader.fragmentShader = shader.fragmentShader
      .replace("#include <common>", `#include <common>\nvarying vec3 vPlace;\n${pattern}`)
      .replace("#include <color_fragment>", "diffuseColor.rgb = mix(vec3(0.95), vec3(0.015), patches(normalize(vPlace)));");
  };
  return material;
}

function ribbonGeometry(): BufferGeometry {
  const geometry = new BufferGeometry();
  const indices = Array.from({ length: trailPoints - 1 }, (_, n) => [2 * n, 2 * n + 1, 2 * n + 3, 2 * n, 2 * n + 3, 2 * n + 2]).flat();
  for (const [name, size] of [["position", 3], ["strength", 1]] as const) {
    geometry.setAttribute(name, new BufferAttribute(new Float32Array(2 * trailPoints * size), size).setUsage(DynamicDrawUsage));
  }
  geometry.setIndex(indices);
  return geometry;
}

function ribbonMaterial(): ShaderMaterial {
  return new ShaderMaterial({
    transparent: true, depthWrite: false, side: 2,
    vertexShader: /* glsl */ `
      attribute float strength;
      varying float alpha;
      void main() { alpha = 0.6 * strength; gl_Position = projectionMatrix * (viewMatrix * vec4(position, 1.0)); }`,
    fragmentShader: /* glsl */ `
      varying float alpha;
      void main() { gl_FragColor = vec4(1.0, 0.97, 0.75, alpha); }`,
  });
}
