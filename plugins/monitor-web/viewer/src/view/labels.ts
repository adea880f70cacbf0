import { BufferAttribute, CanvasTexture, DynamicDrawUsage, Group, InstancedBufferAttribute, InstancedBufferGeometry, InstancedMesh, LinearFilter, LinearMipmapLinearFilter, Mesh, PlaneGeometry, ShaderMaterial, type Texture, type Vector3 } from "three";
import type { Robot } from "../model";
import { multiply } from "./affine";
import { css, inkOn, teamColour, type TeamColours } from "./palette";
import type { Decal } from "./pieces";

const cellWidth = 96, cellHeight = 64;

/// The robots' numbers: a label above each head, with a size that is legible at any distance, and the numbers on the
/// torsos.
export class Labels {
  readonly group = new Group();
  private readonly texture: CanvasTexture;
  private readonly anchors: InstancedBufferAttribute;
  private readonly heads: Mesh<InstancedBufferGeometry, ShaderMaterial>;
  private readonly numbers: InstancedMesh | null;
  private readonly locals: Float32Array;

  constructor(private readonly robots: readonly Robot[], private readonly decals: readonly Decal[], teams: TeamColours, screen: Vector3) {
    const columns = Math.max(1, Math.ceil(Math.sqrt(robots.length)));
    this.texture = paintAtlas(robots, teams, columns);
    this.anchors = new InstancedBufferAttribute(new Float32Array(4 * robots.length), 4).setUsage(DynamicDrawUsage) as InstancedBufferAttribute;
    this.heads = new Mesh(this.headGeometry(columns), headMaterial(this.texture, screen));
    this.heads.frustumCulled = false;
    this.heads.renderOrder = 10;
    this.group.add(this.heads);
    this.locals = Float32Array.from(decals.flatMap(d => d.matrix));
    this.numbers = decals.length > 0 ? this.numberMesh(columns) : null;
    if (this.numbers) this.group.add(this.numbers);
  }

  /// Shows or hides the labels above the heads; the numbers on the torsos stay visible.
  set visible(on: boolean) {
    this.heads.visible = on;
  }

  /// Updates the labels for a new frame. `tops`: height of each robot's label above its head [m].
  update(worlds: Float32Array, tops: Float32Array): void {
    this.robots.forEach(({ head }, n) => {
      const o = 16 * head + 12;
      this.anchors.setXYZW(n, worlds[o]!, worlds[o + 1]!, worlds[o + 2]! + tops[n]!, 1);
    });
    this.anchors.needsUpdate = true;
    if (!this.numbers) return;
    const matrices = this.numbers.instanceMatrix.array as Float32Array;
    this.decals.forEach((decal, n) => {
      multiply(matrices, 16 * n, worlds, 16 * decal.node, this.locals, 16 * n);
      for (const column of [0, 8]) for (let k = 0; k < 3; k++) matrices[16 * n + column + k]! *= decal.size;
    });
    this.numbers.instanceMatrix.needsUpdate = true;
  }

  dispose(): void {
    this.texture.dispose();
    for (const mesh of [this.heads, this.numbers]) {
      mesh?.geometry.dispose();
      (mesh?.material as ShaderMaterial | undefined)?.dispose();
    }
    this.numbers?.dispose();
  }

  private headGeometry(columns: number): InstancedBufferGeometry {
    const geometry = new InstancedBufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(new Float32Array([-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0]), 3));
    geometry.setIndex([0, 1, 2, 0, 2, 3]);
    geometry.setAttribute("anchor", this.anchors);
    geometry.setAttribute("cell", cells(this.robots.map((_, n) => n), columns, this.robots.length, 0));
    geometry.instanceCount = this.robots.length;
    return geometry;
  }

  private numberMesh(columns: number): InstancedMesh {
    const plane = new PlaneGeometry(1, 1).rotateX(Math.PI / 2);
    plane.setAttribute("cell", cells(this.decals.map(d => d.robot), columns, this.robots.length, 1));
    const mesh = new InstancedMesh(plane, numberMaterial(this.texture), this.decals.length);
    mesh.instanceMatrix.setUsage(DynamicDrawUsage);
    mesh.frustumCulled = false;
    mesh.renderOrder = 1;
    return mesh;
  }
}

/// Rectangles of these robots in the atlas: left, bottom, width, height. Labels are in the lower half of the rows,
/// numbers in the upper half.
function cells(robots: readonly number[], columns: number, count: number, half: 0 | 1): InstancedBufferAttribute {
  const rows = Math.ceil(count / columns);
  const values = robots.flatMap(robot => {
    const [column, row] = [robot % columns, Math.floor(robot / columns) + half * rows];
    return [column / columns, row / (2 * rows), 1 / columns, 1 / (2 * rows)];
  });
  return new InstancedBufferAttribute(new Float32Array(values), 4);
}

function paintAtlas(robots: readonly Robot[], teams: TeamColours, columns: number): CanvasTexture {
  const rows = Math.max(1, Math.ceil(robots.length / columns));
  const canvas = document.createElement("canvas");
  canvas.width = columns * cellWidth;
  canvas.height = 2 * rows * cellHeight;
  const paint = canvas.getContext("2d")!;
  paint.textAlign = "center";
  paint.textBaseline = "middle";
  robots.forEach((robot, n) => {
    const [x, row] = [((n % columns) + 0.5) * cellWidth, Math.floor(n / columns)];
    const fromBelow = (r: number) => canvas.height - (r + 0.5) * cellHeight;
    const text = robot.number > 0 ? String(robot.number) : "?";
    paintLabel(paint, x, fromBelow(row), text, robot, teams);
    paintNumber(paint, x, fromBelow(row + rows), text, robot, teams);
  });
  const texture = new CanvasTexture(canvas);
  texture.minFilter = LinearMipmapLinearFilter;
  texture.magFilter = LinearFilter;
  texture.premultiplyAlpha = true;
  return texture;
}

function paintLabel(paint: CanvasRenderingContext2D, x: number, y: number, text: string, robot: Robot, teams: TeamColours): void {
  const colour = teamColour(robot.side, teams);
  paint.beginPath();
  paint.roundRect(x - 36, y - 25, 72, 50, 22);
  paint.fillStyle = css(colour);
  paint.fill();
  paint.lineWidth = 5;
  paint.strokeStyle = "#ffffff";
  paint.stroke();
  paint.fillStyle = css(inkOn(colour));
  paint.font = "700 42px system-ui, 'DejaVu Sans', sans-serif";
  paint.fillText(text, x, y + 3);
}

function paintNumber(paint: CanvasRenderingContext2D, x: number, y: number, text: string, robot: Robot, teams: TeamColours): void {
  paint.fillStyle = css(inkOn(teamColour(robot.side, teams)));
  paint.font = "800 58px system-ui, 'DejaVu Sans', sans-serif";
  paint.fillText(text, x, y + 4);
}

/// Labels are as large as a sign of 0.3 m width, but clamped to this range of heights in pixels.
function headMaterial(atlas: Texture, screen: Vector3): ShaderMaterial {
  return new ShaderMaterial({
    transparent: true, premultipliedAlpha: true, depthWrite: false,
    uniforms: { atlas: { value: atlas }, screen: { value: screen } },
    vertexShader: /* glsl */ `
      attribute vec4 anchor;
      attribute vec4 cell;
      uniform vec3 screen;
      varying vec2 place;
      void main() {
        vec4 clip = projectionMatrix * (viewMatrix * vec4(anchor.xyz, 1.0));
        float half_ = clamp(0.075 * projectionMatrix[1][1] * screen.y / clip.w, 8.5 * screen.z, 17.0 * screen.z);
        place = cell.xy + (0.5 + 0.5 * position.xy) * cell.zw;
        clip.xy += (position.xy + vec2(0.0, 1.0)) * vec2(half_ * ${(cellWidth / cellHeight).toFixed(3)}, half_) / screen.xy * clip.w;
        clip.z -= 0.002 * clip.w;
        gl_Position = clip;
      }`,
    fragmentShader: /* glsl */ `
      uniform sampler2D atlas;
      varying vec2 place;
      void main() {
        gl_FragColor = texture2D(atlas, place);
      }`,
  });
}

function numberMaterial(atlas: Texture): ShaderMaterial {
  return new ShaderMaterial({
    transparent: true, premultipliedAlpha: true, depthWrite: false, polygonOffset: true, polygonOffsetFactor: -2, polygonOffsetUnits: -2,
    uniforms: { atlas: { value: atlas } },
    vertexShader: /* glsl */ `
      attribute vec4 cell;
      varying vec2 place;
      void main() {
        place = cell.xy + uv * cell.zw;
        gl_Position = projectionMatrix * (viewMatrix * (instanceMatrix * vec4(position, 1.0)));
      }`,
    fragmentShader: /* glsl */ `
      uniform sampler2D atlas;
      varying vec2 place;
      void main() { gl_FragColor = texture2D(atlas, place); }`,
  });
}
